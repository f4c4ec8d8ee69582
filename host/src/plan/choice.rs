//! The choice of a plan: error times time, both as a pilot measured them, for every plan that the scene leaves open.

use bidir_kernel::{Join, Techniques};
use serde::Serialize;

use super::{
    Stage,
    effects::Effects,
    evidence::{Evidence, Record},
    joins::possible,
    plugins::Plugin,
};

/// Light paths per camera path that are tried.
const WALKS: [f64; 5] = [0.0, 0.25, 0.5, 1.0, 2.0];

/// Connections per light path that are tried.
const CONNECTIONS: [f64; 4] = [0.0, 0.25, 0.5, 1.0];

/// The best of many predictions is the luckiest as well. So the plan under way, at first the best one without light paths, which is one of
/// few, is left only for one that is better by more than chance often explains: by so much over the root of the pilot's camera paths, within
/// these bounds.
const LUCK: f64 = 15.0;
const MARGIN: [f64; 2] = [0.02, 0.25];

/// Light that is rarer than all that was seen is dearer to plans that leave a kind of join out: one that makes all is left only for one that
/// is so many times as good, or as good as the second where it has no light paths at all.
const INSURANCE: [f64; 2] = [1.02, 1.25];

/// A plan that leaves a kind of join out, and is noisier than a pilot says, is left for one that makes all and is so many times as good: the
/// pilot may have told too little of that one's noise as well.
const DOUBT: f64 = 1.35;

/// How many times as much a sample counts as one of the stage before, at most.
const MOST_WORTH: f64 = 16.0;

/// What costs of rationed light paths and connections are told from: a quarter of them.
pub const RATION: f64 = 0.25;

/// Measured CPU nanoseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Costs {
    /// Of a camera path with one light point per vertex, where there are no light paths.
    pub camera_path: f64,
    /// Of the light point of each of its vertices, within that.
    pub next_event: f64,
    /// What a camera path takes more where there are light paths: it has more rivals to weigh, and more to keep.
    pub beside: f64,
    /// Of a light path beside a camera path, its vertices shown to the lens.
    pub light_path: f64,
    /// Of one without camera paths.
    pub alone: f64,
    /// Of connecting all vertices of a camera path with all of a light path.
    pub connections: f64,
    /// What connecting only a quarter takes more than a quarter of that.
    pub rationed: f64,
}

impl Costs {
    /// Of a sample.
    pub fn of(&self, stage: &Stage) -> f64 {
        self.split(stage).iter().sum()
    }

    /// Of its camera path, its light paths and its connections.
    pub fn split(&self, stage: &Stage) -> [f64; 3] {
        let techniques = stage.techniques();
        let walks = techniques.light_walks();
        if !techniques.camera_walk() {
            return [0.0, walks * self.alone, 0.0];
        }
        let camera = self.camera_path + (stage.next_event - 1.0) * self.next_event + if walks > 0.0 { self.beside } else { 0.0 };
        let part = if walks > 0.0 { stage.connection / walks } else { 0.0 };
        let rationed = if part > 0.0 { self.rationed * (1.0 - part) / (1.0 - RATION) } else { 0.0 };
        [camera.max(0.0), walks * self.light_path, walks * (part * self.connections + rationed)]
    }
}

/// How long a render goes on.
#[derive(Clone, Copy, Debug)]
pub enum Until {
    /// So many samples of every pixel.
    Samples(f64),
    /// So many CPU nanoseconds per pixel.
    Nanoseconds(f64),
}

impl Until {
    /// Samples per pixel that a plan comes to.
    fn samples(self, cost: f64) -> f64 {
        match self {
            Self::Samples(samples) => samples,
            Self::Nanoseconds(time) => time / cost.max(1.0),
        }
    }
}

/// What a render by one stage said of its own error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// How it was sampled.
    pub stage: Stage,
    /// Samples per pixel.
    pub samples: f64,
    /// Its estimated relMSE.
    pub error: f64,
    /// How many times what was told of it it was before, when what is rare had just been watched: then it was that bright things are
    /// smaller, or dark ones darker, than a pilot knows.
    pub before: f64,
}

