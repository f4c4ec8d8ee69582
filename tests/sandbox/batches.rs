//! Several questions in one call get the answers of the single calls, bit for bit: of every BSDF module that is committed, on both sides,
//! for both things that walks carry, as many at once as there can be, and one more.

use std::sync::Arc;

use bidir::plugin::{Engine, Kind, Module, Roster, Sandbox, SandboxedBsdf, ShaderId, Strictness};
use bidir_kernel::{BATCH, Bsdf, Carried, Sampler, Scatter, Vec3, sampler::Independent};

use super::{direction, root};

fn modules() -> Vec<Arc<Module>> {
    let engine = Engine::new().expect("an engine");
    let files = std::fs::read_dir(root().join("plugins/prebuilt")).expect("the folder").map(|entry| entry.expect("an entry").path());
    let modules = files.filter(|file| file.extension().is_some_and(|ending| ending == "wasm"));
    modules
        .map(|file| Arc::new(Module::load(&engine, &file).expect("a module")))
        .filter(|module| module.manifest().kind == Kind::Bsdf)
        .collect()
}

fn bits(scatter: &Scatter) -> [u32; 5] {
    let [r, g, b] = scatter.value.0;
    [r, g, b, scatter.pdf.0, scatter.pdf_rev.0].map(f32::to_bits)
}

fn hold(bsdf: &SandboxedBsdf, carried: Carried, numbers: &mut Independent) -> u32 {
    let (wo, u) = (direction(numbers), [(); 3].map(|()| numbers.next()));
    let wi: Vec<Vec3> = (0..=BATCH).map(|_| direction(numbers)).collect();
    let single: Vec<Scatter> = wi.iter().map(|wi| bsdf.eval(wo, *wi, carried)).collect();
    let sampled = bsdf.sample(wo, u, carried);
    for count in [0, 1, 2, BATCH, BATCH + 1] {
        let mut many = vec![Scatter::NONE; count];
        bsdf.eval_n(wo, &wi[..count], carried, &mut many);
        assert!(many.iter().map(bits).eq(single[..count].iter().map(bits)), "{count} at once: {many:?}, one by one: {single:?}");
    }
    let (scatter, together) = bsdf.eval_and_sample(wo, wi[0], u, carried);
    assert_eq!(bits(&scatter), bits(&single[0]));
    assert_eq!(together, sampled);
    u32::from(!scatter.value.is_black())
}

#[test]
fn many_at_once_answer_as_one_by_one() {
    let modules = modules();
    assert!(modules.len() >= 12, "{}", modules.len());
    let (mut with, mut lit) = (0, 0);
    for module in &modules {
        let mut roster = Roster::default();
        let id: ShaderId = roster.shader(module, &[]).expect("its defaults");
        let sandbox = Sandbox::new(Arc::new(roster), Strictness::Strict);
        with += u32::from(module.exports().iter().any(|(name, _)| name == "bsdf_vertex"));
        for i in 0..500 {
            let carried = if i % 2 == 0 { Carried::Radiance } else { Carried::Importance };
            lit += hold(&sandbox.bsdf(id), carried, &mut Independent::new(3, 0, i));
        }
        assert_eq!(sandbox.fault(), None, "{}", module.file().display());
    }
    // The one in C has neither export, and is asked one by one.
    assert!(with as usize == modules.len() - 1 && lit > 1000, "{with} of {}, {lit}", modules.len());
}
