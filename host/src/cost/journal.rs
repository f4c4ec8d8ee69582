//! What has been measured, kept in a file as it comes: a run that was cut off goes on from there.

use std::{
    fs::{self, OpenOptions},
    io::Write,
    path::{Path, PathBuf},
};

use serde::{Deserialize, Serialize};

use super::{pace::Pass, spent::Spent, subject::Snapshot, techniques::Techniques};
use crate::{
    error::{Error, Result},
    partial::Partial,
    plan::Stage,
};

/// What is being written, for messages.
const WHAT: &str = "journal";

/// What a journal is about. One of anything else is begun anew.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// Of this program.
    pub version: String,
    /// Of what was read for it, as a digest.
    pub scene: String,
    /// Of the image, in pixels.
    pub size: [u32; 2],
    /// Render threads.
    pub threads: usize,
    /// Of the random numbers.
    pub seed: u64,
    /// Seconds for everything.
    pub budget: f64,
    /// Files that were given.
    pub references: Vec<PathBuf>,
}

/// Something that was measured.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Entry {
    /// A half of the reference is in its file.
    Half {
        /// 0 or 1.
        half: usize,
        /// Samples per pixel.
        spp: u32,
        /// Wall-clock seconds.
        seconds: f64,
    },
    /// What a pilot chose.
    Plan {
        /// The plan.
        stage: Stage,
        /// In words.
        card: Vec<String>,
        /// Wall-clock seconds of a sample of every technique once, of all pixels.
        pace: f64,
    },
    /// A render of a method.
    Run {
        /// Which.
        method: String,
        /// Which of its renders.
        seed: u64,
        /// Its errors on the way.
        snapshots: Vec<Snapshot>,
        /// Its passes.
        passes: Vec<Pass>,
        /// What was sampled.
        words: String,
    },
    /// A render of a setting of a knob.
    Setting {
        /// Which knob.
        knob: String,
        /// To what it was turned.
        setting: String,
        /// Its errors at the end, seed by seed, and its time.
        runs: Vec<Snapshot>,
    },
    /// Where time went.
    Time(Spent),
    /// The techniques apart, if there is room for them.
    Techniques(Option<Techniques>),
    /// Something failed, and is not tried again.
    Failed {
        /// What was done.
        what: String,
        /// How it failed.
        words: String,
    },
    /// So many seconds were spent in all.
    Spent(f64),
}

/// The journal of a folder.
#[derive(Debug)]
pub struct Journal {
    file: PathBuf,
    entries: Vec<Entry>,
}

impl Journal {
    /// Opens the folder's, or begins one.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn open(folder: &Path, header: &Header) -> Result<Self> {
        let file = folder.join("journal.jsonl");
        let known = fs::read_to_string(&file).ok();
        let mut lines = known.iter().flat_map(|text| text.lines());
        let same = lines.next().and_then(|line| serde_json::from_str::<Header>(line).ok()).is_some_and(|known| known == *header);
        if same {
            // The last line may have been cut off; what cannot be read is measured again.
            let entries = lines.filter_map(|line| serde_json::from_str(line).ok()).collect();
            let journal = Self { file, entries };
            journal.rewrite(header)?;
            return Ok(journal);
        }
        let journal = Self { file, entries: Vec::new() };
        journal.rewrite(header)?;
        Ok(journal)
    }

    /// What has been measured.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// The first entry that something is made of.
    pub fn find<T>(&self, of: impl FnMut(&Entry) -> Option<T>) -> Option<T> {
        self.entries.iter().find_map(of)
    }

    /// Seconds that were spent.
    pub fn spent(&self) -> f64 {
        self.entries.iter().filter_map(|entry| if let Entry::Spent(seconds) = entry { Some(*seconds) } else { None }).sum()
    }

    /// Keeps something.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn add(&mut self, entry: Entry) -> Result<()> {
        let line = line(&self.file, &entry)?;
        let written = OpenOptions::new().append(true).open(&self.file).and_then(|mut file| file.write_all(line.as_bytes()));
        written.map_err(|error| {
            Error::in_file(&self.file, format!("the {WHAT} cannot be written: {error}"), "free some space, or choose another folder")
        })?;
        self.entries.push(entry);
        Ok(())
    }

    fn rewrite(&self, header: &Header) -> Result<()> {
        let mut text = line(&self.file, header)?;
        for entry in &self.entries {
            text += &line(&self.file, entry)?;
        }
        Partial::write_text(&self.file, WHAT, &text)
    }
}

fn line(file: &Path, value: &impl Serialize) -> Result<String> {
    let text = serde_json::to_string(value)
        .map_err(|error| Error::in_file(file, format!("no JSON: {error}"), "this is a bug; please report it"))?;
    Ok(text + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(budget: f64) -> Header {
        Header { version: "1".into(), scene: "a".into(), size: [4, 4], threads: 1, seed: 0, budget, references: Vec::new() }
    }

    #[test]
    fn what_was_measured_is_there_again_and_a_line_that_was_cut_off_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let mut journal = Journal::open(folder.path(), &header(1.0)).unwrap();
        journal.add(Entry::Half { half: 0, spp: 8, seconds: 0.5 }).unwrap();
        journal.add(Entry::Spent(0.75)).unwrap();
        let file = folder.path().join("journal.jsonl");
        let whole = fs::read_to_string(&file).unwrap();
        fs::write(&file, whole + "{\"spent\":1").unwrap();
        let mut again = Journal::open(folder.path(), &header(1.0)).unwrap();
        assert_eq!((again.entries().len(), again.spent()), (2, 0.75));
        again.add(Entry::Spent(1.0)).unwrap();
        assert_eq!(Journal::open(folder.path(), &header(1.0)).unwrap().spent(), 1.75);
    }

    #[test]
    fn a_journal_of_something_else_is_begun_anew() {
        let folder = tempfile::tempdir().unwrap();
        Journal::open(folder.path(), &header(1.0)).unwrap().add(Entry::Spent(1.0)).unwrap();
        assert!(Journal::open(folder.path(), &header(2.0)).unwrap().entries().is_empty());
    }
}
