//! What can be said on the command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

use super::plugin::templates;
use crate::{plan::Named, render::Numbers, scene::description::Quantity};

/// A bidirectional path tracer for Mitsuba 3 scenes and glTF.
#[derive(Debug, Parser)]
#[command(name = "bidir", version, about)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene to an image; without a scene, one that comes with the program
    Render(Render),
    /// Say what a scene holds, what would be simulated, and what this program reads
    Explain(Explain),
    /// Write every technique (s,t) as an image of its own, weighted and unweighted, and all of them as a pyramid
    Techniques(Techniques),
    /// Hold an image against a reference: relMSE, SMAPE, bias, worst block
    Compare(Compare),
    /// Say what accuracy costs in time: a page with error against time, prices, and what each knob costs and brings
    Cost(Cost),
    /// Test whether a BSDF or a light is right, and say in words what is wrong and where
    Check(Check),
    /// Begin a plugin, list plugins, or look into one
    #[command(subcommand)]
    Plugin(Plugin),
}

/// Where a scene comes from.
#[derive(Debug, Args)]
pub struct SceneArguments {
    /// Give a value to a $name of the scene; of a glTF, to size or lights
    #[arg(long = "define", value_name = "NAME=VALUE", value_parser = definition)]
    pub defines: Vec<(String, String)>,
    /// The longest path, in segments, whatever the scene says; -1 is unlimited
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(i64).range(-1..i64::from(u32::MAX)))]
    pub max_depth: Option<i64>,
    /// A folder of plugins, before those that BIDIR_PLUGINS names; may be given again
    #[arg(long = "plugins", value_name = "DIR")]
    pub plugins: Vec<PathBuf>,
    /// End the render at a plugin's first bad answer, instead of leaving such answers out
    #[arg(long)]
    pub strict: bool,
}

/// `bidir render`
#[derive(Debug, Args)]
pub struct Render {
    /// A Mitsuba 3 scene, or a glTF: .gltf or .glb
    pub scene: Option<PathBuf>,
    /// The image to write: .exr, .hdr or .png
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Which techniques run
    #[arg(long, value_enum, default_value_t)]
    pub integrator: Named,
    /// Run the techniques that this file says
    #[arg(long, value_name = "FILE.json", conflicts_with = "integrator")]
    pub plan: Option<PathBuf>,
    /// Samples per pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub spp: Option<u32>,
    /// Render for about this long
    #[arg(long, value_name = "SECONDS", value_parser = positive, conflicts_with = "spp")]
    pub time: Option<f64>,
    /// Render until the estimated relMSE is at most this
    #[arg(long, value_name = "RELMSE", value_parser = positive, conflicts_with_all = ["spp", "time"])]
    pub error: Option<f64>,
    #[command(flatten)]
    pub from: SceneArguments,
    /// Of the random numbers
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Which random numbers
    #[arg(long, value_enum, default_value_t)]
    pub sampler: Numbers,
    /// Render threads; as many as the machine has, unless told
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub threads: Option<u32>,
    /// Layers beside the picture, with commas between, in the same EXR; or all
    #[arg(long = "aov", value_name = "NAME", value_delimiter = ',', value_parser = aov_names())]
    pub aovs: Vec<String>,
    /// Write what was done, and what it took, as JSON
    #[arg(long, value_name = "FILE.json")]
    pub stats: Option<PathBuf>,
    /// No progress; warnings stay
    #[arg(long)]
    pub quiet: bool,
}

/// What layers can hold.
fn aov_names() -> clap::builder::PossibleValuesParser {
    Quantity::ALL.map(Quantity::name).into_iter().chain(["all"]).collect::<Vec<_>>().into()
}

/// `bidir explain`
#[derive(Debug, Args)]
pub struct Explain {
    /// A Mitsuba 3 scene, or a glTF; without one, what this program reads is listed
    pub scene: Option<PathBuf>,
    #[command(flatten)]
    pub from: SceneArguments,
    /// As JSON
    #[arg(long)]
    pub json: bool,
}

/// `bidir techniques`
#[derive(Debug, Args)]
pub struct Techniques {
    /// A Mitsuba 3 scene, or a glTF: .gltf or .glb
    pub scene: PathBuf,
    /// The folder to write to
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Samples per pixel
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..))]
    pub spp: u32,
    /// The longest paths to show
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = clap::value_parser!(u32).range(1..=64))]
    pub longest: u32,
    #[command(flatten)]
    pub from: SceneArguments,
    /// Of the random numbers
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Which random numbers
    #[arg(long, value_enum, default_value_t)]
    pub sampler: Numbers,
    /// Render threads; as many as the machine has, unless told
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub threads: Option<u32>,
    /// No progress
    #[arg(long)]
    pub quiet: bool,
}

