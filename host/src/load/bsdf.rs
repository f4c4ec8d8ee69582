//! `<bsdf>`: what surfaces are made of.

use bidir_kernel::{Lobe, Spectrum};

use super::{
    catalog,
    context::Context,
    ior, plugin,
    properties::{Properties, Value, line},
    suggest::{did_you_mean, list},
    texture::{Range, parameter, texture},
    xml::Element,
};
use crate::{
    error::{Error, Result},
    scene::description::{Bending, Distribution, Material, MaterialId, NormalMap, Principled, Texture},
};

/// How deep materials may nest, references followed.
const MAX_DEPTH: usize = 16;

/// The material of a shape that names none: grey, or black where the shape shines, as in Mitsuba.
pub(super) fn default(context: &mut Context, shines: bool) -> MaterialId {
    if let Some(known) = context.default_materials[usize::from(shines)] {
        return known;
    }
    let reflectance = if shines { 0.0 } else { 0.5 };
    let id = add(context, Material::Diffuse { reflectance: Texture::Constant(Spectrum::splat(reflectance)) });
    context.default_materials[usize::from(shines)] = Some(id);
    id
}

/// The material that an element describes; once for each element, however often it is referred to, and once for each mesh that wears it
/// if it asks for attributes.
pub(super) fn material(context: &mut Context, element: &Element) -> Result<MaterialId> {
    let of_wearer = (element.serial, Some(context.wearer.key()));
    if let Some(known) = context.material_ids.get(&(element.serial, None)) {
        return Ok(*known);
    }
    if let Some(known) = context.material_ids.get(&of_wearer) {
        context.attributes_asked = true;
        return Ok(*known);
    }
    if context.materials_open.contains(&element.serial) {
        let thing = format!("the bsdf on line {} refers to itself", line(&element.place));
        return Err(Error::at(&element.place, thing, "take one of the references out"));
    }
    if context.materials_open.len() >= MAX_DEPTH {
        return Err(Error::at(&element.place, format!("materials nest more than {MAX_DEPTH} deep"), "flatten them"));
    }
    context.materials_open.push(element.serial);
    let outer = std::mem::take(&mut context.attributes_asked);
    let properties = Properties::read(element, &context.ids)?;
    let material = match plugin::find(context, "bsdf", &properties, &element.place)? {
        Some(module) => Material::Plugin(plugin::shader(context, &properties, module)?),
        None => {
            catalog::check("bsdf", properties.kind(), &element.place)?;
            read(context, &properties)?
        }
    };
    properties.finish()?;
    let id = add(context, material);
    context.materials_open.pop();
    context.material_ids.insert(if context.attributes_asked { of_wearer } else { (element.serial, None) }, id);
    context.attributes_asked |= outer;
    Ok(id)
}

fn add(context: &mut Context, material: Material) -> MaterialId {
    context.materials.push(material);
    MaterialId(context.materials.len() as u32 - 1)
}

