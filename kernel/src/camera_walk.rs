//! From the camera: light hits (s = 0), next event (s = 1), and the vertices that are connected to the light walk's.

use crate::{
    bsdf::{Bsdf, Carried, Scatter},
    camera::Camera,
    density::{Chance, conversions},
    film::{Contribution, Film},
    light::{Illumination, Light},
    point::{Place, Point, Ray, Segment},
    real::{Real, Vec2, Vec3},
    roulette::{casts, survive},
    sampler::{DIMENSIONS_PER_VERTEX, Sampler, Walk, shadow, start, vertex},
    scene::Scene,
    spectrum::Spectrum,
    strategy::Strategy,
    technique::{Join, Technique},
    vertex::{Bounce, Vertex, step},
    walk::WalkVertex,
    weight::{Rivals, Side, share},
};

/// How many of a vertex's dimensions one next event takes; those beyond the first lie far away from all others.
const NEXT_EVENT_STRIDE: u32 = 1 << 20;

struct CameraWalk<'a, 's, S: Scene, P, F> {
    scene: &'s S,
    strategy: &'a Strategy,
    joined_length: u32,
    sampler: &'a mut P,
    film: &'a mut F,
}

/// The camera walk's newest vertex as a joint needs it.
struct End<'a, R> {
    side: &'a Side<R>,
    throughput: Spectrum,
    /// Segments from the lens to here.
    length: u32,
    /// Whether techniques other than s = 0 and s = 1 can make this path.
    joined: bool,
}

/// A point of a light that a vertex may be lit by.
struct Lit<I> {
    id: I,
    chance: Chance,
    sampled: Illumination,
    /// Of its random numbers, the first.
    dimension: u32,
}

/// Traces one camera walk and joins each of its vertices to the lights; returns how many it left in `store`.
pub(crate) fn camera_walk<'s, S: Scene, F: Film>(
    scene: &'s S,
    strategy: &Strategy,
    joined_length: u32,
    sampler: &mut impl Sampler,
    raster: Vec2,
    store: &mut [Option<WalkVertex<'s, S, F::Rivals>>],
    film: &mut F,
) -> usize {
    CameraWalk { scene, strategy, joined_length, sampler, film }.run(raster, store)
}

