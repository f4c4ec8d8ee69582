//! Where two runs part is said.

use bidir_twin::{
    case::{Case, named},
    double,
    parting::{Said, before, partings},
    setting::Shape,
    single,
    tape::Given,
};

fn case() -> Case {
    named("dielectric/rectangle/pinhole/bidirectional/balance").expect("a case")
}

/// Two worlds that are not the same, on purpose: one has no ball.
#[test]
fn a_parting_names_its_walk_its_vertex_and_its_things() {
    let case = case();
    let mut other = case.setting.clone();
    let ball = other.things.iter().position(|thing| thing.name == "ball").expect("a ball");
    other.things[ball].shape = Shape::Ball { centre: [0.0, 50.0, 0.0], radius: 0.5 };
    let (single, double) = (single::world::World::new(&case.setting), double::world::World::new(&other));
    let said: Vec<String> = (0..100)
        .flat_map(|index| {
            let (a, b) = (single.trace(&case.plan, [1, index], None), double.trace(&case.plan, [1, index], None));
            partings(&a, &b)
        })
        .flatten()
        .map(|parting| Said(&parting, &case.setting).to_string())
        .collect();
    let starts = |start: &str| said.iter().any(|said| said.starts_with(start));
    assert!(starts("camera walk, vertex 1: the ball in f32, the back wall in f64, "), "{said:#?}");
    assert!(starts("light walk, vertex 1: the ball in f32, the floor in f64, "), "{said:#?}");
    assert!(said.iter().all(|said| said.contains("from the nearer edge")), "{said:#?}");
}

/// Techniques that use nothing of what comes after the parting are compared all the same.
#[test]
fn what_lies_before_a_parting_is_compared() {
    let case = case();
    let world = double::world::World::new(&case.setting);
    let index = (0..100).find(|&index| world.trace(&case.plan, [1, index], None).walks.iter().all(|walk| walk.len() >= 3));
    let tape = world.trace(&case.plan, [1, index.expect("long walks")], None);
    // Both walks end where the other run meets its second vertex.
    let mut short = tape.clone();
    short.walks.iter_mut().for_each(|walk| walk.truncate(2));
    let apart = partings(&tape, &short);
    let told = |s, t| before(&Given { s, t, value: [1.0; 3], weight: 1.0 }, &apart);
    // The first vertex of each walk has been met, and left.
    assert!(told(0, 2) && told(1, 2) && told(2, 2) && told(2, 1) && told(3, 0));
    assert!(!told(0, 3) && !told(1, 3) && !told(3, 2) && !told(2, 3) && !told(3, 1) && !told(4, 0));
    assert!(partings(&tape, &tape).iter().all(Option::is_none));
}
