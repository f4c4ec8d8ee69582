//! Layers beside the picture: what is known of a pixel besides its light (arbitrary output variables).

/// A layer, and what compositors find it by.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Aov {
    /// Of the layer; its channels are `name.X` and so on.
    pub name: String,
    /// What is in it.
    pub of: Quantity,
    /// Whose words its channels follow.
    pub words: Words,
}

/// What a layer can hold. Means over a pixel's samples, by the film's filter, and 0 where nothing is met, but for the numbers, which are
/// those of what lies behind the middle of a pixel, counted from 0, and −1 where nothing does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Quantity {
    /// The part of light from the lens's side that the first surface gives back or lets through, estimated from its own samples.
    Albedo,
    /// Unit, in the world; interpolated between vertices.
    ShadingNormal,
    /// Unit, in the world; the surface's own.
    GeometricNormal,
    /// Distance from the lens, along the ray.
    Depth,
    /// In the world.
    Position,
    /// Surface coordinates.
    Uv,
    /// Which shape, in the order of the file without those that have no area; those of groups follow.
    ShapeIndex,
    /// Which triangle of its mesh; exact up to 2²⁴, as a float is.
    PrimIndex,
    /// Which material, in the order in which they are first read; those inside others have numbers of their own.
    MaterialIndex,
    /// Samples of the pixel.
    Samples,
    /// How far the picture's value may be off, squared: estimated from the two halves of the samples.
    Variance,
    /// What each technique brings, weighed, a layer each; pixels are boxes there.
    Techniques,
}

/// Whose words a layer's channels follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Words {
    /// Those of Mitsuba's `aov`.
    Mitsuba,
    /// Those that compositors know.
    Compositors,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::Albedo,
        Self::ShadingNormal,
        Self::GeometricNormal,
        Self::Depth,
        Self::Position,
        Self::Uv,
        Self::ShapeIndex,
        Self::PrimIndex,
        Self::MaterialIndex,
        Self::Samples,
        Self::Variance,
        Self::Techniques,
    ];

    /// What it is called where one is asked for; Mitsuba's word where it has one.
    pub fn name(self) -> &'static str {
        match self {
            Self::Albedo => "albedo",
            Self::ShadingNormal => "sh_normal",
            Self::GeometricNormal => "geo_normal",
            Self::Depth => "depth",
            Self::Position => "position",
            Self::Uv => "uv",
            Self::ShapeIndex => "shape_index",
            Self::PrimIndex => "prim_index",
            Self::MaterialIndex => "material_index",
            Self::Samples => "samples",
            Self::Variance => "variance",
            Self::Techniques => "techniques",
        }
    }

    /// The one of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|quantity| quantity.name() == name)
    }

    /// The layer that compositors and denoisers look for it in.
    pub fn layer(self) -> Aov {
        let name = match self {
            Self::ShadingNormal => "N",
            Self::GeometricNormal => "Ng",
            Self::Position => "P",
            other => other.name(),
        };
        Aov { name: name.to_owned(), of: self, words: Words::Compositors }
    }

    /// Whether it is of what the lens meets first.
    pub fn is_of_first_surface(self) -> bool {
        self.is_filtered() || matches!(self, Self::ShapeIndex | Self::PrimIndex | Self::MaterialIndex)
    }

    /// Whether it is a mean over a pixel's samples of what the lens meets first.
    pub fn is_filtered(self) -> bool {
        use Quantity::{Albedo, Depth, GeometricNormal, Position, ShadingNormal, Uv};
        matches!(self, Albedo | ShadingNormal | GeometricNormal | Depth | Position | Uv)
    }
}

impl Aov {
    /// Its channels, in the order of an image's bands.
    pub fn channels(&self) -> &'static [&'static str] {
        match self.of {
            Quantity::Albedo | Quantity::Variance | Quantity::Techniques => &["R", "G", "B"],
            Quantity::ShadingNormal | Quantity::GeometricNormal | Quantity::Position => &["X", "Y", "Z"],
            Quantity::Uv => &["U", "V"],
            Quantity::Depth if self.words == Words::Mitsuba => &["T"],
            Quantity::Depth => &["Z"],
            Quantity::ShapeIndex | Quantity::PrimIndex | Quantity::MaterialIndex if self.words == Words::Mitsuba => &["I"],
            Quantity::ShapeIndex | Quantity::PrimIndex | Quantity::MaterialIndex => &["id"],
            Quantity::Samples => &["count"],
        }
    }
}
