//! The price of each knob: one is turned at a time, everything else stays as `auto` has it.

use bidir_kernel::Strategy;
use serde::Serialize;

use super::{
    curve::Bias,
    reference::Reference,
    subject::{Manner, Snapshot, Subject},
};
use crate::{
    error::Result,
    plan::{Stage, joins::possible},
    rays::{Quality, Triangles},
    render::Numbers,
    scene::{
        Scene,
        description::{Description, Filter},
    },
};

/// A knob, with all that it was turned to.
#[derive(Clone, Debug, Serialize)]
pub struct Knob {
    /// Which.
    pub knob: &'static str,
    /// What it does.
    pub words: &'static str,
    /// What it was turned to.
    pub settings: Vec<Setting>,
}

/// What a setting costs and brings.
#[derive(Clone, Debug, Serialize)]
pub struct Setting {
    /// The setting.
    pub setting: String,
    /// Whether that is how everything else was measured.
    pub base: bool,
    /// Samples per pixel.
    pub spp: u32,
    /// CPU seconds of a render of so many samples.
    pub cpu: f64,
    /// Its error, in the mean over seeds.
    pub relmse: f64,
    /// The same, trimmed.
    pub trimmed: f64,
    /// 1 / (relMSE · CPU seconds); `None` where the error is too small to be told.
    pub efficiency: Option<f64>,
    /// Of the mean, as a share of the reference's.
    pub bias: Bias,
    /// Whether no other setting of any knob has a smaller error in less time.
    pub pareto: bool,
}

/// One way to turn a knob.
pub struct Turn {
    /// Which knob.
    pub knob: &'static str,
    /// To what.
    pub setting: String,
    /// Whether it is where it was.
    pub base: bool,
    /// Why the image is then another one.
    pub declared: Option<String>,
    /// What is sampled.
    pub stage: Stage,
    change: Change,
}

/// What is changed beside the techniques.
enum Change {
    Nothing,
    Depth(u32),
    Roulette(u32),
    Numbers(Numbers),
    Filter(Filter),
    Triangles(Triangles),
    Quality(Quality),
    Scene(Box<(Description, Scene)>),
}

/// What knobs do.
const WORDS: [(&str, &str); 10] = [
    ("depth", "the longest path, in segments"),
    ("roulette", "the length from which paths may end by chance"),
    ("next event", "light points per vertex of a camera path"),
    ("light paths", "per camera path"),
    ("connections", "how many of the pairs of vertices of a light path and its camera path are joined"),
    ("plugins", "shaders compiled into the program, or each as a module in its sandbox"),
    ("sampler", "random numbers: points that keep their distance, or each for itself"),
    ("filter", "how samples make pixels"),
    ("triangles", "rays that never slip between neighbours, or may"),
    ("tree", "how carefully the tree is built that rays descend; building is not in the time"),
];

/// Everything that can be turned, in the order in which it is shown; `sandboxed` is the scene with modules for its built-in shaders,
/// where there is one.
pub fn turns(subject: &Subject, base: &Stage, sandboxed: Option<(Description, Scene)>) -> Vec<Turn> {
    let integrator = &subject.description.integrator;
    let mut all = Vec::new();
    let turn = |knob, setting: String, base_setting: bool, declared: Option<&str>, stage: Stage, change| {
        let declared = declared.map(str::to_owned).or_else(|| subject.missed(&stage));
        Turn { knob, setting, base: base_setting, declared, stage, change }
    };
    let same = |knob, setting: &str, base_setting, change| turn(knob, setting.to_owned(), base_setting, None, *base, change);

    let deepest = integrator.max_depth.unwrap_or(u32::MAX);
    for depth in [2, 3, 5, 9].into_iter().filter(|depth| *depth < deepest) {
        all.push(turn("depth", depth.to_string(), false, Some("longer paths are left out"), *base, Change::Depth(depth)));
    }
    let words = integrator.max_depth.map_or("any".to_owned(), |depth| depth.to_string());
    all.push(same("depth", &words, true, Change::Depth(deepest)));

    let first = integrator.rr_depth;
    let mut starts = vec![1, 5, first];
    starts.sort_unstable();
    starts.dedup();
    for start in starts.into_iter().filter(|start| *start < deepest) {
        all.push(same("roulette", &start.to_string(), start == first, Change::Roulette(start)));
    }
    all.push(same("roulette", "never", first >= deepest, Change::Roulette(u32::MAX)));

    let counted = |stage: Stage| Stage::of(&possible(&subject.effects, integrator.max_depth, &stage.techniques()));
    let walks = base.techniques().light_walks();
    for next_event in [0.0, 1.0, 2.0] {
        let stage = counted(Stage { next_event, ..*base });
        all.push(turn("next event", next_event.to_string(), next_event == base.next_event, None, stage, Change::Nothing));
    }
    for count in [0.0, 0.25, 0.5, 1.0, 2.0] {
        let share = if walks > 0.0 { base.connection / walks } else { 0.0 };
        let stage = counted(Stage { lens_splat: count, lens_hit: count, connection: count * share, ..*base });
        let is_base = stage.techniques() == base.techniques();
        all.push(turn("light paths", count.to_string(), is_base, None, stage, Change::Nothing));
    }
    for share in [0.0, 0.25, 0.5, 1.0].into_iter().filter(|_| walks > 0.0) {
        let stage = counted(Stage { connection: share * walks, ..*base });
        let is_base = stage.techniques() == base.techniques();
        all.push(turn("connections", share.to_string(), is_base, None, stage, Change::Nothing));
    }
    if let Some(sandboxed) = sandboxed {
        all.push(same("plugins", "native", true, Change::Nothing));
        all.push(same("plugins", "sandboxed", false, Change::Scene(Box::new(sandboxed))));
    }
    all.push(same("sampler", "sobol", true, Change::Nothing));
    all.push(same("sampler", "independent", false, Change::Numbers(Numbers::Independent)));
    let own = subject.description.film.filter;
    let filters = [("box", Filter::Box), ("tent", Filter::Tent { radius: 1.0 }), ("gaussian", Filter::Gaussian { stddev: 0.5 })];
    if filters.iter().all(|(_, filter)| *filter != own) {
        all.push(same("filter", "the scene's", true, Change::Nothing));
    }
    for (name, filter) in filters {
        let declared = (filter != own).then_some("another filter makes another picture");
        all.push(turn("filter", name.to_owned(), filter == own, declared, *base, Change::Filter(filter)));
    }
    all.push(same("triangles", "watertight", true, Change::Nothing));
    all.push(same("triangles", "fast", false, Change::Triangles(Triangles::Fast)));
    all.push(same("tree", "high", true, Change::Nothing));
    all.push(same("tree", "low", false, Change::Quality(Quality::Low)));
    // What the scene has no use for is the base again, or nothing at all.
    all.retain(|turn| turn.base || turn.is_a_change(base));
    let alone = |knob: &str| all.iter().filter(|turn| turn.knob == knob).count() < 2;
    let lonely: Vec<_> = WORDS.iter().map(|(knob, _)| *knob).filter(|knob| alone(knob)).collect();
    all.retain(|turn| !lonely.contains(&turn.knob));
    all
}