impl Seen {
    /// What is told of it, in relMSE times samples per pixel.
    fn told(&self, evidence: &Evidence, record: Option<&Record>) -> f64 {
        evidence.errors(&[(self.stage, self.samples)], record)[0].max(f64::MIN_POSITIVE)
    }

    /// How many times as noisy it is as is told; at least once.
    pub fn times(&self, evidence: &Evidence, record: Option<&Record>) -> f64 {
        let times = self.error * self.samples / self.told(evidence, record);
        if times.is_finite() { times.max(1.0) } else { 1.0 }
    }

    /// How much noisier it is than a pilot says, in relMSE times samples per pixel. That is of light too rare for the pilot; and what is so
    /// rare most plans make about as seldom as each other.
    fn beyond(&self, evidence: &Evidence, record: Option<&Record>) -> f64 {
        let beyond = self.error * self.samples - self.before * self.told(evidence, record);
        if beyond.is_finite() { beyond.max(0.0) } else { 0.0 }
    }
}

/// A plan that was looked at.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Candidate {
    /// Its counts.
    pub stage: Stage,
    /// relMSE at the end of the render times its samples per pixel, about; `None` where the plan misses what the pilot saw.
    pub error: Option<f64>,
    /// CPU nanoseconds of a sample.
    pub cost: f64,
}

impl Candidate {
    /// 1 / (error · cost); 0 where it misses something.
    pub fn efficiency(&self) -> f64 {
        self.error.map_or(0.0, |error| 1.0 / (error.max(f64::MIN_POSITIVE) * self.cost.max(f64::MIN_POSITIVE)))
    }
}

/// What was chosen, and from what.
#[derive(Clone, Debug, Serialize)]
pub struct Choice {
    /// The plan.
    pub chosen: Candidate,
    /// Every plan that was looked at, the best one first.
    pub candidates: Vec<Candidate>,
    /// What the pilot measured.
    pub costs: Costs,
    /// Camera paths of the pilot.
    pub camera_paths: usize,
    /// Camera paths of the render that were watched.
    pub watched: usize,
    /// How much of every error, times samples per pixel, the render saw and the pilot did not.
    pub beyond: f64,
    /// How many times as noisy as the pilot said a plan was seen to be that leaves some kind of join out.
    pub times: f64,
    /// How many times as good another plan would have had to be.
    pub margin: f64,
    /// What each kind of join costs and saves.
    pub joins: Vec<Worth>,
    /// What calls of plugins take, module by module.
    pub plugins: Vec<Plugin>,
    /// What would be chosen if these took no time; `None` where no plugin is called.
    pub without_plugins: Option<Candidate>,
}

impl Choice {
    /// Whether the plan, being so many times as noisy as was told, might be left for one that makes every kind of join.
    pub fn is_doubted(&self, times: f64, open: &[Stage]) -> bool {
        let full = self.candidates.iter().filter(|candidate| is_full(&candidate.stage, open)).map(Candidate::efficiency);
        times * full.fold(0.0, f64::max) >= DOUBT * self.chosen.efficiency()
    }

    /// How much a sample of the chosen stage should count against one of another that was looked at: as much as it is less noisy, within
    /// bounds. Both are told as at the end of the render: of a few samples nobody knows what is rare.
    pub fn worth(&self, other: &Stage) -> f64 {
        let Some(other) = self.candidates.iter().find(|candidate| candidate.stage.techniques() == other.techniques()) else { return 1.0 };
        let own = self.chosen.error.filter(|own| *own > 0.0);
        own.map_or(1.0, |own| (other.error.unwrap_or(f64::INFINITY) / own).clamp(1.0 / MOST_WORTH, MOST_WORTH))
    }

    /// What would be chosen if samples cost so much.
    pub(super) fn at(&self, costs: &Costs) -> Candidate {
        let all: Vec<_> = self.candidates.iter().map(|candidate| Candidate { cost: costs.of(&candidate.stage), ..*candidate }).collect();
        let open: Vec<_> = all.iter().map(|candidate| candidate.stage).collect();
        let stays = |candidate: &Candidate| candidate.stage.techniques() == self.chosen.stage.techniques();
        let full = |candidate: &Candidate| self.watched > 0 && is_full(&candidate.stage, &open);
        settled(&all, self.margin, stays, full).unwrap_or(self.chosen)
    }
}

