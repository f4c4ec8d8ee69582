//! A BSDF with one mistake at a time. `tests/check/mistakes.rs` says what each is, and which test has to name it.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "`!(x > 0.0)` refuses NaN too")]

mod right;

use core::sync::atomic::{AtomicU32, Ordering};

use bidir_sdk::{Bsdf, Carried, Chance, Lobe, Made, PerSolidAngle, Real, Scatter, Scattered, Spectrum, Vec3};
use bidir_standard::{Dielectric, Plastic, RoughDielectric};
use right::{Mixed, Right, microfacet, mixed};

bidir_sdk::parameters! {
    /// Something with one mistake.
    pub struct Wrong {
        /// Which mistake; 0 is none.
        mistake: int(min 0, max 63) = 0;
        /// What it is made in.
        base: choice Base { Mixed = "mixed", Glass = "glass", Plastic = "plastic", Clear = "clear" } = "mixed";
        /// Roughness.
        alpha: float(min 0.02, max 0.8) = 0.2;
        /// Of what is matt.
        albedo: rgb(min 0.0, max 1.0) = 0.8;
    }
}

/// Of glass.
const ETA: Real = 1.5;

impl Wrong {
    /// That mistake in that base.
    pub fn new(mistake: i32, base: Base, alpha: Real, albedo: Spectrum) -> Self {
        Self { mistake, base, alpha, albedo }
    }

    fn right(&self) -> Right {
        let white = Spectrum::ONE;
        match self.base {
            Base::Mixed => Right::Mixed(mixed(self.alpha, self.albedo)),
            Base::Glass => {
                let microfacet = microfacet(self.alpha);
                Right::Glass(RoughDielectric { eta: ETA, specular_reflectance: white, specular_transmittance: white, microfacet })
            }
            Base::Plastic => Right::Plastic(Plastic::new(ETA, self.albedo, white, true)),
            Base::Clear => Right::Clear(Dielectric { eta: ETA, specular_reflectance: white, specular_transmittance: white }),
        }
    }

    fn mixed(&self) -> bool {
        self.base == Base::Mixed
    }

    /// What the values, and with them the weights, are multiplied by.
    fn factor(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Real {
        let index = if wo.z > 0.0 { ETA } else { 1.0 / ETA };
        let refracted = wo.z * wi.z < 0.0;
        let squared = if refracted { index * index } else { 1.0 };
        let radiance = carried == Carried::Radiance;
        match self.mistake {
            // The cosine is missing.
            9 if self.mixed() => 1.0 / wi.z.abs().max(1e-3),
            // η² is missing, or doubled, or on the other mode.
            11 if radiance => squared,
            12 if radiance => 1.0 / squared,
            13 => {
                if radiance {
                    squared
                } else {
                    1.0 / squared
                }
            }
            // One direction counts for more than the other.
            16 if self.mixed() => 1.0 - 0.1 * wi.z,
            // Too much comes back.
            17 if self.mixed() => 1.02,
            // The tangent matters.
            38 if self.mixed() => 1.0 - 0.2 * (wo.x * wi.x).abs(),
            _ => 1.0,
        }
    }
}

/// A density times a factor.
fn times(pdf: PerSolidAngle, factor: Real) -> PerSolidAngle {
    PerSolidAngle(pdf.0 * factor)
}

/// Below this cosine the sampling of some mistakes never goes.
const LOW: Real = 0.2;

/// The answers so far: what no shader should know.
static ANSWERS: AtomicU32 = AtomicU32::new(0);

fn now_and_then() -> Real {
    if ANSWERS.fetch_add(1, Ordering::Relaxed) % 5 == 4 { 1.0001 } else { 1.0 }
}

impl Wrong {
    /// `eval`, as the mistake has it for samples too.
    fn evaluated(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        let mut scatter = self.right().eval(wo, wi, carried);
        scatter.value = scatter.value * self.factor(wo, wi, carried);
        match self.mistake {
            // 3 % more or less.
            1 => (scatter.pdf, scatter.pdf_rev) = (times(scatter.pdf, 1.03), times(scatter.pdf_rev, 1.03)),
            2 => (scatter.pdf, scatter.pdf_rev) = (times(scatter.pdf, 0.97), times(scatter.pdf_rev, 0.97)),
            // The chance of picking the lobe is not in the pdf.
            5 if self.mixed() => (scatter.pdf, scatter.pdf_rev) = (times(scatter.pdf, 2.0), times(scatter.pdf_rev, 2.0)),
            6 if self.base == Base::Plastic => {
                let matt = |w: Vec3| PerSolidAngle((w.z * core::f32::consts::FRAC_1_PI).max(0.0));
                if scatter.pdf.0 > 0.0 {
                    (scatter.pdf, scatter.pdf_rev) = (matt(wi), matt(wo));
                }
            }
            // The way back has the density of the way there, or a little less than its own.
            7 => scatter.pdf_rev = scatter.pdf,
            8 => scatter.pdf_rev = times(scatter.pdf_rev, 0.95),
            // Only importance has another density.
            37 if carried == Carried::Importance => {
                (scatter.pdf, scatter.pdf_rev) = (times(scatter.pdf, 1.05), times(scatter.pdf_rev, 1.05));
            }
            // Never sampled, but bright.
            42 if self.mixed() && scatter.pdf.0 > 0.0 => {
                let least = |pdf: PerSolidAngle, w: Vec3| if w.z < LOW { PerSolidAngle(1e-6) } else { pdf };
                (scatter.pdf, scatter.pdf_rev) = (least(scatter.pdf, wi), least(scatter.pdf_rev, wo));
            }
            _ => {}
        }
        scatter
    }

