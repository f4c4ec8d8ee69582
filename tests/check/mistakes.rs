//! Every mistake is caught, and the test that should catch it is the first one named.

use bidir::check::Test;
use wrong::Base;

use super::report;

/// A promise that is not kept, rather than a mistake of the crate's.
pub(super) const NEVER_OBSERVED: i32 = 24;

/// The mistakes of `tests/wrong` by their numbers, and the test that must be the first to fail.
pub(super) const MISTAKES: [(i32, &str, Test); 42] = [
    (1, "pdf 3 % too large, and the weight follows it", Test::Mass),
    (2, "pdf 3 % too small", Test::Mass),
    (3, "weight 3 % too large", Test::Weight),
    (4, "value 3 % too small in eval alone", Test::Weight),
    (5, "the chance of picking a lobe is not in the pdf", Test::Mass),
    (6, "the chance of picking the coat is not in the pdf of the base", Test::Mass),
    (7, "pdf_rev is pdf", Test::Reverse),
    (8, "pdf_rev 5 % too small", Test::Reverse),
    (9, "the cosine is missing", Test::Reciprocity),
    (10, "the cosine is missing in eval alone", Test::Weight),
    (11, "η² is missing", Test::Carried),
    (12, "η² counts twice", Test::Carried),
    (13, "η² is on importance", Test::Carried),
    (14, "eta is upside down", Test::Carried),
    (15, "a refracted sample has eta = 1", Test::Carried),
    (16, "not reciprocal by up to 10 %", Test::Reciprocity),
    (17, "2 % of energy too much", Test::Albedo),
    (18, "NaN closer to grazing than 1e-6", Test::Range),
    (19, "weight 5 % too large in one corner of the parameters", Test::Weight),
    (20, "every fifth answer is 0.01 % larger", Test::Purity),
    (21, "half of the directions are never made", Test::Sampling),
    (22, "sampling a quarter wider than the pdf, so that more of it ends below the horizon", Test::Mass),
    (23, "samples from a lobe that is not declared", Test::Lobes),
    (NEVER_OBSERVED, "a declared lobe that is never there", Test::Lobes),
    (25, "the fifth answer of a batch is missing", Test::Batch),
    (26, "asked together, the value is rounded otherwise", Test::Batch),
    (27, "a sample's pdf is 3 % larger than eval's", Test::Agreement),
    (28, "a sample's pdf_rev is its pdf", Test::Agreement),
    (29, "the chance of a delta lobe is 5 % too large", Test::Chance),
    (30, "the chance of a delta lobe's way back is that of the other lobe", Test::Reverse),
    (31, "directions 2 % too long", Test::Range),
    (32, "negative between two angles", Test::Range),
    (33, "no pdf near the horizon, where there is a value", Test::Range),
    (34, "drawn again until a sample is good", Test::Mass),
    (35, "weights clamped at 0.9", Test::Weight),
    (36, "reflected to the other side", Test::Range),
    (37, "pdf 5 % larger for importance", Test::Carried),
    (38, "the tangent matters, and isotropic is declared", Test::Isotropy),
    (39, "a tenth of the samples is thrown away", Test::Mass),
    (40, "samples near the horizon are thrown away", Test::Mass),
    (42, "bright where samples never go", Test::Furnace),
    (43, "a delta lobe denies its way back", Test::Paths),
];

/// A check of each, in two halves so that they run side by side.
fn all_are_named(half: usize) {
    let mut missed = Vec::new();
    for (mistake, what, test) in MISTAKES.iter().skip(half).step_by(2) {
        let report = report(*mistake, 7);
        let words = report.verdict(*test).map(|verdict| verdict.sentence.clone()).unwrap_or_default();
        println!("{mistake}, {what}: {:?}: {words}", report.failed());
        if report.culprit != Some(*test) {
            missed.push(format!("{mistake}, {what}: wanted {test:?}, found {report}"));
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n\n"));
}

#[test]
fn odd_mistakes_are_named() {
    all_are_named(0);
}

#[test]
fn even_mistakes_are_named() {
    all_are_named(1);
}

#[test]
fn without_a_mistake_nothing_is_wrong() {
    for seed in 0..5 {
        let report = report(0, seed);
        assert!(report.passed, "{report}");
    }
}

#[test]
fn a_sentence_says_what_and_where() {
    let report = report(19, 7);
    let verdict = report.verdict(Test::Weight).expect("a verdict");
    assert!(verdict.sentence.starts_with("weight is 1.05"), "{}", verdict.sentence);
    assert!(verdict.sentence.contains(&format!("{:?} 0.8", Base::Mixed)), "{}", verdict.sentence);
    assert!(verdict.sentence.contains("θ = ") && verdict.inputs.wi.is_some(), "{verdict:?}");
    assert!(report.to_string().ends_with(&format!("wrong: {}", verdict.sentence)));
}

#[test]
fn verdicts_do_not_depend_on_the_number_of_threads() {
    let shader = |_: usize| wrong::Wrong::new(3, Base::Glass, 0.2, bidir_kernel::Spectrum::ONE);
    let sets = vec![bidir::check::Set::named("glass")];
    let glass = bidir::check::Linked::bsdfs(sets, super::promises(2 | 16), shader);
    let with = |threads| bidir::check::bsdfs(&glass, &bidir::check::Settings { threads, ..super::settings(3) });
    assert_eq!(with(1).verdicts, with(3).verdicts);
}
