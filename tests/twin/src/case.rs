//! The cases, by name: every material under every light, seen by every camera, and the hard ones.

use crate::{
    Held, Tally,
    setting::{Eye, Lamp, Lens, Material, Plan, Set, Setting, Shape, Sharing, Slopes, Thing},
};

/// A setting, how it is sampled, and how often.
#[derive(Clone, Debug)]
pub struct Case {
    /// Parts joined by slashes.
    pub name: String,
    /// The world.
    pub setting: Setting,
    /// The techniques.
    pub plan: Plan,
    /// Samples.
    pub samples: u64,
}

impl Case {
    /// Random numbers of its own: pools of cases are not to tell one path many times.
    pub fn seed(&self) -> u64 {
        self.name.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
    }

    /// Compares f32 with f64.
    pub fn run(&self) -> Vec<Held> {
        Tally::of(self).held()
    }
}

/// The case of this name.
pub fn named(name: &str) -> Option<Case> {
    matrix().chain(hard()).find(|case| case.name == name)
}

/// Every material × light × camera × set of techniques × heuristic.
pub fn matrix() -> impl Iterator<Item = Case> {
    MATERIALS.into_iter().flat_map(|(material_name, material)| {
        LIGHTS.into_iter().flat_map(move |(light_name, light)| {
            LENSES.into_iter().flat_map(move |(lens_name, lens)| {
                plans().map(move |(plan_name, plan)| Case {
                    name: format!("{material_name}/{light_name}/{lens_name}/{plan_name}"),
                    setting: room(material, light, lens).placed(1.0, 0.0),
                    plan,
                    samples: 400,
                })
            })
        })
    })
}

/// Long chains, any scale, far away.
pub fn hard() -> impl Iterator<Item = Case> {
    let chains = [("mirrors", Material::RoughMirror((Slopes::Ggx, [1e-6; 2]))), ("gold", Material::Conductor)]
        .into_iter()
        .flat_map(|(name, mirror)| sharings().map(move |(sharing, heuristic)| (format!("chain of 64 {name}/{sharing}"), mirror, heuristic)))
        .map(|(name, mirror, heuristic)| Case {
            name,
            setting: corridor(mirror).placed(1.0, 0.0),
            plan: Plan { techniques: Set::Bidirectional, heuristic, max_depth: 72, rr_depth: 1_000 },
            samples: 500,
        });
    let glossy = [1e-12, 1e-6, 1.0, 1e6, 1e12].into_iter().flat_map(|scale| {
        [0.3, 0.02, 1e-4].into_iter().map(move |alpha| Case {
            name: format!("64 glossy bounces, α = {alpha}, at scale {scale:e}"),
            setting: furnace(Material::RoughMirror((Slopes::Ggx, [alpha; 2]))).placed(scale, 0.0),
            plan: Plan { techniques: Set::Bidirectional, heuristic: Sharing::Power, max_depth: 66, rr_depth: 1_000 },
            samples: 20,
        })
    });
    let placed = [("scale 1e-6", 1e-6, 0.0), ("scale 1e6", 1e6, 0.0), ("1e3 sizes away", 1.0, 1e3)];
    let placed = placed.into_iter().flat_map(|(name, scale, shift)| {
        MATERIALS.into_iter().flat_map(move |(material_name, material)| {
            LENSES.into_iter().map(move |(lens_name, lens)| Case {
                name: format!("{material_name}/all lights/{lens_name}/{name}"),
                setting: room(material, Light::All, lens).placed(scale, shift),
                plan: Plan { techniques: Set::Bidirectional, heuristic: Sharing::Power, max_depth: 6, rr_depth: 5 },
                samples: 400,
            })
        })
    });
    chains.chain(glossy).chain(placed)
}

