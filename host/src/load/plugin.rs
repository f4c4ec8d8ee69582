//! Plugins as scenes name them: found by their type, given parameters by their manifest.

use std::{path::Path, sync::Arc};

use super::{
    catalog,
    context::Context,
    properties::{Properties, Value},
    texture::{self, Range, named_here},
};
use crate::{
    error::{Error, Place, Result},
    plugin::{self, Kind, Module, Parameter, ParameterType},
    scene::description::{PluginShader, Texture, TexturedParameter},
};

/// The module that `<tag type="name">` means: none where that is a built-in, unless the library has one for it, or nothing at all.
pub(super) fn find(context: &Context, tag: &'static str, of: &Properties, place: &Place) -> Result<Option<Arc<Module>>> {
    let name = of.kind();
    let explicit = plugin::is_module(name);
    if !explicit && catalog::supported(tag).contains(&name) {
        let module = context.library.instead_of(name).map_err(|error| named_here(&error, place))?;
        return Ok(module.filter(|module| of.are_all(|property| module.manifest().params.iter().any(|known| known.name == property))));
    }
    let near = context.folders(place);
    let Some(file) = context.library.find(name, &near) else {
        if explicit {
            let looked: Vec<_> = near.iter().chain(context.library.folders()).map(|folder| folder.join("").display().to_string()).collect();
            let looked = if looked.is_empty() { "nowhere".to_owned() } else { looked.join(", ") };
            let remedy = format!("put it beside the scene, or name its folder with --plugins or {}; looked in {looked}", plugin::VARIABLE);
            return Err(Error::at(place, format!("there is no module {name}"), remedy));
        }
        return Ok(None);
    };
    let module = context.library.load(&file).map_err(|error| named_here(&error, place))?;
    let kind = module.manifest().kind;
    let fits = if tag == "bsdf" { Kind::Bsdf } else { Kind::Light };
    if kind != fits {
        let thing = format!("{} is a {}, and stands for a {}", file.display(), kind.name(), fits.name());
        return Err(Error::at(place, thing, format!("use it as <{}>", if kind == Kind::Bsdf { "bsdf" } else { "emitter" })));
    }
    Ok(Some(module))
}

/// A module with the parameters that stand inside an element.
pub(super) fn shader(context: &mut Context, of: &Properties, module: Arc<Module>) -> Result<PluginShader> {
    let mut block = module.manifest().defaults();
    let mut textures = Vec::new();
    for parameter in &module.manifest().params {
        match of.any(&parameter.name) {
            None => {}
            Some(Value::Object(_)) => textures.push(textured(context, of, parameter)?),
            Some(value) => {
                let value = value_of(parameter, value).ok_or_else(|| of.wrong_type(&parameter.name, value, tag(parameter.kind)))?;
                parameter.write(&value, &mut block).map_err(|why| of.error(&parameter.name, why, remedy(parameter)))?;
            }
        }
    }
    Ok(PluginShader { module, block, textures })
}

fn textured(context: &mut Context, of: &Properties, parameter: &Parameter) -> Result<TexturedParameter> {
    if !parameter.texturable {
        let remedy = format!("write <{} name=\"{}\" …/>", tag(parameter.kind), parameter.name);
        return Err(of.error(&parameter.name, "cannot vary over the surface, says its manifest", remedy));
    }
    let (min, max) = parameter.range();
    let texture: Texture = texture::parameter(context, of, &parameter.name, 0.0, Range { min, max })?;
    Ok(TexturedParameter { offset: parameter.offset, channels: if parameter.kind == ParameterType::Rgb { 3 } else { 1 }, texture })
}

/// What the scene wrote, as a parameter's value; `None` if it is of another type.
fn value_of(parameter: &Parameter, value: &Value) -> Option<plugin::Value> {
    let float = |v: f64| plugin::Value::Float(v as f32);
    Some(match (parameter.kind, value) {
        (ParameterType::Float | ParameterType::Rgb, Value::Float(v)) => float(*v),
        (ParameterType::Float | ParameterType::Rgb, Value::Integer(v)) => float(*v as f64),
        (ParameterType::Rgb, Value::Color(color)) => plugin::Value::Rgb(color.0),
        (ParameterType::Int, Value::Integer(v)) => {
            plugin::Value::Int(i32::try_from(*v).unwrap_or(if *v < 0 { i32::MIN } else { i32::MAX }))
        }
        (ParameterType::Bool, Value::Boolean(v)) => plugin::Value::Bool(*v),
        (ParameterType::Enum, Value::Text(text)) => plugin::Value::Word(text.trim().to_owned()),
        _ => return None,
    })
}

/// The element that holds such a parameter.
fn tag(kind: ParameterType) -> &'static str {
    match kind {
        ParameterType::Float => "float",
        ParameterType::Rgb => "rgb",
        ParameterType::Int => "integer",
        ParameterType::Bool => "boolean",
        ParameterType::Enum => "string",
    }
}

fn remedy(parameter: &Parameter) -> String {
    let file = |words: &str| words.split_whitespace().collect::<Vec<_>>().join(" ");
    match parameter.help.as_str() {
        "" => "its manifest says what it takes".to_owned(),
        help => file(help),
    }
}

/// What a module of that name would be called in a message about an unknown type.
pub(super) fn hint(kind: &str) -> String {
    if kind.is_empty() || Path::new(kind).components().count() != 1 {
        return String::new();
    }
    format!("; a plugin is found as {kind}.wasm beside the scene, in --plugins, or in {}", plugin::VARIABLE)
}
