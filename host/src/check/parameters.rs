//! Parameters all over the space that a manifest declares.

use super::{
    dice::{Dice, stream},
    subject::Set,
};
use crate::plugin::{Manifest, Parameter, ParameterType, Value};

/// A set with its parameter block.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub(super) set: Set,
    pub(super) bytes: Vec<u8>,
}

/// How many sets there are at most, whatever is left to choose.
const MOST: usize = 40;
/// Of these, corners of the whole space, and points within it.
const CORNERS: usize = 6;
const WITHIN: usize = 10;

/// The values that one set gives; every other parameter has its default.
type Chosen<'a> = Vec<(&'a Parameter, Value)>;

/// The defaults; each parameter at its ends, the others at their defaults; all at their ends; points within.
pub(super) fn all_over(manifest: &Manifest, given: &[(&str, Value)], seed: u64) -> Vec<Block> {
    let mut dice = Dice::new(stream(seed, 0x7061_7261));
    let is_given = |parameter: &Parameter| given.iter().any(|(name, _)| *name == parameter.name);
    let free: Vec<_> = manifest.params.iter().filter(|parameter| !is_given(parameter)).collect();
    let mut chosen: Vec<Chosen<'_>> = vec![Vec::new()];
    for parameter in &free {
        chosen.extend(ends(parameter).into_iter().map(|end| vec![(*parameter, end)]));
    }
    // With many parameters, not every end can have a set of its own.
    while chosen.len() > MOST - CORNERS - WITHIN {
        let at = 1 + dice.below(chosen.len() - 1);
        chosen.remove(at);
    }
    if !free.is_empty() {
        for corner in 0..CORNERS {
            let one = |parameter: &&'_ Parameter, dice: &mut Dice| {
                let ends = ends(parameter);
                let number = matches!(parameter.kind, ParameterType::Float | ParameterType::Rgb | ParameterType::Int);
                // First all numbers at their least, then at their most, what is no number at its default; then anything.
                let at = match corner {
                    0 => number.then_some(0),
                    1 => number.then_some(ends.len() - 1),
                    _ => Some(dice.below(ends.len())),
                };
                at.map(|at| ends[at].clone())
            };
            chosen.push(free.iter().filter_map(|parameter| Some((*parameter, one(parameter, &mut dice)?))).collect());
        }
        for _ in 0..WITHIN {
            chosen.push(free.iter().map(|parameter| (*parameter, within(parameter, &mut dice))).collect());
        }
    }
    let mut blocks: Vec<Block> = Vec::new();
    for chosen in chosen {
        let block = block(manifest, given, &chosen);
        if blocks.iter().all(|known| known.set.name != block.set.name) {
            blocks.push(block);
        }
    }
    blocks
}

/// One set: what is given, the rest at the defaults.
pub(super) fn one(manifest: &Manifest, given: &[(&str, Value)]) -> Block {
    block(manifest, given, &Vec::new())
}

fn block(manifest: &Manifest, given: &[(&str, Value)], chosen: &Chosen<'_>) -> Block {
    let mut bytes = manifest.defaults();
    let mut parts = Vec::new();
    for parameter in &manifest.params {
        let given = given.iter().find(|(name, _)| *name == parameter.name).map(|(_, value)| value);
        let chosen = chosen.iter().find(|(other, _)| other.name == parameter.name).map(|(_, value)| value);
        let Some(value) = given.or(chosen) else { continue };
        let before = bytes.clone();
        // Given values were checked, and chosen ones lie within their ranges.
        if parameter.write(value, &mut bytes).is_ok() && bytes != before {
            parts.push((parameter.name.as_str(), written(value)));
        }
    }
    let name = parts.iter().map(|(name, value)| format!("{name}={}", escaped(value))).collect::<Vec<_>>().join("/");
    let words = parts.iter().map(|(name, value)| format!("{name} = {value}")).collect::<Vec<_>>().join(", ");
    Block { set: Set { name, words }, bytes }
}

/// Slashes part the parameters of a set's name.
fn escaped(value: &str) -> String {
    value.replace('%', "%25").replace('/', "%2F")
}

