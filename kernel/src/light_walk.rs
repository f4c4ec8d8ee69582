//! From a light: emission, lens splats (t = 1), lens hits (t = 0), and the vertices that the camera walk connects to.

use crate::{
    bsdf::{Carried, Scatter},
    camera::{Camera, Seen},
    density::{Spread, conversions},
    film::{Contribution, Film},
    light::{Emission, Light},
    math::dot,
    point::{Place, Point, Ray, Segment},
    real::{Real, Vec3},
    roulette::survive,
    sampler::{DIMENSIONS_PER_VERTEX, Sampler, Walk, start, vertex},
    scene::Scene,
    spectrum::Spectrum,
    strategy::Strategy,
    technique::{Join, Technique},
    vertex::{Bounce, Vertex, Way, bsdf_numbers, step},
    walk::WalkVertex,
    weight::{Rivals, Side, share},
};

struct LightWalk<'a, 's, S: Scene, P, F> {
    scene: &'s S,
    strategy: &'a Strategy,
    joined_length: u32,
    /// The first of the walk's dimensions.
    dimension: u32,
    sampler: &'a mut P,
    film: &'a mut F,
}

/// How far apart the dimensions of two light walks of one sample lie.
const WALK_STRIDE: u32 = 1 << 20;

/// Traces the light walk of that number; returns how many vertices it left in `store`.
pub(crate) fn light_walk<'s, S: Scene, F: Film>(
    scene: &'s S,
    strategy: &Strategy,
    joined_length: u32,
    number: u32,
    sampler: &mut impl Sampler,
    store: &mut [Option<WalkVertex<'s, S, F::Rivals>>],
    film: &mut F,
) -> usize {
    let mut walk = LightWalk { scene, strategy, joined_length, dimension: number.wrapping_mul(WALK_STRIDE), sampler, film };
    walk.run(store)
}

