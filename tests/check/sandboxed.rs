//! Mistakes through the sandbox, as the command finds them.

use std::{
    collections::BTreeMap,
    path::Path,
    sync::{Arc, Mutex, OnceLock},
};

use bidir::{
    check::{self, Case, Plugin, Report, Test},
    plugin::{Engine, Module, Roster, Sandbox, Strictness, Value},
};
use bidir_kernel::{Bsdf, Carried, Sampler, Vec3, sampler::Independent};

use super::settings;

fn module() -> &'static Arc<Module> {
    static MODULE: OnceLock<Arc<Module>> = OnceLock::new();
    let load = || Module::load(&Engine::new().expect("an engine"), &Path::new(env!("CARGO_MANIFEST_DIR")).join("wrong/wrong.wasm"));
    MODULE.get_or_init(|| Arc::new(load().expect("a module")))
}

fn given(mistake: i32) -> [(String, Value); 1] {
    [("mistake".to_owned(), Value::Int(mistake))]
}

/// Of a check of each mistake: whoever comes first makes it.
fn report(mistake: i32) -> Arc<Report> {
    static REPORTS: Mutex<BTreeMap<i32, Arc<OnceLock<Arc<Report>>>>> = Mutex::new(BTreeMap::new());
    let one = Arc::clone(REPORTS.lock().expect("no test that failed here").entry(mistake).or_default());
    let make = || check::bsdfs(&Plugin::new(module(), &given(mistake), 5).expect("parameters"), &settings(5));
    Arc::clone(one.get_or_init(|| Arc::new(make())))
}

/// It gives up when it is asked with certain numbers, which natively would end the test.
const TRAPS: i32 = 41;

#[test]
fn mistakes_are_named_in_the_sandbox_too() {
    let expected = [
        (1, Test::Mass),
        (3, Test::Weight),
        (7, Test::Reverse),
        (11, Test::Carried),
        (17, Test::Albedo),
        (18, Test::Range),
        (19, Test::Weight),
        (20, Test::Purity),
        (21, Test::Sampling),
        (22, Test::Mass),
        (23, Test::Lobes),
        (29, Test::Chance),
        (TRAPS, Test::Calls),
    ];
    for (mistake, test) in expected {
        let report = report(mistake);
        assert_eq!(report.culprit, Some(test), "{mistake}: {report}");
    }
    let report = report(0);
    assert!(report.passed, "{report}");
}

#[test]
fn a_case_replayed_finds_what_was_found() {
    for mistake in [1, 3, 18] {
        let report = report(mistake);
        let verdict = report.verdict(report.culprit.expect("a culprit")).expect("a verdict");
        let case: Case = verdict.case.as_ref().expect("a case").to_string().parse().expect("as it was written");
        let parts = case.parameters.split('/').map(|part| part.split_once('=').expect("a value"));
        let plugin = Plugin::with(module(), &check::values(module().manifest(), parts).expect("values")).expect("parameters");
        let again = check::replay_bsdf(&plugin, &case).expect("a set");
        let found = again.verdict(case.test).expect("a verdict");
        assert_eq!((found.statistic, found.threshold, &found.inputs), (verdict.statistic, verdict.threshold, &verdict.inputs));
        assert_eq!(found.sentence, verdict.sentence);
    }
}

/// Among others, tells a module that is older than its source.
#[test]
fn the_module_makes_the_same_mistakes_as_the_crate() {
    for mistake in (0..43).filter(|mistake| ![20, TRAPS].contains(mistake)) {
        for base in ["mixed", "glass", "plastic", "clear"] {
            let values = [("mistake", Value::Int(mistake)), ("base", base.into()), ("alpha", 0.3.into())];
            let mut block = module().manifest().defaults();
            for (name, value) in &values {
                module().manifest().parameter(name).expect("a parameter").write(value, &mut block).expect("a value");
            }
            let native = wrong::bsdf(&block);
            let mut roster = Roster::default();
            let shader = roster.shader(module(), &values).expect("a shader");
            let sandbox = Sandbox::new(Arc::new(roster), Strictness::Lenient);
            let sandboxed = sandbox.bsdf(shader);
            for i in 0..100 {
                let mut numbers = Independent::new(1, 2, i);
                let mut direction = || Vec3::from([(); 3].map(|()| 2.0 * numbers.next() - 1.0)).normalize();
                let (wo, wi) = (direction(), direction());
                let (u, carried) = ([(); 3].map(|()| numbers.next()), Carried::Importance);
                let (here, there) = (native.eval(wo, wi, carried), sandboxed.eval(wo, wi, carried));
                if sandbox.quarantine().count() == 0 {
                    assert_eq!(format!("{here:?}"), format!("{there:?}"), "{mistake}, {base}, {wo} {wi}");
                }
                let (here, there) = (native.sample(wo, u, carried), sandboxed.sample(wo, u, carried));
                if sandbox.quarantine().count() == 0 {
                    assert_eq!(format!("{here:?}"), format!("{there:?}"), "{mistake}, {base}, {wo} {u:?}");
                }
            }
        }
    }
}