/// Every kind of surface of the standard crate.
pub const MATERIALS: [(&str, Material); 16] = [
    ("diffuse", Material::Diffuse),
    ("conductor", Material::Conductor),
    ("rough conductor", Material::RoughConductor((Slopes::Ggx, [0.2; 2]))),
    ("brushed conductor", Material::RoughConductor((Slopes::Ggx, [0.05, 0.4]))),
    ("rough conductor, Beckmann", Material::RoughConductor((Slopes::Beckmann, [0.2; 2]))),
    ("brushed conductor, Beckmann", Material::RoughConductor((Slopes::Beckmann, [0.05, 0.4]))),
    ("conductor of α = 1e-4", Material::RoughConductor((Slopes::Ggx, [1e-4; 2]))),
    ("conductor of α = 1e-4, Beckmann", Material::RoughConductor((Slopes::Beckmann, [1e-4; 2]))),
    ("dielectric", Material::Dielectric(1.5)),
    ("rough dielectric", Material::RoughDielectric(1.5, (Slopes::Ggx, [0.2; 2]))),
    ("brushed dielectric, Beckmann", Material::RoughDielectric(1.5, (Slopes::Beckmann, [0.05, 0.4]))),
    ("dielectric of α = 1e-3", Material::RoughDielectric(1.5, (Slopes::Ggx, [1e-3; 2]))),
    ("weak dielectric", Material::Dielectric(1.000_01)),
    ("thin dielectric", Material::ThinDielectric(1.5)),
    ("plastic", Material::Plastic(1.5)),
    ("null", Material::Null),
];

/// What lights a room.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Light {
    /// A rectangle under the ceiling.
    Rectangle,
    /// A ball.
    Ball,
    /// A point.
    Point,
    /// A spot.
    Spot,
    /// Parallel rays.
    Directional,
    /// All around.
    Sky,
    /// All of them.
    All,
}

const LIGHTS: [(&str, Light); 7] = [
    ("rectangle", Light::Rectangle),
    ("ball", Light::Ball),
    ("point", Light::Point),
    ("spot", Light::Spot),
    ("directional", Light::Directional),
    ("sky", Light::Sky),
    ("all lights", Light::All),
];

const LENSES: [(&str, Lens); 3] = [("pinhole", Lens::Pinhole), ("thin lens", Lens::Thin(0.4)), ("parallel", Lens::Parallel)];

fn sharings() -> impl Iterator<Item = (&'static str, Sharing)> {
    [("balance", Sharing::Balance), ("power", Sharing::Power)].into_iter()
}

fn plans() -> impl Iterator<Item = (String, Plan)> {
    let sets = [("path", Set::Path), ("light", Set::Light), ("bidirectional", Set::Bidirectional)];
    sets.into_iter().flat_map(|(name, techniques)| {
        sharings().map(move |(sharing, heuristic)| (format!("{name}/{sharing}"), Plan { techniques, heuristic, max_depth: 6, rr_depth: 3 }))
    })
}

fn dark(name: &'static str, shape: Shape, material: Material) -> Thing {
    Thing { name, shape, material, radiance: 0.0 }
}

fn rectangle(centre: [f64; 3], u: [f64; 3], v: [f64; 3]) -> Shape {
    Shape::Rectangle { centre, u, v }
}

