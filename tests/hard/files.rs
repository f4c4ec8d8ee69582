//! Cases that are scenes. The first line of a file in `scenes/` is a comment that says what must hold, in these words:
//!
//! ```text
//! finite                      every pixel is a finite number, by every estimator
//! agree all|not-light|not-path [xN]   the estimators make one picture, with N times the samples
//! mean V within W by path,…   the mean of the picture is V, but for a share W
//! black                       every pixel is 0
//! same                        nothing changes when all is scaled, moved and turned
//! ```
//!
//! In the sandbox every shader whose type ends in `$kind` is a module, and must make the native picture bit for bit.

use std::{
    fs,
    path::{Path, PathBuf},
};

use bidir::{image::Image, load, plugin::Library, render::Job, scene::Scene};
use bidir_kernel::{Heuristic, Techniques};

use super::{Form, Held, transforms};
use crate::{
    estimators::{ALL, Agreement, DOUBT, NOT_LIGHT, NOT_PATH},
    pictures::{BDPT, LIGHT, PATH, Subject},
    statistics::{Estimate, threshold},
};

/// By their names in files and messages.
pub const ESTIMATORS: [(&str, Techniques); 3] = [("path", PATH), ("light", LIGHT), ("bdpt", BDPT)];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("hard/scenes")
}

/// The modules that are committed.
pub fn library() -> Library {
    Library::new(vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("../plugins/prebuilt")])
}

/// The scene files of a case.
pub fn of_case(number: u32) -> Vec<PathBuf> {
    let mut files: Vec<_> = fs::read_dir(folder()).expect("scenes").map(|entry| entry.expect("an entry").path()).collect();
    files.retain(|file| name(file).starts_with(&format!("{number:02}_")));
    files.sort();
    files
}

