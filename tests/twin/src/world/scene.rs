//! The world as the kernel sees it, and one sample of it.

use super::{
    super::kernel::{
        Heuristic, Point, Ray, Scene, Segment, Strategy, Techniques, Walk, WalkVertex, math::vec2, sample, sampler::Independent,
        sampler::Sampler,
    },
    extent, eye, lamp, moved,
    record::{self, Kept, Recorder, Told},
    surface::Surface,
    widened,
};
use crate::{
    geometry,
    nudge::Nudge,
    setting::{Lamp, Plan, Set, Setting, Sharing},
    tape::{Event, Tape},
};

/// A setting, ready to be sampled.
pub struct World<'a> {
    setting: &'a Setting,
    surfaces: Vec<Surface>,
    lights: Vec<usize>,
}

impl<'a> World<'a> {
    /// The world of a setting.
    pub fn new(setting: &'a Setting) -> Self {
        let count = setting.things.len();
        let shining = (0..count).filter(|&id| setting.things[id].radiance > 0.0);
        Self {
            setting,
            surfaces: setting.things.iter().map(|thing| Surface::new(&thing.material)).collect(),
            lights: shining.chain(count..count + setting.lamps.len()).collect(),
        }
    }

    /// One sample of the plan, by its seed and its index, exact but for what this world's numbers cannot hold; with a seed, moved as rounding would.
    pub fn trace(&self, plan: &Plan, [seed, index]: [u64; 2], nudged: Option<u64>) -> Tape {
        let (recorder, nudge) = (Recorder::new(), Nudge::new(nudged));
        self.run(plan, Independent::new(1, seed, index), &recorder, &nudge);
        recorder.done()
    }

    fn run(&self, plan: &Plan, numbers: Independent, recorder: &Recorder, nudge: &Nudge) {
        let scene = Watched { world: self, recorder, nudge, eye: eye::Watched::new(&self.setting.eye, nudge) };
        let strategy = Strategy {
            techniques: match plan.techniques {
                Set::Path => Techniques::PATH,
                Set::Light => Techniques::LIGHT,
                Set::Bidirectional => Techniques::BIDIRECTIONAL,
            },
            heuristic: match plan.heuristic {
                Sharing::Balance => Heuristic::Balance,
                Sharing::Power => Heuristic::Power,
            },
            max_depth: plan.max_depth,
            rr_depth: plan.rr_depth,
        };
        let mut sampler = Told { numbers, recorder };
        sampler.seek(Walk::Camera, 0);
        let [x, y] = sampler.next_pair();
        let raster = vec2(x, y) * eye::RESOLUTION;
        let store = || (1..plan.max_depth).map(|_| None).collect::<Vec<Option<WalkVertex<'_, Watched<'_>>>>>();
        let mut film = Kept { recorder, scale: self.setting.scale };
        let (mut camera_path, mut light_path) = (store(), store());
        sample(&scene, &strategy, &mut sampler, raster, &mut camera_path, &mut light_path, &mut film);
    }
}

/// A world that tells what walks meet in it.
struct Watched<'a> {
    world: &'a World<'a>,
    recorder: &'a Recorder,
    nudge: &'a Nudge,
    eye: eye::Watched<'a>,
}

impl Watched<'_> {
    fn nearest(&self, ray: &Ray) -> Option<geometry::Hit> {
        let origin = moved(self.nudge, ray.origin);
        geometry::nearest(&self.world.setting.things, widened(origin), widened(ray.direction), f64::from(ray.t_max))
    }
}

impl<'a> Scene for Watched<'a> {
    type Hit = usize;
    type LightId = usize;
    type Camera = eye::Watched<'a>;
    type Bsdf<'b>
        = record::Watched<'b>
    where
        Self: 'b;
    type Light<'b>
        = lamp::Watched<'b>
    where
        Self: 'b;

    fn camera(&self) -> &eye::Watched<'a> {
        &self.eye
    }

    fn intersect(&self, ray: &Ray) -> Option<(Point, usize)> {
        let hit = self.nearest(ray);
        self.recorder.note(Event::Met { thing: hit.map(|hit| hit.thing), edge: hit.map_or(1.0, |hit| hit.edge) });
        hit.map(|hit| (extent::placed(self.nudge, &hit.site), hit.thing))
    }

    /// Not told: the joins that use it are.
    fn unoccluded(&self, a: &Point, b: &Point, segment: Segment) -> bool {
        self.nearest(&Ray::between(a, b, segment)).is_none()
    }

    fn bsdf(&self, _: &Point, thing: usize) -> record::Watched<'_> {
        record::Watched { surface: self.world.surfaces[thing], nudge: self.nudge, recorder: self.recorder }
    }

    fn light(&self, id: usize) -> lamp::Watched<'_> {
        lamp::Watched { source: lamp::Source::new(self.world.setting, id, self.nudge), nudge: self.nudge }
    }

    fn light_id_at(&self, thing: usize) -> Option<usize> {
        (self.world.setting.things[thing].radiance > 0.0).then_some(thing)
    }

    fn environment(&self) -> Option<usize> {
        let sky = self.world.setting.lamps.iter().position(|lamp| matches!(lamp, Lamp::Sky))?;
        Some(self.world.setting.things.len() + sky)
    }

    fn lights(&self) -> &[usize] {
        &self.world.lights
    }
}
