//! What calls of plugins take, told while somebody wants to know.

use std::time::{Duration, Instant};

/// How often a module was called, and how long that took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Metered {
    /// Calls of its exports.
    pub calls: u64,
    /// Wall-clock nanoseconds in these calls, the checks of their answers included.
    pub nanoseconds: f64,
    /// Wall-clock nanoseconds that telling took.
    pub telling: f64,
}

/// Counts the calls of each module, and times them.
#[derive(Debug)]
pub(super) struct Meter {
    modules: Vec<Metered>,
    /// Nanoseconds of one look at the clock.
    look: f64,
}

impl Meter {
    pub(super) fn new(modules: usize) -> Self {
        Self { modules: vec![Metered::default(); modules], look: look() }
    }

    /// Something was asked of a module, and came to so many calls.
    pub(super) fn add(&mut self, module: usize, calls: u64, took: Duration) {
        if let Some(metered) = self.modules.get_mut(module) {
            metered.calls += calls;
            // Of two looks at the clock, about half of each lies between them.
            metered.nanoseconds += (took.as_nanos() as f64 - self.look).max(0.0);
            metered.telling += 2.0 * self.look;
        }
    }

    pub(super) fn read(self) -> Vec<Metered> {
        self.modules
    }
}

/// The least that lies between two looks at the clock: what one takes.
fn look() -> f64 {
    let least = (0..32).map(|_| Instant::now().elapsed()).min();
    least.unwrap_or_default().as_nanos() as f64
}
