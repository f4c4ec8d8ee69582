//! What stability costs: each guard in both of its forms, timed side by side. No flag and no feature turns one off.

use std::{hint::black_box, path::Path, sync::Arc};

use bidir::{
    check::builtin,
    plugin::{Engine, Module, Roster, Sandbox, Strictness},
    rays::{Geometry as _, Triangles},
};
use bidir_kernel::{
    Bsdf, Carried, Heuristic, Ray, Segment, Vec3,
    technique::Join,
    weight::{Side, Step},
};
use cpu_time::ThreadTime;
use wasmtime::{Config, Memory, Store, TypedFunc};

use super::{geometry, lights::Dice, single::SingleSide};

/// What a guard costs.
#[derive(Clone, Debug)]
pub struct Price {
    /// The guard.
    pub guard: &'static str,
    /// What it keeps out: the rows that it is for.
    pub rows: &'static str,
    /// What is counted.
    pub unit: &'static str,
    /// Nanoseconds of CPU time for each, medians of rounds in turn.
    pub with: f64,
    /// Without it.
    pub without: f64,
}

const ROUNDS: usize = 15;

/// Medians of both, in turn, for `count` things a round.
fn both(count: usize, mut with: impl FnMut(), mut without: impl FnMut()) -> (f64, f64) {
    let mut times = [Vec::new(), Vec::new()];
    for round in 0..=ROUNDS {
        for (times, form) in times.iter_mut().zip([&mut with as &mut dyn FnMut(), &mut without]) {
            let start = ThreadTime::now();
            form();
            // The first round warms up.
            if round > 0 {
                times.push(start.elapsed().as_secs_f64() * 1e9 / count as f64);
            }
        }
    }
    let [with, without] = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[ROUNDS / 2]
    });
    (with, without)
}

/// All of them.
pub fn prices() -> Vec<Price> {
    vec![rays(), weights(), answers(), functions()]
}

/// Closest hits within a closed ball, at random.
fn rays() -> Price {
    const RAYS: usize = 200_000;
    let scene = |triangles| geometry::globe_scene(1.0, 0.0, triangles).0;
    let (watertight, fast) = (scene(Triangles::Watertight), scene(Triangles::Fast));
    let mut dice = Dice::new(3);
    let mut within = || Vec3::from_array(std::array::from_fn(|_| dice.number() - 0.5));
    let ray = |_| {
        let (origin, target) = (within(), within() * 4.0);
        Ray { origin, direction: target - origin, t_max: f32::INFINITY, segment: Segment::Inner }
    };
    let rays: Vec<_> = (0..RAYS).map(ray).collect();
    let cast = |scene: &bidir::scene::Scene| {
        rays.iter().for_each(|ray| {
            black_box(scene.geometry().closest(ray));
        })
    };
    let (with, without) = both(RAYS, || cast(&watertight), || cast(&fast));
    Price { guard: "watertight triangles (against the fast test)", rows: "18, 21, 29", unit: "closest hit", with, without }
}

/// A walk's closed sums, 16 steps, by both heuristics in turn.
fn weights() -> Price {
    const STEPS: usize = 1 << 20;
    let mut dice = Dice::new(4);
    let mut number = || f64::from(dice.number()) + 0.1;
    let steps: Vec<_> = (0..STEPS)
        .map(|_| Step {
            pdf: number(),
            pdf_rev: number(),
            delta: false,
            forward: number(),
            backward: number(),
            join: Join::Connection,
            effort: 1.0,
        })
        .collect();
    let double = || {
        for walk in steps.chunks(16) {
            black_box(walk.iter().fold(<Side>::start(Heuristic::Power, 1.0, Join::LightHit, 1.0), |side, step| {
                side.advance(Heuristic::Power, black_box(step))
            }));
        }
    };
    let single = || {
        for walk in steps.chunks(16) {
            black_box(walk.iter().fold(SingleSide::start(true, 1.0, 1.0), |side, step| side.advance(true, black_box(step))));
        }
    };
    let (with, without) = both(STEPS, double, single);
    Price { guard: "weights in f64 (against f32)", rows: "14, 49, 50", unit: "vertex", with, without }
}

