//! What can happen to light in a scene, read off what the scene holds.

use bidir_kernel::{Lobe, Real, Spectrum};
use bidir_standard::Microfacet;
use serde::Serialize;

use crate::plugin::Roster;
use crate::scene::{
    Scene,
    description::{Description, Geometry, Material, MaterialId, SensorKind, Texture},
    lights::{ProfileSource, Seat},
    surface::Finish,
};

/// Each is whether the scene has any of it. A surface counts once a shape wears it, a light once it shines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Effects {
    /// Lights on shapes: a ray can land on them.
    pub area_lights: bool,
    /// Light from infinitely far all around: a ray that escapes lands on it.
    pub environment: bool,
    /// Lights of one point or one direction, which no ray lands on.
    pub dirac_lights: bool,
    /// Scattering into the whole hemisphere.
    pub diffuse: bool,
    /// Scattering about the mirror direction.
    pub glossy_reflection: bool,
    /// Scattering about the refracted direction.
    pub glossy_transmission: bool,
    /// Reflection into one direction.
    pub delta_reflection: bool,
    /// Transmission into one direction.
    pub delta_transmission: bool,
    /// Light bends as it passes a surface.
    pub refraction: bool,
    /// Light passes a surface without bending.
    pub straight_transmission: bool,
    /// Colours or roughness that vary over a surface.
    pub textures: bool,
    /// Normals that are not the geometry's.
    pub shading_normals: bool,
    /// A lens with an area: depth of field, and something for light to land on.
    pub finite_lens: bool,
    /// A camera whose rays are parallel.
    pub parallel_rays: bool,
    /// The camera sees only from some distance on, or up to one.
    pub clipping: bool,
    /// The lens sees through emitters.
    pub hidden_emitters: bool,
}

impl Effects {
    /// Of a scene with nothing in it.
    pub const NONE: Self = Self {
        area_lights: false,
        environment: false,
        dirac_lights: false,
        diffuse: false,
        glossy_reflection: false,
        glossy_transmission: false,
        delta_reflection: false,
        delta_transmission: false,
        refraction: false,
        straight_transmission: false,
        textures: false,
        shading_normals: false,
        finite_lens: false,
        parallel_rays: false,
        clipping: false,
        hidden_emitters: false,
    };

    /// Those of a scene, and of the description it was built from.
    pub fn of(description: &Description, scene: &Scene) -> Self {
        let mut effects = Self { hidden_emitters: description.integrator.hide_emitters, ..Self::default() };
        for light in scene.all_lights().sources() {
            effects.textures |= matches!(light.profile, ProfileSource::Textured(_));
            match light.seat {
                Seat::Shape(_) => effects.area_lights = true,
                Seat::Environment { .. } => effects.environment = true,
                Seat::Point { .. } | Seat::Directional(_) => effects.dirac_lights = true,
            }
        }
        for shape in description.all_shapes() {
            effects.shading_normals |= matches!(&shape.geometry, Geometry::Mesh { mesh, .. } if !mesh.normals.is_empty());
            effects.surface(&description.materials, shape.material);
        }
        let sensor = &description.sensor;
        match sensor.kind {
            SensorKind::Perspective { aperture_radius, .. } => effects.finite_lens = aperture_radius > 0.0,
            SensorKind::Orthographic => effects.parallel_rays = true,
        }
        effects.clipping = sensor.near_clip.is_some() || sensor.far_clip.is_some();
        effects
    }

    fn surface(&mut self, materials: &[Material], id: MaterialId) {
        let lobes = lobes(materials, id);
        self.diffuse |= lobes.intersects(Lobe::DIFFUSE_REFLECTION | Lobe::DIFFUSE_TRANSMISSION);
        self.glossy_reflection |= lobes.intersects(Lobe::GLOSSY_REFLECTION);
        self.glossy_transmission |= lobes.intersects(Lobe::GLOSSY_TRANSMISSION);
        self.delta_reflection |= lobes.intersects(Lobe::DELTA_REFLECTION);
        self.delta_transmission |= lobes.intersects(Lobe::DELTA_TRANSMISSION);
        for (_, material) in with_parts(materials, id) {
            match material {
                Material::Dielectric { eta, .. } | Material::RoughDielectric { eta, .. } if *eta != 1.0 => self.refraction = true,
                Material::Dielectric { .. } | Material::ThinDielectric { .. } | Material::Null | Material::Mask { .. } => {
                    self.straight_transmission = true;
                }
                Material::Principled(of) if !of.spec_trans.is(0.0) => self.refraction = true,
                // What a module does with what it transmits is not known before it is asked.
                Material::Plugin(_) => {
                    self.refraction |= lobes.intersects(Lobe::GLOSSY_TRANSMISSION | Lobe::DELTA_TRANSMISSION);
                    self.straight_transmission |= lobes.intersects(Lobe::DELTA_TRANSMISSION);
                }
                _ => {}
            }
            self.textures |= material.textures().iter().any(|texture| !matches!(texture, Texture::Constant(_)));
        }
    }

    /// Whether any light shines.
    pub fn lights(&self) -> bool {
        self.landable_lights() || self.dirac_lights
    }

    /// Whether a ray can land on a light.
    pub fn landable_lights(&self) -> bool {
        self.area_lights || self.environment
    }