impl Turn {
    fn is_a_change(&self, base: &Stage) -> bool {
        let techniques = self.stage.techniques();
        !matches!(self.change, Change::Nothing) || techniques != base.techniques() && (techniques.camera_walk() || techniques.light_walk())
    }

    /// Calls `render` with the subject as the knob has it.
    pub fn render<T>(&self, subject: &Subject, render: impl FnOnce(&Manner) -> Result<T>) -> Result<T> {
        let manner = subject.manner(&self.stage);
        let strategy = manner.strategy;
        match &self.change {
            Change::Nothing => render(&manner),
            Change::Depth(max_depth) => render(&Manner { strategy: Strategy { max_depth: *max_depth, ..strategy }, ..manner }),
            Change::Roulette(rr_depth) => render(&Manner { strategy: Strategy { rr_depth: *rr_depth, ..strategy }, ..manner }),
            Change::Numbers(numbers) => render(&Manner { numbers: *numbers, ..manner }),
            Change::Filter(filter) => {
                let mut description = subject.description.clone();
                description.film.filter = *filter;
                render(&Manner { description: &description, ..manner })
            }
            Change::Triangles(triangles) => {
                let scene = Scene::new(&subject.description)?.with_triangles(*triangles);
                render(&Manner { scene: &scene, ..manner })
            }
            Change::Quality(quality) => {
                let scene = Scene::with_quality(&subject.description, *quality)?;
                render(&Manner { scene: &scene, ..manner })
            }
            Change::Scene(other) => render(&Manner { scene: &other.1, description: &other.0, ..manner }),
        }
    }
}

/// What a setting's renders say together: each its samples, CPU seconds, errors.
pub fn setting(turn: &Turn, runs: &[Snapshot], reference: &Reference) -> Option<Setting> {
    let mean = |of: &dyn Fn(&Snapshot) -> f64| runs.iter().map(of).sum::<f64>() / runs.len() as f64;
    let spp = runs.first()?.spp;
    let (cpu, relmse) = (mean(&|run| run.cpu), mean(&|run| run.errors.relmse));
    let biases: Vec<f64> = runs.iter().map(|run| run.errors.bias).collect();
    Some(Setting {
        setting: turn.setting.clone(),
        base: turn.base,
        spp,
        cpu,
        relmse,
        trimmed: mean(&|run| run.errors.trimmed),
        efficiency: (relmse > 0.0 && cpu > 0.0).then(|| 1.0 / (relmse * cpu)),
        bias: Bias { interval: reference.interval(&biases, spp), declared: turn.declared.clone() },
        pareto: false,
    })
}

/// Puts settings, each of as many samples, to their knobs, and marks those that no other beats in both error and time.
pub fn together(settings: Vec<(&'static str, Setting)>) -> Vec<Knob> {
    let all: Vec<[f64; 2]> = settings.iter().map(|(_, s)| [s.relmse.max(0.0), s.cpu]).collect();
    let beaten = |[error, time]: [f64; 2]| all.iter().any(|[e, t]| *e <= error && *t <= time && (*e < error || *t < time));
    let mut knobs: Vec<Knob> = WORDS.iter().map(|(knob, words)| Knob { knob, words, settings: Vec::new() }).collect();
    for ((knob, setting), figures) in settings.into_iter().zip(all.clone()) {
        let pareto = !beaten(figures);
        if let Some(of) = knobs.iter_mut().find(|other| other.knob == knob) {
            of.settings.push(Setting { pareto, ..setting });
        }
    }
    knobs.retain(|knob| !knob.settings.is_empty());
    knobs
}
