//! What is asked of plugins can be counted and timed.

use std::{path::Path, sync::Arc};

use bidir::plugin::{Engine, Metered, Module, Roster, Sandbox, ShaderId, Strictness};
use bidir_kernel::{Bsdf, Carried, Scatter, Vec3};

use super::root;

const GOOD: &str = include_str!("../hostile/modules/good.wat");
const HARM: &str = include_str!("../hostile/modules/harm.wat");

/// What `harm.wat` is told to do when it is asked.
const GIVE_UP: [u8; 8] = [4, 0, 0, 0, 4, 0, 0, 0];

/// One shader of each module.
fn sandbox(modules: Vec<Module>) -> (Sandbox, Vec<ShaderId>) {
    let mut roster = Roster::default();
    let shaders = modules.into_iter().map(|module| roster.add(&Arc::new(module), &GIVE_UP)).collect();
    (Sandbox::new(Arc::new(roster), Strictness::Lenient), shaders)
}

fn written(text: &str) -> Module {
    let bytes = wat::parse_str(text).expect("text that is well formed");
    Module::from_bytes(&Engine::new().expect("an engine"), Path::new("written.wasm"), &bytes, None).expect("a good module")
}

/// A single call, two at once, and five at once.
fn ask(sandbox: &Sandbox, shader: ShaderId) {
    let bsdf = sandbox.bsdf(shader);
    bsdf.eval(Vec3::Z, Vec3::Z, Carried::Radiance);
    bsdf.eval_and_sample(Vec3::Z, Vec3::Z, [0.5; 3], Carried::Radiance);
    bsdf.eval_n(Vec3::Z, &[Vec3::Z; 5], Carried::Radiance, &mut [Scatter::NONE; 5]);
}

#[test]
fn calls_are_counted_for_each_module_while_they_are_metered() {
    let file = root().join("plugins/prebuilt/diffuse.wasm");
    let at_once = Module::load(&Engine::new().expect("an engine"), &file).expect("a module");
    let (sandbox, shaders) = sandbox(vec![written(GOOD), at_once]);
    assert_eq!(sandbox.files().last(), Some(&*file));
    ask(&sandbox, shaders[1]);
    let ((), first) = sandbox.metered(|| ask(&sandbox, shaders[0]));
    ask(&sandbox, shaders[0]);
    let ((), second) = sandbox.metered(|| ask(&sandbox, shaders[1]));
    let calls = |metered: &[Metered]| metered.iter().map(|module| module.calls).collect::<Vec<_>>();
    // Without exports that answer several questions, each is a call.
    assert_eq!((calls(&first), calls(&second)), (vec![1 + 2 + 5, 0], vec![0, 1 + 1 + 1]));
    assert!(first[0].nanoseconds > 0.0 && first[1].nanoseconds == 0.0, "{first:?}");
}

#[test]
fn a_call_that_breaks_off_breaks_off_metered_too() {
    let (sandbox, shaders) = sandbox(vec![written(HARM)]);
    sandbox.metered(|| ask(&sandbox, shaders[0]));
    assert!(sandbox.faulted() && sandbox.fault().is_some());
    let ((), metered) = sandbox.metered(|| ask(&sandbox, shaders[0]));
    assert_eq!(metered[0], Metered::default());
}
