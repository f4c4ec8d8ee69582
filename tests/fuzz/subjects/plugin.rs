//! Plugins: their manifests, and whole modules.

use std::{
    path::Path,
    sync::{Arc, OnceLock},
};

use bidir::plugin::{Engine, Kind, Manifest, Module, Parameter, ParameterType, Roster, Sandbox, Strictness, Value};
use bidir_kernel::{Bsdf, Carried, Profile, Scatter, Scattered, Spectrum, Vec2, Vec3};

use crate::told;

/// The largest parameter block, in bytes.
const LARGEST_BLOCK: usize = 4096;

/// The largest memory of a module, in bytes.
const LARGEST_MEMORY: usize = 16 << 20;

/// A manifest is refused in words, or has defaults that it takes itself.
pub fn manifest(data: &[u8]) {
    let manifest = match Manifest::read(data) {
        Ok(manifest) => manifest,
        Err(why) => return assert!(!why.trim().is_empty()),
    };
    let mut block = manifest.defaults();
    assert!(block.len() == manifest.block_bytes() && block.len() <= LARGEST_BLOCK);
    assert_eq!(manifest.params.is_empty(), manifest.words(&block).is_empty());
    match manifest.kind {
        Kind::Bsdf => assert!(!manifest.lobes.is_empty() && manifest.lobes().0 != 0),
        Kind::Light => assert!(!manifest.emits_from.is_empty()),
    }
    for parameter in &manifest.params {
        assert!(manifest.parameter(&parameter.name).is_some());
        written(parameter, &mut block);
    }
}

/// Offers values of every type.
fn written(parameter: &Parameter, block: &mut [u8]) {
    let (min, max) = parameter.range();
    let known = parameter.values.last().cloned().unwrap_or_default();
    let values = [0.5, f32::NAN, f32::INFINITY, min, max].map(Value::Float).into_iter();
    let values = values.chain([i32::MIN, 0, i32::MAX].map(Value::Int)).chain([Value::Rgb([0.0, 0.5, f32::NAN])]);
    for value in values.chain([Value::Bool(true), Value::Word(known.clone()), Value::Word("no such word".to_owned())]) {
        match parameter.write(&value, block) {
            Err(why) => assert!(!why.trim().is_empty()),
            Ok(()) => assert!(!matches!(value, Value::Float(v) if !v.is_finite()), "{value:?} is taken for {parameter:?}"),
        }
    }
    if parameter.kind == ParameterType::Enum {
        assert_eq!(parameter.write(&Value::Word(known), block), Ok(()));
    }
}

/// One engine for all: it takes a long stretch of addresses.
fn engine() -> &'static Engine {
    static ENGINE: OnceLock<Engine> = OnceLock::new();
    ENGINE.get_or_init(|| Engine::new().expect("a machine that runs WebAssembly"))
}

const WO: Vec3 = Vec3::new(0.6, 0.0, 0.8);
const WI: Vec3 = Vec3::new(0.0, -0.6, 0.8);
const BELOW: Vec3 = Vec3::new(0.0, 0.8, -0.6);

/// A module is refused with a remedy, or answers each of its exports within its limits, and only with what an answer may be.
pub fn module(data: &[u8]) {
    let module = match Module::from_bytes(engine(), Path::new("fuzz.wasm"), data, None) {
        Ok(module) => Arc::new(module),
        Err(error) => return told(&error),
    };
    let mut roster = Roster::default();
    let shader = roster.add(&module, &module.manifest().defaults());
    let sandbox = Sandbox::new(Arc::new(roster), Strictness::Lenient);
    match module.manifest().kind {
        Kind::Bsdf => surface(&sandbox.bsdf(shader)),
        Kind::Light => lamp(&sandbox.profile(shader)),
    }
    assert!(sandbox.memory_bytes(shader).is_none_or(|bytes| bytes <= LARGEST_MEMORY));
    if let Some(fault) = sandbox.fault() {
        assert!(fault.to_string().starts_with("fuzz.wasm: "), "{fault}");
    }
    for entry in sandbox.quarantine().0 {
        assert!(entry.to_string().contains("fuzz.wasm"), "{entry}");
    }
}

fn surface(bsdf: &impl Bsdf) {
    let u = [0.3, 0.6, 0.9];
    scatter(&bsdf.eval(WO, WI, Carried::Radiance));
    scattered(bsdf.sample(WO, u, Carried::Importance));
    let (evaluated, sampled) = bsdf.eval_and_sample(WO, BELOW, u, Carried::Radiance);
    scatter(&evaluated);
    scattered(sampled);
    let mut scatters = [Scatter::NONE; 2];
    bsdf.eval_n(WO, &[WI, BELOW], Carried::Radiance, &mut scatters);
    scatters.iter().for_each(scatter);
}

fn scatter(scatter: &Scatter) {
    assert!(light(scatter.value) && number(scatter.pdf.0) && number(scatter.pdf_rev.0), "{scatter:?}");
}

fn scattered(scattered: Option<Scattered>) {
    let fine = |s: &Scattered| light(s.weight) && number(s.eta) && s.eta > 0.0 && (s.wi.length() - 1.0).abs() < 0.02;
    assert!(scattered.as_ref().is_none_or(fine), "{scattered:?}");
}

fn lamp(profile: &impl Profile) {
    let profiled = profile.eval(Vec2::new(0.3, 0.6), WI);
    assert!(light(profiled.radiance) && number(profiled.pdf.0), "{profiled:?}");
    let emitted = profile.emit(Vec2::new(0.3, 0.6), [0.9, 0.1]);
    assert!(emitted.as_ref().is_none_or(|e| light(e.profiled.radiance) && number(e.profiled.pdf.0)), "{emitted:?}");
}

fn light(value: Spectrum) -> bool {
    value.0.into_iter().all(number)
}

fn number(value: f32) -> bool {
    (0.0..1e30).contains(&value)
}
