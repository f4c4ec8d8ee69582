//! Error against time: what a method's renders say together, what an error costs, and who overtakes whom.

use serde::Serialize;

use super::{interval::Interval, subject::Snapshot};

/// The errors whose price is told.
pub const TARGETS: [f64; 4] = [1e-1, 1e-2, 1e-3, 1e-4];

/// Seconds that everything takes at least: clocks are coarse.
const SOON: f64 = 1e-6;
/// Points that a price beyond the last of them rests on.
const LAST: usize = 3;
/// Places at which two curves are held against each other.
const STEPS: u32 = 200;
/// Who is ahead by so much, as a logarithm, is clearly ahead.
const CLEAR: f64 = 0.05;

/// One method's renders, seed by seed.
#[derive(Clone, Debug, Serialize)]
pub struct Method {
    /// As the command line spells it.
    pub name: &'static str,
    /// What it samples.
    pub words: String,
    /// Where its renders stood, by samples per pixel.
    pub points: Vec<Point>,
    /// Of the mean, as a share of the reference's.
    pub bias: Bias,
}

/// How much too bright pictures are, and whether that is known to be.
#[derive(Clone, Debug, Serialize)]
pub struct Bias {
    /// As a share of the reference's mean.
    #[serde(flatten)]
    pub interval: Interval,
    /// Why it is expected.
    pub declared: Option<String>,
}

/// All renders at the same number of samples.
#[derive(Clone, Debug, Serialize)]
pub struct Point {
    /// Samples per pixel.
    pub spp: u32,
    /// One for each seed.
    pub runs: Vec<Moment>,
}

/// One of them.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Moment {
    /// Which.
    pub seed: u64,
    /// What it was like.
    #[serde(flatten)]
    pub snapshot: Snapshot,
}

/// How a price is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum How {
    /// Renders got there.
    Measured,
    /// They did not, and are taken to go on as 1/t.
    Extrapolated,
    /// It misses light, and never gets there.
    Never,
}

/// What an error costs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Price {
    /// The error.
    pub relmse: f64,
    /// CPU seconds.
    pub cpu: Option<f64>,
    /// Wall-clock seconds.
    pub wall: Option<f64>,
    /// How that is known.
    pub how: How,
}

/// A method's prices.
#[derive(Clone, Debug, Serialize)]
pub struct Prices {
    /// Which.
    pub method: &'static str,
    /// One for each of [`TARGETS`].
    pub targets: Vec<Price>,
}

/// Where the renders of a method stand in the mean: CPU seconds, wall-clock seconds, relMSE.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stand {
    cpu: f64,
    wall: f64,
    relmse: f64,
}

/// Renders by seed, put together by samples. A number of samples that not all have come to is left out, if any is left.
pub fn points(runs: &[(u64, Vec<Snapshot>)]) -> Vec<Point> {
    let mut all: Vec<Point> = Vec::new();
    for (seed, snapshots) in runs {
        for snapshot in snapshots {
            let moment = Moment { seed: *seed, snapshot: *snapshot };
            match all.iter_mut().find(|point| point.spp == snapshot.spp) {
                Some(point) => point.runs.push(moment),
                None => all.push(Point { spp: snapshot.spp, runs: vec![moment] }),
            }
        }
    }
    all.sort_by_key(|point| point.spp);
    let most = all.iter().map(|point| point.runs.len()).max().unwrap_or(0);
    all.retain(|point| point.runs.len() == most);
    all
}

impl Method {
    /// Where renders stand in the mean. What is left of a tiny error after the reference's noise is taken out may be below 0.
    fn stands(&self) -> Vec<Stand> {
        let stand = |point: &Point| {
            let mean = |of: fn(&Snapshot) -> f64| point.runs.iter().map(|run| of(&run.snapshot)).sum::<f64>() / point.runs.len() as f64;
            Stand { cpu: mean(|at| at.cpu).max(SOON), wall: mean(|at| at.wall).max(SOON), relmse: mean(|at| at.errors.relmse) }
        };
        self.points.iter().map(stand).collect()
    }

