//! What both worlds are built from, in numbers that f32 and f64 hold alike.

/// A world: things, lamps and an eye.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Surfaces; those with radiance are lights.
    pub things: Vec<Thing>,
    /// Lights that are no surface. At most one [`Lamp::Sky`].
    pub lamps: Vec<Lamp>,
    /// The camera.
    pub eye: Eye,
    /// Of a sphere that holds all things.
    pub centre: [f64; 3],
    /// Of that sphere.
    pub radius: f64,
    /// How large the world is; the intensities of lamps go with its square, so that the image does not change.
    pub scale: f64,
}

/// A surface.
#[derive(Clone, Debug)]
pub struct Thing {
    /// What messages call it.
    pub name: &'static str,
    /// Where it is.
    pub shape: Shape,
    /// What it does to light.
    pub material: Material,
    /// What it sends out on the side of its normal, W/(m² sr); 0 for what is no light.
    pub radiance: f64,
}

/// A surface's place.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// centre ± u ± v, u and v perpendicular; its normal is u × v.
    Rectangle {
        /// Its middle.
        centre: [f64; 3],
        /// Half an edge.
        u: [f64; 3],
        /// Half the other edge.
        v: [f64; 3],
    },
    /// Its normal points outwards.
    Ball {
        /// Its middle.
        centre: [f64; 3],
        /// Its radius.
        radius: f64,
    },
    /// Shading normals are interpolated between the corners'; they need not be unit vectors.
    Triangle {
        /// Counter-clockwise, seen from the side of the geometric normal.
        corners: [[f64; 3]; 3],
        /// At each corner.
        normals: [[f64; 3]; 3],
    },
}

/// The slopes of microfacets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slopes {
    /// Trowbridge & Reitz.
    Ggx,
    /// Gaussian.
    Beckmann,
}

/// Microfacets: their slopes, and their roughness along both tangents.
pub type Facets = (Slopes, [f64; 2]);

/// A shader of the standard crate and the parameters that matter here.
#[derive(Clone, Copy, Debug)]
pub enum Material {
    /// Lambert's.
    Diffuse,
    /// Gold.
    Conductor,
    /// Gold of microfacets.
    RoughConductor(Facets),
    /// Loses nothing but what its microfacets hide.
    RoughMirror(Facets),
    /// Index inside / outside.
    Dielectric(f64),
    /// Index inside / outside.
    RoughDielectric(f64, Facets),
    /// Index inside / outside.
    ThinDielectric(f64),
    /// Index inside / outside; inner reflections saturate the colour.
    Plastic(f64),
    /// Not there.
    Null,
}

/// A light that is no surface.
#[derive(Clone, Copy, Debug)]
pub enum Lamp {
    /// The same intensity everywhere.
    Point([f64; 3]),
    /// From a place along an axis, with the half angle of its cone in degrees.
    Spot([f64; 3], [f64; 3], f64),
    /// Which way light travels.
    Directional([f64; 3]),
    /// The same radiance from everywhere.
    Sky,
}

/// The camera: where from, where to, and through which lens.
#[derive(Clone, Copy, Debug)]
pub struct Eye {
    /// The lens's middle.
    pub from: [f64; 3],
    /// A point that the middle of the film sees.
    pub to: [f64; 3],
    /// The lens.
    pub lens: Lens,
    /// Half the film's width: at distance 1, or in world units without perspective.
    pub half_width: f64,
}

/// What rays enter the camera through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// A point.
    Pinhole,
    /// A disk of this radius; what `to` is at the distance of is in focus.
    Thin(f64),
    /// None: parallel rays.
    Parallel,
}

/// Which techniques make a path, how they share it, and how far it goes.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// The techniques.
    pub techniques: Set,
    /// How they share.
    pub heuristic: Sharing,
    /// Longest path, in segments.
    pub max_depth: u32,
    /// Roulette begins after this many scatterings.
    pub rr_depth: u32,
}

/// A set of techniques of the kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Set {
    /// Path tracing.
    Path,
    /// Light tracing.
    Light,
    /// All techniques.
    Bidirectional,
}

/// A heuristic of the kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sharing {
    /// By densities.
    Balance,
    /// By their squares.
    Power,
}

/// The nearest number that both worlds hold.
pub fn rounded(x: f64) -> f64 {
    f64::from(x as f32)
}

impl Setting {
    /// The same world `scale` times as large and then moved by `shift` of its radii along each axis, in numbers that f32 holds.
    pub fn placed(mut self, scale: f64, shift: f64) -> Self {
        let by = scale * shift * self.radius;
        let length = |x: f64| rounded(x * scale);
        let place = |p: [f64; 3]| p.map(|x| rounded(x * scale + by));
        for thing in &mut self.things {
            thing.shape = match thing.shape {
                Shape::Rectangle { centre, u, v } => Shape::Rectangle { centre: place(centre), u: u.map(length), v: v.map(length) },
                Shape::Ball { centre, radius } => Shape::Ball { centre: place(centre), radius: length(radius) },
                Shape::Triangle { corners, normals } => {
                    Shape::Triangle { corners: corners.map(place), normals: normals.map(|n| n.map(rounded)) }
                }
            };
        }
        for lamp in &mut self.lamps {
            *lamp = match *lamp {
                Lamp::Point(at) => Lamp::Point(place(at)),
                Lamp::Spot(at, axis, cutoff) => Lamp::Spot(place(at), axis, cutoff),
                other => other,
            };
        }
        let Eye { from, to, lens, half_width } = self.eye;
        self.eye = Eye {
            from: place(from),
            to: place(to),
            lens: if let Lens::Thin(radius) = lens { Lens::Thin(length(radius)) } else { lens },
            half_width: if lens == Lens::Parallel { length(half_width) } else { rounded(half_width) },
        };
        (self.centre, self.radius, self.scale) = (place(self.centre), length(self.radius), length(self.scale));
        self
    }
}
