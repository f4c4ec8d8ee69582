//! The hard cases: most of them broke some renderer; each has a number, an invariant, and a worst value that is measured.
//!
//! What can be said by a scene is a file in `scenes/`, whose first line names what must hold ([`files`]); the rest is asked of shaders,
//! rays, lights and films directly. Rows 17, 53, 55 and the medium half of 11 wait until there are media and merging.

pub mod camera;
pub mod chains;
pub mod files;
pub mod geometry;
pub mod guards;
pub mod lights;
pub mod page;
pub mod plugins;
pub mod scattering;
pub mod single;
pub mod transforms;
pub mod twin;

/// What a case is asked in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The program as it is: f32, shaders linked in.
    Native,
    /// With the shaders as modules.
    Sandbox,
}

/// What was found, and what it may be at most.
#[derive(Clone, Debug, PartialEq)]
pub struct Held {
    /// In words, and in which unit.
    pub what: String,
    /// The worst that was met.
    pub worst: f64,
    /// More than this is wrong.
    pub bound: f64,
}

impl Held {
    /// A number that must not exceed a bound.
    pub fn new(what: impl Into<String>, worst: f64, bound: f64) -> Self {
        Self { what: what.into(), worst, bound }
    }

    /// A number of bad things, none of which may be.
    pub fn none(what: impl Into<String>, bad: usize) -> Self {
        Self::new(what, bad as f64, 0.0)
    }

    /// Whether it is so; not a number is not.
    pub fn holds(&self) -> bool {
        self.worst <= self.bound
    }
}

/// What is asked natively alone.
fn native(form: Form, held: impl FnOnce() -> Vec<Held>) -> Vec<Held> {
    if form == Form::Native { held() } else { Vec::new() }
}

/// A row of the table.
#[derive(Clone, Copy)]
pub struct Case {
    /// Its number there.
    pub number: u32,
    /// What is hard.
    pub what: &'static str,
    /// What it broke: project, and issue where there is one.
    pub seen: &'static str,
    /// What must hold.
    pub must: &'static str,
    /// Measures it; empty in a form that says nothing about it.
    pub run: fn(Form) -> Vec<Held>,
}

/// A row that is nothing but its scene files.
macro_rules! file {
    ($number:literal, $what:literal, $seen:literal, $must:literal) => {
        $crate::hard::Case { number: $number, what: $what, seen: $seen, must: $must, run: |form| $crate::hard::files::run($number, form) }
    };
}
pub(crate) use file;

/// Every case, by its number.
pub fn cases() -> Vec<Case> {
    let all = [scattering::CASES, geometry::CASES, lights::CASES, camera::CASES, plugins::CASES];
    all.into_iter().flatten().copied().collect()
}

/// The case of that number.
pub fn case(number: u32) -> Case {
    cases().into_iter().find(|case| case.number == number).unwrap_or_else(|| panic!("there is no case {number}"))
}
