//! What there is in glTF, what is read of it, and what extensions say of materials. `docs/gltf.md` is these tables in prose.

use ::gltf::json::texture::Info;
use serde::Deserialize;

use super::{Reader, asset::Asset};
use crate::error::Result;

/// What becomes of a feature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Support {
    /// It means what it should.
    Done,
    /// Nearly: `docs/gltf.md` says how.
    Approximated,
    /// It is left out, and a file that requires it refused; what to do then.
    LeftOut(&'static str),
}

const WITHOUT: Support = Support::LeftOut("export it without");

/// Extensions that Khronos has ratified, and those of several vendors.
pub const EXTENSIONS: &[(&str, Support)] = &[
    ("EXT_lights_ies", Support::LeftOut("use a light plugin such as iesspot in a Mitsuba scene")),
    ("EXT_lights_image_based", Support::LeftOut("use envmap in a Mitsuba scene")),
    ("EXT_mesh_gpu_instancing", Support::Done),
    ("EXT_meshopt_compression", Support::LeftOut("export it without compression")),
    ("EXT_texture_webp", Support::LeftOut("export its images as PNG or JPEG")),
    ("KHR_animation_pointer", WITHOUT),
    ("KHR_draco_mesh_compression", Support::LeftOut("export it without compression")),
    ("KHR_lights_punctual", Support::Approximated),
    ("KHR_materials_anisotropy", WITHOUT),
    ("KHR_materials_clearcoat", Support::Approximated),
    ("KHR_materials_diffuse_transmission", Support::Approximated),
    ("KHR_materials_dispersion", WITHOUT),
    ("KHR_materials_emissive_strength", Support::Done),
    ("KHR_materials_ior", Support::Done),
    ("KHR_materials_iridescence", WITHOUT),
    ("KHR_materials_pbrSpecularGlossiness", Support::LeftOut("convert its materials to metallic-roughness")),
    ("KHR_materials_sheen", Support::Approximated),
    ("KHR_materials_specular", Support::Approximated),
    ("KHR_materials_transmission", Support::Approximated),
    ("KHR_materials_unlit", Support::Approximated),
    ("KHR_materials_variants", WITHOUT),
    ("KHR_materials_volume", Support::Approximated),
    ("KHR_mesh_quantization", Support::Done),
    ("KHR_meshopt_compression", Support::LeftOut("export it without compression")),
    ("KHR_node_visibility", Support::Done),
    ("KHR_texture_basisu", Support::LeftOut("export its images as PNG or JPEG")),
    ("KHR_texture_transform", Support::Done),
    ("KHR_xmp", WITHOUT),
    ("KHR_xmp_json_ld", WITHOUT),
];

/// An error if the file requires what is left out here.
pub(super) fn check_required(asset: &Asset) -> Result<()> {
    let understood = |name: &str| EXTENSIONS.iter().find(|(known, _)| *known == name).map_or(WITHOUT, |(_, support)| *support);
    let required = asset.root.extensions_required.iter().map(|name| (name, understood(name)));
    let refused: Vec<_> = required
        .filter_map(|(name, support)| match support {
            Support::LeftOut(remedy) => Some((name.as_str(), remedy)),
            Support::Done | Support::Approximated => None,
        })
        .collect();
    let Some((_, remedy)) = refused.first() else { return Ok(()) };
    let names: Vec<_> = refused.iter().map(|(name, _)| *name).collect();
    Err(asset.error(format!("requires {}, which is not read here", names.join(" and ")), *remedy))
}

impl Reader<'_> {
    /// Lists what the file uses and is not read.
    pub(super) fn list_extensions(&mut self) {
        for name in &self.asset.root.extensions_used {
            let read = EXTENSIONS.iter().any(|(known, support)| known == name && !matches!(support, Support::LeftOut(_)));
            if !read {
                self.leave_out(name);
            }
        }
    }
}

/// `KHR_materials_transmission`
#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Transmission {
    pub(super) transmission_factor: f32,
    pub(super) transmission_texture: Option<Info>,
}

/// `KHR_materials_diffuse_transmission`
#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct DiffuseTransmission {
    pub(super) diffuse_transmission_factor: f32,
    pub(super) diffuse_transmission_texture: Option<Info>,
}

/// `KHR_materials_ior`
#[derive(Deserialize)]
#[serde(default)]
pub(super) struct Ior {
    pub(super) ior: f32,
}

impl Default for Ior {
    fn default() -> Self {
        Self { ior: 1.5 }
    }
}

/// `KHR_materials_volume`
#[derive(Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Volume {
    pub(super) thickness_factor: f32,
    pub(super) attenuation_color: [f32; 3],
}

impl Default for Volume {
    fn default() -> Self {
        Self { thickness_factor: 0.0, attenuation_color: [1.0; 3] }
    }
}

/// `KHR_materials_specular`
#[derive(Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Specular {
    pub(super) specular_factor: f32,
    pub(super) specular_texture: Option<Info>,
    pub(super) specular_color_factor: [f32; 3],
    pub(super) specular_color_texture: Option<Info>,
}

impl Default for Specular {
    fn default() -> Self {
        Self { specular_factor: 1.0, specular_texture: None, specular_color_factor: [1.0; 3], specular_color_texture: None }
    }
}

/// `KHR_materials_clearcoat`
#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Clearcoat {
    pub(super) clearcoat_factor: f32,
    pub(super) clearcoat_texture: Option<Info>,
    pub(super) clearcoat_roughness_factor: f32,
    pub(super) clearcoat_roughness_texture: Option<Info>,
    pub(super) clearcoat_normal_texture: Option<Info>,
}

/// `KHR_materials_sheen`
#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Sheen {
    pub(super) sheen_color_factor: [f32; 3],
    pub(super) sheen_color_texture: Option<Info>,
}

/// `KHR_materials_emissive_strength`
#[derive(Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct EmissiveStrength {
    pub(super) emissive_strength: f32,
}

impl Default for EmissiveStrength {
    fn default() -> Self {
        Self { emissive_strength: 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `docs/gltf.md` has a row for each extension.
    #[test]
    fn the_table_in_the_docs_is_this_one() {
        let table = include_str!("../../../../docs/gltf.md");
        let (_, extensions) = table.split_once("\n## Extensions").unwrap();
        let rows: Vec<_> = extensions.lines().filter(|line| line.starts_with("| `")).collect();
        assert_eq!(rows.len(), EXTENSIONS.len());
        for (row, (name, support)) in rows.iter().zip(EXTENSIONS) {
            let said = match support {
                Support::Done => "done".to_owned(),
                Support::Approximated => "approximated: ".to_owned(),
                Support::LeftOut(remedy) => format!("left out; if it is required: {remedy}"),
            };
            assert!(row.starts_with(&format!("| `{name}` | {said}")), "{name}: {row}");
        }
        assert!(EXTENSIONS.is_sorted_by_key(|(name, _)| name));
    }

    #[test]
    fn the_docs_name_all_that_is_left_out() {
        let docs = include_str!("../../../../docs/gltf.md");
        let sources = [
            include_str!("mod.rs"),
            include_str!("mesh.rs"),
            include_str!("principled.rs"),
            include_str!("shape.rs"),
            include_str!("texture.rs"),
        ];
        let mut count = 0;
        for source in sources {
            for (_, rest) in source.match_indices("leave_out(\"").map(|(at, found)| source.split_at(at + found.len())) {
                let what = rest.split('"').next().unwrap();
                assert!(docs.contains(what), "docs/gltf.md does not say that this is left out: {what}");
                count += 1;
            }
        }
        assert!(count >= 12, "{count}");
    }
}
