//! Identities that hold for every pair of directions.

use bidir_kernel::{Carried, Lobe, Made, Scatter, Scattered, Vec3};

use super::view::View;
use crate::check::{dice::Dice, ledger::Ledger, report::names, tally::Tally, test::Test};

/// The comparisons of one view.
struct Tallies {
    agreement: Tally,
    carried: Tally,
    weight: Tally,
    reverse: Tally,
    reciprocity: Tally,
    isotropy: Tally,
}

pub(super) fn judge(view: &View<'_>, count: usize, ledger: &mut Ledger, dice: &mut Dice) {
    let samples: Vec<_> = (0..count).filter_map(|_| sampled(view, dice.three(), ledger)).collect();
    let eta = one_index(&samples);
    let mut tallies = Tallies {
        agreement: Tally::new(Test::Agreement),
        carried: Tally::new(Test::Carried),
        weight: Tally::new(Test::Weight),
        reverse: Tally::new(Test::Reverse),
        reciprocity: Tally::new(Test::Reciprocity),
        isotropy: Tally::new(Test::Isotropy),
    };
    for sample in samples.iter().filter(|sample| sample.lobe.intersects(Lobe::SMOOTH)) {
        tallies.of_sample(view, sample, dice);
        tallies.of_pair(view, sample.wi, eta, dice);
        dice.roll();
    }
    for _ in 0..count / 2 {
        let wi = dice.direction();
        declared(view, wi, ledger);
        tallies.of_pair(view, wi, eta, dice);
    }
    let Tallies { agreement, carried, weight, reverse, reciprocity, isotropy } = tallies;
    [agreement, carried, weight, reverse, reciprocity, isotropy].into_iter().for_each(|tally| tally.settle(ledger));
}

/// A sample, the same for both carried modes but for its weight.
fn sampled(view: &View<'_>, u: [f32; 3], ledger: &mut Ledger) -> Option<Scattered> {
    let [radiance, importance] = [Carried::Radiance, Carried::Importance].map(|carried| view.bsdf.sample(view.wo, u, carried));
    let plain = |sample: Option<Scattered>| sample.map(|sample| Scattered { weight: Default::default(), ..sample });
    ledger.demand(Test::Carried, plain(radiance) == plain(importance), || {
        let words = "direction, densities, lobe or eta of a sample differ between radiance and importance";
        (view.inputs(None, Some(u)), format!("{words}{}", view.place()))
    });
    let sample = if view.carried == Carried::Radiance { radiance } else { importance }?;
    ledger.observe(sample.lobe);
    ledger.demand(Test::Carried, sample.lobe.intersects(Lobe::TRANSMISSION) || sample.eta == 1.0, || {
        let words = format!("a reflected sample has eta = {}, and nothing was refracted{}", sample.eta, view.place());
        (view.inputs(Some(sample.wi), Some(u)), words)
    });
    Some(sample)
}

/// The index of every smooth sample that passed through, if there is but one.
fn one_index(samples: &[Scattered]) -> Option<f64> {
    let mut etas = samples.iter().filter(|sample| sample.lobe.intersects(Lobe::SMOOTH_TRANSMISSION)).map(|sample| f64::from(sample.eta));
    let first = etas.next()?;
    etas.all(|eta| (eta / first - 1.0).abs() < 1e-4).then_some(first)
}

/// Values lie on sides where a smooth lobe is declared.
fn declared(view: &View<'_>, wi: Vec3, ledger: &mut Ledger) {
    let lobes = if wi.z * view.wo.z > 0.0 { Lobe::SMOOTH_REFLECTION } else { Lobe::SMOOTH_TRANSMISSION };
    let scatter = view.eval(wi);
    ledger.demand(Test::Lobes, scatter.value.is_black() || view.promises.lobes.intersects(lobes), || {
        let words = format!(
            "eval has a value where only {} could give one, and none of them is declared{}",
            names(lobes).join(" and "),
            view.place()
        );
        (view.inputs(Some(wi), None), words)
    });
}