    /// Whether any surface can be joined to: it scatters between directions that it did not choose.
    pub fn smooth(&self) -> bool {
        self.diffuse || self.glossy_reflection || self.glossy_transmission
    }

    /// Whether any surface sends light into one direction.
    pub fn delta(&self) -> bool {
        self.delta_reflection || self.delta_transmission
    }

    /// Every effect, in words.
    pub fn list(&self) -> [(&'static str, bool); 16] {
        [
            ("area lights", self.area_lights),
            ("environment", self.environment),
            ("Dirac lights (point, spot, directional)", self.dirac_lights),
            ("diffuse scattering", self.diffuse),
            ("glossy reflection", self.glossy_reflection),
            ("glossy transmission", self.glossy_transmission),
            ("delta reflection (mirrors)", self.delta_reflection),
            ("delta transmission (clear glass, null)", self.delta_transmission),
            ("refraction", self.refraction),
            ("transmission without bending", self.straight_transmission),
            ("textures", self.textures),
            ("shading normals", self.shading_normals),
            ("finite lens (depth of field)", self.finite_lens),
            ("parallel camera rays", self.parallel_rays),
            ("clipping distances", self.clipping),
            ("emitters hidden from the lens", self.hidden_emitters),
        ]
    }
}

/// The material and all that it is made of, those before what they are made of.
pub(super) fn with_parts(materials: &[Material], id: MaterialId) -> Vec<(MaterialId, &Material)> {
    let named = |id: MaterialId| Some((id, materials.get(id.0 as usize)?));
    let mut all: Vec<_> = named(id).into_iter().collect();
    let mut next = 0;
    while let Some((_, material)) = all.get(next) {
        all.extend(material.parts().iter().filter_map(|part| named(*part)));
        next += 1;
    }
    all
}

/// Every lobe that a material has anywhere; of a black diffuse one, none.
pub fn lobes(materials: &[Material], id: MaterialId) -> Lobe {
    with_parts(materials, id).into_iter().map(|(_, material)| lobes_of(material)).fold(Lobe::NONE, |all, lobes| all | lobes)
}

/// Those of a material itself, without its parts'.
fn lobes_of(material: &Material) -> Lobe {
    let alone = || std::slice::from_ref(material);
    let looked_up = || Finish::new(alone(), MaterialId(0), &mut Roster::default()).map_or(Lobe::NONE, |finish| finish.lobes());
    let varies = |u: &Texture, v: &Texture| !matches!((u, v), (Texture::Constant(_), Texture::Constant(_)));
    match material {
        Material::Diffuse { reflectance: Texture::Constant(Spectrum::BLACK) } => Lobe::NONE,
        Material::Mask { opacity, .. } if least(opacity) < 1.0 => Lobe::DELTA_TRANSMISSION,
        Material::RoughConductor { alpha_u, alpha_v, .. } if varies(alpha_u, alpha_v) => {
            let smooth = least(alpha_u).max(least(alpha_v)) < Microfacet::LEAST;
            Lobe::GLOSSY_REFLECTION | if smooth { Lobe::DELTA_REFLECTION } else { Lobe::NONE }
        }
        Material::RoughDielectric { alpha_u, alpha_v, eta, .. } if varies(alpha_u, alpha_v) => {
            let smooth = least(alpha_u).max(least(alpha_v)) * (eta - 1.0).abs().min(1.0) < Microfacet::LEAST;
            Lobe::GLOSSY_REFLECTION | Lobe::GLOSSY_TRANSMISSION | if smooth { Lobe::DELTA } else { Lobe::NONE }
        }
        Material::Principled(of) => {
            let (opaque, glassy) = (!of.spec_trans.is(1.0) && !of.metallic.is(1.0), !of.spec_trans.is(0.0) && !of.metallic.is(1.0));
            let base = if opaque { Lobe::DIFFUSE_REFLECTION } else { Lobe::NONE };
            base | Lobe::GLOSSY_REFLECTION | if glassy { Lobe::GLOSSY_TRANSMISSION } else { Lobe::NONE }
        }
        Material::PrincipledThin(of) => {
            let (diffuse, glossy) = (!of.spec_trans.is(1.0), !of.spec_trans.is(0.0));
            let reflected = if diffuse && !of.diff_trans.is(2.0) { Lobe::DIFFUSE_REFLECTION } else { Lobe::NONE };
            let passed = if diffuse && !of.diff_trans.is(0.0) { Lobe::DIFFUSE_TRANSMISSION } else { Lobe::NONE };
            reflected | passed | if glossy { Lobe::GLOSSY_REFLECTION | Lobe::GLOSSY_TRANSMISSION } else { Lobe::NONE }
        }
        one if !one.parts().is_empty() => Lobe::NONE,
        _ => looked_up(),
    }
}

/// The least value of a texture's first band anywhere.
fn least(texture: &Texture) -> Real {
    match texture {
        Texture::Constant(value) => value[0],
        Texture::Checkerboard { color0, color1, .. } => color0[0].min(color1[0]),
        Texture::Bitmap(bitmap) => bitmap.texels.iter().map(|texel: Spectrum| texel[0]).fold(Real::INFINITY, Real::min),
        Texture::Attribute { mesh, index, scale } => {
            let values = mesh.attributes.get(*index).map_or(&[][..], |attribute| &attribute.values);
            values.iter().map(|value| value[0] * scale).fold(Real::INFINITY, Real::min)
        }
    }
}