fn read(context: &mut Context, of: &Properties) -> Result<Material> {
    let mut fraction = |name, default| parameter(context, of, name, default, Range::FRACTION);
    Ok(match of.kind() {
        "diffuse" => Material::Diffuse { reflectance: fraction("reflectance", 0.5)? },
        "conductor" => {
            let (eta, k) = metal(of)?;
            Material::Conductor { eta, k, specular_reflectance: fraction("specular_reflectance", 1.0)? }
        }
        "roughconductor" => {
            let (eta, k) = metal(of)?;
            let specular_reflectance = fraction("specular_reflectance", 1.0)?;
            let Roughness { distribution, alpha_u, alpha_v } = roughness(context, of)?;
            Material::RoughConductor { eta, k, specular_reflectance, distribution, alpha_u, alpha_v }
        }
        "dielectric" => Material::Dielectric {
            eta: eta(of, "bk7")?,
            specular_reflectance: fraction("specular_reflectance", 1.0)?,
            specular_transmittance: fraction("specular_transmittance", 1.0)?,
        },
        "thindielectric" => Material::ThinDielectric {
            eta: eta(of, "bk7")?,
            specular_reflectance: fraction("specular_reflectance", 1.0)?,
            specular_transmittance: fraction("specular_transmittance", 1.0)?,
        },
        "roughdielectric" => {
            let eta = eta(of, "bk7")?;
            if eta == 1.0 {
                let remedy = "make int_ior and ext_ior differ, or use null";
                return Err(Error::at(of.place(), "roughdielectric between two equal indices of refraction", remedy));
            }
            let specular_reflectance = fraction("specular_reflectance", 1.0)?;
            let specular_transmittance = fraction("specular_transmittance", 1.0)?;
            let Roughness { distribution, alpha_u, alpha_v } = roughness(context, of)?;
            Material::RoughDielectric { eta, specular_reflectance, specular_transmittance, distribution, alpha_u, alpha_v }
        }
        "plastic" => Material::Plastic {
            eta: eta(of, "polypropylene")?,
            diffuse_reflectance: fraction("diffuse_reflectance", 0.5)?,
            specular_reflectance: fraction("specular_reflectance", 1.0)?,
            nonlinear: of.boolean("nonlinear")?.unwrap_or(false),
        },
        "roughplastic" => {
            let eta = eta(of, "polypropylene")?;
            let diffuse_reflectance = fraction("diffuse_reflectance", 0.5)?;
            let specular_reflectance = fraction("specular_reflectance", 1.0)?;
            let nonlinear = of.boolean("nonlinear")?.unwrap_or(false);
            let distribution = distribution(of)?;
            let alpha = of.float("alpha")?.unwrap_or(0.1) as f32;
            if alpha < 0.0 {
                return Err(of.error("alpha", "is negative", "write 0 or more"));
            }
            Material::RoughPlastic { eta, diffuse_reflectance, specular_reflectance, nonlinear, distribution, alpha }
        }
        "principled" => Material::Principled(Box::new(principled(context, of)?)),
        "principledthin" => Material::PrincipledThin(Box::new(principled(context, of)?)),
        "twosided" => twosided(context, of)?,
        "mask" => Material::Mask { opacity: fraction("opacity", 0.5)?, bsdf: inner(context, of)? },
        "blendbsdf" => {
            let weight = fraction("weight", 0.5)?;
            if !of.has("weight") {
                return Err(of.missing("weight", "float"));
            }
            Material::Blend { weight, parts: two(context, of)? }
        }
        "normalmap" => {
            let map = NormalMap::Normals(map(context, of, "normalmap")?);
            Material::Bent { map, bending: bending(of)?, bsdf: inner(context, of)? }
        }
        "bumpmap" => {
            let map = NormalMap::Heights(map(context, of, "")?, of.float("scale")?.unwrap_or(1.0) as f32);
            Material::Bent { map, bending: bending(of)?, bsdf: inner(context, of)? }
        }
        _ => Material::Null,
    })
}

/// Of `principled` or `principledthin`; what either does not have is left at nothing.
fn principled(context: &mut Context, of: &Properties) -> Result<Principled> {
    let thin = of.kind() == "principledthin";
    of.pass_over(if thin {
        &[
            "diffuse_reflectance_sampling_rate",
            "specular_reflectance_sampling_rate",
            "specular_transmittance_sampling_rate",
            "diffuse_transmittance_sampling_rate",
        ]
    } else {
        &["diffuse_reflectance_sampling_rate", "main_specular_sampling_rate", "clearcoat_sampling_rate"]
    });
    let nothing = Texture::Constant(Spectrum::BLACK);
    let mut fraction = |name, default| parameter(context, of, name, default, Range::FRACTION);
    let base_color = fraction("base_color", 0.5)?;
    let (roughness, anisotropic) = (fraction("roughness", 0.5)?, fraction("anisotropic", 0.0)?);
    let (spec_trans, spec_tint) = (fraction("spec_trans", 0.0)?, fraction("spec_tint", 0.0)?);
    let (sheen, sheen_tint, flatness) = (fraction("sheen", 0.0)?, fraction("sheen_tint", 0.0)?, fraction("flatness", 0.0)?);
    let mut thick = |name| if thin { Ok(nothing.clone()) } else { fraction(name, 0.0) };
    let (metallic, clearcoat, clearcoat_gloss) = (thick("metallic")?, thick("clearcoat")?, thick("clearcoat_gloss")?);
    let diff_trans = if thin { parameter(context, of, "diff_trans", 0.0, Range { min: 0.0, max: 2.0 })? } else { nothing };
    let eta = if thin {
        parameter(context, of, "eta", 1.5, Range { min: 1e-3, max: 1e3 })?
    } else {
        Texture::Constant(Spectrum::splat(principled_eta(of, !spec_trans.is(0.0))?))
    };
    Ok(Principled {
        base_color,
        roughness,
        anisotropic,
        metallic,
        spec_trans,
        eta,
        spec_tint,
        sheen,
        sheen_tint,
        flatness,
        clearcoat,
        clearcoat_gloss,
        diff_trans,
    })
}

