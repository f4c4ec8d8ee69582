//! A surface that a walk has reached, and what happens to light there.

use crate::{
    bsdf::{Bsdf, Carried, Lobe, Made, Scatter, Scattered},
    density::conversions,
    math::dot,
    point::Point,
    real::{Real, Vec3},
    sampler::Sampler,
    scene::Scene,
    spectrum::Spectrum,
    technique::Join,
    weight::Step,
};

/// A point of a walk with its surface and the direction the walk came from.
pub(crate) struct Vertex<'s, S: Scene + 's> {
    pub point: Point,
    pub bsdf: S::Bsdf<'s>,
    pub lobes: Lobe,
    /// Towards where the walk came from, in the world and in the shading frame.
    pub from: Vec3,
    pub wo: Vec3,
    pub carried: Carried,
}

/// A scattering event as the walk that goes through it needs it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounce {
    pub direction: Vec3,
    pub weight: Spectrum,
    pub pdf: f64,
    pub pdf_rev: f64,
    pub delta: bool,
    pub eta: Real,
}

impl<'s, S: Scene + 's> Vertex<'s, S> {
    /// `None` where the walk arrived on different sides of the geometric and of the shading normal.
    #[inline(always)]
    pub fn new(point: Point, bsdf: S::Bsdf<'s>, from: Vec3, carried: Carried) -> Option<Self> {
        let wo = point.frame.to_local(from);
        same_side::<S>(&point, from, wo.z).then(|| Self { lobes: bsdf.lobes(), wo, point, bsdf, from, carried })
    }

    /// Whether a path can be joined here.
    #[inline(always)]
    pub fn joins(&self) -> bool {
        self.lobes.intersects(Lobe::SMOOTH)
    }

    /// `toward` in the shading frame; `None` where nothing can be scattered, whatever the directions are beyond their sides.
    #[inline(always)]
    pub fn local(&self, toward: Vec3) -> Option<Vec3> {
        let wi = self.point.frame.to_local(toward);
        if S::EFFECTS.shading_normals && !self.point.same_side(toward) {
            return None;
        }
        let cosines = wi.z * self.wo.z;
        let lobes = if cosines > 0.0 { Lobe::SMOOTH_REFLECTION } else { Lobe::SMOOTH_TRANSMISSION };
        (self.lobes.intersects(lobes) && cosines.abs() > 0.0).then_some(wi)
    }

    /// What the smooth lobes answered towards `toward`, the adjoint factor of the shading normal included.
    #[inline(always)]
    pub fn scattered(&self, toward: Vec3, mut scatter: Scatter) -> Scatter {
        if self.carried == Carried::Importance {
            scatter.value = scatter.value * self.adjoint(toward);
        }
        scatter
    }

    /// The smooth lobes towards `toward`.
    #[inline(always)]
    pub fn scatter(&self, toward: Vec3) -> Option<Scatter> {
        Some(self.scattered(toward, self.bsdf.eval(self.wo, self.local(toward)?, self.carried)))
    }

    /// The smooth lobes towards `toward`, if there is such a direction, and where the walk goes on.
    #[inline(always)]
    pub fn scatter_and_bounce(&self, toward: Option<Vec3>, u: [Real; 3]) -> (Option<Scatter>, Option<Bounce>) {
        let Some((toward, wi)) = toward.and_then(|toward| Some((toward, self.local(toward)?))) else { return (None, self.bounce(u)) };
        let (scatter, sampled) = self.bsdf.eval_and_sample(self.wo, wi, u, self.carried);
        (Some(self.scattered(toward, scatter)), sampled.and_then(|sampled| self.gone_on(sampled)))
    }

    /// Where the walk goes on.
    #[inline(always)]
    pub fn bounce(&self, u: [Real; 3]) -> Option<Bounce> {
        self.gone_on(self.bsdf.sample(self.wo, u, self.carried)?)
    }

    #[inline(always)]
    fn gone_on(&self, sampled: Scattered) -> Option<Bounce> {
        let Scattered { wi, weight, made, eta, .. } = sampled;
        let direction = self.point.frame.to_world(wi);
        if weight.is_black() || !same_side::<S>(&self.point, direction, dot(direction, self.point.normal)) {
            return None;
        }
        let weight = if self.carried == Carried::Importance { weight * self.adjoint(direction) } else { weight };
        let (pdf, pdf_rev, delta) = match made {
            Made::Smooth { pdf, pdf_rev } => (f64::from(pdf.0), f64::from(pdf_rev.0), false),
            Made::Delta { .. } if !S::EFFECTS.deltas => return None,
            Made::Delta { chance, chance_rev } => {
                // A refracted bundle changes its solid angle: η_o² cos θ_o dω_o = η_i² cos θ_i dω_i. The reverse chance
                // is per dω_o, the forward one per dω_i.
                let widening = f64::from(self.wo.z.abs()) / (f64::from(eta) * f64::from(eta) * f64::from(wi.z.abs()));
                (f64::from(chance.0), f64::from(chance_rev.0) * widening, true)
            }
        };
        (pdf > 0.0).then_some(Bounce { direction, weight, pdf, pdf_rev, delta, eta })
    }

    /// |ω_o·n_s| |ω_i·n_g| / (|ω_o·n_g| |ω_i·n_s|): what a shading normal does to importance (Veach 1997, 5.3.2).
    #[inline]
    fn adjoint(&self, toward: Vec3) -> Real {
        if !S::EFFECTS.shading_normals || self.point.normal == self.point.frame.z {
            return 1.0;
        }
        let Point { normal, frame, .. } = &self.point;
        let below = (dot(self.from, *normal) * dot(toward, frame.z)).abs();
        if below > 0.0 { (self.wo.z * dot(toward, *normal)).abs() / below } else { 0.0 }
    }
}

/// Whether the unit direction `w` lies on the same side of both normals; `cos` is its cosine where they are one.
#[allow(clippy::double_comparisons, reason = "what is no number lies on no side")]
#[inline(always)]
fn same_side<S: Scene>(point: &Point, w: Vec3, cos: Real) -> bool {
    if S::EFFECTS.shading_normals { point.same_side(w) } else { cos < 0.0 || cos > 0.0 }
}

/// The numbers of a vertex's BSDF, to whose dimension the sampler has gone.
#[inline(always)]
pub(crate) fn bsdf_numbers<S: Scene>(sampler: &mut impl Sampler) -> [Real; 3] {
    let [x, y] = sampler.next_pair();
    [x, y, if S::EFFECTS.lobe_choice { sampler.next() } else { 0.0 }]
}

/// The density, or chance, of a direction, that of the way back, and whether it was a Dirac.
pub(crate) type Way = (f64, f64, bool);

/// A walk's way from `from` to `to`, and the join that would do instead, with its effort.
#[inline]
pub(crate) fn step(from: &Point, to: &Point, direction: Vec3, (pdf, pdf_rev, delta): Way, (join, effort): (Join, f64)) -> Step {
    let (forward, backward) = conversions(from, to, direction);
    Step { pdf, pdf_rev, delta, forward, backward, join, effort }
}
