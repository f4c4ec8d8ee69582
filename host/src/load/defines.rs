//! `$name` in attribute values: what `--define` and `<default>` say.

use std::{collections::BTreeMap, ops::Bound};

use super::suggest::{did_you_mean, list};
use crate::error::{Error, Place, Result};

/// How much all the values that are filled in may come to, in bytes: each may hold the one before it twice.
const MAX_FILLED: usize = 64 << 20;

/// Values by name. What was given from outside wins over what the scene says, and the scene's first word over its later ones.
pub(super) struct Defines {
    values: BTreeMap<String, String>,
    /// Given from outside, and whether the scene ever asked.
    given: BTreeMap<String, bool>,
    /// How much was filled in so far, in bytes.
    filled: usize,
}

impl Defines {
    /// From `--define NAME=VALUE`; the last of two equal names wins.
    pub(super) fn new(given: &[(String, String)]) -> Self {
        let values = given.iter().cloned().collect();
        Self { values, given: given.iter().map(|(name, _)| (name.clone(), false)).collect(), filled: 0 }
    }

    /// What `<default>` says.
    pub(super) fn set_default(&mut self, name: &str, value: String) {
        self.mark(name);
        self.values.entry(name.to_owned()).or_insert(value);
    }

    /// `text` with every `$name` replaced; the longest name that fits is meant.
    pub(super) fn apply(&mut self, text: &str, place: &Place) -> Result<String> {
        let mut out = String::with_capacity(text.len());
        let mut rest = text;
        while let Some(dollar) = rest.find('$') {
            out.push_str(&rest[..dollar]);
            rest = &rest[dollar + 1..];
            let Some((name, value)) = self.longest(rest) else { return Err(self.undefined(rest, place)) };
            let (name, value) = (name.clone(), value.clone());
            self.filled += value.len();
            if self.filled > MAX_FILLED {
                let thing = format!("the values filled in for $names come to more than {} MiB", MAX_FILLED >> 20);
                return Err(Error::at(place, thing, "write shorter values"));
            }
            out.push_str(&value);
            self.mark(&name);
            rest = &rest[name.len()..];
        }
        out.push_str(rest);
        Ok(out)
    }

    /// The longest name that `text` begins with, and its value.
    fn longest(&self, text: &str) -> Option<(&String, &String)> {
        let mut shared = text;
        loop {
            // Names sort as their beginnings do: none that sorts after this one fits, nor any longer than what it shares with the text.
            let before = (Bound::Excluded(""), Bound::Included(shared));
            let (name, value) = self.values.range::<str, _>(before).next_back()?;
            let length = name.chars().zip(shared.chars()).take_while(|(a, b)| a == b).map(|(a, _)| a.len_utf8()).sum();
            if length == name.len() {
                return Some((name, value));
            }
            shared = &shared[..length];
        }
    }

    /// An error if something was given that the scene never asked for.
    pub(super) fn check_used(&self, scene: &std::path::Path) -> Result<()> {
        let Some((name, _)) = self.given.iter().find(|(_, used)| !**used) else { return Ok(()) };
        let known: Vec<&str> = self.values.keys().map(String::as_str).filter(|k| self.given.get(*k) != Some(&false)).collect();
        let remedy = if known.is_empty() {
            "it defines no parameters; leave the --define out".to_owned()
        } else {
            format!("{}its parameters are {}", did_you_mean(name, &known), list(&known))
        };
        Err(Error::in_file(scene, format!("the scene has no parameter \"{name}\" to define"), remedy))
    }

    fn mark(&mut self, name: &str) {
        if let Some(used) = self.given.get_mut(name) {
            *used = true;
        }
    }

    fn undefined(&self, rest: &str, place: &Place) -> Error {
        let name: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        if name.is_empty() {
            return Error::at(
                place,
                "a \"$\" without a parameter's name",
                "write $name, with a <default name=\"name\" value=\"…\"/> above it",
            );
        }
        let known: Vec<&str> = self.values.keys().map(String::as_str).collect();
        let hint = did_you_mean(&name, &known);
        let thing = format!("the parameter ${name} is undefined here");
        Error::at(place, thing, format!("{hint}add <default name=\"{name}\" value=\"…\"/> above it, or give --define {name}=VALUE"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place() -> Place {
        Place { file: "s.xml".into(), position: Some((1, 2)) }
    }

    #[test]
    fn the_longest_name_is_meant() {
        let mut defines = Defines::new(&[("a".into(), "1".into()), ("ab".into(), "2".into())]);
        assert_eq!(defines.apply("$a $ab $a.5", &place()), Ok("1 2 1.5".into()));
        let mut defines = Defines::new(&["", "a", "abc", "abd", "b", "ä"].map(|name| (name.into(), format!("<{name}>"))));
        assert_eq!(defines.apply("$abb$abda$abcc$ba$ää", &place()), Ok("<a>bb<abd>a<abc>c<b>a<ä>ä".into()));
        assert!(defines.apply("$c", &place()).is_err() && defines.apply("$", &place()).is_err());
    }

    #[test]
    fn values_that_double_and_double_are_refused() {
        let mut defines = Defines::new(&[("a0".into(), "0123456789".into())]);
        let error = (0..100).find_map(|i| match defines.apply(&format!("$a{i}$a{i}"), &place()) {
            Ok(value) => {
                defines.set_default(&format!("a{}", i + 1), value);
                None
            }
            Err(error) => Some(error.to_string()),
        });
        assert!(error.unwrap().contains("more than 64 MiB"));
    }

    #[test]
    fn a_given_value_wins_over_the_default() {
        let mut defines = Defines::new(&[("a".into(), "1".into())]);
        defines.set_default("a", "2".into());
        assert_eq!(defines.apply("$a", &place()), Ok("1".into()));
    }

    #[test]
    fn an_undefined_name_is_an_error_at_its_place() {
        let error = Defines::new(&[]).apply("x$zz", &place()).unwrap_err();
        assert!(error.to_string().starts_with("s.xml:1:2: the parameter $zz is undefined"), "{error}");
    }

    #[test]
    fn an_unused_definition_is_an_error_that_names_what_there_is() {
        let mut defines = Defines::new(&[("ress".into(), "1".into())]);
        defines.set_default("res", "2".into());
        let error = defines.check_used("s.xml".as_ref()).unwrap_err().to_string();
        assert!(error.contains("\"ress\"") && error.contains("did you mean \"res\""), "{error}");
    }
}