impl Tallies {
    /// A smooth sample against `eval`.
    fn of_sample(&mut self, view: &View<'_>, sample: &Scattered, dice: &Dice) {
        let Made::Smooth { pdf, pdf_rev } = sample.made else { return };
        let (wi, scatter) = (sample.wi, view.eval(sample.wi));
        let spread = || view.spread(view.wo, wi, dice);
        let say = |subject: &'static str, other: &'static str| {
            move |ratio: f64| (view.inputs(Some(wi), None), format!("{subject} is {ratio:.3} × {other}{}", view.place()))
        };
        self.agreement.take(f64::from(pdf.0), f64::from(scatter.pdf.0), spread, say("a sample's pdf", "that of eval"));
        self.agreement.take(f64::from(pdf_rev.0), f64::from(scatter.pdf_rev.0), spread, say("a sample's pdf_rev", "that of eval"));
        for band in 0..3 {
            let product = f64::from(sample.weight[band]) * f64::from(scatter.pdf.0);
            self.weight.take(product, f64::from(scatter.value[band]), spread, say("weight", "value / pdf"));
        }
    }

    /// `eval` against itself.
    fn of_pair(&mut self, view: &View<'_>, wi: Vec3, eta: Option<f64>, dice: &Dice) {
        let wo = view.wo;
        let eval = |carried, wo, wi| view.bsdf.eval(wo, wi, carried);
        let [radiance, importance] = [Carried::Radiance, Carried::Importance].map(|carried| eval(carried, wo, wi));
        let back = eval(Carried::Importance, wi, wo);
        if [radiance, importance, back].iter().all(|scatter| *scatter == Scatter::NONE) {
            return;
        }
        let spread = || view.spread(wo, wi, dice).max(view.spread(wi, wo, dice));
        let say = |words: String| (view.inputs(Some(wi), None), format!("{words}{}", view.place()));
        let number = |x: f32| f64::from(x);
        self.carried.take(number(importance.pdf.0), number(radiance.pdf.0), spread, |r| {
            say(format!("the pdf for importance is {r:.3} × that for radiance, and must be the same"))
        });
        self.reverse
            .take(number(radiance.pdf_rev.0), number(back.pdf.0), spread, |r| say(format!("pdf_rev is {r:.3} × the pdf of the way back")));
        self.reverse
            .take(number(back.pdf_rev.0), number(radiance.pdf.0), spread, |r| say(format!("pdf_rev of the way back is {r:.3} × the pdf")));
        let factor = if wi.z * wo.z > 0.0 { Some(1.0) } else { eta.map(|eta| eta * eta) };
        for band in 0..3 {
            if let Some(factor) = factor {
                self.carried.take(number(importance.value[band]), factor * number(radiance.value[band]), spread, |r| {
                    say(format!("the value for importance is {:.3} × that for radiance, and eta² is {factor:.3}", r * factor))
                });
            }
            if view.promises.reciprocal {
                let (there, here) = (number(radiance.value[band]) / number(wi.z.abs()), number(back.value[band]) / number(wo.z.abs()));
                self.reciprocity
                    .take(there, here, spread, |r| say(format!("f for radiance is {r:.3} × f for importance with the directions swapped")));
            }
        }
        if view.promises.isotropic {
            self.turned(view, wi, &radiance, dice);
        }
    }

    /// The same pair at another azimuth.
    fn turned(&mut self, view: &View<'_>, wi: Vec3, here: &Scatter, dice: &Dice) {
        let (sin, cos) = (core::f32::consts::TAU * dice.clone().real()).sin_cos();
        let turn = |w: Vec3| Vec3::new(cos * w.x - sin * w.y, sin * w.x + cos * w.y, w.z);
        let there = view.bsdf.eval(turn(view.wo), turn(wi), Carried::Radiance);
        let numbers = |s: &Scatter| [s.value[0], s.value[1], s.value[2], s.pdf.0, s.pdf_rev.0];
        for (there, here) in numbers(&there).into_iter().zip(numbers(here)) {
            self.isotropy.take(
                f64::from(there),
                f64::from(here),
                || view.spread(view.wo, wi, dice),
                |ratio| {
                    let words = "isotropic is declared, but turning both directions about the normal makes an answer";
                    (view.inputs(Some(wi), None), format!("{words} {ratio:.3} × as large{}", view.place()))
                },
            );
        }
    }
}