/// The names and values that a set's name is made of.
pub(super) fn parts(name: &str) -> Vec<(String, String)> {
    let parts = name.split('/').filter(|part| !part.is_empty()).map(|part| part.split_once('=').unwrap_or((part, "")));
    parts.map(|(name, value)| (name.to_owned(), value.replace("%2F", "/").replace("%25", "%"))).collect()
}

/// As [`read`] reads it.
fn written(value: &Value) -> String {
    match value {
        Value::Float(v) => v.to_string(),
        Value::Rgb([r, g, b]) if r == g && g == b => r.to_string(),
        Value::Rgb([r, g, b]) => format!("{r},{g},{b}"),
        Value::Int(v) => v.to_string(),
        Value::Bool(v) => v.to_string(),
        Value::Word(word) => word.clone(),
    }
}

/// A value for a parameter, as `--set` and cases write it; `None` if it is none.
pub(super) fn read(parameter: &Parameter, text: &str) -> Option<Value> {
    Some(match parameter.kind {
        ParameterType::Float => Value::Float(text.parse().ok()?),
        ParameterType::Rgb => {
            let numbers: Vec<f32> = text.split(',').map(|part| part.trim().parse().ok()).collect::<Option<_>>()?;
            match numbers[..] {
                [grey] => Value::Float(grey),
                [r, g, b] => Value::Rgb([r, g, b]),
                _ => return None,
            }
        }
        ParameterType::Int => Value::Int(text.parse().ok()?),
        ParameterType::Bool => Value::Bool(text.parse().ok()?),
        ParameterType::Enum => Value::Word(text.to_owned()),
    })
}

/// The ends of a float's or a channel's range; where one is not declared, ten times the default's distance away.
fn range(parameter: &Parameter) -> (f64, f64) {
    let default = match parameter.default.as_array().map(Vec::as_slice) {
        Some([first, ..]) => first.as_f64(),
        _ => parameter.default.as_f64(),
    };
    let default = default.unwrap_or(0.0);
    let far = if default == 0.0 { 1.0 } else { default.abs() };
    match (parameter.min, parameter.max) {
        (Some(min), Some(max)) => (min, max),
        (Some(min), None) => (min, default.max(min) + 10.0 * far.max(default - min)),
        (None, Some(max)) => (default.min(max) - 10.0 * far, max),
        (None, None) if default > 0.0 => (0.1 * far, 10.0 * far),
        (None, None) => (-10.0 * far, 10.0 * far),
    }
}

/// Ranges of more orders of magnitude than this keep nonsense out rather than say what is likely.
const WIDE: f64 = 1e4;

/// Of a range that wide, what lies a quarter of the way from the default to its ends, in logarithms: an index of refraction that may be
/// 0.001 … 1000 is asked from 0.24 to 7.6.
fn likely(parameter: &Parameter) -> (f64, f64) {
    let ((min, max), default) = (range(parameter), parameter.default.as_f64().unwrap_or(0.0));
    let toward = |end: f64| default * (end / default).powf(0.25);
    if min > 0.0 && max > WIDE * min && default > 0.0 { (toward(min), toward(max)) } else { (min, max) }
}

/// What of the parameters' ranges is left out, in words.
pub(super) fn narrowed(manifest: &Manifest, given: &[(&str, Value)]) -> Vec<String> {
    let free = manifest.params.iter().filter(|parameter| given.iter().all(|(name, _)| *name != parameter.name));
    let words = free.filter_map(|parameter| {
        let ((min, max), declared) = (likely(parameter), range(parameter));
        let name = &parameter.name;
        ((min, max) != declared).then(|| format!("{name} may be {} … {}, and was asked from {min:.2} to {max:.2}", declared.0, declared.1))
    });
    words.collect()
}

fn ends(parameter: &Parameter) -> Vec<Value> {
    let (min, max) = likely(parameter);
    match parameter.kind {
        ParameterType::Float | ParameterType::Rgb => vec![Value::Float(min as f32), Value::Float(max as f32)],
        ParameterType::Int => vec![Value::Int(min.ceil() as i32), Value::Int(max.floor() as i32)],
        ParameterType::Bool => vec![Value::Bool(false), Value::Bool(true)],
        ParameterType::Enum => parameter.values.iter().map(|word| Value::Word(word.clone())).collect(),
    }
}