/// What a kind of join costs and saves.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Worth {
    /// Which join, as a plan's file spells it.
    pub join: &'static str,
    /// Its part of the time of a sample.
    pub cost: f64,
    /// How many times the error would be without it; `None` where something would be missing.
    pub error_without: Option<f64>,
}

/// The plans that a scene leaves open: counts of joins that cannot be made there are 0.
pub fn open(effects: &Effects, max_depth: Option<u32>) -> Vec<Stage> {
    let mut all: Vec<Stage> = Vec::new();
    let mut take = |light_hit: f64, next_event: f64, walks: f64, connection: f64| {
        let counts = Techniques { light_hit, next_event, connection: connection * walks, lens_splat: walks, lens_hit: walks };
        let techniques = possible(effects, max_depth, &counts);
        let stage = Stage::of(&techniques);
        if (techniques.light_walk() || techniques.camera_walk()) && !all.contains(&stage) {
            all.push(stage);
        }
    };
    for walks in WALKS {
        for connection in CONNECTIONS {
            // What two light walks of one camera path have in common the pilot cannot see.
            take(1.0, 1.0, walks, if walks <= 1.0 { connection } else { 0.0 });
        }
        take(1.0, 0.0, walks, 0.0);
    }
    take(0.0, 0.0, 1.0, 0.0);
    all
}

/// Whether a plan makes every kind of join that any open one makes: nothing that another plan would bring stays hidden from who watches it.
pub fn is_full(stage: &Stage, open: &[Stage]) -> bool {
    Join::ALL.iter().all(|&join| stage.effort(join) > 0.0 || open.iter().all(|open| open.effort(join) == 0.0))
}

/// The plan with the most ways to make a path, each once: for a scene of which nothing was seen.
pub fn broadest(open: &[Stage]) -> Option<Stage> {
    let breadth = |stage: &Stage| Join::ALL.map(|join| stage.effort(join).min(1.0)).iter().sum::<f64>();
    open.iter().copied().max_by(|a, b| breadth(a).total_cmp(&breadth(b)))
}

/// The best one, or the best of those that stay, if chance might have put it behind, or the best of those that make every kind of join.
fn settled(all: &[Candidate], margin: f64, stays: impl Fn(&Candidate) -> bool, full: impl Fn(&Candidate) -> bool) -> Option<Candidate> {
    let by_efficiency = |a: &&Candidate, b: &&Candidate| a.efficiency().total_cmp(&b.efficiency());
    let best = all.iter().max_by(by_efficiency)?;
    let near = |which: &dyn Fn(&Candidate) -> bool, margin: f64| {
        let nearest = all.iter().filter(|candidate| which(candidate)).max_by(by_efficiency);
        nearest.filter(|nearest| nearest.efficiency() * margin >= best.efficiency())
    };
    let insurance = if best.stage.techniques().light_walks() > 0.0 { INSURANCE[0] } else { INSURANCE[1] };
    near(&stays, margin).or_else(|| near(&full, insurance)).or(Some(best)).copied()
}

/// What a choice rests on.
#[derive(Clone, Copy, Debug)]
pub struct Known<'a> {
    /// What a pilot saw.
    pub evidence: &'a Evidence,
    /// What it took.
    pub costs: &'a Costs,
    /// What the render's first samples brought that the pilot saw too little of.
    pub record: Option<&'a Record>,
    /// What the render said of its error.
    pub seen: Option<&'a Seen>,
    /// How many times as good as the stage under way another plan has to be at least.
    pub sure: f64,
}

