//! The same question, asked again.

use bidir_kernel::{Bsdf, Carried, Real, Vec3};

use crate::check::{
    case,
    dice::Dice,
    ledger::{Inputs, Ledger},
    subject::Surfaces,
    test::Test,
};

/// Questions, and how many of them are asked of an instance that was asked nothing before.
const QUESTIONS: usize = 256;
const FRESH: usize = 16;

#[derive(Clone, Copy)]
struct Question {
    wo: Vec3,
    carried: Carried,
    wi: Vec3,
    u: [Real; 3],
    sample: bool,
}

impl Question {
    fn new(dice: &mut Dice, bsdf: &dyn Bsdf) -> Self {
        let (wo, u) = (dice.direction(), dice.three());
        let carried = if dice.below(2) == 0 { Carried::Radiance } else { Carried::Importance };
        // Where a sample leads, so that narrow lobes are met.
        let wi = bsdf.sample(wo, dice.three(), carried).map_or_else(|| dice.direction(), |sample| sample.wi);
        Self { wo, carried, wi, u, sample: dice.below(2) == 0 }
    }

    /// In words, which are those of its bits.
    fn answer(&self, bsdf: &dyn Bsdf) -> String {
        if self.sample {
            format!("{:?}", bsdf.sample(self.wo, self.u, self.carried))
        } else {
            format!("{:?}", bsdf.eval(self.wo, self.wi, self.carried))
        }
    }

    fn inputs(&self) -> Inputs {
        let (wi, u) = if self.sample { (None, Some(self.u)) } else { (Some(self.wi.to_array()), None) };
        Inputs { wo: Some(self.wo.to_array()), wi, u, carried: Some(case::word(self.carried)), ..Inputs::default() }
    }
}

pub(super) fn judge(surfaces: &dyn Surfaces, set: usize, ledger: &mut Ledger, dice: &mut Dice) {
    let asker = surfaces.open();
    let questions: Vec<_> = (0..QUESTIONS).map(|_| Question::new(dice, &*asker.bsdf(set))).collect();
    let first = surfaces.open();
    let answers: Vec<_> = questions.iter().map(|question| question.answer(&*first.bsdf(set))).collect();
    let mut judge = |at: usize, again: String, how: &str| {
        let question: &Question = &questions[at];
        ledger.demand(Test::Purity, again == answers[at], || {
            let (name, place) = (if question.sample { "sample" } else { "eval" }, super::at(&[&surfaces.sets()[set].words]));
            (question.inputs(), format!("{name} answers {}, and {how} {again}{place}", answers[at]))
        });
    };
    // In another order, twice in a row, with other parameters asked in between.
    let second = surfaces.open();
    let (bsdf, other) = (second.bsdf(set), second.bsdf((set + 1) % surfaces.sets().len()));
    let mut order: Vec<_> = (0..QUESTIONS).collect();
    for at in (1..QUESTIONS).rev() {
        order.swap(at, dice.below(at + 1));
    }
    for at in order {
        judge(at, questions[at].answer(&*bsdf), "asked in another order");
        judge(at, questions[at].answer(&*bsdf), "asked twice");
        questions[dice.below(QUESTIONS)].answer(&*other);
    }
    for at in (0..QUESTIONS).step_by(QUESTIONS / FRESH) {
        judge(at, questions[at].answer(&*surfaces.open().bsdf(set)), "asked first");
    }
}
