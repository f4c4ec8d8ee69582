//! The verdicts of a check.

use std::fmt;

use bidir_kernel::Lobe;
use serde::Serialize;

use super::{
    case::Case,
    ledger::{Entry, Inputs, Ledger},
    test::Test,
};

/// How a test ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// It holds.
    Passed,
    /// It does not.
    Failed,
    /// It was not asked, since what is checked declares that it does not hold, or there was nothing to ask.
    Excepted,
}

/// What one test found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// Which one.
    pub test: Test,
    /// How it ended.
    pub outcome: Outcome,
    /// What was found in the worst case, in words; what holds, where none is bad.
    pub sentence: String,
    /// The worst case's number,
    pub statistic: f64,
    /// and what it may be at most.
    pub threshold: f64,
    /// Samples behind that number.
    pub samples: u64,
    /// How many judgments there were,
    pub judged: u64,
    /// and how many of them were bad.
    pub failed: u64,
    /// The worst case's question.
    pub inputs: Inputs,
    /// What to replay, to see it again.
    pub case: Option<Case>,
}

/// What calls cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Cost {
    /// Of `eval`, in nanoseconds.
    pub eval_nanoseconds: f64,
    /// Of `sample`, or of a light's `emit`.
    pub sample_nanoseconds: f64,
    /// Of an instance's memory, where it has one of its own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub memory_bytes: Option<usize>,
}

/// What a check found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// `bsdf` or `light`.
    pub kind: &'static str,
    /// Whether no test failed.
    pub passed: bool,
    /// The first test that failed: what to mend first, since others may fail for it.
    pub culprit: Option<Test>,
    /// One for each test, in the order of culprits.
    pub verdicts: Vec<Verdict>,
    /// What was declared otherwise, and so not held against it.
    pub exceptions: Vec<String>,
    /// Parts of the parameters' space that were not asked about.
    pub left_out: Vec<String>,
    /// Lobes that samples named.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub observed: Vec<&'static str>,
    /// Sets of parameters.
    pub sets: usize,
    /// Of the random numbers.
    pub seed: u64,
    /// The logarithm of the number of samples in each piece, base 2.
    pub effort: u32,
    /// What calls cost.
    pub cost: Cost,
    /// Wall clock.
    pub seconds: f64,
}

/// The names of lobes.
pub(super) fn names(lobes: Lobe) -> Vec<&'static str> {
    bidir_abi::lobe::NAMES.iter().filter(|(bit, _)| lobes.0 & bit != 0).map(|(_, name)| *name).collect()
}

impl Verdict {
    pub(super) fn of(test: Test, entry: &Entry) -> Self {
        let blank = Self {
            test,
            outcome: Outcome::Excepted,
            sentence: "nothing there to ask".to_owned(),
            statistic: 0.0,
            threshold: 0.0,
            samples: 0,
            judged: entry.judged,
            failed: entry.failed,
            inputs: Inputs::default(),
            case: None,
        };
        let Some(worst) = &entry.worst else { return blank };
        let failed = worst.severity() > 1.0;
        Self {
            outcome: if failed { Outcome::Failed } else { Outcome::Passed },
            sentence: if failed { worst.words.clone() } else { test.promise().to_owned() },
            statistic: worst.statistic,
            threshold: worst.threshold,
            samples: worst.samples,
            inputs: worst.inputs.clone(),
            case: worst.case.clone(),
            ..blank
        }
    }
}

/// The verdicts of the tests, from what was found.
pub(super) fn verdicts(tests: &[Test], ledger: &Ledger) -> Vec<Verdict> {
    let none = Entry::default();
    tests.iter().map(|test| Verdict::of(*test, ledger.entries.get(test).unwrap_or(&none))).collect()
}

impl Report {
    /// The verdict of one test.
    pub fn verdict(&self, test: Test) -> Option<&Verdict> {
        self.verdicts.iter().find(|verdict| verdict.test == test)
    }

    /// The tests that failed, the first of them to be mended first.
    pub fn failed(&self) -> Vec<Test> {
        self.verdicts.iter().filter(|verdict| verdict.outcome == Outcome::Failed).map(|verdict| verdict.test).collect()
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for verdict in &self.verdicts {
            let Verdict { test, outcome, sentence, statistic, threshold, judged, failed, case, .. } = verdict;
            let name = test.name();
            match outcome {
                Outcome::Passed => {
                    writeln!(f, "pass  {name:<12} {sentence} ({judged} times; at worst {statistic:.2e} of {threshold:.2e})")?
                }
                Outcome::Excepted => writeln!(f, "-     {name:<12} {sentence}")?,
                Outcome::Failed => {
                    writeln!(f, "FAIL  {name:<12} {sentence}")?;
                    writeln!(f, "      {:<12} in {failed} of {judged} judgments; at worst {statistic:.3e}, at most {threshold:.3e}", "")?;
                    if let Some(case) = case {
                        writeln!(f, "      {:<12} --replay '{case}'", "")?;
                    }
                }
            }
        }
        for exception in &self.exceptions {
            writeln!(f, "declared: {exception}")?;
        }
        for words in &self.left_out {
            writeln!(f, "left out: {words}")?;
        }
        let Cost { eval_nanoseconds, sample_nanoseconds, memory_bytes } = self.cost;
        let answer = if self.kind == "light" { "emit" } else { "sample" };
        write!(f, "eval takes {eval_nanoseconds:.0} ns, {answer} {sample_nanoseconds:.0} ns")?;
        if let Some(bytes) = memory_bytes {
            write!(f, "; an instance has {} KiB of memory", bytes >> 10)?;
        }
        writeln!(f, "; {} sets of parameters, seed {}, {:.1} s", self.sets, self.seed, self.seconds)?;
        match self.culprit {
            None => write!(f, "all right"),
            Some(first) => write!(f, "wrong: {}", self.verdict(first).map_or(first.name(), |verdict| verdict.sentence.as_str())),
        }
    }
}
