//! Whether a BSDF or a light is right, told from its answers alone.
//!
//! A check asks a family of shaders, one for each set of parameters, from the normal to grazing, for both carried modes, and gives a
//! [`Verdict`] for each [`Test`]: the worst statistic, its threshold, a sentence, and the [`Case`] that shows it again.
//! `docs/check.md` says what each test means. Plugins are checked in their sandbox ([`Plugin`]), and an engine's own
//! shaders where they are ([`Linked`]):
//!
//! ```
//! # use bidir::check::{self, Linked, Promises, Set, Settings};
//! # use bidir_kernel::{Bsdf, Carried, Lobe, Made, PerSolidAngle, Scatter, Scattered, Spectrum, Vec3, real::INV_PI, warp};
//! struct Chalk(Spectrum);
//!
//! impl Bsdf for Chalk {
//! #   fn eval(&self, wo: Vec3, wi: Vec3, _: Carried) -> Scatter {
//! #       if !(wo.z > 0.0 && wi.z > 0.0) {
//! #           return Scatter::NONE;
//! #       }
//! #       let density = |w: Vec3| PerSolidAngle(warp::cosine_hemisphere_pdf(w.z));
//! #       Scatter { value: self.0 * (wi.z * INV_PI), pdf: density(wi), pdf_rev: density(wo) }
//! #   }
//! #   fn sample(&self, wo: Vec3, u: [f32; 3], carried: Carried) -> Option<Scattered> {
//! #       let wi = warp::cosine_hemisphere([u[0], u[1]]);
//! #       let Scatter { pdf, pdf_rev, .. } = self.eval(wo, wi, carried);
//! #       let made = Made::Smooth { pdf, pdf_rev };
//! #       (wo.z > 0.0).then_some(Scattered { wi, weight: self.0, made, eta: 1.0, lobe: Lobe::DIFFUSE_REFLECTION })
//! #   }
//! #   fn lobes(&self) -> Lobe {
//! #       Lobe::DIFFUSE_REFLECTION
//! #   }
//!     // …
//! }
//!
//! let albedos = [0.0, 0.5, 1.0];
//! let sets = albedos.map(|albedo| Set::named(format!("albedo {albedo}"))).to_vec();
//! let promises = Promises { lobes: Lobe::DIFFUSE_REFLECTION, reciprocal: true, isotropic: true };
//! let chalks = Linked::bsdfs(sets, promises, |set| Chalk(Spectrum::splat(albedos[set])));
//! let report = check::bsdfs(&chalks, &Settings { effort: Some(10), ..Settings::default() });
//! assert!(report.passed, "{report}");
//! ```

mod bridge;
pub mod builtin;
mod case;
mod chart;
mod crew;
mod dice;
mod lamp;
mod ledger;
#[cfg(feature = "renderer")]
pub mod page;
mod parameters;
mod partition;
mod report;
mod sandboxed;
mod significance;
mod subject;
mod surface;
mod tally;
mod test;
mod timing;

use std::{collections::BTreeMap, time::Instant};

pub use case::Case;
pub use ledger::Inputs;
pub use report::{Cost, Outcome, Report, Verdict};
pub use sandboxed::Plugin;
pub use significance::{JUDGMENTS, RISK};
pub use subject::{Instance, Lamp, Lamps, Linked, Promises, Refusal, Set, Surface, Surfaces};
pub use test::Test;

use crate::{
    error::{Error, Result},
    plugin::{Manifest, Value},
};
use ledger::Ledger;

/// How a check is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Of the random numbers. The same seed and effort give the same verdicts, at any number of threads.
    pub seed: u64,
    /// Threads; 0 counts as 1.
    pub threads: usize,
    /// The logarithm of the number of samples in each piece, base 2; by default 14, and less where calls are slow.
    pub effort: Option<u32>,
}

impl Default for Settings {
    fn default() -> Self {
        Self { seed: 0, threads: 2, effort: None }
    }
}

/// Checks BSDFs.
pub fn bsdfs(surfaces: &dyn Surfaces, settings: &Settings) -> Report {
    let (start, cost) = (Instant::now(), timing::of_bsdf(surfaces));
    let effort = settings.effort.unwrap_or_else(|| timing::effort(&cost));
    let pieces = surface::pieces(surfaces.sets().len(), settings.seed);
    let mut ledger = crew::work(&pieces, settings.threads, |piece| surface::run(surfaces, piece, effort));
    surface::lobes(surfaces.promises(), &mut ledger);
    let verdicts = report::verdicts(&Test::OF_BSDFS, &ledger);
    let report = Report { effort, cost, sets: surfaces.sets().len(), seed: settings.seed, ..blank("bsdf", verdicts) };
    let (observed, left_out) = (report::names(bidir_kernel::Lobe(ledger.observed)), surfaces.left_out());
    excepted(Report { observed, left_out, seconds: start.elapsed().as_secs_f64(), ..report }, surfaces.promises())
}

