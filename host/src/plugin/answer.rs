//! What a plugin answered, checked and brought into the kernel's terms.

use std::fmt;

use bidir_abi::{EmitOut, EvalOut, ProfileOut, SampleOut, lobe};
use bidir_kernel::{Chance, Emitted, Lobe, Made, PerSolidAngle, Scatter, Scattered, Spectrum, Vec3, profile::Profiled};

/// What is wrong with an answer. It is left out, and counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Flaw {
    /// A number is NaN, negative, infinite or 1e30 and more.
    OutOfRange(&'static str, f32),
    /// Light goes where, says the density, it never goes.
    NoDensity(&'static str),
    /// A direction's squared length is not within 0.98 … 1.02.
    NotUnit(f32),
    /// A chance above 1.
    NoChance(f32),
    /// A reflected direction on the other side, or a transmitted one on this.
    WrongSide,
    /// A sample's lobe is not one of those that the manifest names.
    WrongLobe(u32),
}

impl fmt::Display for Flaw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfRange(what, value) => write!(f, "{what} is {value}, and must lie within 0 … 1e30"),
            Self::NoDensity(what) => write!(f, "{what} is above 0 where the density is 0"),
            Self::NotUnit(squared) => write!(f, "the direction has the length {}, and must have 1", squared.sqrt()),
            Self::NoChance(chance) => write!(f, "the chance of a delta lobe is {chance}, and must lie within 0 … 1"),
            Self::WrongSide => write!(f, "the direction lies on the other side of the surface than its lobe says"),
            Self::WrongLobe(bits) => {
                let name = lobe::NAMES.iter().find(|(bit, _)| bit == bits).map(|(_, name)| *name);
                match name {
                    Some(name) => write!(f, "the sample came from the lobe {name}, which the manifest does not name"),
                    None => write!(f, "the sample's lobe is {bits}, and must be one of 1, 2, 4, 8, 16, 32"),
                }
            }
        }
    }
}

/// From here on numbers are taken for broken.
const TOO_MUCH: f32 = 1e30;

/// What rounding may add to a chance of 1.
const CHANCE_ROUNDING: f32 = 1e-5;

/// Whether all numbers are in range, by one comparison: bits of floats that are not negative sort as the floats do,
/// and those of NaN, ∞ and negative numbers lie above. −0 lies there, too; it is told apart by [`number`].
#[inline(always)]
fn plain<const N: usize>(numbers: [f32; N]) -> bool {
    numbers.into_iter().fold(0, |most, number| most.max(number.to_bits())) < TOO_MUCH.to_bits()
}

#[cold]
fn number(what: &'static str, value: f32) -> Result<(), Flaw> {
    // NaN fails both comparisons.
    if (0.0..TOO_MUCH).contains(&value) { Ok(()) } else { Err(Flaw::OutOfRange(what, value)) }
}

/// What is wrong with numbers that are not plain.
#[cold]
fn numbers<const N: usize>(what: &'static str, rgb: [f32; 3], others: [(&'static str, f32); N]) -> Result<(), Flaw> {
    rgb.map(|value| (what, value)).into_iter().chain(others).try_for_each(|(what, value)| number(what, value))
}

#[inline(always)]
fn unit([x, y, z]: [f32; 3]) -> Result<Vec3, Flaw> {
    let squared = x * x + y * y + z * z;
    if (0.98..=1.02).contains(&squared) { Ok(Vec3::new(x, y, z)) } else { Err(Flaw::NotUnit(squared)) }
}

/// `bsdf_eval`'s answer.
#[inline(always)]
pub(crate) fn scatter(out: &EvalOut) -> Result<Scatter, Flaw> {
    let EvalOut { value: [r, g, b], pdf, pdf_rev } = *out;
    if !plain([r, g, b, pdf, pdf_rev]) {
        numbers("the value", out.value, [("pdf", pdf), ("pdf_rev", pdf_rev)])?;
    }
    let value = Spectrum(out.value);
    if pdf == 0.0 && !value.is_black() {
        return Err(Flaw::NoDensity("the value"));
    }
    Ok(Scatter { value, pdf: PerSolidAngle(pdf), pdf_rev: PerSolidAngle(pdf_rev) })
}

/// `bsdf_sample`'s answer to ω_o, of a plugin that has those lobes.
#[inline(always)]
pub(crate) fn scattered(out: &SampleOut, wo_z: f32, declared: Lobe) -> Result<Option<Scattered>, Flaw> {
    if out.lobe == lobe::NONE {
        return Ok(None);
    }
    if !out.lobe.is_power_of_two() || out.lobe & declared.0 == 0 {
        return Err(Flaw::WrongLobe(out.lobe));
    }
    let lobe = Lobe(out.lobe);
    let wi = unit(out.wi)?;
    let across = wi.z * wo_z;
    if if lobe.intersects(Lobe::REFLECTION) { across < 0.0 } else { across > 0.0 } {
        return Err(Flaw::WrongSide);
    }
    let SampleOut { weight: [r, g, b], pdf, pdf_rev, eta, .. } = *out;
    if !plain([r, g, b, pdf, pdf_rev, eta]) {
        numbers("the weight", out.weight, [("pdf", pdf), ("pdf_rev", pdf_rev), ("eta", eta)])?;
    }
    let weight = Spectrum(out.weight);
    if pdf == 0.0 {
        return Err(Flaw::NoDensity("the sample"));
    }
    let made = if lobe.intersects(Lobe::DELTA) {
        if let Some(chance) = [pdf, pdf_rev].into_iter().find(|chance| *chance > 1.0 + CHANCE_ROUNDING) {
            return Err(Flaw::NoChance(chance));
        }
        Made::Delta { chance: Chance(pdf), chance_rev: Chance(pdf_rev) }
    } else {
        Made::Smooth { pdf: PerSolidAngle(pdf), pdf_rev: PerSolidAngle(pdf_rev) }
    };
    Ok(Some(Scattered { wi, weight, made, eta: if eta == 0.0 { 1.0 } else { eta }, lobe }))
}

/// `light_eval`'s answer.
#[inline(always)]
pub(crate) fn profiled(out: &ProfileOut) -> Result<Profiled, Flaw> {
    let ProfileOut { radiance: [r, g, b], pdf } = *out;
    if !plain([r, g, b, pdf]) {
        numbers("the radiance", out.radiance, [("pdf", pdf)])?;
    }
    let radiance = Spectrum(out.radiance);
    if pdf == 0.0 && !radiance.is_black() {
        return Err(Flaw::NoDensity("the radiance"));
    }
    Ok(Profiled { radiance, pdf: PerSolidAngle(pdf) })
}

/// `light_emit`'s answer.
#[inline(always)]
pub(crate) fn emitted(out: &EmitOut) -> Result<Option<Emitted>, Flaw> {
    let profiled = profiled(&ProfileOut { radiance: out.radiance, pdf: out.pdf })?;
    if out.pdf == 0.0 {
        return Ok(None);
    }
    Ok(Some(Emitted { direction: unit(out.direction)?, profiled }))
}
