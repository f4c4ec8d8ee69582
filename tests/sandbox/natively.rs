//! The plugins that are crates answer natively what their modules answer, bit for bit, whatever their parameters are.

use std::sync::Arc;

use bidir::plugin::{Engine, Kind, Module, Roster, Sandbox, ShaderId, Strictness, Value};
use bidir_kernel::{Bsdf, Carried, Profile, Sampler, Vec2, sampler::Independent};

use super::{direction, root};

/// Questions to each shader.
const ASKED: u64 = 4000;

/// A module that is committed, with parameters at random within their ranges for every shader.
fn sandboxed(name: &str, kind: Kind) -> (Arc<Module>, Vec<Vec<u8>>) {
    let module = Module::load(&Engine::new().expect("an engine"), &root().join(format!("plugins/prebuilt/{name}.wasm"))).expect("a module");
    assert_eq!(module.manifest().kind, kind, "{name}");
    let blocks = (0..20).map(|shader| block(&module, &mut Independent::new(9, 0, shader))).collect();
    (Arc::new(module), blocks)
}

/// A parameter block: floats and colours at random, the rest as the manifest has it.
fn block(module: &Module, numbers: &mut Independent) -> Vec<u8> {
    let mut block = module.manifest().defaults();
    for parameter in &module.manifest().params {
        let (least, most) = (parameter.min.unwrap_or(0.0), parameter.max.unwrap_or(1.0));
        let mut number = || (least + (most.min(least + 100.0) - least) * f64::from(numbers.next())) as f32;
        for value in [Value::Rgb([number(), number(), number()]), Value::Float(number())] {
            if parameter.write(&value, &mut block).is_ok() {
                break;
            }
        }
    }
    block
}

fn asked(module: &Arc<Module>, block: &[u8]) -> (Sandbox, ShaderId) {
    let mut roster = Roster::default();
    let id = roster.add(module, block);
    (Sandbox::new(Arc::new(roster), Strictness::Strict), id)
}

fn bsdf<B: Bsdf>(name: &str, native: impl Fn(&[u8]) -> B) {
    let (module, blocks) = sandboxed(name, Kind::Bsdf);
    let mut scattered = 0;
    for block in &blocks {
        let (native, (sandbox, id)) = (native(block), asked(&module, block));
        let sandboxed = sandbox.bsdf(id);
        for i in 0..ASKED / blocks.len() as u64 {
            let mut numbers = Independent::new(4, 1, i);
            let (wo, wi, u) = (direction(&mut numbers), direction(&mut numbers), [(); 3].map(|()| numbers.next()));
            let carried = if i % 2 == 0 { Carried::Radiance } else { Carried::Importance };
            let (here, there) = (native.eval(wo, wi, carried), sandboxed.eval(wo, wi, carried));
            // Their words are those of the bits: each f32 that is not NaN has words of its own.
            assert_eq!(format!("{here:?}"), format!("{there:?}"), "{name}, {block:?}, {wo} {wi}");
            let (here, there) = (native.sample(wo, u, carried), sandboxed.sample(wo, u, carried));
            assert_eq!(format!("{here:?}"), format!("{there:?}"), "{name}, {block:?}, {wo} {u:?}");
            scattered += u32::from(here.is_some());
        }
        assert_eq!(sandbox.fault(), None);
    }
    assert!(scattered > 500, "{name}: {scattered}");
}

fn light<P: Profile>(name: &str, native: impl Fn(&[u8]) -> P) {
    let (module, blocks) = sandboxed(name, Kind::Light);
    let mut lit = 0;
    for block in &blocks {
        let (native, (sandbox, id)) = (native(block), asked(&module, block));
        let sandboxed = sandbox.profile(id);
        for i in 0..ASKED / blocks.len() as u64 {
            let mut numbers = Independent::new(5, 1, i);
            let (uv, w, u) = (Vec2::new(numbers.next(), numbers.next()), direction(&mut numbers), [numbers.next(), numbers.next()]);
            let (here, there) = (native.eval(uv, w), sandboxed.eval(uv, w));
            assert_eq!(format!("{here:?}"), format!("{there:?}"), "{name}, {block:?}, {w}");
            let (here, there) = (native.emit(uv, u), sandboxed.emit(uv, u));
            assert_eq!(format!("{here:?}"), format!("{there:?}"), "{name}, {block:?}, {u:?}");
            lit += u32::from(here.is_some());
        }
        assert_eq!(sandbox.fault(), None);
    }
    assert!(lit > 500, "{name}: {lit}");
}

#[test]
fn bsdfs_answer_the_same_linked_and_sandboxed() {
    bsdf("velvet", velvet::bsdf);
    bsdf("thinfilm", thinfilm::bsdf);
    bsdf("coatedmirror", coatedmirror::bsdf);
    bsdf("leaf-rust", leaf::bsdf);
}

#[test]
fn lights_answer_the_same_linked_and_sandboxed() {
    light("sky", sky::light);
    light("iesspot-rust", iesspot::light);
    light("gobo-rust", gobo::light);
}
