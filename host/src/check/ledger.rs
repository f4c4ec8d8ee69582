//! What the pieces of a check found, and how it adds up.

use std::collections::BTreeMap;

use bidir_kernel::Lobe;
use serde::Serialize;

use super::{case::Case, test::Test};

/// The inputs of one question, as far as there are any.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Inputs {
    /// Towards where the walk came from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wo: Option<[f32; 3]>,
    /// Where it goes on to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wi: Option<[f32; 3]>,
    /// The numbers of a sample; the last one is 0 for a light's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub u: Option<[f32; 3]>,
    /// Surface coordinates of a light.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub uv: Option<[f32; 2]>,
    /// What leaves a light.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f32; 3]>,
    /// `radiance` or `importance`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub carried: Option<&'static str>,
}

/// The worst that a test met.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Finding {
    pub(super) statistic: f64,
    pub(super) threshold: f64,
    pub(super) samples: u64,
    pub(super) inputs: Inputs,
    pub(super) words: String,
    pub(super) case: Option<Case>,
}

impl Finding {
    /// Over 1 where the test fails.
    pub(super) fn severity(&self) -> f64 {
        // Nothing of nothing is no deviation; not a number is as bad as can be.
        let share = if self.statistic == 0.0 { 0.0 } else { self.statistic / self.threshold };
        if share.is_nan() { f64::INFINITY } else { share }
    }
}

/// Of one test.
#[derive(Clone, Debug, Default)]
pub(super) struct Entry {
    pub(super) judged: u64,
    pub(super) failed: u64,
    pub(super) worst: Option<Finding>,
}

/// The findings of a piece, or of all.
#[derive(Clone, Debug, Default)]
pub(super) struct Ledger {
    pub(super) entries: BTreeMap<Test, Entry>,
    /// Lobes that samples named.
    pub(super) observed: u32,
}

impl Ledger {
    /// Takes a judgment; `found` describes it if it is the worst.
    pub(super) fn judge(&mut self, test: Test, statistic: f64, threshold: f64, samples: u64, found: impl FnOnce() -> (Inputs, String)) {
        let mut finding = Finding { statistic, threshold, samples, inputs: Inputs::default(), words: String::new(), case: None };
        let severity = finding.severity();
        let entry = self.entries.entry(test).or_default();
        entry.judged += 1;
        entry.failed += u64::from(severity > 1.0);
        if entry.worst.as_ref().is_none_or(|worst| severity > worst.severity()) {
            (finding.inputs, finding.words) = found();
            entry.worst = Some(finding);
        }
    }

    /// Takes a judgment that is a yes or a no.
    pub(super) fn demand(&mut self, test: Test, holds: bool, found: impl FnOnce() -> (Inputs, String)) {
        self.judge(test, f64::from(u8::from(!holds)), 0.5, 1, found);
    }

    pub(super) fn observe(&mut self, lobe: Lobe) {
        self.observed |= lobe.0;
    }

    /// Says of all that was found where it was.
    pub(super) fn signed(mut self, case: impl Fn(Test) -> Case) -> Self {
        for (test, entry) in &mut self.entries {
            if let Some(worst) = &mut entry.worst {
                worst.case = Some(case(*test));
            }
        }
        self
    }

    /// Takes in what another piece found; of equals the earlier stays.
    pub(super) fn merge(&mut self, other: Self) {
        self.observed |= other.observed;
        for (test, entry) in other.entries {
            let known = self.entries.entry(test).or_default();
            known.judged += entry.judged;
            known.failed += entry.failed;
            let severity = |entry: &Entry| entry.worst.as_ref().map_or(-1.0, Finding::severity);
            if severity(&entry) > severity(known) {
                known.worst = entry.worst;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_stays_and_not_a_number_is_worse_than_any() {
        let mut ledger = Ledger::default();
        for statistic in [0.5, 2.0, f64::NAN, 3.0] {
            ledger.judge(Test::Weight, statistic, 1.0, 1, || (Inputs::default(), format!("{statistic}")));
        }
        let entry = &ledger.entries[&Test::Weight];
        assert_eq!((entry.judged, entry.failed), (4, 3));
        assert_eq!(entry.worst.as_ref().expect("a finding").words, "NaN");
    }
}
