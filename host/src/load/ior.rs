//! Named indices of refraction.

use bidir_kernel::Spectrum;

/// name, eta red, green, blue, k red, green, blue
const METALS: &str = include_str!("data/metals.csv");
/// name, index
const DIELECTRICS: &str = include_str!("data/iors.csv");

/// η and k of a metal; the case counts.
pub(super) fn metal(name: &str) -> Option<(Spectrum, Spectrum)> {
    let numbers = row(METALS, |n| n == name)?;
    match numbers.as_slice() {
        [a, b, c, d, e, f] => Some((Spectrum([*a, *b, *c]), Spectrum([*d, *e, *f]))),
        _ => None,
    }
}

/// The index of a dielectric; the case does not count.
pub(super) fn dielectric(name: &str) -> Option<f64> {
    // Read as f64: 1.000277 differs from its f32.
    let (_, index) = rows(DIELECTRICS).find(|(n, _)| n.eq_ignore_ascii_case(name))?;
    index.trim().parse().ok()
}

/// The metals there are.
pub(super) fn metals() -> Vec<&'static str> {
    rows(METALS).map(|(name, _)| name).collect()
}

/// The dielectrics there are.
pub(super) fn dielectrics() -> Vec<&'static str> {
    rows(DIELECTRICS).map(|(name, _)| name).collect()
}

fn rows(table: &'static str) -> impl Iterator<Item = (&'static str, &'static str)> {
    table.lines().skip(1).filter_map(|line| line.split_once(','))
}

fn row(table: &'static str, fits: impl Fn(&str) -> bool) -> Option<Vec<f32>> {
    let (_, numbers) = rows(table).find(|(name, _)| fits(name))?;
    numbers.split(',').map(|n| n.trim().parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_can_be_read() {
        assert!(metals().len() > 30 && metals().into_iter().all(|name| metal(name).is_some()));
        assert!(dielectrics().len() > 20 && dielectrics().into_iter().all(|name| dielectric(name).is_some()));
        assert_eq!(metal("none"), Some((Spectrum::BLACK, Spectrum::ONE)));
        assert_eq!(dielectric("Water"), Some(1.333));
    }
}
