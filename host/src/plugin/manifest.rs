//! What a module says of itself, read without running it.

use bidir_abi::{limit, lobe, manifest};
use bidir_kernel::Lobe;
use serde::{Deserialize, Serialize};

/// What a module is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A surface's scattering.
    Bsdf,
    /// An emission profile.
    Light,
}

impl Kind {
    /// As the manifest writes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bsdf => manifest::kind::BSDF,
            Self::Light => manifest::kind::LIGHT,
        }
    }
}

/// Where a light can shine from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum EmitsFrom {
    /// Every point of a shape.
    Area,
    /// One point.
    Point,
    /// The sphere of directions.
    Environment,
}

impl EmitsFrom {
    /// As the manifest writes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Area => manifest::emits_from::AREA,
            Self::Point => manifest::emits_from::POINT,
            Self::Environment => manifest::emits_from::ENVIRONMENT,
        }
    }
}

/// Types of parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ParameterType {
    /// One f32.
    Float,
    /// Three f32.
    Rgb,
    /// One i32.
    Int,
    /// One i32, 0 or 1.
    Bool,
    /// One i32, the index of a word.
    Enum,
}

impl ParameterType {
    /// In the block.
    pub fn bytes(self) -> usize {
        if self == Self::Rgb { 12 } else { 4 }
    }

    /// As the manifest writes it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Float => manifest::parameter::FLOAT,
            Self::Rgb => manifest::parameter::RGB,
            Self::Int => manifest::parameter::INT,
            Self::Bool => manifest::parameter::BOOL,
            Self::Enum => manifest::parameter::ENUM,
        }
    }
}

/// A parameter of a plugin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// What scenes call it.
    pub name: String,
    /// Its type.
    #[serde(rename = "type")]
    pub kind: ParameterType,
    /// Where it lies in the block, bytes.
    pub offset: u32,
    /// What it is where a scene does not say; checked like a scene's value.
    pub default: serde_json::Value,
    /// The least it may be, per channel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// The most it may be, per channel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
    /// The words of an enum.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub values: Vec<String>,
    /// Whether a texture may stand for it.
    #[serde(default)]
    pub texturable: bool,
    /// A name for people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub label: String,
    /// What it does.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub help: String,
}

/// What a module says of itself. Unknown keys mean nothing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// A label.
    pub name: String,
    /// BSDF or light.
    pub kind: Kind,
    /// For people.
    #[serde(default)]
    pub description: String,
    /// Every lobe that a BSDF can have, by name.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lobes: Vec<String>,
    /// Whether light may go either way through a BSDF.
    #[serde(default = "yes")]
    pub reciprocal: bool,
    /// Whether a BSDF looks alike however it is turned about its normal.
    #[serde(default)]
    pub isotropic: bool,
    /// Where a light can shine from.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub emits_from: Vec<EmitsFrom>,
    /// Its parameters.
    #[serde(default)]
    pub params: Vec<Parameter>,
}

/// What scenes say of a shader themselves.
const RESERVED: [&str; 7] = ["id", "name", "type", "as", "to_world", "position", "sampling_weight"];

fn yes() -> bool {
    true
}

impl Manifest {
    /// Reads and checks a manifest; says what is wrong with it.
    ///
    /// # Errors
    /// In one clause.
    pub fn read(json: &[u8]) -> Result<Self, String> {
        let manifest: Self = serde_json::from_slice(json).map_err(|error| format!("is not as the ABI page has it: {error}"))?;
        manifest.check_kind()?;
        if let Some(taken) = manifest.params.iter().find(|parameter| RESERVED.contains(&parameter.name.as_str())) {
            return Err(format!("has parameter \"{}\", a name that the host keeps for itself", taken.name));
        }
        for (at, parameter) in manifest.params.iter().enumerate() {
            parameter.check().map_err(|why| format!("has parameter \"{}\", {why}", parameter.name))?;
            for other in &manifest.params[..at] {
                let apart = parameter.end() <= other.offset as usize || other.end() <= parameter.offset as usize;
                if parameter.name == other.name || !apart {
                    return Err(format!("has parameters \"{}\" and \"{}\" of one name or in one place", other.name, parameter.name));
                }
            }
        }
        Ok(manifest)
    }

    fn check_kind(&self) -> Result<(), String> {
        if let Some(unknown) = self.lobes.iter().find(|name| lobe::named(name).is_none()) {
            let names: Vec<_> = lobe::NAMES.iter().map(|(_, name)| *name).collect();
            return Err(format!("names the lobe \"{unknown}\", which is none of {}", names.join(", ")));
        }
        match self.kind {
            Kind::Bsdf if self.lobes.is_empty() => Err("names no \"lobes\", and a BSDF without any is black".to_owned()),
            Kind::Light if self.emits_from.is_empty() => {
                Err("has no \"emits_from\": area, point, environment, or several of them".to_owned())
            }
            _ => Ok(()),
        }
    }

    /// Every lobe a BSDF says it can have.
    pub fn lobes(&self) -> Lobe {
        Lobe(self.lobes.iter().filter_map(|name| lobe::named(name)).fold(0, |all, bit| all | bit))
    }

    /// The parameter of that name.
    pub fn parameter(&self, name: &str) -> Option<&Parameter> {
        self.params.iter().find(|parameter| parameter.name == name)
    }

    /// Bytes of a parameter block.
    pub fn block_bytes(&self) -> usize {
        self.params.iter().map(Parameter::end).max().unwrap_or(0)
    }
}

impl Parameter {
    fn end(&self) -> usize {
        self.offset as usize + self.kind.bytes()
    }

    fn check(&self) -> Result<(), String> {
        if self.name.is_empty() || !self.name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
            return Err("whose name is not made of letters, digits and _".to_owned());
        }
        if !self.offset.is_multiple_of(4) || self.offset as usize + self.kind.bytes() > limit::MAX_PARAMETER_BYTES {
            let most = limit::MAX_PARAMETER_BYTES;
            return Err(format!("whose offset {} is not a multiple of 4, or past the {most} bytes that a block may have", self.offset));
        }
        if (self.kind == ParameterType::Enum) == self.values.is_empty() {
            return Err("whose \"values\" must be there for an enum, and only for one".to_owned());
        }
        if self.texturable && !matches!(self.kind, ParameterType::Float | ParameterType::Rgb) {
            return Err("which only a float or an rgb could be: texturable".to_owned());
        }
        if let (Some(min), Some(max)) = (self.min, self.max)
            && min > max
        {
            return Err(format!("whose least value {min} is above its most, {max}"));
        }
        let mut block = vec![0; self.end()];
        let default =
            self.json_default().ok_or_else(|| format!("whose default {} is not of its type, {}", self.default, self.kind.name()))?;
        self.write(&default, &mut block).map_err(|why| format!("whose default {why}"))
    }
}