impl<'s, S: Scene, P: Sampler, F: Film> LightWalk<'_, 's, S, P, F> {
    #[inline(always)]
    fn seek(&mut self, dimension: u32) {
        self.sampler.seek(Walk::Light, self.dimension.wrapping_add(dimension));
    }

    fn run(&mut self, store: &mut [Option<WalkVertex<'s, S, F::Rivals>>]) -> usize {
        let Strategy { techniques, heuristic, .. } = *self.strategy;
        let scene = self.scene;
        let hides_emitters = S::EFFECTS.hidden_emitters && scene.hides_emitters();
        self.seek(start::LIGHT);
        let [x, y] = self.sampler.next_pair();
        let Some((id, chance)) = scene.pick_light(None, || self.sampler.next()) else { return 0 };
        let light = scene.light(id);
        self.seek(start::DIRECTION);
        let [u, v] = self.sampler.next_pair();
        let Some(emission) = light.emit([x, y, u, v]) else { return 0 };
        let Emission { point: mut previous, mut direction, weight, exit } = emission;
        let end = f64::from(chance.0) * f64::from(exit.end.value());
        let spread = f64::from(exit.spread.value());
        if weight.is_black() || !weight.is_finite() || end <= 0.0 || spread <= 0.0 {
            return 0;
        }
        // Whether the lens may see the walk's newest vertex.
        let mut seen = exit.end.can_be_hit() && !hides_emitters;
        if seen && techniques.uses(Join::LensSplat) && self.joined_length >= 1 {
            self.splat_light(&light, &previous, chance.0);
        }

        let mut side = Side::start(heuristic, end, Join::LightHit, if exit.end.can_be_hit() { techniques.light_hit } else { 0.0 });
        let mut throughput = weight / chance.0;
        let emitted = throughput.max();
        let mut way = (spread, 0.0, false);
        let mut stored = 0;
        let mut length = 1;
        loop {
            if techniques.uses(Join::LensHit) && seen {
                self.lens_hit(&previous, direction, length, &side, throughput, way);
            }
            // A vertex here makes paths of at least one segment more.
            if length >= self.joined_length {
                return stored;
            }
            let Some((point, hit)) = scene.intersect(&Ray::leaving(&previous, direction, Segment::Inner)) else { return stored };
            let instead = if length > 1 {
                (Join::Connection, techniques.connection)
            } else if techniques.uses(Join::NextEvent) {
                let picked = f64::from(scene.light_chance(id, Some(&point)).0);
                let density = f64::from(light.next_event_density(&previous, &point).value());
                (Join::NextEvent, techniques.next_event * picked * density / end)
            } else {
                (Join::NextEvent, 0.0)
            };
            side = side.advance(heuristic, &step(&previous, &point, direction, way, instead));
            let Some(here) = Vertex::new(point, scene.bsdf(&point, hit), -direction, Carried::Importance) else { return stored };
            let dimension = length.wrapping_mul(DIMENSIONS_PER_VERTEX);
            seen = !(hides_emitters && scene.light_id_at(hit).is_some());
            let bounce = self.splat_and_bounced(&here, length, &side, throughput, seen);
            if here.joins()
                && techniques.uses(Join::Connection)
                && let Some(slot) = store.get_mut(stored)
            {
                *slot = Some(WalkVertex { vertex: here, throughput, side, length });
                stored += 1;
            }
            let Some(bounce) = bounce else { return stored };
            throughput *= bounce.weight;
            if length >= self.strategy.rr_depth {
                self.seek(dimension + vertex::ROULETTE);
                match survive(throughput.max() / emitted, self.sampler.next()) {
                    Some(scale) => throughput = throughput * scale,
                    None => return stored,
                }
            }
            (previous, direction) = (point, bounce.direction);
            way = (bounce.pdf, bounce.pdf_rev, bounce.delta);
            length += 1;
        }
    }

    /// (s, t) = (1, 1): the walk's own first vertex, shown to the lens. Next event's choice of light has no part in it.
    fn splat_light(&mut self, light: &S::Light<'s>, point: &Point, chance: Real) {
        let Strategy { techniques, heuristic, .. } = *self.strategy;
        self.seek(start::SPLAT);
        let lens = self.sampler.next_pair();
        let Some(seen) = self.scene.camera().see(point, lens) else { return };
        // Light from infinitely far away is told by the line along which it arrives.
        let at = if point.place == Place::Distant { Point::distant(seen.point.position, point.normal) } else { *point };
        let exit = light.emitted(&at, -seen.direction);
        if exit.radiance.is_black() || !self.lens_sees(&seen, point) {
            return;
        }
        let made_by_light = f64::from(chance) * f64::from(exit.end.value());
        let (to_light, to_lens) = conversions(&seen.point, point, seen.direction);
        let made_by_camera = f64::from(seen.spread.value()) * to_light;
        let on_lens = f64::from(exit.spread.value()) * to_lens;
        let by_camera = heuristic.of(techniques.light_hit * made_by_camera / made_by_light);
        let others = F::Rivals::NONE.with(Join::LightHit, by_camera).with(Join::LensHit, self.lens_hit_share(&seen, on_lens));
        let own = heuristic.of(techniques.lens_splat);
        self.film.weighed(own, others);
        self.film.splat(
            seen.raster,
            Contribution {
                value: exit.radiance * seen.weight * ((made_by_camera / (made_by_light * techniques.lens_splat)) as Real),
                weight: share(own, others.total()) as Real,
                technique: Technique { s: 1, t: 1 },
            },
        );
    }

    /// t = 1, a vertex of the walk shown to the lens, and where the walk goes on; both are asked for at once.
    fn splat_and_bounced(
        &mut self,
        vertex: &Vertex<'s, S>,
        length: u32,
        side: &Side<F::Rivals>,
        throughput: Spectrum,
        lens_sees: bool,
    ) -> Option<Bounce> {
        let dimension = length.wrapping_mul(DIMENSIONS_PER_VERTEX);
        let seen = if lens_sees && vertex.joins() && self.strategy.techniques.uses(Join::LensSplat) {
            self.seek(dimension + vertex::ENDPOINT);
            self.scene.camera().see(&vertex.point, self.sampler.next_pair())
        } else {
            None
        };
        self.seek(dimension + vertex::BSDF);
        let u = bsdf_numbers::<S>(self.sampler);
        let (scatter, bounce) = vertex.scatter_and_bounce(seen.as_ref().map(|seen| -seen.direction), u);
        if let (Some(seen), Some(scatter)) = (&seen, &scatter) {
            self.splat(&vertex.point, length, side, throughput, seen, scatter);
        }
        bounce
    }

    /// t = 1: a vertex of the walk, shown to the lens.
    fn splat(&mut self, point: &Point, length: u32, side: &Side<F::Rivals>, throughput: Spectrum, seen: &Seen, scatter: &Scatter) {
        let Strategy { techniques, heuristic, .. } = *self.strategy;
        if scatter.value.is_black() || !self.lens_sees(seen, point) {
            return;
        }
        let spread = f64::from(seen.spread.value());
        let (to_vertex, to_lens) = conversions(&seen.point, point, seen.direction);
        let made_by_camera = spread * to_vertex;
        // The cosine at the vertex is in the scattered value already.
        let importance = match seen.spread {
            Spread::SolidAngle(_) => seen.point.direction_to(point).map_or(0.0, |(_, squared)| spread / f64::from(squared)),
            Spread::Parallel(_) => spread,
        };
        let on_lens = f64::from(scatter.pdf.0) * to_lens;
        let by_camera = side.sum(heuristic, made_by_camera, f64::from(scatter.pdf_rev.0));
        let others = by_camera.with(Join::LensHit, self.lens_hit_share(seen, on_lens));
        let own = heuristic.of(techniques.lens_splat);
        self.film.weighed(own, others);
        self.film.splat(
            seen.raster,
            Contribution {
                value: throughput * scatter.value * seen.weight * ((importance / techniques.lens_splat) as Real),
                weight: share(own, others.total()) as Real,
                technique: Technique { s: length + 1, t: 1 },
            },
        );
    }

    /// What landing on the lens adds to a splat's weight, if `on_lens` is how densely the walk would have landed there.
    fn lens_hit_share(&self, seen: &Seen, on_lens: f64) -> f64 {
        if seen.end.can_be_hit() {
            self.strategy.heuristic.of(self.strategy.techniques.lens_hit * on_lens / f64::from(seen.end.value()))
        } else {
            0.0
        }
    }

    /// Whether the lens sees `point` along this ray: within its clipping distances, and nothing in between.
    fn lens_sees(&self, seen: &Seen, point: &Point) -> bool {
        let distance =
            if point.place == Place::Distant { Real::INFINITY } else { dot(point.position - seen.point.position, seen.direction) };
        if distance <= seen.near || distance > seen.far {
            return false;
        }
        let mut from = seen.point;
        from.position += seen.direction * seen.near;
        self.scene.unoccluded(point, &from, Segment::Lens)
    }

    /// t = 0: the segment from `previous` crosses the lens. The lens casts no shadow: the walk goes on as if nothing were there.
    fn lens_hit(&mut self, previous: &Point, direction: Vec3, length: u32, side: &Side<F::Rivals>, throughput: Spectrum, way: Way) {
        let Strategy { techniques, heuristic, .. } = *self.strategy;
        if length > self.joined_length {
            return;
        }
        let Some(seen) = self.scene.camera().hit(previous.leave(direction), direction, Real::INFINITY) else { return };
        if !self.lens_sees(&seen, previous) {
            return;
        }
        let lens = &seen.point;
        let (end, spread) = (f64::from(seen.end.value()), f64::from(seen.spread.value()));
        let cos = f64::from(dot(lens.normal, direction).abs());
        // Showing the vertex before to the lens is the last step's other way; the walk has not counted it yet.
        let at_lens = side.advance(heuristic, &step(previous, lens, direction, way, (Join::LensSplat, techniques.lens_splat)));
        let others = at_lens.sum(heuristic, end, spread);
        let own = heuristic.of(techniques.lens_hit);
        self.film.weighed(own, others);
        self.film.splat(
            seen.raster,
            Contribution {
                value: throughput * seen.weight * ((end * spread / (cos * techniques.lens_hit)) as Real),
                weight: share(own, others.total()) as Real,
                technique: Technique { s: length + 1, t: 0 },
            },
        );
    }
}