fn name(file: &Path) -> String {
    file.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// Reads a scene; what it names with `$kind` is a module in the sandbox.
pub fn read(file: &Path, form: Form) -> Subject {
    let text = fs::read_to_string(file).expect("a scene");
    let kinds = text.contains("name=\"kind\"") && form == Form::Sandbox;
    let defines: Vec<_> = kinds.then(|| ("kind".to_owned(), ".wasm".to_owned())).into_iter().collect();
    let description = load::load(file, &defines, &library()).expect("a good scene").description;
    let scene = Scene::new(&description).expect("a scene");
    Subject { description, scene }
}

/// Reads the content of a scene that may name the files beside the others.
pub fn read_text(content: &str) -> Subject {
    let text = format!(r#"<scene version="3.0.0">{content}</scene>"#);
    let loaded = load::load_str(&text, Path::new("case.xml"), Some(&folder()), &[], &library()).expect("a good scene");
    let scene = Scene::new(&loaded.description).expect("a scene");
    Subject { description: loaded.description, scene }
}

/// Everything that the files of a case say must hold.
pub fn run(number: u32, form: Form) -> Vec<Held> {
    let files = of_case(number);
    assert!(!files.is_empty(), "case {number} has no scene");
    files.iter().flat_map(|file| of_file(file, form)).collect()
}

fn of_file(file: &Path, form: Form) -> Vec<Held> {
    let text = fs::read_to_string(file).expect("a scene");
    let first = text.lines().next().and_then(|line| line.strip_prefix("<!--")?.strip_suffix("-->"));
    let must = first.unwrap_or_else(|| panic!("{} does not begin with what must hold", file.display()));
    let native = read(file, Form::Native);
    if form == Form::Sandbox {
        return if text.contains("name=\"kind\"") { vec![twins(&name(file), &native, &read(file, form))] } else { Vec::new() };
    }
    must.split(';').flat_map(|must| held(&name(file), must.trim(), &native)).collect()
}

fn held(name: &str, must: &str, subject: &Subject) -> Vec<Held> {
    let words: Vec<_> = must.split_whitespace().collect();
    match words[..] {
        ["finite"] => vec![finite(name, subject)],
        ["agree", which] => agree(name, subject, which, 1),
        ["agree", which, times] => agree(name, subject, which, times.trim_start_matches('x').parse().expect("a number")),
        ["mean", value, "within", within, "by", by] => {
            let number = |text: &str| text.parse::<f64>().expect("a number");
            by.split(',').flat_map(|by| mean(name, subject, by, number(value), number(within))).collect()
        }
        ["black"] => vec![black(name, subject)],
        ["same"] => transforms::same(name, subject),
        _ => panic!("{name}: \"{must}\" says nothing"),
    }
}

/// A picture by few samples, whatever becomes of it.
pub fn image(subject: &Subject, techniques: Techniques, samples: u32) -> Image {
    let job = subject.job(subject.strategy(techniques, Heuristic::Balance), samples, 5);
    subject.image(&Job { threads: 2, ..job })
}

/// Numbers of a picture that are none, or are negative.
pub fn bad(image: &Image) -> usize {
    image.pixels.iter().flatten().filter(|value| !(value.is_finite() && **value >= 0.0)).count()
}

fn finite(name: &str, subject: &Subject) -> Held {
    let pictures = ESTIMATORS.map(|(_, techniques)| image(subject, techniques, 64));
    // A picture that is black all over would be finite too.
    let dark = pictures.iter().all(|picture| picture.pixels.iter().flatten().all(|value| *value == 0.0));
    let found = pictures.iter().map(bad).sum::<usize>();
    Held::none(format!("{name}: values that are no finite number, or no light at all"), if dark { usize::MAX } else { found })
}

fn agree(name: &str, subject: &Subject, which: &str, effort: u32) -> Vec<Held> {
    let estimators = match which {
        "all" => ALL,
        "not-light" => NOT_LIGHT,
        "not-path" => NOT_PATH,
        _ => panic!("{name}: there are no estimators \"{which}\""),
    };
    let agreement = Agreement::of(subject, estimators, effort);
    vec![
        Held::new(
            format!("{name}: deviation of {} estimators, as a share of what chance explains", estimators.len()),
            agreement.worst(),
            1.0,
        ),
        Held::new(format!("{name}: standard error of a mean, as a share of it"), agreement.doubt(), DOUBT),
        Held::new(format!("{name}: difference of two means, as a share of them"), agreement.apart(), (4.0 * agreement.doubt()).max(0.01)),
    ]
}

/// An estimate against what is known, as [`crate::statistics::assert_is`] has it.
pub fn known(what: &str, found: &Estimate, wanted: f64, within: f64) -> Vec<Held> {
    let apart = found.minus(&Estimate::exactly(wanted));
    let limit = threshold(12, apart.degrees);
    let (share, doubt) = ((apart.mean / wanted).abs(), apart.error / wanted.abs());
    vec![
        Held::new(
            format!("{what}: {:.6} for {wanted:.6}, as a share of what chance explains", found.mean),
            apart.deviation(wanted) / limit,
            1.0,
        ),
        Held::new(format!("{what}: the same, relatively"), share, within.max(3.0 * doubt)),
        Held::new(format!("{what}: its standard error, relatively"), doubt, 0.5 * within),
    ]
}

fn mean(name: &str, subject: &Subject, by: &str, wanted: f64, within: f64) -> Vec<Held> {
    let (estimator, samples) = by.split_once('*').map_or((by, 256), |(estimator, samples)| (estimator, samples.parse().expect("a number")));
    let (_, techniques) = ESTIMATORS.into_iter().find(|(name, _)| *name == estimator).expect("an estimator");
    let found = subject.pictures(subject.strategy(techniques, Heuristic::Balance), samples, 1);
    known(&format!("{name}, {estimator}"), &found.mean(found.whole(), &[0, 1, 2]), wanted, within)
}

fn black(name: &str, subject: &Subject) -> Held {
    let lit = |techniques| image(subject, techniques, 64).pixels.iter().filter(|pixel| **pixel != [0.0; 3]).count();
    Held::none(format!("{name}: pixels that are not black"), ESTIMATORS.map(|(_, techniques)| lit(techniques)).iter().sum())
}

/// Pixels that differ in any bit.
pub fn different(a: &Image, b: &Image) -> usize {
    let bits = |image: &Image| image.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect::<Vec<_>>();
    if (a.width, a.height) == (b.width, b.height) { bits(a).iter().zip(bits(b)).filter(|(a, b)| **a != *b).count() } else { usize::MAX }
}

fn twins(name: &str, native: &Subject, sandboxed: &Subject) -> Held {
    let differ = |techniques| different(&image(native, techniques, 8), &image(sandboxed, techniques, 8));
    Held::none(format!("{name}: pixels that differ from the native picture"), differ(PATH) + differ(LIGHT) + differ(BDPT))
}