/// A plan for what is known: the stage under way, unless one of the open ones is clearly better.
pub fn choose(open: &[Stage], known: &Known, until: Until, under_way: Option<&Stage>) -> Option<Choice> {
    let Known { evidence, costs, record, seen, sure } = *known;
    // Where some kind of join was not made, what was seen may be what that would take away: it is held against those alone that do without.
    let (all_made, some_left_out) = (seen.filter(|seen| is_full(&seen.stage, open)), seen.filter(|seen| !is_full(&seen.stage, open)));
    let beyond = all_made.map_or(0.0, |seen| seen.beyond(evidence, record));
    let times = some_left_out.map_or(1.0, |seen| seen.times(evidence, record));
    let doubted = |stage: &Stage| {
        some_left_out.is_some_and(|seen| seen.stage.techniques() == stage.techniques() || record.is_none() && !is_full(stage, open))
    };
    let look = |stages: &[Stage], record: Option<&Record>, doubted: &dyn Fn(&Stage) -> bool| -> Vec<Candidate> {
        let plans: Vec<_> = stages.iter().map(|stage| (*stage, until.samples(costs.of(stage)))).collect();
        let errors = evidence.errors(&plans, record);
        let candidate = |(stage, error): (&Stage, f64)| Candidate {
            stage: *stage,
            error: error.is_finite().then_some(error.max(0.0) * if doubted(stage) { times } else { 1.0 } + beyond),
            cost: costs.of(stage),
        };
        stages.iter().zip(errors).map(candidate).collect()
    };
    if evidence.samples() == 0 {
        return None;
    }
    // Of plans that nobody watched for it is known that they were hopeless, and not how much of the rare they have.
    let watched = |stage: &&Stage| record.is_none_or(|record| record.knows(stage));
    let mut all = look(&open.iter().filter(watched).copied().collect::<Vec<_>>(), record, &doubted);
    if let Some(stage) = under_way.filter(|stage| all.iter().all(|candidate| candidate.stage.techniques() != stage.techniques())) {
        all.extend(look(&[*stage], record, &doubted));
    }
    all.sort_by(|a, b| b.efficiency().total_cmp(&a.efficiency()));
    let stays = |candidate: &Candidate| match under_way {
        Some(stage) => stage.techniques() == candidate.stage.techniques(),
        None => candidate.stage.techniques().light_walks() == 0.0,
    };
    let (camera_paths, watched) = (evidence.samples(), record.map_or(0, Record::samples));
    // Before the first sample it is said what a render would do that is not watched.
    let full = |candidate: &Candidate| under_way.is_some() && is_full(&candidate.stage, open);
    let in_doubt = times > 1.0 && record.is_none() && all.first().is_some_and(|best| is_full(&best.stage, open));
    let margin = if in_doubt { DOUBT } else { margin(camera_paths + watched) }.max(sure);
    let chosen = settled(&all, margin, stays, full)?;
    let used: Vec<Join> = Join::ALL.into_iter().filter(|&join| chosen.stage.effort(join) > 0.0).collect();
    // Nobody watches for plans that are not open: the pilot alone knows them all.
    let stages: Vec<Stage> = std::iter::once(chosen.stage).chain(used.iter().map(|&join| chosen.stage.without(join))).collect();
    let told = look(&stages, None, &|_| false);
    let joins = used.iter().zip(&told[1..]).map(|(&join, left)| Worth {
        join: super::joins::name(join),
        cost: (1.0 - left.cost / chosen.cost).max(0.0),
        error_without: left.error.zip(told[0].error).map(|(without, with)| without / with.max(f64::MIN_POSITIVE)),
    });
    let joins = joins.collect();
    let (costs, candidates) = (*costs, all);
    Some(Choice {
        chosen,
        candidates,
        costs,
        camera_paths,
        watched,
        beyond,
        times,
        margin,
        joins,
        plugins: Vec::new(),
        without_plugins: None,
    })
}

impl Stage {
    /// The same without a kind of join.
    fn without(&self, join: Join) -> Self {
        let mut other = *self;
        *match join {
            Join::LightHit => &mut other.light_hit,
            Join::NextEvent => &mut other.next_event,
            Join::Connection => &mut other.connection,
            Join::LensSplat => &mut other.lens_splat,
            Join::LensHit => &mut other.lens_hit,
        } = 0.0;
        other
    }
}

/// How much better another plan has to be, after so many camera paths.
fn margin(samples: usize) -> f64 {
    1.0 + (LUCK / (samples.max(1) as f64).sqrt()).clamp(MARGIN[0], MARGIN[1])
}

#[cfg(test)]
mod tests {
    use bidir_kernel::Technique;

    use super::*;
    use crate::{
        plan::evidence::{Brought, Grid},
        scene::description::Crop,
    };

