//! A piece of a check, written so that it can be asked again.

use std::{fmt, str::FromStr};

use bidir_kernel::{Carried, Vec3};
use serde::{Serialize, Serializer};

use super::{parameters, test::Test};

/// Where a finding was made: all that decides the answer to `--replay CASE`. It is written with slashes between its parts, the parameters
/// last: `weight/stream=17/effort=14/wo=0.6,0,0.8/carried=radiance/with/alpha=0.1`.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// What was tested.
    pub test: Test,
    /// Of the random numbers.
    pub stream: u64,
    /// The logarithm of the number of samples, base 2.
    pub effort: u32,
    /// ω_o and what the walk carried; none where the test goes through many.
    pub view: Option<(Vec3, Carried)>,
    /// The parameters, as their set is called.
    pub parameters: String,
}

impl Case {
    /// The parameters of a plugin's case, as `--set` takes them.
    pub fn given(&self) -> Vec<(String, String)> {
        parameters::parts(&self.parameters)
    }
}

/// What begins the parameters.
const WITH: &str = "/with/";

pub(super) fn word(carried: Carried) -> &'static str {
    match carried {
        Carried::Radiance => "radiance",
        Carried::Importance => "importance",
    }
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/stream={}/effort={}", self.test.name(), self.stream, self.effort)?;
        if let Some((Vec3 { x, y, z, .. }, carried)) = self.view {
            write!(f, "/wo={x},{y},{z}/carried={}", word(carried))?;
        }
        if self.parameters.is_empty() { Ok(()) } else { write!(f, "{WITH}{}", self.parameters) }
    }
}

impl FromStr for Case {
    type Err = String;

    /// Says in one clause what is wrong.
    fn from_str(text: &str) -> Result<Self, String> {
        let (head, parameters) = text.split_once(WITH).unwrap_or((text, ""));
        let mut parts = head.split('/');
        let name = parts.next().unwrap_or_default();
        let test = Test::named(name).ok_or_else(|| format!("begins with \"{name}\", which is no test"))?;
        let (mut stream, mut effort, mut wo, mut carried) = (None, None, None, None);
        for part in parts {
            let bad = || format!("holds \"{part}\", which says nothing");
            let (key, value) = part.split_once('=').ok_or_else(bad)?;
            match key {
                "stream" => stream = Some(value.parse().map_err(|_| bad())?),
                "effort" => effort = Some(value.parse().ok().filter(|e| (4..=24).contains(e)).ok_or_else(bad)?),
                "wo" => {
                    let numbers: Result<Vec<f32>, _> = value.split(',').map(str::parse).collect();
                    let [x, y, z] = numbers.ok().and_then(|n| <[f32; 3]>::try_from(n).ok()).ok_or_else(bad)?;
                    wo = Some(Vec3::new(x, y, z));
                }
                "carried" => {
                    let both = [Carried::Radiance, Carried::Importance];
                    carried = Some(both.into_iter().find(|c| word(*c) == value).ok_or_else(bad)?);
                }
                _ => return Err(bad()),
            }
        }
        let missing = |what: &str| format!("does not say its {what}");
        Ok(Self {
            test,
            stream: stream.ok_or_else(|| missing("stream"))?,
            effort: effort.ok_or_else(|| missing("effort"))?,
            view: wo.zip(carried),
            parameters: parameters.to_owned(),
        })
    }
}

impl Serialize for Case {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_case_is_read_as_it_is_written() {
        let view = Some((Vec3::new(0.1, -3.4e-8, 0.994_987_4), Carried::Importance));
        for (view, parameters) in [(view, "alpha=0.1/tint=0.5,0.5,1"), (None, ""), (view, "a name of an engine's own")] {
            let case = Case { test: Test::Weight, stream: u64::MAX - 3, effort: 14, view, parameters: parameters.to_owned() };
            assert_eq!(case.to_string().parse(), Ok(case));
        }
    }

    #[test]
    fn what_is_no_case_is_refused_in_a_clause() {
        for (text, word) in [
            ("", "no test"),
            ("colour/stream=1/effort=14", "\"colour\""),
            ("weight/effort=14", "its stream"),
            ("weight/stream=1/effort=99", "\"effort=99\""),
            ("weight/stream=1/effort=14/wo=1,2", "\"wo=1,2\""),
            ("weight/stream=1/effort=14/up", "\"up\""),
        ] {
            let said = text.parse::<Case>().expect_err(text);
            assert!(said.contains(word), "{text}: {said}");
        }
    }
}