    /// The right sample of a surface, with another direction if the mistake says so.
    fn drawn(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        let right = self.right();
        match (self.mistake, right) {
            // The pdf is that of a narrower lobe.
            (22, Right::Mixed(Mixed { matt, .. })) => {
                Mixed { metal: mixed(1.25 * self.alpha, self.albedo).metal, matt }.sample(wo, u, carried)
            }
            // Another is drawn until one is good.
            (34, _) => (0..8).find_map(|again| {
                let turned = |x: Real| (x + 0.381_966 * again as Real).fract();
                right.sample(wo, [turned(u[0]), turned(u[1]), u[2]], carried)
            }),
            // Roulette that nobody knows of.
            (39, _) if u[0] > 0.9 => None,
            // Half of the directions are never made.
            (21, Right::Mixed(_)) => right.sample(wo, u, carried).map(|sample| {
                let Vec3 { x, y, z, .. } = sample.wi;
                Scattered { wi: Vec3::new(x.abs(), y, z), ..sample }
            }),
            // Those near the horizon are thrown away.
            (40 | 42, Right::Mixed(_)) => right.sample(wo, u, carried).filter(|sample| sample.wi.z >= LOW),
            _ => right.sample(wo, u, carried),
        }
    }

    /// What is wrong with a delta sample.
    fn delta(&self, mut sample: Scattered, chance: Real, chance_rev: Real) -> Scattered {
        if self.mistake == 29 && chance < 0.9 {
            sample.weight = sample.weight / 1.05;
        }
        let (chance, chance_rev) = match self.mistake {
            29 if chance < 0.9 => (1.05 * chance, 1.05 * chance_rev),
            30 if chance < 1.0 => (chance, 1.0 - chance_rev),
            43 => (chance, 0.0),
            _ => (chance, chance_rev),
        };
        sample.made = Made::Delta { chance: Chance(chance), chance_rev: Chance(chance_rev) };
        sample
    }

