//! What is right passes, whatever the seed.

use std::{fs, path::Path, sync::Arc};

use bidir::{
    check::{self, Plugin, Promises, Settings, Test, builtin},
    load::catalog,
    plugin::{Engine, Kind, Module, modules},
};
use bidir_kernel::{
    Bsdf, Carried, Lobe, Made, PerSolidAngle, Real, Scatter, Scattered, Spectrum, Vec3,
    real::INV_PI,
    warp::{cosine_hemisphere, cosine_hemisphere_pdf},
};

use super::{settings, surface};

fn prebuilt() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../plugins/prebuilt")
}

/// Checks a module as the command does, with fewer samples.
fn passes(engine: &Engine, file: &Path, seeds: std::ops::Range<u64>, effort: u32) {
    let module = Arc::new(Module::load(engine, file).expect("a module"));
    for seed in seeds {
        let plugin = Plugin::new(&module, &[], seed).expect("parameters");
        let settings = Settings { effort: Some(effort), ..settings(seed) };
        let report =
            if module.manifest().kind == Kind::Bsdf { check::bsdfs(&plugin, &settings) } else { check::lights(&plugin, &settings) };
        assert!(report.passed, "{}, seed {seed}: {report}", file.display());
    }
}

/// More seeds with `BIDIR_CHECK_SEEDS`. With few samples what is right passes no sooner: bounds follow their number.
#[test]
fn every_committed_module_passes() {
    let engine = Engine::new().expect("an engine");
    let seeds = std::env::var("BIDIR_CHECK_SEEDS").ok().and_then(|seeds| seeds.parse().ok()).unwrap_or(1);
    for file in modules(&prebuilt()).expect("a folder") {
        passes(&engine, &file, 0..seeds, 10);
    }
}

#[test]
fn every_built_in_has_its_module_or_a_reason() {
    let known: Vec<_> = builtin::MODULES.iter().map(|(name, _)| *name).chain(builtin::OTHERS.iter().map(|(name, _)| *name)).collect();
    for name in catalog::supported("bsdf").iter().chain(catalog::supported("emitter")) {
        assert!(known.contains(name), "{name}");
    }
    for (name, bytes) in builtin::MODULES {
        assert_eq!(fs::read(prebuilt().join(format!("{name}.wasm"))).expect("a module"), bytes, "{name}");
    }
}

/// A diffuse surface in three steps of grey, told by ω_o alone: not reciprocal, and meant so.
#[derive(Clone, Copy)]
struct Toon;

impl Toon {
    fn shade(self, wo: Vec3) -> Real {
        0.3 * (3.0 * wo.z).ceil().clamp(1.0, 3.0)
    }
}

impl Bsdf for Toon {
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        let scatter = Matt.eval(wo, wi, carried);
        Scatter { value: scatter.value * self.shade(wo), ..scatter }
    }

    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        Matt.sample(wo, u, carried).map(|sample| Scattered { weight: sample.weight * self.shade(wo), ..sample })
    }

    fn lobes(&self) -> Lobe {
        Lobe::DIFFUSE_REFLECTION
    }
}

/// White, and alike in every direction.
#[derive(Clone, Copy)]
struct Matt;

impl Bsdf for Matt {
    fn eval(&self, wo: Vec3, wi: Vec3, _: Carried) -> Scatter {
        if !(wo.z > 0.0 && wi.z > 0.0) {
            return Scatter::NONE;
        }
        let pdf = |w: Vec3| PerSolidAngle(cosine_hemisphere_pdf(w.z));
        Scatter { value: Spectrum::splat(wi.z * INV_PI), pdf: pdf(wi), pdf_rev: pdf(wo) }
    }

    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        let wi = cosine_hemisphere([u[0], u[1]]);
        let Scatter { pdf, pdf_rev, .. } = self.eval(wo, wi, carried);
        let made = Made::Smooth { pdf, pdf_rev };
        (pdf.0 > 0.0).then_some(Scattered { wi, weight: Spectrum::ONE, made, eta: 1.0, lobe: Lobe::DIFFUSE_REFLECTION })
    }

    fn lobes(&self) -> Lobe {
        Lobe::DIFFUSE_REFLECTION
    }
}
#[test]
fn what_is_declared_not_to_be_reciprocal_is_not_held_to_it() {
    let promise = |reciprocal| Promises { lobes: Lobe::DIFFUSE_REFLECTION, reciprocal, isotropic: true };
    let honest = surface("toon", promise(false), || Toon, 1);
    assert!(honest.passed && honest.exceptions.len() == 1 && honest.exceptions[0].contains("not reciprocal"), "{honest}");
    assert_eq!(surface("toon", promise(true), || Toon, 1).failed(), [Test::Reciprocity]);
}
