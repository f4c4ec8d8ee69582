//! Questions asked at once.

use bidir_kernel::{BATCH, Made, Scatter, Scattered};

use super::view::View;
use crate::check::{dice::Dice, ledger::Ledger, test::Test};

/// Batches of each kind.
const ROUNDS: usize = 32;

/// The words of an answer are those of its bits: each f32 that is a number has words of its own.
fn same(a: &Scatter, b: &Scatter) -> bool {
    a == b || format!("{a:?}") == format!("{b:?}")
}

fn alike(a: &Option<Scattered>, b: &Option<Scattered>) -> bool {
    a == b || format!("{a:?}") == format!("{b:?}")
}

pub(super) fn judge(view: &View<'_>, ledger: &mut Ledger, dice: &mut Dice) {
    for round in 0..ROUNDS {
        // Half the directions are samples, so that narrow lobes are met.
        let towards = |dice: &mut Dice| {
            let sample = view.sample(dice.three()).filter(|sample| matches!(sample.made, Made::Smooth { .. }));
            sample.filter(|_| dice.below(2) == 0).map_or_else(|| dice.direction(), |sample| sample.wi)
        };
        let many: Vec<_> = (0..2 + round % (BATCH - 1)).map(|_| towards(dice)).collect();
        let mut together = vec![Scatter::NONE; many.len()];
        view.bsdf.eval_n(view.wo, &many, view.carried, &mut together);
        for (wi, together) in many.iter().zip(&together) {
            let alone = view.eval(*wi);
            ledger.demand(Test::Batch, same(together, &alone), || {
                let words = format!("eval_n answers {together:?} among {}, and eval {alone:?}{}", many.len(), view.place());
                (view.inputs(Some(*wi), None), words)
            });
        }
        let (wi, u) = (towards(dice), dice.three());
        let (scatter, sample) = view.bsdf.eval_and_sample(view.wo, wi, u, view.carried);
        let (evaluated, sampled) = (view.eval(wi), view.sample(u));
        ledger.demand(Test::Batch, same(&scatter, &evaluated) && alike(&sample, &sampled), || {
            let words =
                format!("bsdf_vertex answers {scatter:?} and {sample:?}, and eval {evaluated:?} and sample {sampled:?}{}", view.place());
            (view.inputs(Some(wi), Some(u)), words)
        });
    }
}
