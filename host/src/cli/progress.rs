//! How far a render is, on standard error.

use std::{
    io::{self, IsTerminal, Write},
    time::Duration,
};

mod stages;

pub use stages::Stages;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Where nobody watches, a line at least this often.
const INTERVAL: Duration = Duration::from_secs(5);
/// Parts of the bar.
const PARTS: u64 = 1000;

/// When the render will be done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// At so many samples per pixel.
    Samples(u32),
    /// After so long.
    Time(Duration),
    /// At an estimated relMSE of so much.
    Error(f64),
}

/// How much to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verbosity {
    /// No progress.
    Quiet,
    /// A bar on a terminal, else a line now and then.
    Shown,
}

/// Shows how far a render is.
#[derive(Debug)]
pub struct Progress {
    goal: Goal,
    display: Display,
}

#[derive(Debug)]
enum Display {
    Nothing,
    Bar(ProgressBar),
    Lines(Pace),
}

/// Which moments get a line: the first, each doubling of the samples and each [`INTERVAL`].
#[derive(Debug, Default)]
struct Pace {
    doubled: u32,
    last: Option<Duration>,
    /// What came since the last line.
    pending: Option<String>,
}

impl Progress {
    /// Before the first sample.
    pub fn new(goal: Goal, verbosity: Verbosity) -> Self {
        let display = match verbosity {
            Verbosity::Quiet => Display::Nothing,
            Verbosity::Shown if io::stderr().is_terminal() => Display::Bar(bar()),
            Verbosity::Shown => Display::Lines(Pace::default()),
        };
        Self { goal, display }
    }

    /// So many samples per pixel are on the film, after so long, with that estimated relMSE (if there is an estimate yet).
    pub fn update(&mut self, spp: u32, elapsed: Duration, error: Option<f64>) {
        let status = |goal| status(goal, spp, elapsed, error);
        match &mut self.display {
            Display::Nothing => {}
            Display::Bar(bar) => {
                bar.set_position((share(self.goal, spp, elapsed, error).unwrap_or(0.0) * PARTS as f64) as u64);
                bar.set_message(status(self.goal));
            }
            Display::Lines(pace) => {
                if let Some(line) = pace.pass(spp, elapsed, status(self.goal)) {
                    say(&line);
                }
            }
        }
    }

    /// The render has ended, at its goal or before.
    pub fn finish(&mut self) {
        match std::mem::replace(&mut self.display, Display::Nothing) {
            Display::Nothing => {}
            Display::Bar(bar) => bar.abandon(),
            Display::Lines(pace) => {
                if let Some(line) = pace.pending {
                    say(&line);
                }
            }
        }
    }
}

impl Pace {
    fn pass(&mut self, spp: u32, elapsed: Duration, line: String) -> Option<String> {
        let late = self.last.is_none_or(|last| elapsed.saturating_sub(last) >= INTERVAL);
        if late || spp >= self.doubled {
            self.doubled = spp.max(1).saturating_mul(2);
            self.last = Some(elapsed);
            self.pending = None;
            Some(line)
        } else {
            self.pending = Some(line);
            None
        }
    }
}

fn bar() -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(PARTS), ProgressDrawTarget::stderr());
    match ProgressStyle::with_template("{bar:24} {percent:>3} %  {msg}") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// A line that cannot be shown is not worth ending a render for.
fn say(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}

/// How much of the work is done, 0 … 1, if that can be told: an error falls as 1 / samples.
fn share(goal: Goal, spp: u32, elapsed: Duration, error: Option<f64>) -> Option<f64> {
    let share = match goal {
        Goal::Samples(total) => f64::from(spp) / f64::from(total),
        Goal::Time(total) => elapsed.as_secs_f64() / total.as_secs_f64(),
        Goal::Error(wanted) => error.filter(|_| spp > 0).map(|error| wanted / error)?,
    };
    // 0 / 0: nothing was to be done.
    Some(if share.is_nan() { 1.0 } else { share.clamp(0.0, 1.0) })
}

fn status(goal: Goal, spp: u32, elapsed: Duration, error: Option<f64>) -> String {
    let mut parts = Vec::new();
    parts.push(match goal {
        Goal::Samples(total) => format!("{spp}/{total} spp"),
        Goal::Time(_) | Goal::Error(_) => format!("{spp} spp"),
    });
    match (goal, error) {
        (Goal::Error(wanted), Some(error)) => parts.push(format!("relMSE {error:.2e}, wanted {wanted:.2e}")),
        (_, Some(error)) => parts.push(format!("relMSE {error:.2e}")),
        (_, None) => {}
    }
    parts.push(span(elapsed));
    if let Some(done) = share(goal, spp, elapsed, error).filter(|done| *done > 0.0) {
        // An estimate of years, or of less than can be told, is not worth a word.
        if let Ok(left) = Duration::try_from_secs_f64(elapsed.as_secs_f64() * (1.0 - done) / done) {
            parts.push(format!("{} left", span(left)));
        }
    }
    parts.join(", ")
}

/// 3.2 s, 2 min 05 s, 3 h 07 min.
fn span(time: Duration) -> String {
    let seconds = time.as_secs();
    match seconds {
        0..60 => format!("{:.1} s", time.as_secs_f64()),
        60..3600 => format!("{} min {:02} s", seconds / 60, seconds % 60),
        _ => format!("{} h {:02} min", seconds / 3600, seconds / 60 % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn s(seconds: u64) -> Duration {
        Duration::from_secs(seconds)
    }

    #[test]
    fn each_goal_tells_what_is_left() {
        let said = |goal, error| status(goal, 16, s(30), error);
        assert_eq!(said(Goal::Samples(64), Some(0.0123)), "16/64 spp, relMSE 1.23e-2, 30.0 s, 1 min 30 s left");
        assert_eq!(said(Goal::Time(s(40)), None), "16 spp, 30.0 s, 10.0 s left");
        assert_eq!(said(Goal::Error(0.01), Some(0.02)), "16 spp, relMSE 2.00e-2, wanted 1.00e-2, 30.0 s, 30.0 s left");
        assert_eq!(said(Goal::Error(0.01), None), "16 spp, 30.0 s");
        assert_eq!(span(s(3600 * 3 + 7 * 60)), "3 h 07 min");
    }

    #[test]
    fn no_number_breaks_a_status() {
        for goal in [Goal::Samples(0), Goal::Samples(1), Goal::Time(s(0)), Goal::Error(0.0), Goal::Error(1e-300)] {
            for error in [None, Some(0.0), Some(f64::NAN), Some(f64::INFINITY), Some(1e300)] {
                for (spp, elapsed) in [(0, s(0)), (u32::MAX, s(0)), (7, s(u32::MAX.into()))] {
                    assert!(!status(goal, spp, elapsed, error).contains("NaN s"));
                    assert!(share(goal, spp, elapsed, error).is_none_or(|share| (0.0..=1.0).contains(&share)));
                }
            }
        }
    }

    #[test]
    fn lines_come_at_doublings_and_every_five_seconds() {
        let mut pace = Pace::default();
        let mut shown = Vec::new();
        for spp in 1..=20 {
            shown.extend(pace.pass(spp, Duration::from_millis(700 * u64::from(spp)), spp.to_string()));
        }
        assert_eq!(shown, ["1", "2", "4", "8", "16"]);
        assert_eq!(pace.pending.as_deref(), Some("20"));
        assert!(pace.pass(21, s(11) + INTERVAL + Duration::from_millis(200), "21".into()).is_some());
        assert!(pace.pending.is_none());
    }
}