/// Index inside / index outside, from `eta` or `specular`. What lets light through must bend it a little, as in Mitsuba.
fn principled_eta(of: &Properties, glassy: bool) -> Result<f32> {
    match (of.positive("eta")?, of.float("specular")?) {
        (Some(_), Some(_)) => Err(of.error("specular", "is given together with eta", "keep either of them")),
        (Some(eta), None) if !(1e-3..=1e3).contains(&eta) => Err(of.error("eta", format!("is {eta:e}"), "write 0.001 … 1000")),
        (Some(eta), None) => Ok(if glassy && eta == 1.0 { 1.001 } else { eta as f32 }),
        (None, specular) => {
            let specular = specular.unwrap_or(0.5) as f32;
            if !(0.0..=1.0).contains(&specular) {
                return Err(of.error("specular", format!("is {specular}"), "it must lie within 0 … 1"));
            }
            Ok(bidir_standard::Principled::eta_of_specular(if glassy && specular == 0.0 { 1e-3 } else { specular }))
        }
    }
}

fn bending(of: &Properties) -> Result<Bending> {
    let flips = of.boolean("flip_invalid_normals")?.unwrap_or(true);
    let shadowed = of.boolean("use_shadowing_function")?.unwrap_or(true);
    Ok(Bending { flips, shadowed })
}

/// The one material inside another.
fn inner(context: &mut Context, of: &Properties) -> Result<MaterialId> {
    match of.objects("bsdf").as_slice() {
        [one] => material(context, one),
        other => {
            let thing = format!("{} holds {} materials", of.kind(), other.len());
            Err(Error::at(of.place(), thing, "put one <bsdf> into it"))
        }
    }
}

/// The two materials inside another.
fn two(context: &mut Context, of: &Properties) -> Result<[MaterialId; 2]> {
    match of.objects("bsdf").as_slice() {
        [first, second] => Ok([material(context, first)?, material(context, second)?]),
        other => {
            let thing = format!("{} holds {} materials", of.kind(), other.len());
            Err(Error::at(of.place(), thing, "put two <bsdf> into it"))
        }
    }
}

/// The bitmap that turns normals; of any name where none is given.
fn map(context: &mut Context, of: &Properties, name: &str) -> Result<Texture> {
    let textures = of.objects("texture");
    let [one] = textures.as_slice() else {
        let thing = format!("{} holds {} textures", of.kind(), textures.len());
        let named = if name.is_empty() { String::new() } else { format!(" name=\"{name}\"") };
        return Err(Error::at(of.place(), thing, format!("put one <texture type=\"bitmap\"{named}> into it")));
    };
    let map = texture(context, one, Range::ANY, &one.place)?;
    if !matches!(map, Texture::Bitmap(_)) {
        return Err(Error::at(&one.place, format!("{} takes a bitmap", of.kind()), "write <texture type=\"bitmap\">"));
    }
    Ok(map)
}

fn twosided(context: &mut Context, of: &Properties) -> Result<Material> {
    let sides = of.objects("bsdf");
    let mut ids = Vec::with_capacity(2);
    for side in &sides {
        let id = material(context, side)?;
        if transmits(&context.materials, id) {
            let kind = side.attribute("type").unwrap_or("");
            return Err(Error::at(&side.place, format!("twosided holds {kind}, which lets light through"), "use it without twosided"));
        }
        ids.push(id);
    }
    match ids.as_slice() {
        [both] => Ok(Material::TwoSided { sides: [*both; 2] }),
        [front, back] => Ok(Material::TwoSided { sides: [*front, *back] }),
        other => {
            let thing = format!("twosided holds {} materials", other.len());
            Err(Error::at(of.place(), thing, "put one into it for both sides, or two: front, back"))
        }
    }
}

