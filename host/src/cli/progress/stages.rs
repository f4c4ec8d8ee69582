//! What happens before the first sample, on standard error, where it takes long.

use std::{path::Path, time::Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::{IsTerminal, Verbosity, io, say, span};
use crate::scene::description::Description;

/// From this many primitives on, building takes long enough to be told.
const MANY: usize = 1_000_000;

/// Shows what is being done. On a terminal each stage stands there while it lasts; elsewhere there is a line for each once a scene
/// turns out to be large.
#[derive(Debug)]
pub struct Stages {
    verbosity: Verbosity,
    current: Option<ProgressBar>,
    /// Of the stage.
    start: Instant,
    /// What was read and how long that took, for scenes that turn out to be large.
    loaded: String,
    large: bool,
}

impl Stages {
    /// Before the first stage.
    pub fn new(verbosity: Verbosity) -> Self {
        Self { verbosity, current: None, start: Instant::now(), loaded: String::new(), large: false }
    }

    /// A scene file is going to be read.
    pub fn loading(&mut self, scene: &Path) {
        (self.start, self.loaded) = (Instant::now(), scene.display().to_string());
        self.show(format!("loading {}", self.loaded));
    }

    /// So many of the files that the scene names are read.
    pub fn file(&self, done: usize, of: usize) {
        if let Some(bar) = &self.current {
            bar.set_message(format!("loading {}, {done} of {of} files", self.loaded));
        }
    }

    /// It is read; there may be warnings of it now.
    pub fn loaded(&mut self) {
        self.clear();
        self.loaded = format!("loaded {} in {}", self.loaded, span(self.start.elapsed()));
    }

    /// The scene is going to be built.
    pub fn building(&mut self, description: &Description) {
        let primitives = description.primitives();
        self.large = primitives > MANY;
        if self.large {
            self.line(&self.loaded);
            let stage = building(primitives, description.groups.len());
            if self.on_terminal() { self.show(stage) } else { self.line(&stage) }
        }
        self.start = Instant::now();
    }

    /// It is built.
    pub fn built(&mut self) {
        self.clear();
        if self.large {
            self.line(&format!("built in {}", span(self.start.elapsed())));
        }
    }

    fn on_terminal(&self) -> bool {
        self.verbosity == Verbosity::Shown && io::stderr().is_terminal()
    }

    fn show(&mut self, stage: String) {
        if self.on_terminal() {
            let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
            let bar = if let Ok(style) = ProgressStyle::with_template("{msg} …") { bar.with_style(style) } else { bar };
            bar.set_message(stage);
            bar.tick();
            self.current = Some(bar);
        }
    }

    fn clear(&mut self) {
        if let Some(bar) = self.current.take() {
            bar.finish_and_clear();
        }
    }

    fn line(&self, line: &str) {
        if self.verbosity == Verbosity::Shown {
            say(line);
        }
    }
}

/// An error on the way leaves no stage on the terminal.
impl Drop for Stages {
    fn drop(&mut self) {
        self.clear();
    }
}

fn building(primitives: usize, groups: usize) -> String {
    match groups {
        0 => format!("building the tree over {primitives} primitives"),
        _ => format!("building {} trees over {primitives} primitives", groups + 1),
    }
}