fn within(parameter: &Parameter, dice: &mut Dice) -> Value {
    let (min, max) = likely(parameter);
    match parameter.kind {
        ParameterType::Float => Value::Float(between(min, max, dice)),
        ParameterType::Rgb => Value::Rgb([(); 3].map(|()| between(min, max, dice))),
        ParameterType::Int => Value::Int((min + (max - min + 1.0) * dice.exact()).floor().min(max) as i32),
        ParameterType::Bool => Value::Bool(dice.below(2) == 1),
        ParameterType::Enum => Value::Word(parameter.values[dice.below(parameter.values.len())].clone()),
    }
}

/// Even, or crowded towards the lower end over four orders of magnitude: much happens at small roughness.
fn between(min: f64, max: f64, dice: &mut Dice) -> f32 {
    let (crowded, u) = (dice.below(2) == 1, dice.exact());
    let share = if crowded { 10f64.powf(-4.0 * u) } else { u };
    let value = if min > 0.0 && max > 20.0 * min { min * (max / min).powf(u) } else { min + (max - min) * share };
    // A bound rounded to f32 may lie outside.
    (value as f32).clamp(min as f32, max as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn manifest(params: &str) -> Manifest {
        let text = format!(r#"{{"name": "x", "kind": "bsdf", "lobes": ["delta_reflection"], "params": [{params}]}}"#);
        Manifest::read(text.as_bytes()).expect("a good manifest")
    }

    fn many() -> Manifest {
        manifest(
            r#"{"name": "alpha", "type": "float", "offset": 0, "default": 0.1, "min": 0},
               {"name": "tint", "type": "rgb", "offset": 4, "default": 0.5, "min": 0, "max": 1},
               {"name": "count", "type": "int", "offset": 16, "default": 2, "min": 1, "max": 5},
               {"name": "thin", "type": "bool", "offset": 20, "default": false},
               {"name": "slopes", "type": "enum", "offset": 24, "default": "b", "values": ["a", "b", "c", "1/2 of 10 %"]},
               {"name": "free", "type": "float", "offset": 28, "default": -1}"#,
        )
    }

    #[test]
    fn sets_are_different_begin_with_the_defaults_and_reach_every_end() {
        let manifest = many();
        let blocks = all_over(&manifest, &[], 1);
        assert_eq!((blocks[0].set.name.as_str(), &blocks[0].bytes), ("", &manifest.defaults()));
        assert!(blocks.len() > 20 && blocks.len() <= MOST);
        for end in
            ["alpha=0", "alpha=1.1", "tint=0", "tint=1", "count=1", "count=5", "thin=true", "slopes=a", "slopes=1%2F2 of 10 %25", "free=10"]
        {
            assert!(blocks.iter().any(|block| block.set.name == end), "{end}");
        }
    }

    #[test]
    fn what_is_given_stays() {
        let manifest = many();
        let blocks = all_over(&manifest, &[("alpha", Value::Float(0.3))], 1);
        assert!(blocks.iter().all(|block| block.bytes[..4] == 0.3f32.to_le_bytes()));
    }

    #[test]
    fn names_lead_back_to_their_blocks() {
        let manifest = many();
        for block in all_over(&manifest, &[], 2) {
            let parts = parts(&block.set.name);
            let value = |name, text| read(manifest.parameter(name).expect("a parameter"), text).expect("of its type");
            let given: Vec<_> = parts.iter().map(|(name, text)| (name.as_str(), value(name, text))).collect();
            assert_eq!(one(&manifest, &given).bytes, block.bytes, "{}", block.set.name);
        }
    }

    #[test]
    fn many_parameters_make_no_more_sets() {
        let params: Vec<_> = (0..100)
            .map(|i| format!(r#"{{"name": "p{i}", "type": "float", "offset": {}, "default": 0.5, "min": 0, "max": 1}}"#, 4 * i))
            .collect();
        assert_eq!(all_over(&manifest(&params.join(",")), &[], 1).len(), MOST);
    }
}