    /// What is wrong with a smooth sample, whose densities are those of `eval`.
    fn smooth(&self, mut sample: Scattered, wo: Vec3, carried: Carried) -> Option<Scattered> {
        let Scatter { value, pdf, pdf_rev } = self.evaluated(wo, sample.wi, carried);
        if !(pdf.0 > 0.0) {
            return None;
        }
        let moved = matches!(self.mistake, 1 | 9 | 21 | 22 | 37);
        sample.weight = if moved { value / pdf.0 } else { sample.weight * self.factor(wo, sample.wi, carried) };
        let (mut claimed, mut claimed_rev) = (pdf, pdf_rev);
        match self.mistake {
            3 => sample.weight = sample.weight * 1.03,
            19 if self.mixed() && self.alpha >= 0.8 && self.albedo == Spectrum::ONE => sample.weight = sample.weight * 1.05,
            23 if sample.lobe == Lobe::GLOSSY_TRANSMISSION => sample.lobe = Lobe::DIFFUSE_TRANSMISSION,
            27 => claimed = times(pdf, 1.03),
            28 => claimed_rev = pdf,
            31 => sample.wi *= 1.02,
            35 => sample.weight = sample.weight.map(|band| band.min(0.9)),
            36 if sample.lobe == Lobe::DIFFUSE_REFLECTION && sample.wi.x > 0.5 => sample.wi.z = -sample.wi.z,
            _ => {}
        }
        sample.made = Made::Smooth { pdf: claimed, pdf_rev: claimed_rev };
        Some(sample)
    }
}

impl Bsdf for Wrong {
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        let mut scatter = self.evaluated(wo, wi, carried);
        match self.mistake {
            4 => scatter.value = scatter.value * 0.97,
            10 if self.mixed() => scatter.value = scatter.value / wi.z.abs().max(1e-3),
            18 if wo.z.abs() < 1e-6 => scatter.value = Spectrum::splat(Real::NAN),
            20 => scatter.value = scatter.value * now_and_then(),
            32 if wi.z > 0.5 && wi.z < 0.51 => scatter.value = Spectrum::splat(-1e-3),
            33 if wi.z < 0.05 => scatter.pdf = PerSolidAngle(0.0),
            _ => {}
        }
        scatter
    }

    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        #[cfg(target_arch = "wasm32")]
        if self.mistake == 41 && u[2] > 0.999 {
            panic!("a mistake");
        }
        let mut sample = self.drawn(wo, u, carried)?;
        if sample.lobe.intersects(Lobe::TRANSMISSION) {
            sample.eta = match self.mistake {
                14 => 1.0 / sample.eta,
                15 => 1.0,
                _ => sample.eta,
            };
        }
        match sample.made {
            Made::Smooth { .. } => self.smooth(sample, wo, carried),
            Made::Delta { chance, chance_rev } => {
                sample.weight = sample.weight * self.factor(wo, sample.wi, carried);
                Some(self.delta(sample, chance.0, chance_rev.0))
            }
        }
    }

    fn lobes(&self) -> Lobe {
        self.right().lobes()
    }

    fn eval_n(&self, wo: Vec3, wi: &[Vec3], carried: Carried, scatters: &mut [Scatter]) {
        for (at, (scatter, wi)) in scatters.iter_mut().zip(wi).enumerate() {
            *scatter = self.eval(wo, *wi, carried);
            if self.mistake == 25 && at == 4 {
                *scatter = Scatter::NONE;
            }
        }
    }

    fn eval_and_sample(&self, wo: Vec3, wi: Vec3, u: [Real; 3], carried: Carried) -> (Scatter, Option<Scattered>) {
        let mut scatter = self.eval(wo, wi, carried);
        if self.mistake == 26 {
            scatter.value = scatter.value * (1.0 + Real::EPSILON);
        }
        (scatter, self.sample(wo, u, carried))
    }
}

bidir_sdk::bsdf! {
    Wrong,
    lobes: [diffuse_reflection, glossy_reflection, delta_reflection, glossy_transmission, delta_transmission],
    isotropic: true,
}