/// Whether a material lets any light through.
fn transmits(materials: &[Material], id: MaterialId) -> bool {
    match &materials[id.0 as usize] {
        Material::Plugin(shader) => shader.module.manifest().lobes().intersects(Lobe::TRANSMISSION),
        Material::Dielectric { .. } | Material::ThinDielectric { .. } | Material::RoughDielectric { .. } => true,
        Material::Mask { .. } | Material::Null | Material::PrincipledThin(_) => true,
        Material::Principled(of) => !of.spec_trans.is(0.0),
        other => other.parts().iter().any(|part| transmits(materials, *part)),
    }
}

/// Index inside over index outside.
fn eta(of: &Properties, inside: &str) -> Result<f32> {
    let index = |name: &'static str, default: &str| -> Result<f64> {
        let named = match of.any(name) {
            Some(Value::Text(text)) => text.trim().to_owned(),
            Some(_) => return of.positive(name).map(|v| v.unwrap_or(1.0)),
            None => default.to_owned(),
        };
        let known = ior::dielectrics();
        ior::dielectric(&named).ok_or_else(|| {
            let remedy = format!("{}write a number, or one of {}", did_you_mean(&named, &known), list(&known));
            of.error(name, format!("is \"{named}\""), remedy)
        })
    };
    // In f32, as a plugin would that is given both.
    let eta = index("int_ior", inside)? as f32 / index("ext_ior", "air")? as f32;
    if !(1e-3..=1e3).contains(&eta) {
        let thing = format!("int_ior / ext_ior of {} is {eta:e}", of.label());
        return Err(Error::at(of.place(), thing, "their ratio must lie within 0.001 … 1000"));
    }
    Ok(eta)
}

/// η and k.
fn metal(of: &Properties) -> Result<(Spectrum, Spectrum)> {
    let name = of.text("material")?.map(|t| t.trim().to_owned());
    let (eta, k) = (of.color("eta")?, of.color("k")?);
    if name.as_deref().is_some_and(|n| n != "none") && (eta.is_some() || k.is_some()) {
        return Err(of.error("material", "is given together with eta or k", "keep either the material or eta and k"));
    }
    let name = name.as_deref().unwrap_or("none");
    let known = ior::metals();
    let Some((named_eta, named_k)) = ior::metal(name) else {
        let remedy = format!("{}give eta and k, or one of {}", did_you_mean(name, &known), list(&known));
        return Err(of.error("material", format!("is \"{name}\""), remedy));
    };
    for (name, value) in [("eta", eta), ("k", k)] {
        if value.is_some_and(|v| v.0.iter().any(|v| *v < 0.0)) {
            return Err(of.error(name, "is negative", "write what was measured, 0 or more"));
        }
    }
    Ok((eta.unwrap_or(named_eta), k.unwrap_or(named_k)))
}

struct Roughness {
    distribution: Distribution,
    alpha_u: Texture,
    alpha_v: Texture,
}

fn distribution(of: &Properties) -> Result<Distribution> {
    of.boolean("sample_visible")?; // changes how directions are found, not what the image is
    of.choice("distribution", &[("beckmann", Distribution::Beckmann), ("ggx", Distribution::Ggx)])
}

fn roughness(context: &mut Context, of: &Properties) -> Result<Roughness> {
    let distribution = distribution(of)?;
    let both = (of.has("alpha"), of.has("alpha_u"), of.has("alpha_v"));
    let mut alpha = |name| parameter(context, of, name, 0.1, Range::NOT_NEGATIVE);
    let (alpha_u, alpha_v) = match both {
        (true, true, _) | (true, _, true) => {
            return Err(of.error("alpha", "is given together with alpha_u or alpha_v", "keep either alpha, or both of the others"));
        }
        (false, true, false) => return Err(of.missing("alpha_v", "float")),
        (false, false, true) => return Err(of.missing("alpha_u", "float")),
        (false, true, true) => (alpha("alpha_u")?, alpha("alpha_v")?),
        (_, false, false) => (alpha("alpha")?, alpha("alpha")?),
    };
    Ok(Roughness { distribution, alpha_u, alpha_v })
}
