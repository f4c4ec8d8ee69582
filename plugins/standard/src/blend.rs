//! Two surfaces in one.

use bidir_sdk::{BATCH, Bsdf, Carried, Chance, Lobe, Made, PerSolidAngle, Real, Scatter, Scattered, Vec3};

/// At every point a part of the second surface and the rest of the first: f = (1 − w) f₀ + w f₁. A mask is such a one of [`crate::Null`]
/// and what it masks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blend<A, B = A> {
    /// The second one's part, w, within 0 … 1; it is also the chance that it is sampled.
    pub weight: Real,
    /// The first one.
    pub first: A,
    /// The second one.
    pub second: B,
}

/// The part that both make of a pair of directions.
#[inline]
fn mixed(weight: Real, first: Scatter, second: Scatter) -> Scatter {
    let rest = 1.0 - weight;
    Scatter {
        value: first.value * rest + second.value * weight,
        pdf: PerSolidAngle(rest * first.pdf.0 + weight * second.pdf.0),
        pdf_rev: PerSolidAngle(rest * first.pdf_rev.0 + weight * second.pdf_rev.0),
    }
}

/// A sample that one of the two made, which it is with that chance; `other` is what the other one says of its directions.
#[inline]
fn made(scattered: Scattered, chance: Real, other: impl FnOnce(Vec3) -> Scatter) -> Scattered {
    match scattered.made {
        Made::Delta { chance: own, chance_rev } => {
            Scattered { made: Made::Delta { chance: Chance(chance * own.0), chance_rev: Chance(chance * chance_rev.0) }, ..scattered }
        }
        Made::Smooth { pdf, pdf_rev } => {
            let other = other(scattered.wi);
            let rest = 1.0 - chance;
            // Of densities beyond all numbers the weight is that of the one lobe.
            let share = rest / (chance * pdf.0);
            Scattered {
                weight: (scattered.weight + other.value * share) * (1.0 / (1.0 + other.pdf.0 * share)),
                made: Made::Smooth {
                    pdf: PerSolidAngle(chance * pdf.0 + rest * other.pdf.0),
                    pdf_rev: PerSolidAngle(chance * pdf_rev.0 + rest * other.pdf_rev.0),
                },
                ..scattered
            }
        }
    }
}

impl<A: Bsdf, B: Bsdf> Bsdf for Blend<A, B> {
    fn eval(&self, wo: Vec3, wi: Vec3, carried: Carried) -> Scatter {
        mixed(self.weight, self.first.eval(wo, wi, carried), self.second.eval(wo, wi, carried))
    }

    fn sample(&self, wo: Vec3, u: [Real; 3], carried: Carried) -> Option<Scattered> {
        let weight = self.weight;
        if u[2] < weight {
            let scattered = self.second.sample(wo, [u[0], u[1], u[2] / weight], carried)?;
            Some(made(scattered, weight, |wi| self.first.eval(wo, wi, carried)))
        } else {
            let rest = 1.0 - weight;
            // Rounding must not make a 1 of it.
            let again = ((u[2] - weight) / rest).min(1.0 - Real::EPSILON);
            let scattered = self.first.sample(wo, [u[0], u[1], again], carried)?;
            Some(made(scattered, rest, |wi| self.second.eval(wo, wi, carried)))
        }
    }

    fn lobes(&self) -> Lobe {
        let first = if self.weight < 1.0 { self.first.lobes() } else { Lobe::NONE };
        let second = if self.weight > 0.0 { self.second.lobes() } else { Lobe::NONE };
        first | second
    }

    fn eval_n(&self, wo: Vec3, wi: &[Vec3], carried: Carried, scatters: &mut [Scatter]) {
        for (wi, scatters) in wi.chunks(BATCH).zip(scatters.chunks_mut(BATCH)) {
            let mut second = [Scatter::NONE; BATCH];
            self.first.eval_n(wo, wi, carried, scatters);
            self.second.eval_n(wo, wi, carried, &mut second[..wi.len()]);
            for (scatter, second) in scatters.iter_mut().zip(second) {
                *scatter = mixed(self.weight, *scatter, second);
            }
        }
    }
}
