//! A check as one page that needs nothing but itself: no script, no network, no other file.
//!
//! It is well-formed XML, so that whoever wants may take it apart, and the same seed gives the same bytes: nothing on it was timed.

mod albedo;
mod ball;
mod light;
mod map;
pub(crate) mod markup;
pub(crate) mod png;
mod polar;
mod surface;
mod verdicts;

pub use verdicts::quoted;

use self::markup::escaped;
use super::{
    crew,
    report::{Outcome, Report},
    subject::{Lamps, Set, Surfaces},
};

/// How a page calls what was checked.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'a> {
    /// In headings.
    pub name: &'a str,
    /// What to type before `--replay`, ready for a shell.
    pub command: &'a str,
}

const STYLE: &str = include_str!("page.css");

/// Sets of parameters that are drawn, at most.
const DRAWN: usize = 6;

/// The page of BSDFs.
pub fn of_bsdfs(surfaces: &dyn Surfaces, report: &Report, subject: Subject<'_>, threads: usize) -> String {
    let drawn = drawn(surfaces.sets(), report);
    // The first piece of work is the large picture.
    let pieces: Vec<_> = drawn.first().map(|set| (*set, true)).into_iter().chain(drawn.iter().map(|set| (*set, false))).collect();
    let less = less(report);
    let mut parts =
        crew::each(
            &pieces,
            threads,
            |(set, large)| {
                if *large { surface::picture(surfaces, *set, less) } else { surface::row(surfaces, *set, less) }
            },
        );
    let rows = parts.split_off(parts.len().min(1));
    page(report, subject, &parts.concat(), &rows, surface::LEGEND)
}

/// The page of lights.
pub fn of_lights(lamps: &dyn Lamps, report: &Report, subject: Subject<'_>, threads: usize) -> String {
    let less = less(report);
    let rows = crew::each(&drawn(lamps.sets(), report), threads, |set| light::row(lamps, *set, less));
    page(report, subject, "", &rows, light::LEGEND)
}

/// By how many powers of 2 fewer questions than usual are asked, since calls are slow.
fn less(report: &Report) -> u32 {
    14_u32.saturating_sub(report.effort).min(6)
}

/// The defaults, then sets that failed something, then others from all over.
fn drawn(sets: &[Set], report: &Report) -> Vec<usize> {
    let place = |name: &str| sets.iter().position(|set| set.name == name);
    let failed = report.verdicts.iter().filter(|verdict| verdict.outcome == Outcome::Failed);
    let mut drawn: Vec<usize> = (0..sets.len().min(1)).collect();
    for set in failed.filter_map(|verdict| place(&verdict.case.as_ref()?.parameters)).take(DRAWN - 2) {
        if !drawn.contains(&set) {
            drawn.push(set);
        }
    }
    let rest: Vec<_> = (0..sets.len()).filter(|set| !drawn.contains(set)).collect();
    let room = (DRAWN - drawn.len()).min(rest.len());
    drawn.extend((0..room).map(|at| rest[at * rest.len() / room]));
    drawn
}

fn page(report: &Report, subject: Subject<'_>, picture: &str, rows: &[String], legend: &str) -> String {
    let (name, headline) = (escaped(subject.name), verdicts::headline(report));
    let title = if report.passed { "all right" } else { "wrong" };
    let (outcome, summary, table) =
        (if report.passed { "passed" } else { "failed" }, verdicts::summary(report), verdicts::table(report, subject.command));
    let rows = rows.concat();
    let version = env!("CARGO_PKG_VERSION");
    format!(
        r#"<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8"/>
<meta name="viewport" content="width=device-width, initial-scale=1"/>
<meta name="color-scheme" content="light dark"/>
<title>{name}: {title}</title>
<style>
{STYLE}</style>
</head>
<body>
<header>
<div>
<p class="kind">{kind}</p>
<h1>{heading}</h1>
<p class="headline {outcome}">{headline}</p>
{summary}
</div>
{picture}</header>
<main>
<h2>Verdicts</h2>
{table}
<h2>Parameters</h2>
<p class="legend">{legend}</p>
{rows}</main>
<footer>bidir {version}, seed {seed}, {sets} {word} of parameters, 2<sup>{effort}</sup> samples in each piece</footer>
</body>
</html>
"#,
        kind = if report.kind == "light" { "Light" } else { "BSDF" },
        seed = report.seed,
        heading = name.replace('/', "/<wbr/>"),
        sets = report.sets,
        word = if report.sets == 1 { "set" } else { "sets" },
        effort = report.effort,
    )
}

/// What heads a row: its parameters, and what went wrong while it was drawn.
fn heading(set: &Set, notes: &[String]) -> String {
    let words = if set.words.is_empty() { "defaults".to_owned() } else { escaped(&set.words) };
    let mut said: Vec<&String> = Vec::new();
    notes.iter().for_each(|note| {
        if !said.contains(&note) {
            said.push(note);
        }
    });
    let notes: String = said.iter().map(|note| format!("<p class=\"note\">{}</p>\n", escaped(note))).collect();
    format!("<h3>{words}</h3>\n{notes}")
}

/// What went wrong in an instance.
fn trouble<I: super::subject::Instance + ?Sized>(instance: &I) -> Vec<String> {
    let refused = instance
        .refusals()
        .into_iter()
        .map(|refusal| format!("{}: {}; such answers are left out here", refusal.asked.export(), refusal.flaw));
    let broken = instance.broken().map(|why| format!("{why}; what came after it is not here"));
    refused.chain(broken).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_come_first_and_no_set_comes_twice() {
        let sets: Vec<_> = (0..40).map(|i| Set::named(format!("p={i}"))).collect();
        let report = super::super::blank("bsdf", Vec::new());
        for count in [0, 1, 2, 6, 7, 40] {
            let mut drawn = drawn(&sets[..count], &report);
            assert_eq!(drawn.len(), count.min(DRAWN));
            assert!(drawn.first().is_none_or(|first| *first == 0));
            drawn.sort_unstable();
            drawn.dedup();
            assert_eq!(drawn.len(), count.min(DRAWN));
        }
    }
}
