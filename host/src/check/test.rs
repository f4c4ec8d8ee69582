//! What is tested.

use serde::{Deserialize, Serialize};

/// A test, in the order in which culprits are named: what comes first spoils what comes later.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Test {
    /// Every call returns.
    Calls,
    /// Answers are finite, not negative, and directions are unit vectors on the side that their lobe says.
    Range,
    /// The same question has the same answer, whatever was asked before.
    Purity,
    /// Questions asked at once are answered as one by one.
    Batch,
    /// Lobes are those that are declared.
    Lobes,
    /// A sample carries the densities that `eval` gives for it.
    Agreement,
    /// What is carried decides the η² of refraction and nothing else.
    Carried,
    /// The density integrates to the share of samples.
    Mass,
    /// Samples fall where the density says.
    Sampling,
    /// Delta lobes are picked as often as their chances say, and each has one direction.
    Chance,
    /// weight · pdf = value.
    Weight,
    /// A reverse density is the density of the way back.
    Reverse,
    /// The weights of all ways to make a path sum to 1.
    Paths,
    /// f is the same both ways.
    Reciprocity,
    /// Nothing depends on the azimuth, where that is declared.
    Isotropy,
    /// No more leaves than arrives.
    Albedo,
    /// Values integrate to what the samples bring.
    Furnace,
    /// A light's sample carries the radiance that `eval` gives for it.
    Emission,
    /// Radiance integrates to what the samples bring.
    Power,
}

impl Test {
    /// Those of a BSDF.
    pub const OF_BSDFS: [Self; 17] = [
        Self::Calls,
        Self::Range,
        Self::Purity,
        Self::Batch,
        Self::Lobes,
        Self::Agreement,
        Self::Carried,
        Self::Mass,
        Self::Sampling,
        Self::Chance,
        Self::Weight,
        Self::Reverse,
        Self::Paths,
        Self::Reciprocity,
        Self::Isotropy,
        Self::Albedo,
        Self::Furnace,
    ];

    /// Those of a light.
    pub const OF_LIGHTS: [Self; 8] =
        [Self::Calls, Self::Range, Self::Purity, Self::Agreement, Self::Mass, Self::Sampling, Self::Emission, Self::Power];

    /// As reports and cases write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Calls => "calls",
            Self::Range => "range",
            Self::Purity => "purity",
            Self::Batch => "batch",
            Self::Lobes => "lobes",
            Self::Agreement => "agreement",
            Self::Mass => "mass",
            Self::Sampling => "sampling",
            Self::Chance => "chance",
            Self::Carried => "carried",
            Self::Weight => "weight",
            Self::Reverse => "reverse",
            Self::Paths => "paths",
            Self::Reciprocity => "reciprocity",
            Self::Isotropy => "isotropy",
            Self::Albedo => "albedo",
            Self::Furnace => "furnace",
            Self::Emission => "emission",
            Self::Power => "power",
        }
    }

    /// The test of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::OF_BSDFS.into_iter().chain(Self::OF_LIGHTS).find(|test| test.name() == name)
    }

    /// What holds if it passes.
    pub fn promise(self) -> &'static str {
        match self {
            Self::Calls => "every call returns",
            Self::Range => "every answer is finite and in range",
            Self::Purity => "answers do not depend on what was asked before",
            Self::Batch => "questions asked at once are answered as one by one",
            Self::Lobes => "samples come from the declared lobes, and from each of them",
            Self::Agreement => "samples carry the densities that eval gives",
            Self::Mass => "the pdf integrates to the share of samples",
            Self::Sampling => "samples fall where the pdf says",
            Self::Chance => "delta lobes are picked as often as their chances say",
            Self::Carried => "what is carried decides the η² of refraction and nothing else",
            Self::Weight => "weight · pdf = value",
            Self::Reverse => "pdf_rev is the pdf of the way back",
            Self::Paths => "the weights of all ways to make a path sum to 1",
            Self::Reciprocity => "f is the same both ways",
            Self::Isotropy => "the azimuth does not matter",
            Self::Albedo => "no more leaves than arrives",
            Self::Furnace => "values integrate to what samples bring",
            Self::Emission => "samples carry the radiance that eval gives",
            Self::Power => "radiance integrates to what samples bring",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_the_reports_and_lead_back() {
        for test in Test::OF_BSDFS.into_iter().chain(Test::OF_LIGHTS) {
            assert_eq!(Test::named(test.name()), Some(test));
            assert_eq!(serde_json::to_value(test).expect("a name"), test.name());
        }
        assert!(Test::OF_BSDFS.is_sorted() && Test::OF_LIGHTS.is_sorted());
    }
}
