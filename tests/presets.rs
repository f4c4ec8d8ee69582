//! Presets: the smallest that covers a scene is taken, and gives the image of the one for any scene, bit for bit.

use bidir::scene::preset::{Preset, Task};
use bidir_kernel::{Effects, Heuristic, Techniques};

use crate::{
    pictures::{BDPT, LIGHT, PATH, Subject},
    scenes::*,
};

/// What may occur in the preset that a render takes.
struct Taken;

impl Task for Taken {
    type Output = Effects;

    fn run<P: Preset>(self, _: P) -> Effects {
        P::EFFECTS
    }
}

fn taken(subject: &Subject, techniques: Techniques) -> Effects {
    subject.scene.with_smallest_preset(subject.strategy(techniques, Heuristic::Balance).effects(), Taken)
}

/// A room in a plain scene, with what is added to it.
fn room_with(added: &[&str]) -> String {
    let cube =
        shape("cube", r#"<scale value="0.4"/><rotate y="1" angle="20"/><translate value="0.2, 0.4, 0"/>"#, &diffuse("0.5, 0.6, 0.7"));
    [depth(8), room(), cube, added.concat()].concat()
}

const TWO: Techniques = Techniques { next_event: 2.0, ..PATH };

/// With every set of techniques, the image is that of the full preset.
fn same(content: &str) {
    for techniques in [PATH, LIGHT, BDPT, TWO, Techniques { next_event: 0.0, ..PATH }] {
        for heuristic in [Heuristic::Balance, Heuristic::Power] {
            let subject = read(content);
            let job = subject.job(subject.strategy(techniques, heuristic), 4, 5);
            let chosen = subject.image(&job);
            let full = Subject { scene: subject.scene.with_effects(Effects::ALL), description: subject.description };
            assert!(taken(&full, techniques) == Effects::ALL);
            let full = full.image(&job);
            let bits = |image: &bidir::image::Image| image.pixels.iter().map(|pixel| pixel.map(f32::to_bits)).collect::<Vec<_>>();
            assert!(bits(&chosen) == bits(&full), "{techniques:?} {heuristic:?}");
        }
    }
}

#[test]
fn a_plain_scene_takes_a_plain_preset() {
    let plain = read(&room_with(&[&pinhole(), &panel()]));
    assert_eq!(taken(&plain, PATH), Effects::NONE);
    let both = taken(&plain, BDPT);
    assert!(both.light_walks && !both.deltas && !both.shading_normals);
    let glass = read(&room_with(&[&pinhole(), &panel(), &ball(&bsdf("dielectric", ""))]));
    assert_eq!(taken(&glass, PATH), Effects { light_walks: false, ..Effects::ALL });
    assert_eq!(taken(&glass, BDPT), Effects::ALL);
}

#[test]
fn what_a_scene_has_no_preset_leaves_out() {
    let room = |added: &[&str]| read(&room_with(added)).scene.effects();
    let sky = emitter("constant", &rgb("radiance", "0.3, 0.4, 0.5"));
    assert_eq!(room(&[&pinhole(), &panel()]), Effects::NONE);
    assert_eq!(room(&[&pinhole(), &sky]), Effects { environment: true, ..Effects::NONE });
    assert_eq!(room(&[&lens(0.2), &panel()]), Effects { finite_lens: true, ..Effects::NONE });
    assert!(room(&[&pinhole(), &panel(), &ball(&bsdf("conductor", ""))]).deltas);
}

#[test]
fn plain_scenes_look_the_same_with_any_preset() {
    let twosided = |colour: &str| format!(r#"<bsdf type="twosided">{}</bsdf>"#, diffuse(colour));
    let behind = shape(
        "rectangle",
        r#"<scale value="0.4"/><rotate x="1" angle="160"/><translate value="-0.6, 1, 0.6"/>"#,
        &twosided("0.7, 0.2, 0.2"),
    );
    let second = shape("rectangle", r#"<scale value="0.2"/><rotate y="1" angle="80"/><translate value="-1.8, 0.8, 0.4"/>"#, &area(20.0));
    same(&room_with(&[&pinhole(), &panel()]));
    same(&room_with(&[&pinhole(), &panel(), &second, &behind]));
}

#[test]
fn other_scenes_look_the_same_with_any_preset() {
    let sky = emitter("constant", &rgb("radiance", "0.3, 0.4, 0.5"));
    same(&room_with(&[&lens(0.2), &panel(), &ball(&bsdf("dielectric", ""))]));
    same(&room_with(&[&pinhole(), &sky, &ball(&bsdf("plastic", ""))]));
}
