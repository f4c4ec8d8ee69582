//! All of it on a small scene: what is written, what is kept, what goes on.

use std::{
    fs,
    path::Path,
    sync::{Arc, atomic::AtomicBool},
    time::Duration,
};

use bidir::{
    cost::{Report, Settings, measure, page, spent},
    load,
    plan::Stage,
    plugin::Library,
    scene::Scene,
};

use super::of_example;
use crate::scenes::{area, camera, depth, film, shape};

fn settings(folder: &Path, seconds: f64) -> Settings {
    Settings { folder: folder.to_owned(), budget: Duration::from_secs_f64(seconds), references: Vec::new(), digest: "cornell".to_owned() }
}

fn measured(folder: &Path, seconds: f64, interrupt: &Arc<AtomicBool>) -> Report {
    let subject = of_example("cornell", 24);
    let report = measure(&subject, None, &settings(folder, seconds), interrupt, &mut |_, _| {}).expect("a report");
    page::write(folder, &report).expect("a page");
    report
}

/// Rays of a render are those of its parts, each rendered alone.
#[test]
fn a_report_is_whole_and_its_rays_are_accounted_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let report = measured(folder.path(), 8.0, &Arc::default());
    let names: Vec<_> = report.methods.iter().map(|method| method.name).collect();
    assert_eq!(names, ["path", "light", "bdpt", "auto"]);
    assert!(report.prices.iter().all(|prices| prices.targets.len() == 4) && !report.plan.is_empty());
    let time = report.time.as_ref().expect("where time went");
    assert_eq!(time.rays.counted, time.rays.predicted);
    assert!(time.rays.counted.closest > 0);
    assert!(time.parts.iter().any(|part| part.tracing > 0.0 && part.tracing < part.seconds), "{:?}", time.parts);
    assert!(time.parts.iter().all(|part| part.rays.is_some() || part.tracing == 0.0), "{:?}", time.parts);
    assert!(report.pyramid.as_ref().is_some_and(|pyramid| pyramid.techniques.len() > 10));
    assert_eq!(report.images.len(), 5);
    let text = |name: &str| fs::read_to_string(folder.path().join(name)).expect("a file");
    let page = text("index.html");
    assert!(!page.contains("{{") && page.contains("data-name=\"reference\"") && page.contains("data-name=\"auto\""));
    let rows: usize = report.methods.iter().flat_map(|method| &method.points).map(|point| point.runs.len()).sum();
    assert_eq!(text("error.csv").lines().count(), 1 + rows);
    assert!(text("prices.csv").lines().count() == 17 && text("knobs.csv").contains("sampler,independent"));
    assert!(text("report.json").contains("\"crossings\""));
}

/// With some of the connections, several light paths, or none.
#[test]
fn the_rays_of_any_plan_are_those_of_its_parts() {
    let subject = of_example("cornell", 16);
    for (walks, connection) in [(1.0, 0.25), (2.0, 2.0), (0.25, 0.125), (1.0, 0.0), (0.0, 0.0)] {
        let stage = Stage { connection, lens_splat: walks, lens_hit: walks, ..Stage::BIDIRECTIONAL };
        let rays = spent::spent(&subject, &stage, 4, &Arc::default()).expect("where time went").rays;
        assert_eq!(rays.counted, rays.predicted, "{walks} {connection}");
    }
}

/// The budget is spent, so nothing is measured again, and what is shown of it is the same.
#[test]
fn what_was_measured_is_not_measured_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let first = measured(folder.path(), 3.0, &Arc::default());
    let again = measured(folder.path(), 3.0, &Arc::default());
    let errors = |report: &Report| format!("{:?}", report.methods);
    assert_eq!(errors(&first), errors(&again));
    assert!(again.methods.len() == 4 && again.spent < 4.0 * first.spent);
}

#[test]
fn an_interrupted_one_is_a_page_too_and_goes_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let cut = measured(folder.path(), 4.0, &Arc::new(AtomicBool::new(true)));
    assert!(cut.interrupted && cut.methods.is_empty() && folder.path().join("index.html").is_file());
    let whole = measured(folder.path(), 4.0, &Arc::default());
    assert_eq!(whole.methods.len(), 4);
}

/// A module that gives up now and then, in the knob that asks for modules.
#[test]
fn what_fails_is_left_out_and_said() {
    let wrong = r#"<bsdf type="wrong"><integer name="mistake" value="41"/></bsdf>"#;
    let lamp = shape("rectangle", r#"<rotate x="1" angle="90"/><translate y="2"/>"#, &area(5.0));
    let content = [depth(5), camera("perspective", &film(24)), shape("sphere", "", wrong), lamp].concat();
    let library = Library::new(vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("wrong")]);
    let text = format!("<scene version=\"3.0.0\">{content}</scene>");
    let description = load::load_str(&text, Path::new("wrong.xml"), None, &[], &library).expect("a good scene").description;
    let scene = Scene::new(&description).expect("a scene");

    let folder = tempfile::tempdir().expect("a folder");
    let settings = settings(folder.path(), 8.0);
    let report = measure(&of_example("cornell", 24), Some((description, scene)), &settings, &Arc::default(), &mut |_, _| {});
    let report = report.expect("a report");
    assert!(!report.out_of_time, "another budget");
    assert!(report.methods.len() == 4 && report.knobs.iter().any(|knob| knob.knob == "sampler"));
    assert!(matches!(&report.left_out[..], [one] if one.starts_with("plugins: ") && one.contains("wrong")), "{:?}", report.left_out);
    page::write(folder.path(), &report).expect("a page");
}
