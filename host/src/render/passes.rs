//! Where passes end.

/// The samples per pixel at the end of the pass that begins with `samples`: 1, 2, 4, … 32, then a quarter more each time.
/// The film adds samples up in one order, so that passes may end anywhere without changing the image.
pub fn pass_end(samples: u32) -> u32 {
    if samples < 32 { (samples + 1).next_power_of_two().max(1) } else { samples.saturating_add(samples / 4) }
}

/// Whether the sample of that number, in a stage that began with that one, knows what the film holds of all samples before it; those up
/// to [`next_look`] know no more. Which samples know of which is so told by their numbers and the plan, wherever passes end.
pub fn looks_back(sample: u32, stage: u32) -> bool {
    sample == stage || sample.is_power_of_two()
}

/// The next sample that [`looks_back`], if its stage still runs.
pub fn next_look(sample: u32) -> u32 {
    sample.checked_add(1).and_then(u32::checked_next_power_of_two).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_grow_and_end() {
        let mut ends = vec![0];
        while *ends.last().unwrap_or(&0) < 100 {
            ends.push(pass_end(*ends.last().unwrap_or(&0)));
        }
        assert_eq!(ends, [0, 1, 2, 4, 8, 16, 32, 40, 50, 62, 77, 96, 120]);
    }

    #[test]
    fn samples_look_back_at_powers_of_two_and_where_their_stage_begins() {
        let looks: Vec<u32> = (0..100).filter(|&sample| looks_back(sample, 12)).collect();
        assert_eq!(looks, [1, 2, 4, 8, 12, 16, 32, 64]);
        assert_eq!([0, 1, 12, 16, u32::MAX].map(next_look), [1, 2, 16, 32, u32::MAX]);
    }
}
