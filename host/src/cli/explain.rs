//! `bidir explain`.

mod catalog;
mod text;

use std::{
    io::{self, Write},
    path::PathBuf,
    time::Duration,
};

use serde::Serialize;

use crate::{
    cli::{
        Outcome,
        arguments::Explain,
        progress::{Stages, Verbosity},
        render::{read, thread_count},
    },
    error::{Error, Result},
    plan::{
        Plan, Stage,
        choice::Choice,
        contents::Contents,
        effects::Effects,
        gaps::{Gap, gaps},
        joins::{Verdict, judge},
    },
    plugin::Strictness,
    render::{Auto, Job, LONGEST_JOINED, Numbers, Target},
    scene::{Scene, description::Description},
};

/// What is to be said of a scene.
#[derive(Debug, Serialize)]
struct Report {
    scene: PathBuf,
    contents: Contents,
    effects: Effects,
    techniques: Vec<Verdict>,
    /// Classes of paths that no technique of the plan finds.
    missing: Vec<Gap>,
    /// Where the image differs from Mitsuba's.
    differences: Vec<String>,
    /// What a pilot found, where there was a choice.
    choice: Option<Choice>,
    /// What `render --plan` takes.
    plan: Plan,
}

pub(super) fn run(arguments: &Explain) -> Result<Outcome> {
    let Some(path) = &arguments.scene else {
        let words = if arguments.json { json(&catalog::by_tag())? } else { catalog::list() };
        return Ok(say(&words));
    };
    let description = read(Some(path), &arguments.from, &mut Stages::new(Verbosity::Quiet))?;
    let scene = Scene::new(&description)?;
    let report = Report::new(path.clone(), &description, &scene);
    Ok(say(&if arguments.json { json(&report)? } else { text::of(&report) }))
}

/// Who stops reading halfway (`| head`) has read enough.
fn say(words: &str) -> Outcome {
    let _ = writeln!(io::stdout(), "{words}");
    Outcome::Done
}

fn json(report: &impl Serialize) -> Result<String> {
    serde_json::to_string_pretty(report).map_err(|error| Error::new(format!("no JSON: {error}"), "this is a bug; please report it"))
}

impl Report {
    fn new(path: PathBuf, description: &Description, scene: &Scene) -> Self {
        let effects = Effects::of(description, scene);
        let (plan, choice) = planned(description, scene, &effects);
        let stage = plan.last().copied().unwrap_or(Stage::BIDIRECTIONAL);
        let max_depth = description.integrator.max_depth;
        Self {
            scene: path,
            contents: Contents::of(description, scene),
            techniques: judge(&effects, &stage, max_depth),
            missing: gaps(&effects, &stage, max_depth),
            differences: differences(description, &effects),
            effects,
            choice,
            plan,
        }
    }
}

/// What each thread of the pilot may take.
const PILOT: Duration = Duration::from_secs(1);

/// Pixels that the pilot looks at.
const PIXELS: u64 = 16_384;

/// The plan that `auto` would begin with, after a longer look than a render takes.
fn planned(description: &Description, scene: &Scene, effects: &Effects) -> (Plan, Option<Choice>) {
    let job = Job {
        strategy: Stage::BIDIRECTIONAL.strategy(&description.integrator),
        seed: description.seed,
        numbers: Numbers::default(),
        threads: thread_count(None),
        target: Target::Samples(description.samples_per_pixel),
        width: description.film.width,
        strictness: Strictness::Lenient,
    };
    let mut auto = Auto::new(description, effects);
    auto.look(scene, &job, PILOT, PIXELS, 0);
    (auto.plan().clone(), auto.choice().cloned())
}