/// Checks emission profiles.
pub fn lights(lamps: &dyn Lamps, settings: &Settings) -> Report {
    let (start, cost) = (Instant::now(), timing::of_light(lamps));
    let effort = settings.effort.unwrap_or_else(|| timing::effort(&cost));
    let pieces = lamp::pieces(lamps.sets().len(), settings.seed, lamps.on_surfaces());
    let ledger = crew::work(&pieces, settings.threads, |piece| lamp::run(lamps, piece, effort));
    let report = Report {
        effort,
        cost,
        sets: lamps.sets().len(),
        seed: settings.seed,
        ..blank("light", report::verdicts(&Test::OF_LIGHTS, &ledger))
    };
    Report { left_out: lamps.left_out(), seconds: start.elapsed().as_secs_f64(), ..report }
}

/// Does again what led to a case of BSDFs, and judges that test alone.
///
/// # Errors
/// If there is no such set of parameters.
pub fn replay_bsdf(surfaces: &dyn Surfaces, case: &Case) -> Result<Report> {
    let piece = surface::Piece { set: place(surfaces.sets(), case)?, stream: case.stream, view: case.view };
    let report = replayed("bsdf", surface::run(surfaces, &piece, case.effort), case);
    Ok(Report { cost: timing::of_bsdf(surfaces), ..report })
}

/// Does again what led to a case of lights, and judges that test alone.
///
/// # Errors
/// If there is no such set of parameters.
pub fn replay_light(lamps: &dyn Lamps, case: &Case) -> Result<Report> {
    let piece = lamp::Piece { set: place(lamps.sets(), case)?, stream: case.stream };
    let report = replayed("light", lamp::run(lamps, &piece, case.effort), case);
    Ok(Report { cost: timing::of_light(lamps), ..report })
}

fn place(sets: &[Set], case: &Case) -> Result<usize> {
    let none = || Error::new(format!("no set of parameters is called \"{}\"", case.parameters), "replay a case of the same shaders");
    sets.iter().position(|set| set.name == case.parameters).ok_or_else(none)
}

fn replayed(kind: &'static str, ledger: Ledger, case: &Case) -> Report {
    let verdicts = report::verdicts(&[case.test], &ledger);
    Report { sets: 1, effort: case.effort, ..blank(kind, verdicts) }
}

fn blank(kind: &'static str, verdicts: Vec<Verdict>) -> Report {
    let culprit = verdicts.iter().find(|verdict| verdict.outcome == Outcome::Failed).map(|verdict| verdict.test);
    Report {
        kind,
        passed: culprit.is_none(),
        culprit,
        verdicts,
        exceptions: Vec::new(),
        left_out: Vec::new(),
        observed: Vec::new(),
        sets: 0,
        seed: 0,
        effort: 0,
        cost: Cost::default(),
        seconds: 0.0,
    }
}

/// What is declared not to hold.
fn excepted(mut report: Report, promises: Promises) -> Report {
    let declared = [
        (Test::Reciprocity, promises.reciprocal, "not reciprocal: f may differ when its directions are swapped"),
        (Test::Isotropy, promises.isotropic, "not isotropic: the azimuth may matter"),
    ];
    for (test, promised, words) in declared {
        if let Some(verdict) = report.verdicts.iter_mut().find(|verdict| verdict.test == test && !promised) {
            (verdict.outcome, verdict.sentence) = (Outcome::Excepted, format!("declared {}", words.split(':').next().unwrap_or(words)));
            report.exceptions.push(words.to_owned());
        }
    }
    report
}

/// Values for parameters, from `NAME=VALUE`.
///
/// # Errors
/// If there is no such parameter, or the text is no value of its type.
pub fn values<'a>(manifest: &Manifest, given: impl IntoIterator<Item = (&'a str, &'a str)>) -> Result<Vec<(String, Value)>> {
    let mut values = BTreeMap::new();
    for (name, text) in given {
        let Some(parameter) = manifest.parameter(name) else {
            let known: Vec<_> = manifest.params.iter().map(|parameter| parameter.name.as_str()).collect();
            let has = if known.is_empty() { "it has none".to_owned() } else { format!("it has {}", known.join(", ")) };
            return Err(Error::new(format!("there is no parameter \"{name}\""), has));
        };
        let none =
            || Error::new(format!("\"{text}\" is no value for \"{name}\""), format!("give a value of its type, {}", parameter.kind.name()));
        values.insert(name.to_owned(), parameters::read(parameter, text).ok_or_else(none)?);
    }
    Ok(values.into_iter().collect())
}
