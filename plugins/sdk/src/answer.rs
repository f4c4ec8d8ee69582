//! What a module's exports answer, without a module: numbers in, a record out. A shader that is linked natively answers
//! the same bits here as its module does.

use crate::{
    Bsdf, Carried, Chance, Emitted, Made, PerSolidAngle, Profile, Real, Scatter, Spectrum, Vec2, Vec3,
    abi::{EmitOut, EvalOut, ProfileOut, SampleOut, carried},
    math::{vec2, vec3},
};

/// `bsdf_eval`.
#[inline(always)]
pub fn eval(shader: &impl Bsdf, carried: i32, wo: [f32; 3], wi: [f32; 3]) -> EvalOut {
    let Scatter { value, pdf, pdf_rev } = shader.eval(vector(wo), vector(wi), what(carried));
    EvalOut { value: bands(value), pdf: narrow(pdf.0), pdf_rev: narrow(pdf_rev.0) }
}

/// `bsdf_sample`; all 0 where there is no sample.
#[inline(always)]
pub fn sample(shader: &impl Bsdf, carried: i32, wo: [f32; 3], u: [f32; 3]) -> SampleOut {
    let Some(made) = shader.sample(vector(wo), u.map(Real::from), what(carried)) else { return SampleOut::default() };
    let (pdf, pdf_rev) = match made.made {
        Made::Smooth { pdf: PerSolidAngle(pdf), pdf_rev: PerSolidAngle(pdf_rev) } => (pdf, pdf_rev),
        Made::Delta { chance: Chance(chance), chance_rev: Chance(chance_rev) } => (chance, chance_rev),
    };
    SampleOut {
        wi: components(made.wi),
        weight: bands(made.weight),
        pdf: narrow(pdf),
        pdf_rev: narrow(pdf_rev),
        lobe: made.lobe.0,
        eta: narrow(made.eta),
    }
}

/// `light_eval`.
#[inline(always)]
pub fn profile(profile: &impl Profile, uv: [f32; 2], w: [f32; 3]) -> ProfileOut {
    let profiled = profile.eval(coordinates(uv), vector(w));
    ProfileOut { radiance: bands(profiled.radiance), pdf: narrow(profiled.pdf.0) }
}

/// `light_emit`; all 0 where nothing leaves.
#[inline(always)]
pub fn emit(profile: &impl Profile, uv: [f32; 2], u: [f32; 2]) -> EmitOut {
    let Some(Emitted { direction, profiled }) = profile.emit(coordinates(uv), u.map(Real::from)) else { return EmitOut::default() };
    EmitOut { direction: components(direction), radiance: bands(profiled.radiance), pdf: narrow(profiled.pdf.0) }
}

#[inline(always)]
fn what(code: i32) -> Carried {
    if code == carried::IMPORTANCE { Carried::Importance } else { Carried::Radiance }
}

#[inline(always)]
fn vector([x, y, z]: [f32; 3]) -> Vec3 {
    vec3(x as Real, y as Real, z as Real)
}

#[inline(always)]
fn coordinates([x, y]: [f32; 2]) -> Vec2 {
    vec2(x as Real, y as Real)
}

#[inline(always)]
fn components(v: Vec3) -> [f32; 3] {
    [narrow(v.x), narrow(v.y), narrow(v.z)]
}

#[inline(always)]
fn bands(spectrum: Spectrum) -> [f32; 3] {
    spectrum.0.map(narrow)
}

/// The ABI's numbers are f32, whatever the kernel's are.
#[allow(clippy::unnecessary_cast, reason = "the kernel's numbers are f64 in its twin")]
#[inline(always)]
fn narrow(x: Real) -> f32 {
    x as f32
}
