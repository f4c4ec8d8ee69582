//! What a module says of itself.

use crate::{
    Parameter, Parameters,
    abi::{
        lobe,
        manifest::{emits_from, kind},
    },
    json::Json,
    parameter::Value,
};

/// A manifest; [`bsdf!`](crate::bsdf!) and [`light!`](crate::light!) make one and write it as JSON.
#[derive(Clone, Copy, Debug)]
pub struct Manifest {
    /// A label; the module's file decides the type.
    pub name: &'static str,
    /// The lines of the parameters' documentation.
    pub description: &'static [&'static str],
    /// What it does.
    pub kind: Kind,
    /// What can be set.
    pub parameters: &'static [Parameter],
}

/// What a module is.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A surface's scattering.
    Bsdf {
        /// Every lobe it can have, as bits of the ABI.
        lobes: u32,
        /// Whether f is the same both ways, but for η².
        reciprocal: bool,
        /// Whether it depends on no azimuth about the normal.
        isotropic: bool,
    },
    /// An emission profile.
    Light {
        /// Of a shape.
        area: bool,
        /// Of a point.
        point: bool,
        /// Of the sphere of directions.
        environment: bool,
    },
}

/// The parts that the macros put a manifest together from.
#[doc(hidden)]
impl Manifest {
    pub const fn bsdf<P: Parameters>(name: &'static str) -> Self {
        Self { name, description: P::DESCRIPTION, kind: Kind::Bsdf { lobes: 0, reciprocal: true, isotropic: false }, parameters: P::LIST }
    }

    pub const fn light<P: Parameters>(name: &'static str) -> Self {
        Self { name, description: P::DESCRIPTION, kind: Kind::Light { area: false, point: false, environment: false }, parameters: P::LIST }
    }

    pub const fn with(mut self, kind: Kind) -> Self {
        self.kind = kind;
        self
    }

    pub const fn checked(self) -> Self {
        match self.kind {
            Kind::Bsdf { lobes, .. } => assert!(lobes != 0, "a BSDF has at least one lobe: lobes: [diffuse_reflection]"),
            Kind::Light { area, point, environment } => {
                assert!(area || point || environment, "a light shines from somewhere: emits_from: [area, point, environment]");
            }
        }
        self
    }

    /// How long the JSON is.
    pub const fn length(&self) -> usize {
        self.write::<0>().length()
    }

    /// The JSON; `N` is its [`Manifest::length`].
    pub const fn json<const N: usize>(&self) -> [u8; N] {
        self.write::<N>().finish()
    }

    const fn write<const N: usize>(&self) -> Json<N> {
        let mut json = Json::new();
        json.raw("{\"name\": ");
        json.string(self.name);
        match self.kind {
            Kind::Bsdf { lobes, reciprocal, isotropic } => {
                key(&mut json, "kind");
                json.string(kind::BSDF);
                key(&mut json, "description");
                json.paragraph(self.description);
                key(&mut json, "lobes");
                names(&mut json, &lobe::NAMES, lobes);
                key(&mut json, "reciprocal");
                json.boolean(reciprocal);
                key(&mut json, "isotropic");
                json.boolean(isotropic);
            }
            Kind::Light { area, point, environment } => {
                key(&mut json, "kind");
                json.string(kind::LIGHT);
                key(&mut json, "description");
                json.paragraph(self.description);
                key(&mut json, "emits_from");
                let places = [(1, emits_from::AREA), (2, emits_from::POINT), (4, emits_from::ENVIRONMENT)];
                names(&mut json, &places, area as u32 | (point as u32) << 1 | (environment as u32) << 2);
            }
        }
        key(&mut json, "params");
        json.raw("[");
        let mut at = 0;
        while at < self.parameters.len() {
            json.raw(if at > 0 { ",\n  " } else { "\n  " });
            parameter(&mut json, &self.parameters[at]);
            at += 1;
        }
        json.raw("]}");
        json
    }
}

const fn key<const N: usize>(json: &mut Json<N>, key: &str) {
    json.raw(", ");
    json.string(key);
    json.raw(": ");
}

/// The names of the bits that are set.
const fn names<const N: usize>(json: &mut Json<N>, known: &[(u32, &str)], bits: u32) {
    let (mut at, mut separator) = (0, "[");
    while at < known.len() {
        if bits & known[at].0 != 0 {
            json.raw(separator);
            json.string(known[at].1);
            separator = ", ";
        }
        at += 1;
    }
    json.raw("]");
}

const fn parameter<const N: usize>(json: &mut Json<N>, of: &Parameter) {
    json.raw("{\"name\": ");
    json.string(of.name);
    key(json, "type");
    json.string(of.default.type_name());
    key(json, "offset");
    json.count(of.offset);
    key(json, "default");
    default(json, &of.default);
    if let Some(min) = of.min {
        key(json, "min");
        json.raw(min.text);
    }
    if let Some(max) = of.max {
        key(json, "max");
        json.raw(max.text);
    }
    if of.texturable {
        key(json, "texturable");
        json.boolean(true);
    }
    if let Some(label) = of.label {
        key(json, "label");
        json.string(label);
    }
    if !of.help.is_empty() {
        key(json, "help");
        json.paragraph(of.help);
    }
    json.raw("}");
}

const fn default<const N: usize>(json: &mut Json<N>, value: &Value) {
    match *value {
        Value::Float(number) | Value::Int(number) => json.raw(number.text),
        Value::Rgb([r, g, b]) => {
            json.raw("[");
            json.raw(r.text);
            json.raw(", ");
            json.raw(g.text);
            json.raw(", ");
            json.raw(b.text);
            json.raw("]");
        }
        Value::Bool(value) => json.boolean(value),
        Value::Choice { chosen, values } => {
            json.string(chosen);
            key(json, "values");
            let mut at = 0;
            while at < values.len() {
                json.raw(if at > 0 { ", " } else { "[" });
                json.string(values[at]);
                at += 1;
            }
            json.raw("]");
        }
    }
}