impl<'s, S: Scene, P: Sampler, F: Film> CameraWalk<'_, 's, S, P, F> {
    fn run(&mut self, raster: Vec2, store: &mut [Option<WalkVertex<'s, S, F::Rivals>>]) -> usize {
        let Strategy { techniques, heuristic, max_depth, .. } = *self.strategy;
        let scene = self.scene;
        self.sampler.seek(Walk::Camera, start::LENS);
        let seen = scene.camera().look(raster, self.sampler.next_pair());
        let mut previous = seen.point;
        let mut direction = seen.direction;
        let mut ray =
            Ray { origin: previous.position + direction * seen.near, direction, t_max: seen.far - seen.near, segment: Segment::Lens };
        let lens_hit = if seen.end.can_be_hit() { techniques.lens_hit } else { 0.0 };
        let mut side = Side::start(heuristic, f64::from(seen.end.value()), Join::LensHit, lens_hit);
        let mut throughput = seen.weight;
        let mut way = (f64::from(seen.spread.value()), 0.0, false);
        let mut eta_scale: Real = 1.0;
        let mut stored = 0;
        let mut length = 1;
        while length <= max_depth {
            let join = if length == 1 { Join::LensSplat } else { Join::Connection };
            let instead = (join, techniques.effort(join));
            let Some((point, hit)) = scene.intersect(&ray) else {
                if let Some(id) = scene.environment()
                    && !(length == 1 && scene.hides_emitters())
                {
                    let at = Point::distant(previous.position, -direction);
                    side = side.advance(heuristic, &step(&previous, &at, direction, way, instead));
                    // A lens that sees only so far is never shown what is infinitely far.
                    let clipped = length == 1 && seen.far < Real::INFINITY;
                    let joined = length <= self.joined_length && !clipped;
                    self.light_hit(id, &at, &previous, direction, way.2, &End { side: &side, throughput, length, joined });
                }
                return stored;
            };
            side = side.advance(heuristic, &step(&previous, &point, direction, way, instead));
            if let Some(id) = scene.light_id_at(hit) {
                let joined = length <= self.joined_length;
                self.light_hit(id, &point, &previous, direction, way.2, &End { side: &side, throughput, length, joined });
            }
            if length >= max_depth {
                return stored;
            }
            let Some(here) = Vertex::new(point, scene.bsdf(&point, hit), -direction, Carried::Radiance) else { return stored };
            // What is joined here makes a path of one segment more at least.
            let joined = length < self.joined_length;
            let bounce = self.lit_and_bounced(&here, &End { side: &side, throughput, length, joined });
            if here.joins()
                && joined
                && techniques.uses(Join::Connection)
                && let Some(slot) = store.get_mut(stored)
            {
                *slot = Some(WalkVertex { vertex: here, throughput, side, length });
                stored += 1;
            }
            let Some(bounce) = bounce else { return stored };
            throughput *= bounce.weight;
            eta_scale *= bounce.eta * bounce.eta;
            if length >= self.strategy.rr_depth {
                self.sampler.seek(Walk::Camera, length.wrapping_mul(DIMENSIONS_PER_VERTEX) + vertex::ROULETTE);
                match survive(throughput.max() * eta_scale, self.sampler.next()) {
                    Some(scale) => throughput = throughput * scale,
                    None => return stored,
                }
            }
            (previous, direction) = (point, bounce.direction);
            way = (bounce.pdf, bounce.pdf_rev, bounce.delta);
            ray = Ray::leaving(&previous, direction, Segment::Inner);
            length += 1;
        }
        stored
    }

    /// s = 0: the walk landed on the light `id` at `at`, coming from `previous`.
    fn light_hit(&mut self, id: S::LightId, at: &Point, previous: &Point, direction: Vec3, delta: bool, end: &End<F::Rivals>) {
        let Strategy { techniques, heuristic, .. } = *self.strategy;
        if !techniques.uses(Join::LightHit) {
            return;
        }
        let light = self.scene.light(id);
        let exit = light.emitted(at, -direction);
        if exit.radiance.is_black() {
            return;
        }
        let made = f64::from(self.scene.light_chance(id, None).0) * f64::from(exit.end.value());
        let joined = end.joined;
        // Joining the last two vertices instead: the walk's own x_0 shown to the lens, or next event, which knows its receiver.
        // No direction is shown to a camera that is itself one direction.
        let apart = at.place == Place::Distant && previous.place == Place::Distant;
        let join = if end.length == 1 { Join::LensSplat } else { Join::NextEvent };
        let instead = if delta || apart || !techniques.uses(join) {
            0.0
        } else if join == Join::LensSplat {
            if joined { heuristic.of(techniques.lens_splat * made) } else { 0.0 }
        } else {
            let picked = f64::from(self.scene.light_chance(id, Some(previous)).0);
            heuristic.of(techniques.next_event * picked * f64::from(light.next_event_density(at, previous).value()))
        };
        let end_density = if joined { made } else { 0.0 };
        let others = end.side.sum_of_hit(heuristic, end_density, f64::from(exit.spread.value()), (join, instead));
        let own = heuristic.of(techniques.light_hit);
        self.film.weighed(own, others);
        self.film.add(Contribution {
            value: end.throughput * exit.radiance,
            weight: share(own, others.total()) as Real,
            technique: Technique { s: 0, t: end.length + 1 },
        });
    }

    /// s = 1, points of lights chosen for this vertex, and where the walk goes on; the last light and that are asked for at once.
    fn lit_and_bounced<B: Bsdf>(&mut self, vertex: &Vertex<B>, end: &End<F::Rivals>) -> Option<Bounce> {
        let dimension = end.length.wrapping_mul(DIMENSIONS_PER_VERTEX);
        let count = if vertex.joins() { self.strategy.techniques.next_event as u32 } else { 0 };
        let mut last = None;
        for turn in 0..count {
            last = self.picked(&vertex.point, dimension.wrapping_add(turn.wrapping_mul(NEXT_EVENT_STRIDE)) + vertex::ENDPOINT);
            if turn + 1 < count
                && let Some(lit) = &last
                && let Some(scatter) = vertex.scatter(lit.sampled.direction)
            {
                self.next_event(vertex, end, lit, &scatter);
            }
        }
        self.sampler.seek(Walk::Camera, dimension + vertex::BSDF);
        let u = [self.sampler.next(), self.sampler.next(), self.sampler.next()];
        let (scatter, bounce) = vertex.scatter_and_bounce(last.as_ref().map(|lit| lit.sampled.direction), u);
        if let (Some(lit), Some(scatter)) = (&last, &scatter) {
            self.next_event(vertex, end, lit, scatter);
        }
        bounce
    }

    fn picked(&mut self, point: &Point, dimension: u32) -> Option<Lit<S::LightId>> {
        self.sampler.seek(Walk::Camera, dimension);
        let (pair, u) = (self.sampler.next_pair(), self.sampler.next());
        let (id, chance) = self.scene.pick_light(Some(point), u)?;
        let sampled = self.scene.light(id).illuminate(point, pair)?;
        Some(Lit { id, chance, sampled, dimension })
    }

    /// s = 1: the vertex lit by one point of a light.
    fn next_event<B: Bsdf>(&mut self, vertex: &Vertex<B>, end: &End<F::Rivals>, lit: &Lit<S::LightId>, scatter: &Scatter) {
        let Strategy { techniques, heuristic, .. } = *self.strategy;
        let (Lit { id, chance, sampled, dimension }, point) = (lit, &vertex.point);
        let per_sample = techniques.next_event as Real * chance.0;
        let value = end.throughput * scatter.value * sampled.weight / per_sample;
        let threshold = self.film.threshold();
        if value.is_black() || (threshold <= 0.0 && !self.scene.unoccluded(point, &sampled.point, Segment::Inner)) {
            return;
        }
        let exit = sampled.exit;
        let own = heuristic.of(techniques.next_event * f64::from(chance.0) * f64::from(sampled.density.value()));
        let mut others = F::Rivals::NONE;
        let (to_light, to_vertex) = conversions(point, &sampled.point, sampled.direction);
        if exit.end.can_be_hit() {
            others = others.with(Join::LightHit, heuristic.of(techniques.light_hit * f64::from(scatter.pdf.0) * to_light));
        }
        if end.joined {
            let made = f64::from(self.scene.light_chance(*id, None).0) * f64::from(exit.end.value());
            let across = f64::from(exit.spread.value()) * to_vertex;
            others = others.and(end.side.sum(heuristic, across, f64::from(scatter.pdf_rev.0)).times(heuristic.of(made)));
        }
        let technique = Technique { s: 1, t: end.length + 1 };
        let mut contribution = Contribution { value, weight: share(own, others.total()) as Real, technique };
        let number = (Walk::Camera, dimension.wrapping_add(shadow::JOIN));
        if threshold > 0.0
            && !(casts(&mut contribution, threshold, self.sampler, number) && self.scene.unoccluded(point, &sampled.point, Segment::Inner))
        {
            return;
        }
        self.film.weighed(own, others);
        self.film.add(contribution);
    }
}
