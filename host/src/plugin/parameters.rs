//! From names and values to the block of numbers that a plugin reads.

use std::fmt::Write;

use super::manifest::{Manifest, Parameter, ParameterType};

/// A value for a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// For a float.
    Float(f32),
    /// For an rgb.
    Rgb([f32; 3]),
    /// For an int.
    Int(i32),
    /// For a bool.
    Bool(bool),
    /// For an enum.
    Word(String),
}

impl From<f32> for Value {
    fn from(value: f32) -> Self {
        Self::Float(value)
    }
}

impl From<[f32; 3]> for Value {
    fn from(value: [f32; 3]) -> Self {
        Self::Rgb(value)
    }
}

impl From<i32> for Value {
    fn from(value: i32) -> Self {
        Self::Int(value)
    }
}

impl From<bool> for Value {
    fn from(value: bool) -> Self {
        Self::Bool(value)
    }
}

impl From<&str> for Value {
    fn from(value: &str) -> Self {
        Self::Word(value.to_owned())
    }
}

impl Manifest {
    /// A block with every default.
    pub fn defaults(&self) -> Vec<u8> {
        let mut block = vec![0; self.block_bytes()];
        for parameter in &self.params {
            if let Some(default) = parameter.json_default() {
                // A manifest is only read with defaults that fit.
                let _checked = parameter.write(&default, &mut block);
            }
        }
        block
    }

    /// What a block holds, in words.
    pub fn words(&self, block: &[u8]) -> String {
        let mut words = String::new();
        for parameter in &self.params {
            let number = |at: u32| {
                let at = (parameter.offset + at) as usize;
                block.get(at..at + 4).and_then(|bytes| bytes.try_into().ok()).unwrap_or([0; 4])
            };
            let float = |at| f32::from_le_bytes(number(at));
            let index = i32::from_le_bytes(number(0));
            let comma = if words.is_empty() { "" } else { ", " };
            let _ = write!(words, "{comma}{} = ", parameter.name);
            let _ = match parameter.kind {
                ParameterType::Float => write!(words, "{}", float(0)),
                ParameterType::Rgb => write!(words, "{} {} {}", float(0), float(4), float(8)),
                ParameterType::Int => write!(words, "{index}"),
                ParameterType::Bool => write!(words, "{}", index != 0),
                ParameterType::Enum => write!(words, "{}", parameter.values.get(index as usize).map_or("?", String::as_str)),
            };
        }
        words
    }
}

impl Parameter {
    /// The manifest's default as a value; `None` if it is of another type.
    pub(super) fn json_default(&self) -> Option<Value> {
        let json = &self.default;
        let number = |json: &serde_json::Value| json.as_f64().map(|v| v as f32);
        Some(match self.kind {
            ParameterType::Float => Value::Float(number(json)?),
            ParameterType::Rgb => match json.as_array().map(Vec::as_slice) {
                Some([r, g, b]) => Value::Rgb([number(r)?, number(g)?, number(b)?]),
                _ => Value::Rgb([number(json)?; 3]),
            },
            ParameterType::Int => Value::Int(i32::try_from(json.as_i64()?).ok()?),
            ParameterType::Bool => Value::Bool(json.as_bool()?),
            ParameterType::Enum => Value::Word(json.as_str()?.to_owned()),
        })
    }

    /// Writes a value to its place in a block.
    ///
    /// # Errors
    /// What is wrong with the value, to be read after the parameter's name.
    pub fn write(&self, value: &Value, block: &mut [u8]) -> Result<(), String> {
        let words: [[u8; 4]; 3] = match (self.kind, value) {
            (ParameterType::Float, Value::Float(v)) => {
                self.check_range(*v)?;
                [v.to_le_bytes(); 3]
            }
            (ParameterType::Float, Value::Int(v)) => return self.write(&Value::Float(*v as f32), block),
            (ParameterType::Rgb, Value::Rgb(rgb)) => {
                rgb.iter().try_for_each(|v| self.check_range(*v))?;
                rgb.map(f32::to_le_bytes)
            }
            (ParameterType::Rgb, Value::Float(v)) => return self.write(&Value::Rgb([*v; 3]), block),
            (ParameterType::Rgb, Value::Int(v)) => return self.write(&Value::Rgb([*v as f32; 3]), block),
            (ParameterType::Int, Value::Int(v)) => {
                self.check_integer(*v)?;
                [v.to_le_bytes(); 3]
            }
            (ParameterType::Bool, Value::Bool(v)) => [i32::from(*v).to_le_bytes(); 3],
            (ParameterType::Enum, Value::Word(word)) => match self.values.iter().position(|known| known == word) {
                Some(index) => [(index as i32).to_le_bytes(); 3],
                None => return Err(format!("is \"{word}\", which is none of {}", self.values.join(", "))),
            },
            (kind, _) => return Err(format!("is not of its type, {}", kind.name())),
        };
        let bytes = self.kind.bytes();
        match block.get_mut(self.offset as usize..self.offset as usize + bytes) {
            Some(place) => place.copy_from_slice(&words.as_flattened()[..bytes]),
            None => return Err("lies outside the block".to_owned()),
        }
        Ok(())
    }

    /// The least and the most a channel may be; finite, whatever the manifest says.
    pub fn range(&self) -> (f32, f32) {
        let within = |v: f64| (v as f32).clamp(f32::MIN, f32::MAX);
        (self.min.map_or(f32::MIN, within), self.max.map_or(f32::MAX, within))
    }

    fn check_range(&self, value: f32) -> Result<(), String> {
        let (min, max) = self.range();
        if (min..=max).contains(&value) { Ok(()) } else { Err(format!("is {value}; it must lie within {}", self.range_words())) }
    }

    fn check_integer(&self, value: i32) -> Result<(), String> {
        let fits = self.min.is_none_or(|min| f64::from(value) >= min) && self.max.is_none_or(|max| f64::from(value) <= max);
        if fits { Ok(()) } else { Err(format!("is {value}; it must lie within {}", self.range_words())) }
    }

    /// The range, for people.
    pub fn range_words(&self) -> String {
        match (self.min, self.max) {
            (Some(min), Some(max)) => format!("{min} … {max}"),
            (Some(min), None) => format!("{min} …"),
            (None, Some(max)) => format!("… {max}"),
            (None, None) => "what is finite".to_owned(),
        }
    }
}
