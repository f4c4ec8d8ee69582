//! `KHR_lights_punctual`: points, spots and the sun.

use bidir_kernel::Spectrum;
use serde::Deserialize;

use super::{
    Reader,
    asset::{DAMAGED, label},
    node::Placed,
};
use crate::{
    error::Result,
    load::defines::Defines,
    scene::description::{Emitter, EmitterKind},
};

const NAME: &str = "KHR_lights_punctual";

#[derive(Deserialize)]
struct All {
    lights: Vec<Light>,
}

/// One that nodes may hold.
#[derive(Deserialize)]
struct Light {
    name: Option<String>,
    #[serde(rename = "type")]
    kind: String,
    #[serde(default = "white")]
    color: [f32; 3],
    #[serde(default = "one")]
    intensity: f32,
    #[serde(default)]
    spot: Cone,
}

fn white() -> [f32; 3] {
    [1.0; 3]
}

fn one() -> f32 {
    1.0
}

/// In radians, half of each cone.
#[derive(Deserialize)]
#[serde(default, rename_all = "camelCase")]
struct Cone {
    inner_cone_angle: f32,
    outer_cone_angle: f32,
}

impl Default for Cone {
    fn default() -> Self {
        Self { inner_cone_angle: 0.0, outer_cone_angle: std::f32::consts::FRAC_PI_4 }
    }
}

/// A node's light.
#[derive(Deserialize)]
struct Held {
    light: usize,
}

impl Reader<'_> {
    /// The lights that nodes hold. Candela become W/sr and lux W/m², one for one, as a nit of what shines becomes a W/(m² sr): all are
    /// photometric in glTF, and so stay in proportion. `$lights` multiplies these.
    pub(super) fn lights(&mut self, nodes: &[Placed], defines: &mut Defines) -> Result<Vec<Emitter>> {
        let asset = self.asset;
        let others = asset.root.extensions.as_ref().map(|all| &all.others);
        let all: Option<All> = asset.extension(others, NAME, "the file")?;
        let all = all.map_or(Vec::new(), |all| all.lights);
        let scale = self.scale(defines)?;
        let mut emitters = Vec::new();
        for placed in nodes {
            let others = placed.node.extensions.as_ref().map(|all| &all.others);
            let Some(Held { light }) = asset.extension(others, NAME, &placed.label())? else { continue };
            let Some(source) = all.get(light) else { return Err(asset.missing(&format!("light {light}"))) };
            let kind = self.emitter(source, placed, scale, &label("light", light, source.name.as_ref()))?;
            emitters.push(Emitter { kind, place: asset.place() });
        }
        Ok(emitters)
    }

    fn scale(&self, defines: &mut Defines) -> Result<f32> {
        defines.set_default("lights", "1".into());
        let text = defines.apply("$lights", &self.asset.place())?;
        let scale = text.trim().parse().ok().filter(|scale| (0.0..=1e30).contains(scale));
        scale.ok_or_else(|| self.asset.error(format!("lights is \"{text}\""), "write what to multiply lights with, 0 or more"))
    }

    fn emitter(&self, source: &Light, placed: &Placed, scale: f32, name: &str) -> Result<EmitterKind> {
        let fail = |thing: String, remedy: &str| Err(self.asset.error(format!("{name} {thing}"), remedy));
        let sent = source.color.map(|v| v * source.intensity * scale);
        if !sent.iter().all(|v| (0.0..=1e30).contains(v)) {
            return fail(format!("sends out {sent:?}"), "light is finite and cannot be less than 0");
        }
        let intensity = Spectrum(sent);
        if source.kind == "point" {
            return Ok(EmitterKind::Point { position: placed.to_world.translation, intensity });
        }
        let Some(to_world) = placed.looking() else {
            return fail(format!("is held by {}, whose axes fall together", placed.label()), DAMAGED);
        };
        match source.kind.as_str() {
            "directional" => Ok(EmitterKind::Directional { direction: to_world.matrix3.z_axis, irradiance: intensity }),
            "spot" => {
                let Cone { inner_cone_angle: inner, outer_cone_angle: outer } = source.spot;
                if !(0.0 <= inner && inner <= outer && 0.0 < outer && outer <= std::f32::consts::FRAC_PI_2 + 1e-5) {
                    return fail(format!("has cones of {inner} and {outer}"), "write 0 ≤ inner ≤ outer ≤ π/2");
                }
                let [beam_width, cutoff_angle] = [inner, outer].map(|angle| f64::from(angle).to_degrees());
                Ok(EmitterKind::Spot { to_world, intensity, cutoff_angle, beam_width })
            }
            other => {
                fail(format!("is of type \"{}\"", other.chars().take(40).collect::<String>()), "there are point, spot and directional")
            }
        }
    }
}