/// A module that answers at once, its answers held to the rules and not.
fn answers() -> Price {
    const CALLS: usize = 1 << 18;
    let bytes = builtin::MODULES.iter().find(|(name, _)| *name == "diffuse").expect("a module").1;
    let module = Arc::new(Module::from_bytes(&Engine::new().expect("an engine"), Path::new("diffuse"), bytes, None).expect("a module"));
    let mut roster = Roster::default();
    let block = module.manifest().defaults();
    let shader = roster.add(&module, &block);
    let sandbox = Sandbox::new(Arc::new(roster), Strictness::Lenient);
    let mut unchecked = Unchecked::new(bytes, &block).expect("the same module");
    let mut dice = Dice::new(5);
    let directions: Vec<_> =
        (0..1024).map(|_| Vec3::new(dice.number() - 0.5, dice.number() - 0.5, 0.1 + dice.number()).normalize()).collect();
    let pair = |i: usize| (directions[i % 1024], directions[(7 * i + 3) % 1024]);
    let checked = || {
        for (wo, wi) in (0..CALLS).map(pair) {
            black_box(sandbox.bsdf(shader).eval(wo, wi, Carried::Radiance));
        }
    };
    let as_they_come = || {
        for (wo, wi) in (0..CALLS).map(pair) {
            black_box(unchecked.eval(wo, wi));
        }
    };
    let (with, without) = both(CALLS, checked, as_they_come);
    Price {
        guard: "plugins called with checks, and faults kept (against by hand, and believed)",
        rows: "48, 58, 66",
        unit: "eval",
        with,
        without,
    }
}

type Eval = TypedFunc<(i32, i32, i32, f32, f32, f32, f32, f32, f32), ()>;

/// A module called by hand, whose answers are believed.
struct Unchecked {
    store: Store<()>,
    memory: Memory,
    eval: Eval,
    scratch: i32,
}

impl Unchecked {
    fn new(bytes: &[u8], block: &[u8]) -> wasmtime::Result<Self> {
        let mut config = Config::new();
        config.epoch_interruption(true).wasm_relaxed_simd(false);
        let engine = wasmtime::Engine::new(&config)?;
        let mut store = Store::new(&engine, ());
        store.set_epoch_deadline(1 << 40);
        let instance = wasmtime::Instance::new(&mut store, &wasmtime::Module::from_binary(&engine, bytes)?, &[])?;
        let scratch = instance.get_typed_func::<i32, i32>(&mut store, "bidir_scratch")?.call(&mut store, 4096)?;
        let memory = instance.get_memory(&mut store, "memory").expect("a memory");
        memory.write(&mut store, scratch as usize + 64, block)?;
        let eval = instance.get_typed_func(&mut store, "bsdf_eval")?;
        Ok(Self { store, memory, eval, scratch })
    }

    #[inline]
    fn eval(&mut self, wo: Vec3, wi: Vec3) -> [f32; 5] {
        let (out, block) = (self.scratch, self.scratch + 64);
        self.eval.call(&mut self.store, (out, block, 0, wo.x, wo.y, wo.z, wi.x, wi.y, wi.z)).expect("an answer");
        let record = &self.memory.data(&self.store)[out as usize..][..20];
        std::array::from_fn(|i| f32::from_le_bytes(std::array::from_fn(|byte| record[4 * i + byte])))
    }
}

/// The functions that shaders call, from the crate that is the same everywhere and from the machine's own library.
fn functions() -> Price {
    const CALLS: usize = 1 << 18;
    let mut dice = Dice::new(6);
    let numbers: Vec<f32> = (0..CALLS).map(|_| 0.05 + 0.9 * dice.number()).collect();
    let each = |ask: &dyn Fn(f32) -> f32| {
        for x in &numbers {
            black_box(ask(*x));
        }
    };
    let same = |x: f32| libm::sinf(x) + libm::expf(x) + libm::logf(x) + libm::powf(x, 2.2) + libm::atan2f(x, 0.3);
    let own = |x: f32| x.sin() + x.exp() + x.ln() + x.powf(2.2) + x.atan2(0.3);
    let (with, without) = both(5 * CALLS, || each(&same), || each(&own));
    Price { guard: "the same functions on every machine (libm against std)", rows: "66", unit: "function", with, without }
}