    const ROOM: Effects = Effects { area_lights: true, diffuse: true, ..Effects::NONE };

    #[test]
    fn what_a_scene_cannot_have_is_not_tried() {
        let stages = open(&ROOM, None);
        assert!(stages.len() > 10);
        assert!(stages.iter().all(|stage| stage.lens_hit == 0.0 && stage.light_hit <= 1.0 && stage.connection <= stage.lens_splat));
        assert!(open(&ROOM, Some(2)).iter().all(|stage| stage.connection == 0.0));
        let mirrors = Effects { diffuse: false, delta_reflection: true, hidden_emitters: true, ..ROOM };
        assert_eq!(open(&mirrors, None), [Stage::of(&Techniques::PATH.only(Join::LightHit))]);
        assert_eq!(broadest(&open(&mirrors, None)), Some(Stage::of(&Techniques::PATH.only(Join::LightHit))));
        assert_eq!(broadest(&open(&Effects::NONE, None)), None);
        assert_eq!(broadest(&stages).map(|stage| stage.connection), Some(1.0));
    }

    fn evidence(shares: [f64; 5]) -> Evidence {
        let mut evidence = Evidence::new(Grid::new(Crop { x: 0, y: 0, width: 1, height: 1 }));
        for i in 0..64 {
            if i % 8 == 0 {
                evidence.add(Brought { value: 1.0, technique: Technique { s: 1, t: 3 }, shares });
            }
            evidence.end_sample();
            if i % 16 == 15 {
                evidence.end_place(0);
            }
        }
        evidence
    }

    const COSTS: Costs = Costs {
        camera_path: 1000.0,
        next_event: 300.0,
        light_path: 1500.0,
        alone: 1500.0,
        connections: 2000.0,
        beside: 0.0,
        rationed: 0.0,
    };

