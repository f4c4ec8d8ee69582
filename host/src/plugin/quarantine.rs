//! Answers that were left out.

use std::{fmt, path::PathBuf};

use bidir_kernel::Carried;

use super::answer::Flaw;

/// What a plugin was asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Asked {
    /// `bsdf_eval`.
    Eval {
        /// ω_o.
        wo: [f32; 3],
        /// ω_i.
        wi: [f32; 3],
        /// What the walk carries.
        carried: Carried,
    },
    /// `bsdf_sample`.
    Sample {
        /// ω_o.
        wo: [f32; 3],
        /// In [0, 1).
        u: [f32; 3],
        /// What the walk carries.
        carried: Carried,
    },
    /// `light_emit`.
    Emit {
        /// Surface coordinates.
        uv: [f32; 2],
        /// In [0, 1).
        u: [f32; 2],
    },
    /// `light_eval`.
    Profile {
        /// Surface coordinates.
        uv: [f32; 2],
        /// The direction.
        w: [f32; 3],
    },
}

impl Asked {
    /// The export that answers just this; a call that asks more at once counts as its parts.
    pub fn export(&self) -> &'static str {
        match self {
            Self::Eval { .. } => bidir_abi::export::BSDF_EVAL,
            Self::Sample { .. } => bidir_abi::export::BSDF_SAMPLE,
            Self::Emit { .. } => bidir_abi::export::LIGHT_EMIT,
            Self::Profile { .. } => bidir_abi::export::LIGHT_EVAL,
        }
    }
}

impl fmt::Display for Asked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let carried = |carried: &Carried| if *carried == Carried::Radiance { "radiance" } else { "importance" };
        match self {
            Self::Eval { wo, wi, carried: c } => write!(f, "wo = {wo:?}, wi = {wi:?}, carried = {}", carried(c)),
            Self::Sample { wo, u, carried: c } => write!(f, "wo = {wo:?}, u = {u:?}, carried = {}", carried(c)),
            Self::Emit { uv, u } => write!(f, "uv = {uv:?}, u = {u:?}"),
            Self::Profile { uv, w } => write!(f, "uv = {uv:?}, w = {w:?}"),
        }
    }
}

/// The bad answers of one export of one module.
#[derive(Clone, Debug, PartialEq)]
pub struct Quarantined {
    /// The module.
    pub file: PathBuf,
    /// What it was asked, the first time; the first in the order of tiles, however many threads there are.
    pub asked: Asked,
    /// What was wrong, that time.
    pub flaw: Flaw,
    /// The parameters, that time, in words.
    pub parameters: String,
    /// How many bad answers there were.
    pub count: u64,
    /// The tile of the first.
    pub(super) tile: u64,
}

impl fmt::Display for Quarantined {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, asked, flaw, parameters, count, .. } = self;
        let (answers, were) = if *count == 1 { ("answer", "was") } else { ("answers", "were") };
        write!(f, "{}: {}: {count} bad {answers} {were} left out; ", file.display(), asked.export())?;
        write!(f, "the first: {flaw}, for {asked}")?;
        if parameters.is_empty() { Ok(()) } else { write!(f, ", with {parameters}") }
    }
}

/// All bad answers, one entry for each export of each module.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Quarantine(pub Vec<Quarantined>);

impl Quarantine {
    /// How many answers there were.
    pub fn count(&self) -> u64 {
        self.0.iter().map(|entry| entry.count).sum()
    }

    /// Takes in what another thread, or an earlier pass, left out.
    pub fn merge(&mut self, other: Self) {
        other.0.into_iter().for_each(|entry| self.add(entry));
    }

    pub(super) fn add(&mut self, entry: Quarantined) {
        let same = |known: &&mut Quarantined| known.file == entry.file && known.asked.export() == entry.asked.export();
        match self.0.iter_mut().find(same) {
            Some(known) => {
                let count = known.count + entry.count;
                if entry.tile < known.tile {
                    *known = entry;
                }
                known.count = count;
            }
            None => {
                self.0.push(entry);
                self.0.sort_by(|a, b| (&a.file, a.asked.export()).cmp(&(&b.file, b.asked.export())));
            }
        }
    }
}