/// A ball and a bent tile of a material on a floor before two walls.
fn room(material: Material, light: Light, lens: Lens) -> Setting {
    let coat = Material::Plastic(1.5);
    let (centre, u, v) = ([0.0, 0.0, 0.0], [0.0, 0.0, 3.0], [3.0, 0.0, 0.0]);
    let mut things = vec![
        dark("floor", rectangle(centre, u, v), Material::Diffuse),
        dark("back wall", rectangle([0.0, 2.0, -3.0], [3.0, 0.0, 0.0], [0.0, 2.0, 0.0]), Material::Diffuse),
        dark("left wall", rectangle([-3.0, 2.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]), coat),
        dark("ball", Shape::Ball { centre: [-0.5, 0.9, 0.1], radius: 0.8 }, material),
        dark("small ball", Shape::Ball { centre: [0.9, 0.45, 1.1], radius: 0.4 }, Material::Diffuse),
        dark(
            "bent tile",
            Shape::Triangle {
                corners: [[0.6, 0.1, -1.4], [2.6, 0.2, -1.0], [1.5, 2.2, -1.6]],
                normals: [[-0.3, -0.1, 1.0], [0.3, 0.0, 1.0], [0.0, 0.35, 1.0]],
            },
            material,
        ),
    ];
    let panel = rectangle([0.3, 3.5, 0.2], [0.7, 0.0, 0.0], [0.0, 0.0, 0.6]);
    let bulb = Shape::Ball { centre: [1.4, 2.3, 0.6], radius: 0.3 };
    let has = |kind: Light| light == kind || light == Light::All;
    let shining = [(Light::Rectangle, "panel", panel), (Light::Ball, "bulb", bulb)];
    things.extend(shining.into_iter().filter(|(kind, ..)| has(*kind)).map(|(_, name, shape)| Thing {
        name,
        shape,
        material: Material::Diffuse,
        radiance: 8.0,
    }));
    let lamps = [
        (Light::Point, Lamp::Point([0.9, 2.4, 1.3])),
        (Light::Spot, Lamp::Spot([-1.2, 3.1, 2.1], [0.25, -0.8, -0.6], 35.0)),
        (Light::Directional, Lamp::Directional([-0.3, -1.0, -0.45])),
        (Light::Sky, Lamp::Sky),
    ];
    Setting {
        things,
        lamps: lamps.into_iter().filter(|(kind, _)| has(*kind)).map(|(_, lamp)| lamp).collect(),
        eye: Eye { from: [0.3, 1.5, 5.5], to: [0.1, 1.0, 0.0], lens, half_width: if lens == Lens::Parallel { 2.2 } else { 0.4 } },
        centre: [0.0, 2.0, 1.0],
        radius: 6.0,
        scale: 1.0,
    }
}

/// Two mirrors that face each other, seen almost along them, and a lit wall at their end.
fn corridor(mirror: Material) -> Setting {
    let things = vec![
        dark("lower mirror", rectangle([0.0, 0.0, 0.0], [0.0, 0.0, 4.0], [50.0, 0.0, 0.0]), mirror),
        dark("upper mirror", rectangle([0.0, 1.0, 0.0], [50.0, 0.0, 0.0], [0.0, 0.0, 4.0]), mirror),
        dark("end", rectangle([40.0, 0.5, 0.0], [0.0, 0.0, 4.0], [0.0, 0.5, 0.0]), Material::Diffuse),
        Thing {
            name: "panel",
            shape: rectangle([38.5, 0.5, -3.0], [1.2, 0.0, 0.0], [0.0, 0.45, 0.0]),
            material: Material::Diffuse,
            radiance: 5.0,
        },
    ];
    Setting {
        things,
        lamps: Vec::new(),
        eye: Eye { from: [-30.0, 0.5, 0.0], to: [-29.0, 1.43, 0.0], lens: Lens::Thin(0.05), half_width: 0.03 },
        centre: [0.0, 0.5, 0.0],
        radius: 51.0,
        scale: 1.0,
    }
}

/// A box of one material with a panel in its ceiling and the camera inside.
fn furnace(material: Material) -> Setting {
    let faces = [
        ("floor", [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]),
        ("ceiling", [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
        ("left wall", [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
        ("right wall", [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]),
        ("back wall", [0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
        ("front wall", [0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]),
    ];
    let mut things: Vec<Thing> = faces.into_iter().map(|(name, centre, u, v)| dark(name, rectangle(centre, u, v), material)).collect();
    things.push(Thing { name: "panel", shape: rectangle([0.1, 0.9, -0.2], [0.3, 0.0, 0.0], [0.0, 0.0, 0.3]), material, radiance: 1.0 });
    Setting {
        things,
        lamps: Vec::new(),
        eye: Eye { from: [0.2, -0.1, 0.8], to: [0.0, -0.3, -0.5], lens: Lens::Thin(0.1), half_width: 0.6 },
        centre: [0.0; 3],
        radius: 2.0,
        scale: 1.0,
    }
}