/// `bidir compare`
#[derive(Debug, Args)]
pub struct Compare {
    /// The image
    pub image: PathBuf,
    /// The reference
    pub reference: PathBuf,
    /// As JSON
    #[arg(long)]
    pub json: bool,
}

/// `bidir cost`
#[derive(Debug, Args)]
pub struct Cost {
    /// A Mitsuba 3 scene, or a glTF: .gltf or .glb
    pub scene: PathBuf,
    /// The folder to write to; begun there before, it goes on
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// A picture to hold all others against; given twice, two independent halves of one. Without any, one is rendered
    #[arg(long = "reference", value_name = "FILE")]
    pub references: Vec<PathBuf>,
    /// How long all of it may take
    #[arg(long, value_name = "SECONDS", value_parser = positive, default_value_t = 120.0)]
    pub budget: f64,
    #[command(flatten)]
    pub from: SceneArguments,
    /// Of the random numbers
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Render threads; as many as the machine has, unless told
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub threads: Option<u32>,
    /// No progress
    #[arg(long)]
    pub quiet: bool,
}

/// `bidir check`
#[derive(Debug, Args)]
pub struct Check {
    /// A plugin's .wasm file, the name of a built-in, or that of a plugin in a folder of plugins
    #[arg(value_name = "PLUGIN.wasm|NAME")]
    pub subject: String,
    /// Keep a parameter at a value (a colour: R,G,B or one number); may be given again
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = definition, conflicts_with = "replay")]
    pub set: Vec<(String, String)>,
    /// Of the random numbers
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// Ask one case again, as a check printed it
    #[arg(long, value_name = "CASE")]
    pub replay: Option<String>,
    /// Threads; as many as the machine has, unless told. The verdicts do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub threads: Option<u32>,
    /// A folder of plugins, before those that BIDIR_PLUGINS names; may be given again
    #[arg(long = "plugins", value_name = "DIR")]
    pub plugins: Vec<PathBuf>,
    /// Write a page with the verdicts, plots and pictures, index.html, into this folder; it is made if it is not there
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    /// As JSON
    #[arg(long)]
    pub json: bool,
}

/// `bidir plugin`
#[derive(Debug, Subcommand)]
pub enum Plugin {
    /// Write a project to begin a plugin with
    New(NewPlugin),
    /// List the plugins in folders, without running them
    List(ListPlugins),
    /// Say what a plugin holds, and how long its calls take
    Inspect(InspectPlugin),
}

/// `bidir plugin new`
#[derive(Debug, Args)]
pub struct NewPlugin {
    /// What scenes will call it: a lower-case letter, then lower-case letters and digits
    pub name: String,
    /// What it is to be
    #[arg(long, value_parser = templates::KINDS)]
    pub kind: String,
    /// What it is to be written in
    #[arg(long, value_parser = templates::LANGUAGES)]
    pub language: String,
    /// The folder to write to, new or empty; by default NAME
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// For Rust: the folder plugins/sdk of a checkout; by default that of the one this program was built from
    #[arg(long, value_name = "PATH")]
    pub sdk: Option<PathBuf>,
}

/// `bidir plugin list`
#[derive(Debug, Args)]
pub struct ListPlugins {
    /// Folders of plugins, before those that BIDIR_PLUGINS names; without any, the current one
    #[arg(value_name = "DIR")]
    pub folders: Vec<PathBuf>,
    /// One more folder; may be given again
    #[arg(long = "plugins", value_name = "DIR")]
    pub plugins: Vec<PathBuf>,
    /// As JSON
    #[arg(long)]
    pub json: bool,
}

/// `bidir plugin inspect`
#[derive(Debug, Args)]
pub struct InspectPlugin {
    /// The module: a .wasm file
    pub file: PathBuf,
    /// As JSON
    #[arg(long)]
    pub json: bool,
}

fn definition(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.is_empty() => Ok((name.to_owned(), value.to_owned())),
        _ => Err("write it as NAME=VALUE".to_owned()),
    }
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("give a number above 0".to_owned()),
    }
}