    fn known(evidence: &Evidence) -> Known<'_> {
        Known { evidence, costs: &COSTS, record: None, seen: None, sure: 1.0 }
    }

    #[test]
    fn light_paths_run_where_they_pay() {
        let open = open(&ROOM, None);
        let choose = |shares| choose(&open, &known(&evidence(shares)), Until::Samples(32.0), None).unwrap().chosen.stage;
        // What the camera finds as well as anything.
        assert_eq!(choose([0.2, 0.78, 0.01, 0.01, 0.0]).lens_splat, 0.0);
        // What it hardly ever finds.
        let found = choose([0.001, 0.0, 0.0, 0.999, 0.0]);
        assert!(found.lens_splat > 0.0 && found.connection == 0.0, "{found:?}");
        let connected = choose([0.001, 0.0, 0.989, 0.01, 0.0]);
        assert!(connected.connection > 0.0, "{connected:?}");
    }

    #[test]
    fn where_all_plans_are_noisy_alike_a_cheap_one_is_better() {
        let (open, evidence) = (open(&ROOM, None), evidence([0.001, 0.0, 0.0, 0.999, 0.0]));
        let choose = |seen: Option<&Seen>| choose(&open, &Known { seen, ..known(&evidence) }, Until::Samples(32.0), None).unwrap();
        let first = choose(None);
        let full = broadest(&open).unwrap();
        let told = evidence.errors(&[(full, 16.0)], None)[0];
        let seen = |beyond| Seen { stage: full, samples: 16.0, error: (told + beyond) / 16.0, before: 1.0 };
        let (as_told, noisier) = (choose(Some(&seen(0.0))), choose(Some(&seen(1e3))));
        assert!(as_told.beyond < 1e-9 && as_told.chosen.stage == first.chosen.stage);
        assert!((noisier.beyond - 1e3).abs() < 1e-6, "{}", noisier.beyond);
        assert!(noisier.chosen.cost < first.chosen.cost, "{:?} {:?}", noisier.chosen, first.chosen);
    }

    /// Where a film is noisier than a pilot said of a plan that leaves some join out, that is held against such plans alone.
    #[test]
    fn a_path_tracer_that_is_noisier_than_told_is_left_for_a_plan_that_makes_every_join() {
        let (open, evidence) = (open(&ROOM, None), evidence([0.2, 0.6, 0.1, 0.1, 0.0]));
        let path = Stage::of(&Techniques::PATH);
        let choose = |seen: Option<&Seen>| choose(&open, &Known { seen, ..known(&evidence) }, Until::Samples(32.0), Some(&path)).unwrap();
        assert_eq!(choose(None).chosen.stage, path);
        let told = evidence.errors(&[(path, 16.0)], None)[0];
        let times = |times: f64| choose(Some(&Seen { stage: path, samples: 16.0, error: times * told / 16.0, before: 1.0 }));
        assert_eq!([0.5, 1.0, 1.1].map(|noise| times(noise).chosen.stage), [path; 3]);
        let noisy = times(20.0);
        assert!([0.5, 1.1, 20.0].map(|times| choose(None).is_doubted(times, &open)) == [false, false, true]);
        assert!(is_full(&noisy.chosen.stage, &open) && noisy.beyond == 0.0, "{:?}", noisy.chosen);
        let error = |choice: &Choice, stage: &Stage| choice.candidates.iter().find(|other| other.stage == *stage).unwrap().error.unwrap();
        assert!((error(&noisy, &path) / error(&choose(None), &path) - 20.0).abs() < 1e-6);
        assert_eq!(error(&noisy, &noisy.chosen.stage), error(&choose(None), &noisy.chosen.stage));
        // Each of its samples is worth several of the path tracer's; of what misses something none are worth much.
        let worth = |path_error: Option<f64>| {
            let of = |other: &Candidate| Candidate { error: if other.stage == path { path_error } else { other.error }, ..*other };
            Choice { candidates: noisy.candidates.iter().map(of).collect(), ..noisy.clone() }.worth(&path)
        };
        let own = noisy.chosen.error.unwrap();
        assert_eq!([Some(4.0 * own), Some(1e9 * own), None].map(worth), [4.0, MOST_WORTH, MOST_WORTH]);
    }

    #[test]
    fn a_plan_under_way_stays_unless_another_is_clearly_better() {
        let candidate = |walks: f64, error| Candidate {
            stage: Stage::of(&Techniques { lens_splat: walks, ..Techniques::PATH }),
            error: Some(error),
            cost: 100.0,
        };
        let all = [candidate(1.0, 1.0), candidate(0.5, 1.05), candidate(0.0, 1.5)];
        let after = |samples: usize, under_way: f64| {
            settled(&all, margin(samples), |candidate| candidate.stage.lens_splat == under_way, |_| false).unwrap().stage.lens_splat
        };
        // 5 % are chance to few camera paths, and are none to many; 50 % are none to either.
        assert_eq!([1.0, 0.5, 0.0, 2.0].map(|under_way| after(1_000, under_way)), [1.0, 0.5, 1.0, 1.0]);
        assert_eq!([1.0, 0.5, 0.0, 2.0].map(|under_way| after(1_000_000, under_way)), [1.0; 4]);
    }

    #[test]
    fn a_plan_that_makes_every_kind_of_join_is_left_for_one_that_is_clearly_better() {
        let candidate = |walks: f64, connection: f64, error| Candidate {
            stage: Stage::of(&Techniques { lens_splat: walks, connection, ..Techniques::PATH }),
            error: Some(error),
            cost: 100.0,
        };
        let open = [[1.0, 1.0], [1.0, 0.0], [0.0, 0.0]].map(|[walks, connection]| candidate(walks, connection, 1.0).stage);
        assert_eq!(open.map(|stage| is_full(&stage, &open)), [true, false, false]);
        // After so many camera paths that little is left to chance.
        let best = |errors: [f64; 3]| {
            let all = [0, 1, 2].map(|i| Candidate { stage: open[i], ..candidate(0.0, 0.0, errors[i]) });
            let chosen = settled(&all, margin(1_000_000), |_| false, |candidate| is_full(&candidate.stage, &open)).unwrap().stage;
            open.iter().position(|stage| *stage == chosen)
        };
        assert_eq!([[1.0, 0.99, 2.0], [1.0, 0.9, 2.0], [1.0, 2.0, 0.9], [1.0, 2.0, 0.7]].map(best), [Some(0), Some(1), Some(0), Some(2)]);
    }
}
