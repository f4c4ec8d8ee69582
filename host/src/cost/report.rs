//! All that was found, as the page and its data have it.

use std::path::PathBuf;

use serde::Serialize;

use super::{
    curve::{Method, Prices},
    interval::CONFIDENCE,
    knobs::Knob,
    spent::Spent,
    subject::Subject,
    techniques::Techniques,
};

/// All that was found.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Of this program.
    pub version: &'static str,
    /// What the scene is called.
    pub scene: String,
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
    /// Render threads.
    pub threads: usize,
    /// Seconds that it might take.
    pub budget: f64,
    /// Seconds that it took.
    pub spent: f64,
    /// Whether something is missing that the same command would go on with.
    pub interrupted: bool,
    /// Whether something is missing for want of time.
    pub out_of_time: bool,
    /// What is missing because it failed, and how.
    pub left_out: Vec<String>,
    /// Renders of each method.
    pub seeds: u64,
    /// How sure intervals are.
    pub confidence: f64,
    /// What pictures were held against.
    pub reference: Option<Held>,
    /// Error against time.
    pub methods: Vec<Method>,
    /// Who overtakes whom.
    pub crossings: Vec<String>,
    /// What errors cost.
    pub prices: Vec<Prices>,
    /// What settings cost and bring.
    pub knobs: Vec<Knob>,
    /// What guards cost that have no knob.
    pub guards: Vec<Guard>,
    /// Where time went.
    pub time: Option<Spent>,
    /// The techniques apart.
    pub pyramid: Option<Techniques>,
    /// The plan card.
    pub plan: Vec<String>,
    /// What there is to see.
    pub images: Vec<Shown>,
}

/// What pictures were held against.
#[derive(Clone, Debug, Serialize)]
pub struct Held {
    /// Whose it is.
    pub words: String,
    /// Whether it was given.
    pub given: bool,
    /// Its own error, where it is known.
    pub relmse: Option<f64>,
}

/// A guard that cannot be switched off.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Guard {
    /// Which.
    pub guard: &'static str,
    /// Times as long as without.
    pub price: f64,
    /// Of what, and where that is measured.
    pub words: &'static str,
}

/// A picture, in its file.
#[derive(Clone, Debug, Serialize)]
pub struct Shown {
    /// What it is called.
    pub name: String,
    /// How it was made.
    pub words: String,
    #[serde(skip)]
    pub(super) file: PathBuf,
}

/// Guards, as `cargo run --release -p bidir-tests --bin hard-cases -- FOLDER` measured them, side by side with the form without.
pub const GUARDS: [Guard; 4] = [
    Guard {
        guard: "watertight triangles",
        price: 1.32,
        words: "235.8 ns and 178.4 ns a closest hit; the knob `triangles` has it for this scene",
    },
    Guard { guard: "weights in f64", price: 1.07, words: "9.6 ns and 9.0 ns a vertex" },
    Guard { guard: "plugins' answers checked, and faults kept", price: 1.76, words: "103.5 ns and 58.9 ns an evaluation in the sandbox" },
    Guard { guard: "the same functions on every machine (libm)", price: 2.51, words: "21.0 ns and 8.4 ns a function; a path has few" },
];

impl Report {
    /// Of nothing yet.
    pub(super) fn blank(subject: &Subject, budget: f64) -> Self {
        let crop = subject.description.film.crop;
        Self {
            version: env!("CARGO_PKG_VERSION"),
            scene: subject.name.clone(),
            width: crop.width,
            height: crop.height,
            threads: subject.threads,
            budget,
            spent: 0.0,
            interrupted: false,
            out_of_time: false,
            left_out: Vec::new(),
            seeds: 0,
            confidence: CONFIDENCE,
            reference: None,
            methods: Vec::new(),
            crossings: Vec::new(),
            prices: Vec::new(),
            knobs: Vec::new(),
            guards: GUARDS.to_vec(),
            time: None,
            pyramid: None,
            plan: Vec::new(),
            images: Vec::new(),
        }
    }
}