    /// What errors cost: where the mean curve, straight between its points in logarithms, first gets there and stays.
    pub fn prices(&self) -> Prices {
        let stands = self.stands();
        let never = self.bias.declared.is_some();
        Prices { method: self.name, targets: TARGETS.map(|target| price(&stands, target, never)).to_vec() }
    }
}

fn price(stands: &[Stand], relmse: f64, never: bool) -> Price {
    let found = |cpu: f64, wall: f64, how| Price { relmse, cpu: Some(cpu), wall: Some(wall), how };
    let nothing = Price { relmse, cpu: None, wall: None, how: How::Never };
    match stands.iter().rposition(|stand| stand.relmse > relmse) {
        // The first sample is as good as that.
        None => stands.first().map_or(nothing, |first| found(first.cpu, first.wall, How::Measured)),
        Some(before) if before + 1 < stands.len() => {
            let (a, b) = (stands[before], stands[before + 1]);
            let part = if b.relmse > 0.0 { (a.relmse / relmse).ln() / (a.relmse / b.relmse).ln() } else { 1.0 };
            let between = |a: f64, b: f64| a * (b / a).powf(part);
            found(between(a.cpu, b.cpu), between(a.wall, b.wall), How::Measured)
        }
        Some(_) if never => nothing,
        Some(_) => {
            let few = &stands[stands.len().saturating_sub(LAST)..];
            let of = |time: fn(&Stand) -> f64| {
                let logarithms: f64 = few.iter().map(|stand| (stand.relmse * time(stand) / relmse).ln()).sum();
                (logarithms / few.len() as f64).exp()
            };
            found(of(|stand| stand.cpu), of(|stand| stand.wall), How::Extrapolated)
        }
    }
}

/// Who overtakes whom for good, and when, in words.
pub fn crossings(methods: &[Method]) -> Vec<String> {
    let curve = |method: &Method| method.stands().into_iter().filter(|stand| stand.relmse > 0.0).collect::<Vec<_>>();
    let curves: Vec<_> = methods.iter().map(|method| (method.name, curve(method))).collect();
    let mut all: Vec<(f64, String)> = Vec::new();
    for (i, (first, a)) in curves.iter().enumerate() {
        for (second, b) in &curves[i + 1..] {
            if let Some((time, first_wins)) = crossing(a, b) {
                let (winner, loser) = if first_wins { (first, second) } else { (second, first) };
                all.push((time, format!("{winner} overtakes {loser} after {} of CPU time", seconds(time))));
            }
        }
    }
    all.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    all.into_iter().map(|(_, words)| words).collect()
}

/// When the curves cross for the last time, if each is clearly ahead once, and whether the first is ahead then.
fn crossing(a: &[Stand], b: &[Stand]) -> Option<(f64, bool)> {
    let start = a.first()?.cpu.max(b.first()?.cpu);
    let end = a.last()?.cpu.min(b.last()?.cpu);
    let steps = (0..=STEPS).map(|i| start * (end / start).powf(f64::from(i) / f64::from(STEPS)));
    // Above 0 where the first curve is the worse one.
    let ahead: Vec<(f64, f64)> = steps.filter_map(|time| Some((time, (at(a, time)? / at(b, time)?).ln()))).collect();
    let (_, last) = *ahead.last()?;
    let after = ahead.iter().rposition(|(_, other)| other * last < 0.0)? + 1;
    let clear = |part: &[(f64, f64)], sign: f64| part.iter().any(|(_, ahead)| ahead * sign > CLEAR);
    (clear(&ahead[..after], -last.signum()) && clear(&ahead[after..], last.signum())).then(|| (ahead[after].0, last < 0.0))
}

/// The error at that time, straight between points in logarithms.
fn at(stands: &[Stand], cpu: f64) -> Option<f64> {
    let after = stands.iter().position(|stand| stand.cpu >= cpu * (1.0 - 1e-9))?;
    let b = stands[after];
    let Some(a) = after.checked_sub(1).map(|before| stands[before]) else { return Some(b.relmse) };
    let part = ((cpu / a.cpu).ln() / (b.cpu / a.cpu).ln()).clamp(0.0, 1.0);
    Some(a.relmse * (b.relmse / a.relmse).powf(part))
}

