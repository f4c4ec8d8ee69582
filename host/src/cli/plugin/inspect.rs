//! `bidir plugin inspect`.

mod timing;

use std::{path::PathBuf, sync::Arc};

use serde::Serialize;

use self::timing::Timing;
use super::{json, reach, say, table::aligned, type_name};
use crate::{
    cli::{Outcome, arguments::InspectPlugin},
    error::Result,
    plugin::{Engine, Kind, Manifest, Module, Parameter},
};

/// What there is to say of a module.
#[derive(Debug, Serialize)]
struct Report {
    #[serde(rename = "type")]
    kind: String,
    file: PathBuf,
    /// Major and minor, with a point between.
    abi: String,
    bytes: usize,
    functions: u32,
    manifest: Manifest,
    exports: Vec<Export>,
    timing: Timing,
}

#[derive(Debug, Serialize)]
struct Export {
    name: String,
    signature: String,
}

pub(super) fn run(arguments: &InspectPlugin) -> Result<Outcome> {
    let module = Arc::new(Module::load(&Engine::new()?, &arguments.file)?);
    let (timing, quarantine) = timing::measure(&module)?;
    for entry in &quarantine.0 {
        eprintln!("warning: {entry}");
    }
    let report = Report::new(&module, timing);
    say(&if arguments.json { json(&report)? } else { report.words() });
    Ok(Outcome::Done)
}

impl Report {
    fn new(module: &Module, timing: Timing) -> Self {
        let (major, minor) = module.version();
        let export = |(name, signature): &(String, String)| Export { name: name.clone(), signature: signature.clone() };
        Self {
            kind: type_name(module.file()),
            file: module.file().to_owned(),
            abi: format!("{major}.{minor}"),
            bytes: module.bytes(),
            functions: module.functions(),
            manifest: module.manifest().clone(),
            exports: module.exports().iter().map(export).collect(),
            timing,
        }
    }

    fn words(&self) -> String {
        let Self { manifest, timing, .. } = self;
        let what = if manifest.kind == Kind::Bsdf { "lobes" } else { "emits from" };
        let mut rows = vec![
            ["type", self.kind.as_str()].map(str::to_owned),
            ["kind", manifest.kind.name()].map(str::to_owned),
            ["description", &manifest.description].map(str::to_owned),
            [what.to_owned(), reach(manifest)],
        ];
        if manifest.kind == Kind::Bsdf {
            rows.push(["reciprocal", yes_or_no(manifest.reciprocal)].map(str::to_owned));
            rows.push(["isotropic", yes_or_no(manifest.isotropic)].map(str::to_owned));
        }
        rows.push(["ABI", &self.abi].map(str::to_owned));
        rows.push(["size".to_owned(), format!("{} bytes, {} functions", self.bytes, self.functions)]);
        for call in &timing.calls {
            rows.push([call.export.to_owned(), format!("{:.0} ns per call", call.nanoseconds)]);
        }
        rows.push(["instantiation".to_owned(), format!("{:.1} µs", timing.instantiation_microseconds)]);
        let mut lines = aligned(&rows);
        lines.extend(["".to_owned(), "Parameters".to_owned()]);
        if manifest.params.is_empty() {
            lines.push("  none".to_owned());
        } else {
            let heading = ["name", "type", "default", "range", "texturable", "help"].map(str::to_owned);
            let rows: Vec<_> = std::iter::once(heading).chain(manifest.params.iter().map(parameter)).collect();
            lines.extend(indented(aligned(&rows)));
        }
        lines.extend(["".to_owned(), "Exports".to_owned()]);
        let exports: Vec<_> = self.exports.iter().map(|export| [export.name.clone(), export.signature.clone()]).collect();
        lines.extend(indented(aligned(&exports)));
        lines.join("\n")
    }
}

fn indented(lines: Vec<String>) -> impl Iterator<Item = String> {
    lines.into_iter().map(|line| format!("  {line}"))
}

fn parameter(parameter: &Parameter) -> [String; 6] {
    let default = match &parameter.default {
        serde_json::Value::String(word) => word.clone(),
        serde_json::Value::Array(numbers) => numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(", "),
        other => other.to_string(),
    };
    let range = match (parameter.values.is_empty(), parameter.min.or(parameter.max)) {
        (false, _) => parameter.values.join(", "),
        (true, Some(_)) => parameter.range_words(),
        (true, None) => "-".to_owned(),
    };
    let texturable = yes_or_no(parameter.texturable).to_owned();
    [parameter.name.clone(), parameter.kind.name().to_owned(), default, range, texturable, parameter.help.clone()]
}

fn yes_or_no(yes: bool) -> &'static str {
    if yes { "yes" } else { "no" }
}
