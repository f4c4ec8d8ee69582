//! One BSDF, seen from one direction.

use bidir_kernel::{Bsdf, Carried, Lobe, Real, Scatter, Scattered, Vec3};

use crate::check::{
    bridge::{Claim, Drawn, Scatterer},
    case,
    dice::Dice,
    ledger::Inputs,
    subject::{Promises, Set},
};

/// A BSDF with one set of parameters, ω_o, and what is carried.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub(super) bsdf: &'a dyn Bsdf,
    pub(super) set: &'a Set,
    pub(super) wo: Vec3,
    pub(super) carried: Carried,
    pub(super) promises: Promises,
}

/// The angle to the normal, for people.
pub(super) fn angle([x, y, z]: [f32; 3]) -> String {
    let degrees = f64::from(x.hypot(y)).atan2(f64::from(z.abs())).to_degrees();
    // As many digits as tell it from 90.
    let digits = (2.0 - (90.0 - degrees).abs().max(1e-7).log10()).clamp(1.0, 8.0) as usize;
    let number = format!("{degrees:.digits$}");
    let number = if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { &number };
    format!("θ = {number}°{}", if z < 0.0 { " from behind" } else { "" })
}

impl View<'_> {
    /// Where this is, for the end of a sentence.
    pub(super) fn place(&self) -> String {
        super::at(&[&self.set.words, &angle(self.wo.to_array()), case::word(self.carried)])
    }

    pub(super) fn inputs(&self, wi: Option<Vec3>, u: Option<[Real; 3]>) -> Inputs {
        let carried = Some(case::word(self.carried));
        Inputs { wo: Some(self.wo.to_array()), wi: wi.map(|wi| wi.to_array()), u, carried, ..Inputs::default() }
    }

    pub(super) fn eval(&self, wi: Vec3) -> Scatter {
        self.bsdf.eval(self.wo, wi, self.carried)
    }

    pub(super) fn sample(&self, u: [Real; 3]) -> Option<Scattered> {
        self.bsdf.sample(self.wo, u, self.carried)
    }

    /// How far rounding of the directions may move anything of `eval`'s answer, relatively.
    pub(super) fn spread(&self, wo: Vec3, wi: Vec3, dice: &Dice) -> f64 {
        spread(self.bsdf, wo, wi, self.carried, dice)
    }
}

/// How far rounding of the directions may move anything of `eval`'s answer, relatively.
pub(super) fn spread(bsdf: &dyn Bsdf, wo: Vec3, wi: Vec3, carried: Carried, dice: &Dice) -> f64 {
    let mut dice = dice.clone();
    let numbers = |wo, wi| {
        let Scatter { value, pdf, pdf_rev } = bsdf.eval(wo, wi, carried);
        [value[0], value[1], value[2], pdf.0, pdf_rev.0].map(f64::from)
    };
    let here = numbers(wo, wi);
    let mut spread: f64 = 0.0;
    for turn in 0..9 {
        let there = match turn % 3 {
            0 => numbers(dice.nudged(wo), wi),
            1 => numbers(wo, dice.nudged(wi)),
            _ => numbers(dice.nudged(wo), dice.nudged(wi)),
        };
        for (a, b) in here.into_iter().zip(there) {
            let largest = a.abs().max(b.abs());
            spread = spread.max(if largest > 0.0 { (a - b).abs() / largest } else { 0.0 });
        }
    }
    spread
}

/// A weight without what refraction does to radiance.
pub(super) fn energy(sample: &Scattered, carried: Carried) -> [f64; 3] {
    let refracted = carried == Carried::Radiance && sample.lobe.intersects(Lobe::TRANSMISSION);
    let factor = if refracted { f64::from(sample.eta).powi(2) } else { 1.0 };
    sample.weight.0.map(|weight| factor * f64::from(weight))
}

impl Scatterer for View<'_> {
    const NOTHING: f64 = 1e-3;

    fn draw(&self, dice: &mut Dice) -> Drawn {
        let Some(sample) = self.sample(dice.three()) else { return Drawn::default() };
        Drawn {
            direction: sample.lobe.intersects(Lobe::SMOOTH).then_some(sample.wi),
            weight: sample.weight.0.map(f64::from),
            energy: energy(&sample, self.carried),
        }
    }

    fn look(&self, w: Vec3) -> Claim {
        let Scatter { value, pdf, .. } = self.eval(w);
        Claim { pdf: f64::from(pdf.0), value: value.0.map(f64::from) }
    }
}

#[cfg(test)]
mod tests {
    use super::angle;

    #[test]
    fn angles_have_the_digits_that_tell_them_from_grazing() {
        assert_eq!(angle([0.0, 0.0, 1.0]), "θ = 0°");
        assert_eq!(angle([0.965_925_8, 0.0, -0.258_819_04]), "θ = 75° from behind");
        assert_eq!(angle([1.0, 0.0, 1e-7]), "θ = 89.9999943°");
    }
}
