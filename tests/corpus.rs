//! Every file of the fuzzers' corpus: what was once a finding stays mended. `tests/fuzz/README.md` says how to look for more.

use std::{
    fs,
    path::{Path, PathBuf},
    sync::mpsc,
    thread,
    time::Duration,
};

use bidir_fuzz_subjects::TARGETS;

/// For one file, on a machine that does other things as well.
const LONG: Duration = Duration::from_secs(20);

fn fuzz() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz")
}

/// The names of what is in a folder of the fuzzers, sorted.
fn names(folder: &str) -> Vec<String> {
    let entries = fs::read_dir(fuzz().join(folder)).unwrap_or_else(|error| panic!("{folder}: {error}"));
    let mut names: Vec<_> = entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("letters")).collect();
    names.sort();
    names
}

/// Gives a target every file of its corpus; none may take longer than [`LONG`].
fn replay(target: &str) {
    let (_, run) = TARGETS.into_iter().find(|(name, _)| *name == target).expect("a target");
    let folder = format!("corpus/{target}");
    let files = names(&folder);
    assert!(!files.is_empty(), "{folder} is empty");
    let inputs: Vec<_> = files.iter().map(|name| fs::read(fuzz().join(&folder).join(name)).expect("a file")).collect();
    let (done, dones) = mpsc::channel();
    // A thread that hangs is left behind: the test fails, and the process ends.
    let worker = thread::spawn(move || {
        for input in inputs {
            run(&input);
            if done.send(()).is_err() {
                break;
            }
        }
    });
    for name in &files {
        match dones.recv_timeout(LONG) {
            Ok(()) => {}
            Err(mpsc::RecvTimeoutError::Timeout) => panic!("{folder}/{name} takes longer than {LONG:?}"),
            Err(mpsc::RecvTimeoutError::Disconnected) => panic!("{folder}/{name} panicked"),
        }
    }
    worker.join().expect("an end");
    println!("{target}: {} files", files.len());
}

#[test]
fn every_scene_of_the_corpus_is_refused_or_traced() {
    replay("scene_xml");
}

#[test]
fn every_mesh_of_the_corpus_is_refused_or_built() {
    replay("obj");
    replay("ply");
    replay("serialized");
}

#[test]
fn every_image_of_the_corpus_is_refused_or_decoded() {
    replay("exr");
    replay("hdr");
    replay("png");
}

#[test]
fn every_manifest_of_the_corpus_is_refused_or_read() {
    replay("manifest");
}

#[test]
fn every_module_of_the_corpus_is_refused_or_answers() {
    replay("module");
}

#[test]
fn every_target_has_a_fuzzer_and_a_corpus() {
    let mut targets: Vec<_> = TARGETS.iter().map(|(name, _)| (*name).to_owned()).collect();
    targets.sort();
    assert_eq!(names("corpus"), targets);
    assert_eq!(names("targets"), targets.iter().map(|name| format!("{name}.rs")).collect::<Vec<_>>());
}
