//! What a scene can set of a plugin, and the block of bytes in which the plugin is given it.

use crate::{
    Real, Spectrum,
    abi::{limit::MAX_PARAMETER_BYTES, manifest::parameter},
    json,
};

/// A struct of parameters; [`parameters!`](crate::parameters) makes one.
pub trait Parameters: Copy + Default {
    /// The lines of the struct's documentation.
    const DESCRIPTION: &'static [&'static str];

    /// The parameters in the order of their offsets.
    const LIST: &'static [Parameter];

    /// How long the block is.
    const BYTES: usize = block_bytes(Self::LIST);

    /// Reads a block: each parameter little-endian at its offset. What lies past the block's end is 0.
    fn from_block(block: &[u8]) -> Self;
}

/// One parameter, as the manifest tells it.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// What scenes call it.
    pub name: &'static str,
    /// Its type, and what it is where a scene does not say.
    pub default: Value,
    /// The least it may be, per channel.
    pub min: Option<Number>,
    /// The most it may be, per channel.
    pub max: Option<Number>,
    /// Whether a texture may stand for it.
    pub texturable: bool,
    /// A name for people.
    pub label: Option<&'static str>,
    /// The lines of its documentation.
    pub help: &'static [&'static str],
    /// Where it lies in the block, bytes.
    pub offset: usize,
}

/// A value as it is written: a type and a default.
#[derive(Clone, Copy, Debug)]
pub enum Value {
    /// An f32.
    Float(Number),
    /// Three f32.
    Rgb([Number; 3]),
    /// An i32.
    Int(Number),
    /// An i32, 0 or 1.
    Bool(bool),
    /// An i32, the index of one of `values`.
    Choice {
        /// The one that is chosen.
        chosen: &'static str,
        /// Everything that can be chosen.
        values: &'static [&'static str],
    },
}

/// A number and how it was written.
#[derive(Clone, Copy, Debug)]
pub struct Number {
    /// A number in JSON.
    pub text: &'static str,
    /// The same.
    pub value: f64,
}

impl Number {
    #[doc(hidden)]
    pub const fn new(text: &'static str, value: f64) -> Self {
        assert!(json::is_number(text), "write the numbers of parameters as in JSON: 1.0, not `1.`, `1_000` or `1f32`");
        Self { text, value }
    }
}

impl Value {
    /// What the manifest calls the type.
    pub const fn type_name(&self) -> &'static str {
        match self {
            Self::Float(_) => parameter::FLOAT,
            Self::Rgb(_) => parameter::RGB,
            Self::Int(_) => parameter::INT,
            Self::Bool(_) => parameter::BOOL,
            Self::Choice { .. } => parameter::ENUM,
        }
    }

    const fn bytes(&self) -> usize {
        if let Self::Rgb(_) = self { 12 } else { 4 }
    }
}

/// The parts that `parameters!` puts a parameter together from.
#[doc(hidden)]
impl Parameter {
    pub const fn new(name: &'static str, help: &'static [&'static str], default: Value) -> Self {
        Self { name, default, min: None, max: None, texturable: false, label: None, help, offset: 0 }
    }

    pub const fn min(mut self, min: Number) -> Self {
        self.min = Some(min);
        self
    }

    pub const fn max(mut self, max: Number) -> Self {
        self.max = Some(max);
        self
    }

    pub const fn texturable(mut self) -> Self {
        assert!(matches!(self.default, Value::Float(_) | Value::Rgb(_)), "only float and rgb parameters can be texturable");
        self.texturable = true;
        self
    }

    pub const fn label(mut self, label: &'static str) -> Self {
        self.label = Some(label);
        self
    }

    /// Checks the parameter; `misfit` says whose default lies outside its range.
    pub const fn checked(self, misfit: &str) -> Self {
        let ranged = self.min.is_some() || self.max.is_some();
        match self.default {
            Value::Float(value) | Value::Int(value) => assert!(self.holds(value), "{}", misfit),
            Value::Rgb([r, g, b]) => assert!(self.holds(r) && self.holds(g) && self.holds(b), "{}", misfit),
            Value::Bool(_) => assert!(!ranged, "only float, rgb and int parameters can have min and max"),
            Value::Choice { chosen, values } => {
                assert!(!ranged, "only float, rgb and int parameters can have min and max");
                place(values, chosen);
            }
        }
        self
    }

    const fn holds(&self, number: Number) -> bool {
        let above = if let Some(min) = self.min { number.value >= min.value } else { true };
        let below = if let Some(max) = self.max { number.value <= max.value } else { true };
        above && below
    }

    /// Gives each parameter its offset.
    pub const fn lay_out<const N: usize>(mut list: [Self; N]) -> [Self; N] {
        let (mut at, mut offset) = (0, 0);
        while at < N {
            list[at].offset = offset;
            offset += list[at].default.bytes();
            at += 1;
        }
        assert!(offset <= MAX_PARAMETER_BYTES, "the parameters take more than 4096 bytes");
        list
    }
}

const fn block_bytes(list: &[Parameter]) -> usize {
    match list {
        [] => 0,
        [.., last] => last.offset + last.default.bytes(),
    }
}

/// The place of `name` among `values`; a name that is not there does not compile.
#[doc(hidden)]
pub const fn place(values: &[&str], name: &str) -> usize {
    let mut at = 0;
    while at < values.len() {
        if same(values[at].as_bytes(), name.as_bytes()) {
            return at;
        }
        at += 1;
    }
    panic!("the default of a choice is not one of its values");
}

const fn same(a: &[u8], b: &[u8]) -> bool {
    let mut at = 0;
    while at < a.len() && at < b.len() && a[at] == b[at] {
        at += 1;
    }
    at == a.len() && at == b.len()
}

/// What `make` makes of a block's parameters.
#[doc(hidden)]
#[inline(always)]
pub fn made<P: Parameters, S>(make: impl Fn(&P) -> S, block: &[u8]) -> S {
    make(&P::from_block(block))
}

/// Reads a block from its beginning.
#[doc(hidden)]
pub struct Reader<'a>(pub &'a [u8]);

impl Reader<'_> {
    #[inline(always)]
    fn word(&mut self) -> [u8; 4] {
        let Some((word, rest)) = self.0.split_first_chunk() else { return [0; 4] };
        self.0 = rest;
        *word
    }

    #[inline(always)]
    pub fn float(&mut self) -> Real {
        f32::from_le_bytes(self.word()) as Real
    }

    #[inline(always)]
    pub fn rgb(&mut self) -> Spectrum {
        let (r, g, b) = (self.float(), self.float(), self.float());
        Spectrum([r, g, b])
    }

    #[inline(always)]
    pub fn int(&mut self) -> i32 {
        i32::from_le_bytes(self.word())
    }

    #[inline(always)]
    pub fn bool(&mut self) -> bool {
        self.int() != 0
    }
}
