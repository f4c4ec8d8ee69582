//! From the camera: light hits (s = 0), next event (s = 1), and the vertices that are connected to the light walk's.

use crate::{
    bsdf::{Carried, Scatter},
    camera::Camera,
    density::{Chance, conversions},
    film::{Contribution, Film},
    light::{Illumination, Light},
    point::{Place, Point, Ray, Segment},
    real::{Real, Vec2, Vec3},
    roulette::survive,
    sampler::{DIMENSIONS_PER_VERTEX, Sampler, Walk, start, vertex},
    scene::Scene,
    spectrum::Spectrum,
    strategy::Strategy,
    technique::{Heuristic, Join, Technique},
    vertex::{Bounce, Vertex, bsdf_numbers, step},
    walk::WalkVertex,
    weight::{Rivals, Side, Step, share},
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
}

/// Traces one camera walk and joins each of its vertices to the lights; returns how many it left in `store`.
#[inline(always)]
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
    #[inline(always)]
    fn run(&mut self, raster: Vec2, store: &mut [Option<WalkVertex<'s, S, F::Rivals>>]) -> usize {
        let Strategy { techniques, heuristic, max_depth, .. } = *self.strategy;
        let scene = self.scene;
        let hides_emitters = S::EFFECTS.hidden_emitters && scene.hides_emitters();
        let seen = scene.camera().look(raster, self.lens_numbers());
        let (near, far) = if S::EFFECTS.clipping { (seen.near, seen.far) } else { (0.0, Real::INFINITY) };
        let mut previous = seen.point.as_receiver();
        let mut direction = seen.direction;
        let origin = if S::EFFECTS.clipping { previous.position + direction * near } else { previous.position };
        let mut ray = Ray { origin, direction, t_max: far - near, segment: Segment::Lens };
        let lens_hit = if seen.end.can_be_hit() { techniques.lens_hit } else { 0.0 };
        let end = if S::EFFECTS.light_walks { f64::from(seen.end.value()) } else { 1.0 };
        let mut side = Side::start(heuristic, end, Join::LensHit, lens_hit);
        let mut throughput = seen.weight;
        // Without light walks, nothing else makes what the lens sees directly, and nobody asks how densely it was made.
        let mut way = (if S::EFFECTS.light_walks { f64::from(seen.spread.value()) } else { 1.0 }, 0.0, false);
        let mut eta_scale: Real = 1.0;
        let mut stored = 0;
        let mut length = 1;
        if max_depth == 0 {
            return 0;
        }
        loop {
            let join = if length == 1 { Join::LensSplat } else { Join::Connection };
            let instead = (join, techniques.effort(join));
            let Some((point, hit)) = scene.intersect(&ray) else {
                if S::EFFECTS.environment
                    && let Some(id) = scene.environment()
                    && !(length == 1 && hides_emitters)
                {
                    let previous = previous.point();
                    let at = Point::distant(previous.position, -direction);
                    if S::EFFECTS.light_walks {
                        side = side.advance(heuristic, &step(&previous, &at, direction, way, instead));
                    }
                    let side = Self::arrived(side, heuristic, || step(&previous, &at, direction, way, instead));
                    // A lens that sees only so far is never shown what is infinitely far.
                    let clipped = length == 1 && far < Real::INFINITY;
                    let joined = length <= self.joined_length && !clipped;
                    self.light_hit(id, &at, &previous, direction, way.2, &End { side: &side, throughput, length, joined });
                }
                return stored;
            };
            if S::EFFECTS.light_walks {
                side = side.advance(heuristic, &step(&previous.point(), &point, direction, way, instead));
            }
            if let Some(id) = scene.light_id_at(hit) {
                let previous = previous.point();
                let side = Self::arrived(side, heuristic, || step(&previous, &point, direction, way, instead));
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
            if S::EFFECTS.light_walks
                && here.joins()
                && joined
                && techniques.uses(Join::Connection)
                && let Some(slot) = store.get_mut(stored)
            {
                *slot = Some(WalkVertex { vertex: here, throughput, side, length });
                stored += 1;
            }
            let Some(bounce) = bounce else { return stored };
            throughput *= bounce.weight;
            if S::EFFECTS.refraction {
                eta_scale *= bounce.eta * bounce.eta;
            }
            if length >= self.strategy.rr_depth {
                self.sampler.seek(Walk::Camera, length.wrapping_mul(DIMENSIONS_PER_VERTEX) + vertex::ROULETTE);
                match survive(throughput.max() * eta_scale, self.sampler.next()) {
                    Some(scale) => throughput = throughput * scale,
                    None => return stored,
                }
            }
            (previous, direction) = (point.as_receiver(), bounce.direction);
            way = (bounce.pdf, bounce.pdf_rev, S::EFFECTS.deltas && bounce.delta);
            ray = Ray::leaving(&point, direction, Segment::Inner);
            length += 1;
        }
    }

    /// Two numbers for a point of the lens.
    #[inline(always)]
    fn lens_numbers(&mut self) -> [Real; 2] {
        if !S::EFFECTS.finite_lens {
            return [0.0; 2];
        }
        self.sampler.seek(Walk::Camera, start::LENS);
        self.sampler.next_pair()
    }

    /// What a light that was hit is told of the other techniques: what the walk has kept; without light walks the last step alone
    /// counts, and is asked for only then.
    #[inline(always)]
    fn arrived(kept: Side<F::Rivals>, heuristic: Heuristic, step: impl FnOnce() -> Step) -> Side<F::Rivals> {
        if S::EFFECTS.light_walks { kept } else { Side::alone(heuristic, &step()) }
    }

    /// s = 0: the walk landed on the light `id` at `at`, coming from `previous`.
    #[inline(always)]
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
        let joined = S::EFFECTS.light_walks && end.joined;
        let made = if joined { f64::from(self.scene.light_chance(id, None).0) * f64::from(exit.end.value()) } else { 0.0 };
        // Joining the last two vertices instead: the walk's own x_0 shown to the lens, or next event, which knows its receiver.
        // No direction is shown to a camera that is itself one direction.
        let apart = at.place == Place::Distant && previous.place == Place::Distant;
        let join = if end.length == 1 { Join::LensSplat } else { Join::NextEvent };
        let instead = if delta || apart || !techniques.uses(join) {
            0.0
        } else if join == Join::LensSplat {
            heuristic.of(techniques.lens_splat * made)
        } else {
            let picked = f64::from(self.scene.light_chance(id, Some(previous)).0);
            heuristic.of(techniques.next_event * picked * f64::from(light.next_event_density(at, previous).value()))
        };
        let others = end.side.sum_of_hit(heuristic, made, f64::from(exit.spread.value()), (join, instead));
        let own = heuristic.of(techniques.light_hit);
        self.film.weighed(own, others);
        self.film.add(Contribution {
            value: end.throughput * exit.radiance,
            weight: share(own, others.total()) as Real,
            technique: Technique { s: 0, t: end.length + 1 },
        });
    }

    /// s = 1, points of lights chosen for this vertex, and where the walk goes on.
    #[inline(always)]
    fn lit_and_bounced(&mut self, vertex: &Vertex<'s, S>, end: &End<F::Rivals>) -> Option<Bounce> {
        let dimension = end.length.wrapping_mul(DIMENSIONS_PER_VERTEX);
        let count = if vertex.joins() { self.strategy.techniques.next_event as u32 } else { 0 };
        // The last light is asked for together with where the walk goes on.
        let alone = if S::EFFECTS.dear_surfaces { count.saturating_sub(1) } else { count };
        let mut turn = 0;
        while turn < alone {
            if let Some(lit) = self.picked(&vertex.point, dimension, turn)
                && let Some(scatter) = vertex.scatter(lit.sampled.direction)
            {
                self.next_event(vertex, end, &lit, &scatter);
            }
            turn += 1;
            if !S::EFFECTS.other_counts {
                break;
            }
        }
        let lit = if alone < count { self.picked(&vertex.point, dimension, alone) } else { None };
        self.sampler.seek(Walk::Camera, dimension + vertex::BSDF);
        let u = bsdf_numbers::<S>(self.sampler);
        if !S::EFFECTS.dear_surfaces {
            return vertex.bounce(u);
        }
        let (scatter, bounce) = vertex.scatter_and_bounce(lit.as_ref().map(|lit| lit.sampled.direction), u);
        if let (Some(lit), Some(scatter)) = (&lit, &scatter) {
            self.next_event(vertex, end, lit, scatter);
        }
        bounce
    }

    /// A point of a light for this receiver, the `turn`th that it is lit by; its own dimensions begin at `dimension`.
    #[inline(always)]
    fn picked(&mut self, point: &Point, dimension: u32, turn: u32) -> Option<Lit<S::LightId>> {
        self.sampler.seek(Walk::Camera, dimension.wrapping_add(turn.wrapping_mul(NEXT_EVENT_STRIDE)) + vertex::ENDPOINT);
        let pair = self.sampler.next_pair();
        let (id, chance) = self.scene.pick_light(Some(point), || self.sampler.next())?;
        let sampled = self.scene.light(id).illuminate(point, pair)?;
        Some(Lit { id, chance, sampled })
    }

    /// s = 1: the vertex lit by one point of a light.
    #[inline]
    fn next_event(&mut self, vertex: &Vertex<'s, S>, end: &End<F::Rivals>, lit: &Lit<S::LightId>, scatter: &Scatter) {
        let Strategy { techniques, heuristic, .. } = *self.strategy;
        let (Lit { id, chance, sampled }, point) = (lit, &vertex.point);
        let per_sample = if S::EFFECTS.other_counts { techniques.next_event as Real } else { 1.0 } * chance.0;
        let value = end.throughput * scatter.value * sampled.weight / per_sample;
        if value.is_black() || !self.scene.unoccluded(point, &sampled.point, Segment::Inner) {
            return;
        }
        let exit = sampled.exit;
        let own = heuristic.of(techniques.next_event * f64::from(chance.0) * f64::from(sampled.density.value()));
        let (to_light, to_vertex) = conversions(point, &sampled.point, sampled.direction);
        let hit = if exit.end.can_be_hit() { heuristic.of(techniques.light_hit * f64::from(scatter.pdf.0) * to_light) } else { 0.0 };
        let mut others = F::Rivals::NONE.with(Join::LightHit, hit);
        let mut total = hit;
        if S::EFFECTS.light_walks {
            if end.joined {
                let made = f64::from(self.scene.light_chance(*id, None).0) * f64::from(exit.end.value());
                let across = f64::from(exit.spread.value()) * to_vertex;
                others = others.and(end.side.sum(heuristic, across, f64::from(scatter.pdf_rev.0)).times(heuristic.of(made)));
            }
            total = others.total();
        }
        self.film.weighed(own, others);
        self.film.add(Contribution { value, weight: share(own, total) as Real, technique: Technique { s: 1, t: end.length + 1 } });
    }
}