/// Where this scene's image differs from Mitsuba's by more than noise.
fn differences(description: &Description, effects: &Effects) -> Vec<String> {
    let (sensor, depth) = (&description.sensor, description.integrator.max_depth.unwrap_or(u32::MAX));
    let mut all = Vec::new();
    if sensor.near_clip.is_none() || sensor.far_clip.is_none() {
        all.push("near_clip and far_clip act only when written; Mitsuba always clips, by default at 0.01 and 10000".to_owned());
    }
    if effects.shading_normals {
        all.push(
            "directions on different sides of the geometric and the shading normal are refused, so that light does not leak; \
             Mitsuba's path tracer lets them pass"
                .to_owned(),
        );
    }
    if effects.dirac_lights && effects.delta() && effects.smooth() && depth > 2 {
        all.push("caustics of point, spot and directional lights appear; Mitsuba's path tracer cannot find them".to_owned());
    }
    if depth > LONGEST_JOINED && effects.lights() {
        all.push(format!("paths of more than {LONGEST_JOINED} segments are made by s = 0 and s = 1 alone, as a path tracer makes them"));
    }
    all
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::{load::load_str, plugin::Library};

    fn report(content: &str) -> Report {
        let text = format!("<scene version=\"3.0.0\"><sensor type=\"perspective\"/>{content}</scene>");
        let description = load_str(&text, Path::new("s.xml"), None, &[], &Library::default()).unwrap().description;
        let scene = Scene::new(&description).unwrap();
        Report::new("s.xml".into(), &description, &scene)
    }

    const CAUSTIC: &str = r#"
        <shape type="sphere"><bsdf type="dielectric"/></shape>
        <shape type="rectangle"><bsdf type="twosided"><bsdf type="diffuse">
            <texture name="reflectance" type="checkerboard"/></bsdf></bsdf></shape>
        <shape type="rectangle"><transform name="to_world"><translate z="-1"/></transform></shape>
        <emitter type="point"><rgb name="intensity" value="3"/></emitter>
        <emitter type="spot"><rgb name="intensity" value="0"/></emitter>"#;

    #[test]
    fn a_report_tells_what_is_there() {
        let Report { contents, effects, .. } = report(CAUSTIC);
        let shapes: Vec<_> = contents.shapes.iter().map(|shape| (shape.kind, shape.count)).collect();
        assert_eq!(shapes, [("rectangle", 2), ("sphere", 1)]);
        assert_eq!(contents.primitives, 3);
        let materials: Vec<_> = contents.materials.iter().map(|m| (m.kind.as_str(), m.shapes, m.textured, m.lobes.as_slice())).collect();
        assert_eq!(
            materials,
            [
                ("dielectric", 1, 0, ["delta_reflection", "delta_transmission"].as_slice()),
                ("twosided diffuse", 1, 1, &["diffuse_reflection"]),
                ("diffuse", 1, 0, &["diffuse_reflection"]),
            ]
        );
        let lights: Vec<_> = contents.lights.iter().map(|light| (light.kind.clone(), light.count, light.share)).collect();
        assert_eq!((lights, contents.black_lights), (vec![("point".to_owned(), 1, 1.0)], 1));
        assert!((contents.lights[0].power - 12.0 * std::f64::consts::PI).abs() < 1e-4);
        let present: Vec<_> = effects.list().into_iter().filter_map(|(name, present)| present.then_some(name)).collect();
        assert_eq!(
            present,
            [
                "Dirac lights (point, spot, directional)",
                "diffuse scattering",
                "delta reflection (mirrors)",
                "delta transmission (clear glass, null)",
                "refraction",
                "textures",
            ]
        );
    }

    #[test]
    fn paths_that_nothing_finds_are_said_aloud_with_a_remedy() {
        let report = report(CAUSTIC);
        let words = text::of(&report);
        assert!(words.contains("L S+ D S+ E") && words.contains("caustics, seen in a mirror or through clear glass"), "{words}");
        assert!(words.contains("area emitter"), "{words}");
        assert!(words.contains("a pinhole cannot be hit"), "{words}");
    }

    #[test]
    fn a_roughness_that_varies_may_be_a_mirror_somewhere() {
        let rough = |values: [&str; 2]| {
            let [a, b] = values;
            let texture = format!(
                "<texture name=\"alpha\" type=\"checkerboard\"><rgb name=\"color0\" value=\"{a}\"/><rgb name=\"color1\" value=\"{b}\"/></texture>"
            );
            report(&format!("<shape type=\"disk\"><bsdf type=\"roughconductor\">{texture}</bsdf></shape>")).effects
        };
        let mixed = rough(["0", "0.2"]);
        assert!(mixed.glossy_reflection && mixed.delta_reflection && mixed.textures);
        let even = rough(["0.1", "0.2"]);
        assert!(even.glossy_reflection && !even.delta_reflection);
    }

    #[test]
    fn the_plan_in_a_report_is_one_that_render_takes() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let value = serde_json::to_value(report(CAUSTIC)).unwrap();
        std::fs::write(file.path(), value["plan"].to_string()).unwrap();
        assert_eq!(Plan::read(file.path()).unwrap().stages.len(), 1);
        assert_eq!(value["techniques"][4]["state"], "impossible");
        assert_eq!(value["techniques"][4]["join"], "lens_hit");
    }

    #[test]
    fn groups_are_counted_once_and_written_out() {
        let group = r#"<shape type="shapegroup" id="g"><shape type="cube"/><shape type="disk"/></shape>
            <shape type="shapegroup" id="h"><shape type="instance"><ref id="g"/></shape><shape type="sphere"/></shape>"#;
        let report = report(&format!("{group}{}<shape type=\"disk\"/>", r#"<shape type="instance"><ref id="h"/></shape>"#.repeat(3)));
        assert_eq!(report.contents.primitives, 12 + 1 + 1 + 1);
        let words = text::of(&report);
        assert!(words.contains("1 mesh (12 triangles), 2 disks, 1 sphere"), "{words}");
        assert!(words.contains("2 groups of 3 shapes, 4 instances; written out, 10 shapes"), "{words}");
    }

    #[test]
    fn an_empty_scene_has_a_report_too() {
        let report = report("");
        assert!(report.missing.is_empty());
        assert!(text::of(&report).contains("nothing in the scene shines"));
    }
}
