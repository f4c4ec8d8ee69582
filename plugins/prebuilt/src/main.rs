//! `cargo run -p bidir-prebuilt [NAME …]`: builds the modules of `plugins/`, all or those named.

use std::{collections::BTreeMap, env, process::ExitCode};

use bidir_prebuilt::{Module, Recorded, Result, Sources, compile, discover, fingerprint, folder, root, tool};

fn main() -> ExitCode {
    match build(&env::args().skip(1).collect::<Vec<_>>()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn build(names: &[String]) -> Result<()> {
    let (root, folder) = (root(), folder());
    let modules = discover(&root)?;
    let wanted = choose(&modules, names)?;
    let mut compilers = BTreeMap::new();
    for module in &wanted {
        compilers.entry(format!("{:?}", module.language)).or_insert_with(|| tool::version(module.language));
    }
    let missing: Vec<&str> = compilers.values().filter_map(|found| found.as_ref().err().map(String::as_str)).collect();
    if !missing.is_empty() {
        return Err(missing.join("\n"));
    }
    let mut sources = Sources::read(&folder)?;
    sources.0.retain(|name, _| modules.iter().any(|module| module.name == *name));
    for module in wanted {
        compile::compile(&root, &folder, module)?;
        let recorded = Recorded {
            language: module.language,
            folder: module.folder.clone(),
            compiler: tool::version(module.language)?,
            sources: fingerprint::sources(&root, module)?,
            module: fingerprint::file(&folder.join(format!("{}.wasm", module.name)))?,
        };
        sources.0.insert(module.name.clone(), recorded);
        sources.write(&folder)?;
    }
    sources.complaints(&root, &folder, &modules)?.iter().for_each(|complaint| eprintln!("{complaint}"));
    Ok(())
}

fn choose<'a>(modules: &'a [Module], names: &[String]) -> Result<Vec<&'a Module>> {
    if names.is_empty() {
        return Ok(modules.iter().collect());
    }
    let find = |name: &String| {
        let known: Vec<&str> = modules.iter().map(|module| module.name.as_str()).collect();
        modules
            .iter()
            .find(|module| module.name == *name)
            .ok_or_else(|| format!("there is no module {name}; there are {}", known.join(", ")))
    };
    names.iter().map(find).collect()
}
