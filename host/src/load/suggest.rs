//! The second half of an error about a name: which one may have been meant, and which ones there are.

/// Names longer than this are nobody's slip of the pen; comparing two takes memory and time by the product of their lengths.
const LONGEST: usize = 100;

/// `did you mean "x"? `, or nothing if no name is close.
pub(crate) fn did_you_mean(name: &str, known: &[&str]) -> String {
    if name.len() > LONGEST {
        return String::new();
    }
    let lower = name.to_lowercase();
    let distance = |k: &str| strsim::damerau_levenshtein(&lower, &k.to_lowercase());
    match known.iter().filter(|k| k.len() <= LONGEST).min_by_key(|k| distance(k)) {
        Some(best) if distance(best) <= 1 + name.chars().count() / 3 => format!("did you mean \"{best}\"? "),
        _ => String::new(),
    }
}

/// `a, b and c`.
pub(super) fn list(names: &[&str]) -> String {
    match names {
        [] => "none".into(),
        [one] => (*one).into(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_close_name_is_suggested() {
        assert_eq!(did_you_mean("ruffconductor", &["roughconductor", "diffuse"]), "did you mean \"roughconductor\"? ");
        assert_eq!(did_you_mean("velvet", &["roughconductor", "diffuse"]), "");
    }

    #[test]
    fn long_names_are_not_compared() {
        let (one, other) = ("a".repeat(1_000_000), "b".repeat(1_000_000));
        assert_eq!(did_you_mean(&one, &[&other, "diffuse"]), "");
        assert_eq!(did_you_mean("difuse", &[&other, "diffuse"]), "did you mean \"diffuse\"? ");
    }
}
