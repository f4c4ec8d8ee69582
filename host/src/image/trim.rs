//! Means that a few fireflies do not decide.

/// The share of pixels with the largest relative errors that a trimmed mean leaves out.
pub const TRIM: f64 = 0.001;

/// The mean without the `trim` share of largest values (their number rounded up, but never all). Reorders `values`; 0 for none.
pub fn trimmed_mean(values: &mut [f64], trim: f64) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let cut = (values.len() as f64 * trim).ceil() as usize;
    let kept = values.len().saturating_sub(cut).max(1).min(values.len());
    values[..kept].iter().sum::<f64>() / kept.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_values_are_left_out_but_never_all() {
        assert_eq!(trimmed_mean(&mut [5.0, 1.0, 3.0], 0.001), 2.0);
        assert_eq!(trimmed_mean(&mut [5.0, 1.0, 3.0], 0.0), 3.0);
        assert_eq!(trimmed_mean(&mut [5.0], 0.001), 5.0);
        assert_eq!(trimmed_mean(&mut [], 0.001), 0.0);
    }
}
