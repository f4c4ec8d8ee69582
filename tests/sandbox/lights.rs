//! Profiles of plugins shine the same into every technique: on a shape, at a point, and as surroundings.

use std::fs;

use bidir::plugin::Library;

use super::{library, read};
use crate::{
    estimators::{ALL, agree_after},
    scenes::*,
};

fn lit_by(name: &str, light: &str, library: &Library, effort: u32) {
    let content = [depth(5), pinhole(), room(), ball(&diffuse("0.6, 0.4, 0.3")), light.to_owned()].concat();
    agree_after(effort, name, &read(&content, library), ALL);
}

const AIM: &str = r#"<transform name="to_world"><lookat origin="1, 2.5, 1.5" target="0, 0.4, 0" up="0, 1, 0"/></transform>"#;

#[test]
fn a_measured_lamp() {
    lit_by("iesspot", &emitter("iesspot", &(rgb("intensity", "12, 10, 8") + AIM)), &library(), 1);
}

#[test]
fn a_projector() {
    let light = emitter("gobo", &(rgb("intensity", "30, 26, 20") + &float("half_width", 25.0) + AIM));
    lit_by("gobo", &light, &library(), 1);
}

#[test]
fn a_sky() {
    let turn = r#"<transform name="to_world"><rotate y="1" angle="40"/></transform>"#;
    lit_by("sky", &emitter("sky", &(float("sun_radius", 8.0) + &float("sun_azimuth", -60.0) + turn)), &library(), 2);
}

#[test]
fn built_ins_as_modules() {
    let panel = panel().replace("\"area\"", "\"area.wasm\"");
    let point = emitter("point.wasm", &(rgb("intensity", "2, 1, 1") + r#"<point name="position" value="-1, 2, 1"/>"#));
    let spot = emitter("spot.wasm", &(rgb("intensity", "20, 19, 15") + &float("cutoff_angle", 28.0) + AIM));
    let sky = emitter("constant.wasm", &rgb("radiance", "0.1, 0.2, 0.1"));
    lit_by("modules", &[panel, point, spot, sky].concat(), &library(), 1);
}

/// Brighter to one side than to the other, by uv too, and as bright behind as before: radiance 1.5 + x + u/2, made uniform in z, and about z
/// by the tangent of half the angle, since a module has no sine of its own.
const LOPSIDED: &str = r#"(module
  (memory (export "memory") 1)
  (@custom "bidir.manifest" "{\"name\":\"lopsided\",\"kind\":\"light\",\"emits_from\":[\"area\",\"environment\",\"point\"]}")
  (func (export "bidir_abi") (result i32) (i32.const 65536))
  (func (export "bidir_scratch") (param i32) (result i32) (i32.const 4096))
  (func $answer (param $at i32) (param $u f32) (param $x f32) (param $y f32)
    (local $r f32) (local $t f32) (local $radiance f32)
    (local.set $r (f32.sqrt (f32.add (f32.mul (local.get $x) (local.get $x)) (f32.mul (local.get $y) (local.get $y)))))
    (if (f32.gt (local.get $r) (f32.const 0))
      (then (local.set $t (f32.div (local.get $y) (f32.add (local.get $r) (f32.abs (local.get $x)))))))
    (local.set $radiance (f32.mul (f32.const 3)
      (f32.add (f32.add (f32.const 1.5) (local.get $x)) (f32.mul (f32.const 0.5) (local.get $u)))))
    (f32.store (local.get $at) (local.get $radiance))
    (f32.store offset=4 (local.get $at) (local.get $radiance))
    (f32.store offset=8 (local.get $at) (local.get $radiance))
    (f32.store offset=12 (local.get $at)
      (f32.mul (f32.const 0.0625) (f32.add (f32.const 1) (f32.mul (local.get $t) (local.get $t))))))
  (func (export "light_eval") (param $out i32) (param i32) (param $u f32) (param f32) (param $x f32) (param $y f32) (param f32)
    (call $answer (local.get $out) (local.get $u) (local.get $x) (local.get $y)))
  (func (export "light_emit") (param $out i32) (param i32) (param $u f32) (param f32) (param $a f32) (param $b f32)
    (local $x f32) (local $y f32) (local $z f32) (local $t f32) (local $side f32) (local $r f32)
    (local.set $z (f32.sub (f32.const 1) (f32.mul (f32.const 2) (local.get $a))))
    (local.set $r (f32.sqrt (f32.max (f32.const 0) (f32.sub (f32.const 1) (f32.mul (local.get $z) (local.get $z))))))
    (local.set $side (select (f32.const 1) (f32.const -1) (f32.lt (local.get $b) (f32.const 0.5))))
    (local.set $t (f32.sub (f32.mul (f32.const 4) (select (local.get $b) (f32.sub (local.get $b) (f32.const 0.5))
      (f32.lt (local.get $b) (f32.const 0.5)))) (f32.const 1)))
    (local.set $r (f32.div (local.get $r) (f32.add (f32.const 1) (f32.mul (local.get $t) (local.get $t)))))
    (local.set $x (f32.mul (f32.mul (local.get $side) (local.get $r)) (f32.sub (f32.const 1) (f32.mul (local.get $t) (local.get $t)))))
    (local.set $y (f32.mul (f32.mul (f32.const 2) (local.get $r)) (local.get $t)))
    (f32.store (local.get $out) (local.get $x))
    (f32.store offset=4 (local.get $out) (local.get $y))
    (f32.store offset=8 (local.get $out) (local.get $z))
    (call $answer (i32.add (local.get $out) (i32.const 12)) (local.get $u) (local.get $x) (local.get $y))))"#;

fn lopsided(name: &str, light: &str, effort: u32) {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("lopsided.wasm"), wat::parse_str(LOPSIDED).expect("a module")).expect("a file");
    lit_by(name, light, &Library::new(vec![folder.path().to_owned()]), effort);
}

/// A shape with that light; the room is behind it, too.
fn on(kind: &str) {
    let transform = r#"<scale value="0.4"/><rotate x="1" angle="60"/><translate value="0.6, 1.7, 0.3"/>"#;
    lopsided(&format!("lopsided_{kind}"), &shape(kind, transform, &(diffuse("0.3, 0.3, 0.3") + &emitter("lopsided", ""))), 1);
}

#[test]
fn what_would_shine_backwards_from_a_rectangle() {
    on("rectangle");
}

#[test]
fn what_would_shine_backwards_from_a_disk() {
    on("disk");
}

#[test]
fn what_would_shine_backwards_from_a_sphere() {
    on("sphere");
}

#[test]
fn a_lopsided_profile_at_a_point_and_around() {
    let point = emitter("lopsided", &(r#"<string name="as" value="point"/>"#.to_owned() + AIM));
    lopsided("lopsided_point", &point, 1);
    let turn = r#"<transform name="to_world"><rotate y="1" angle="40"/><rotate x="1" angle="20"/></transform>"#;
    lopsided("lopsided_environment", &emitter("lopsided", &(r#"<string name="as" value="environment"/>"#.to_owned() + turn)), 1);
}
