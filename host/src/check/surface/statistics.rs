//! What takes many samples to tell.

use crate::check::{
    bridge::{Found, compare},
    dice::Dice,
    ledger::Ledger,
    significance::Significance,
    test::Test,
};

use super::view::{View, angle};

/// So many samples more are a second look.
const AGAIN: usize = 8;

/// So many questions without any answer above 0, and there is nothing on this side.
const DARK: usize = 1024;

pub(super) fn judge(view: &View<'_>, samples: usize, ledger: &mut Ledger, dice: &mut Dice) {
    if dark(view, dice) {
        return;
    }
    let first = compare(view, samples, dice);
    let found = if first.suspicious() { compare(view, AGAIN * samples, dice) } else { first };
    note(view, &found, ledger);
}

/// Whether nothing is scattered.
fn dark(view: &View<'_>, dice: &mut Dice) -> bool {
    (0..DARK).all(|_| {
        let scatter = view.eval(dice.direction());
        scatter.pdf.0 == 0.0 && scatter.value.is_black() && view.sample(dice.three()).is_none()
    })
}

fn note(view: &View<'_>, found: &Found, ledger: &mut Ledger) {
    let (place, inputs) = (view.place(), || view.inputs(None, None));
    let samples = found.samples as u64;
    let Found { share, mass, mass_off, energy, energy_off, brought, claimed, claimed_off, .. } = *found;
    ledger.judge(Test::Mass, mass_off.found.abs(), mass_off.bound, samples, || {
        (inputs(), format!("the pdf integrates to {mass:.4}, and {share:.4} of the samples have a direction from a smooth lobe{place}"))
    });
    if let Some(shape) = found.shape {
        ledger.judge(Test::Sampling, shape.sigmas.max(0.0), Significance::verdict().sigmas(), samples, || {
            let toward = angle(shape.worst.to_array()).replace('θ', "θ_i");
            let words = format!("{:.2} times as many samples as the pdf says fall about {toward}{place}", shape.ratio);
            (view.inputs(Some(shape.worst), None), words)
        });
    }
    ledger.judge(Test::Albedo, energy_off.found, energy_off.bound, samples, || {
        (inputs(), format!("{energy:.4} times as much leaves as arrives, in the strongest band{place}"))
    });
    ledger.judge(Test::Furnace, claimed_off.found.abs(), claimed_off.bound, samples, || {
        (inputs(), format!("samples bring {brought:.4} from a white surround, and the values of eval integrate to {claimed:.4}{place}"))
    });
}
