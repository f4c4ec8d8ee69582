//! The words of a manifest: what a module says of itself in JSON.

/// The custom section that holds it.
pub const SECTION: &str = "bidir.manifest";

/// Keys of the manifest.
pub mod key {
    /// A label, string; the file's name decides the type.
    pub const NAME: &str = "name";
    /// One of [`kind`](super::kind).
    pub const KIND: &str = "kind";
    /// String.
    pub const DESCRIPTION: &str = "description";
    /// Of a BSDF: the lobes it can have, by name.
    pub const LOBES: &str = "lobes";
    /// Of a BSDF, optional: whether f is the same both ways (up to η²); true if absent.
    pub const RECIPROCAL: &str = "reciprocal";
    /// Of a BSDF, optional: whether what it does depends on no azimuth about the normal; false if absent.
    pub const ISOTROPIC: &str = "isotropic";
    /// Of a light: the places it can shine from, by name.
    pub const EMITS_FROM: &str = "emits_from";
    /// A list of parameters.
    pub const PARAMS: &str = "params";
}

/// Keys of a parameter beside `name`.
pub mod param {
    /// One of [`parameter`](super::parameter).
    pub const TYPE: &str = "type";
    /// Where it lies in the parameter block, bytes; a multiple of 4.
    pub const OFFSET: &str = "offset";
    /// What it is where a scene does not say.
    pub const DEFAULT: &str = "default";
    /// Optional: the least it may be, per channel.
    pub const MIN: &str = "min";
    /// Optional: the most it may be, per channel.
    pub const MAX: &str = "max";
    /// The strings of an enum; the block holds the index.
    pub const VALUES: &str = "values";
    /// Optional: whether a texture may stand for it; false if absent.
    pub const TEXTURABLE: &str = "texturable";
    /// Optional: a name for people.
    pub const LABEL: &str = "label";
    /// Optional: what it does.
    pub const HELP: &str = "help";
}

/// What a module is.
pub mod kind {
    /// A surface's scattering.
    pub const BSDF: &str = "bsdf";
    /// An emission profile.
    pub const LIGHT: &str = "light";
}

/// Where a light can shine from.
pub mod emits_from {
    /// Every point of a shape, W/(m² sr); z is the normal.
    pub const AREA: &str = "area";
    /// One point, W/sr; z is its axis.
    pub const POINT: &str = "point";
    /// The sphere of directions, W/(m² sr); z is up.
    pub const ENVIRONMENT: &str = "environment";
}

/// Types of parameters.
pub mod parameter {
    /// One f32.
    pub const FLOAT: &str = "float";
    /// Three f32.
    pub const RGB: &str = "rgb";
    /// One i32.
    pub const INT: &str = "int";
    /// One i32, 0 or 1.
    pub const BOOL: &str = "bool";
    /// One i32, the index into `values`.
    pub const ENUM: &str = "enum";
}
