//! `bidir::check` is right: it passes what is right, and names what is wrong.

mod lights;
mod mistakes;
mod right;
mod sandboxed;

use bidir::check::{self, Linked, Promises, Report, Set, Settings};
use bidir_kernel::{Bsdf, Lobe, Profile, Spectrum};
use wrong::{Base, Wrong};

/// Enough for every mistake here; a check by hand takes four times as many samples.
const EFFORT: u32 = 12;

fn settings(seed: u64) -> Settings {
    Settings { seed, threads: 2, effort: Some(EFFORT) }
}

fn promises(lobes: u32) -> Promises {
    Promises { lobes: Lobe(lobes), reciprocal: true, isotropic: true }
}

/// The surfaces that mistakes are made in, one for each set.
fn surfaces() -> Vec<(Base, f32, Spectrum)> {
    let colour = Spectrum([0.9, 0.4, 0.1]);
    vec![
        (Base::Mixed, 0.2, Spectrum::splat(0.8)),
        (Base::Mixed, 0.02, Spectrum::ONE),
        (Base::Mixed, 0.8, Spectrum::ONE),
        (Base::Mixed, 0.4, colour),
        (Base::Glass, 0.2, Spectrum::ONE),
        (Base::Glass, 0.02, Spectrum::ONE),
        (Base::Glass, 0.8, Spectrum::ONE),
        (Base::Plastic, 0.2, colour),
        (Base::Clear, 0.2, Spectrum::ONE),
    ]
}

/// Checks the crate `wrong`, linked natively.
fn report(mistake: i32, seed: u64) -> Report {
    let mut lobes = 1 | 2 | 4 | 16 | 32;
    // Declared, and never there.
    if mistake == mistakes::NEVER_OBSERVED {
        lobes |= 8;
    }
    let sets = surfaces().iter().map(|(base, alpha, albedo)| Set::named(format!("{base:?} {alpha} {:?}", albedo.0))).collect();
    let make = move |set: usize| {
        let (base, alpha, albedo) = surfaces()[set];
        Wrong::new(mistake, base, alpha, albedo)
    };
    check::bsdfs(&Linked::bsdfs(sets, promises(lobes), make), &settings(seed))
}

/// Checks one BSDF.
fn surface<B: Bsdf + 'static>(name: &str, promises: Promises, make: impl Fn() -> B + Sync, seed: u64) -> Report {
    check::bsdfs(&Linked::bsdfs(vec![Set::named(name)], promises, |_| make()), &settings(seed))
}

/// Checks one emission profile.
fn light<P: Profile + 'static>(name: &str, make: impl Fn() -> P + Sync, seed: u64) -> Report {
    let settings = Settings { effort: Some(14), ..settings(seed) };
    check::lights(&Linked::profiles(vec![Set::named(name)], |_| make()), &settings)
}