/// Two digits.
pub fn seconds(time: f64) -> String {
    match time {
        _ if time < 0.095 => format!("{:.0} ms", 1e3 * time),
        _ if time < 9.95 => format!("{time:.1} s"),
        _ if time < 600.0 => format!("{time:.0} s"),
        _ if time < 36_000.0 => format!("{:.0} min", time / 60.0),
        _ => format!("{:.0} h", time / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::reference::Errors;

    fn stands(cost: f64, errors: &[f64]) -> Vec<Stand> {
        let stand = |(i, &relmse): (usize, &f64)| Stand { cpu: cost * 2f64.powi(i as i32), wall: 0.5 * cost * 2f64.powi(i as i32), relmse };
        errors.iter().enumerate().map(stand).collect()
    }

    #[test]
    fn prices_are_read_between_points_and_beyond_them() {
        let curve = stands(1.0, &[0.4, 0.2, 0.1, 0.05]);
        let of = |target| price(&curve, target, false);
        let close = |found: Option<f64>, wanted: f64| assert!((found.unwrap() / wanted - 1.0).abs() < 1e-9, "{found:?} {wanted}");
        close(of(0.2).cpu, 2.0);
        close(of(0.15).cpu, 4.0 * 0.1 / 0.15);
        close(of(0.15).wall, 2.0 * 0.1 / 0.15);
        close(of(0.5).cpu, 1.0);
        close(of(0.01).cpu, 40.0);
        assert_eq!([of(0.15).how, of(0.01).how], [How::Measured, How::Extrapolated]);
        assert_eq!(price(&curve, 0.01, true).cpu, None);
        close(price(&curve, 0.15, true).cpu, 4.0 * 0.1 / 0.15);
        // Below the reference's noise: there at that point, as far as can be told.
        close(price(&stands(1.0, &[0.4, 0.2, -0.01]), 0.1, false).cpu, 4.0);
    }

    #[test]
    fn a_firefly_in_the_middle_takes_the_price_back() {
        assert!((price(&stands(1.0, &[0.4, 0.05, 0.4, 0.1]), 0.2, false).cpu.unwrap() - 4.0 * 2f64.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn who_is_cheap_and_rough_is_overtaken() {
        let (rough, fine) = (stands(1.0, &[0.5, 0.4, 0.32, 0.3, 0.29]), stands(1.5, &[0.9, 0.45, 0.225, 0.11]));
        let (time, first_wins) = crossing(&rough, &fine).expect("a crossing");
        assert!(!first_wins && (2.0..6.0).contains(&time), "{time}");
        assert_eq!(crossing(&rough, &stands(1.0, &[1.0, 0.8, 0.7, 0.6, 0.5])), None);
        assert_eq!(crossing(&rough, &[]), None);
    }

    #[test]
    fn points_that_not_all_seeds_came_to_are_left_out() {
        let errors = Errors { relmse: 0.1, trimmed: 0.1, smape: 0.1, bias: 0.0, fireflies: 0.0 };
        let of = |list: &[u32]| list.iter().map(|&spp| Snapshot { spp, cpu: 1.0, wall: 1.0, errors }).collect::<Vec<_>>();
        let found = points(&[(0, of(&[1, 2, 3])), (1, of(&[1, 2]))]);
        assert_eq!(found.iter().map(|point| (point.spp, point.runs.len())).collect::<Vec<_>>(), [(1, 2), (2, 2)]);
        assert_eq!(points(&[(0, of(&[1, 2, 3]))]).len(), 3);
    }

    #[test]
    fn times_have_two_digits() {
        let words = [0.012_3, 0.71, 12.3, 3000.0, 72_000.0].map(seconds);
        assert_eq!(words, ["12 ms", "0.7 s", "12 s", "50 min", "20 h"]);
    }
}
