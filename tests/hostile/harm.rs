//! Calls that do not end, or end badly (rows 59 to 61): stopped soon, and named.

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use bidir::plugin::{Cause, Fault, Module, Strictness};
use bidir_kernel::{Bsdf, Carried, Profile, Vec2, Vec3};

use super::{broken, load, refuses, sandbox};

const HARM: &str = include_str!("modules/harm.wat");
const HARM_LIGHT: &str = include_str!("modules/harm_light.wat");

/// What the modules' parameters mean.
const ENDLESS: i32 = 1;
const RECURSION: i32 = 2;
const OUTSIDE: i32 = 3;
const GIVES_UP: i32 = 4;
const DIVISION: i32 = 5;
const GREED: i32 = 6;

/// A processor's second is shared with whatever else runs; the call itself is stopped after about 60 ms.
const SOON: Duration = Duration::from_secs(1);

/// What a call of an export does that is told to do harm.
fn call(export: &str, harm: i32) -> Option<Fault> {
    let light = export.starts_with("light");
    let module: Arc<Module> = load(if light { HARM_LIGHT } else { HARM }).expect("a module that loads");
    let parameters = if export.ends_with("eval") { [harm, 0] } else { [0, harm] };
    let (sandbox, shader) = sandbox(&module, parameters.map(i32::to_le_bytes).as_flattened(), Strictness::Lenient);
    let start = Instant::now();
    match export {
        "bsdf_eval" => assert!(sandbox.bsdf(shader).eval(Vec3::Z, Vec3::Z, Carried::Radiance).value.is_black()),
        "bsdf_sample" => assert!(sandbox.bsdf(shader).sample(Vec3::Z, [0.5; 3], Carried::Radiance).is_none()),
        "light_eval" => assert!(sandbox.profile(shader).eval(Vec2::new(0.5, 0.5), Vec3::Z).radiance.is_black()),
        _ => assert!(sandbox.profile(shader).emit(Vec2::new(0.5, 0.5), [0.5; 2]).is_none()),
    }
    println!("{export}, harm {harm}: {:?}", start.elapsed());
    assert!(start.elapsed() < SOON, "{export} took {:?}", start.elapsed());
    sandbox.fault()
}

const EXPORTS: [&str; 4] = ["bsdf_eval", "bsdf_sample", "light_eval", "light_emit"];

#[test]
fn an_endless_call_is_stopped_and_named() {
    for export in EXPORTS {
        let fault = call(export, ENDLESS).expect("a fault");
        assert_eq!((fault.export, &fault.cause), (export, &Cause::Endless));
        assert!(fault.to_string().starts_with(&format!("hostile.wasm: {export}: one call ran for more than 50 ms")), "{fault}");
    }
}

#[test]
fn every_trap_is_named() {
    let traps = [
        (RECURSION, "ran out of stack"),
        (OUTSIDE, "reached outside its memory"),
        (GIVES_UP, "gave up"),
        (DIVISION, "divided an integer by 0"),
    ];
    for export in EXPORTS {
        for (harm, words) in traps {
            let fault = call(export, harm).expect("a fault");
            assert_eq!(fault.export, export);
            assert!(matches!(&fault.cause, Cause::Trap(why) if why.contains(words)), "{fault}");
        }
    }
}

#[test]
fn memory_ends_at_its_limit_and_the_call_goes_on() {
    for export in EXPORTS {
        assert_eq!(call(export, GREED), None);
    }
}

const LOOP: &str = "(loop $ever (br $ever))";

fn refuses_soon(module: &str, words: &[&str]) {
    let start = Instant::now();
    refuses(module, words);
    println!("{words:?}: {:?}", start.elapsed());
    assert!(start.elapsed() < SOON, "{words:?} took {:?}", start.elapsed());
}

#[test]
fn a_start_function_that_does_not_end_is_stopped() {
    let memory = r#"(memory (export "memory") 1)"#;
    refuses_soon(&broken(memory, &format!("{memory} (func $start {LOOP}) (start $start)")), &["start", "one call ran for more than 50 ms"]);
}

#[test]
fn a_start_function_that_traps_is_named() {
    let memory = r#"(memory (export "memory") 1)"#;
    refuses_soon(&broken(memory, &format!("{memory} (func $start unreachable) (start $start)")), &["start", "gave up"]);
    refuses_soon(&broken(memory, &format!("{memory} (func $start (call $start)) (start $start)")), &["start", "ran out of stack"]);
}

#[test]
fn a_version_or_scratch_that_does_not_end_is_stopped() {
    refuses_soon(&broken("i32.const 65536", &format!("{LOOP} i32.const 0")), &["bidir_abi", "one call ran for more than 50 ms"]);
    refuses_soon(&broken("i32.const 1024", &format!("{LOOP} i32.const 0")), &["bidir_scratch", "one call ran for more than 50 ms"]);
}

#[test]
fn segments_outside_memory_and_table_are_named() {
    let memory = r#"(memory (export "memory") 1)"#;
    refuses(&broken(memory, &format!(r#"{memory} (data (i32.const 65535) "ab")"#)), &["start", "reached outside its memory"]);
    let table = "(table 1 funcref) (elem (i32.const 1) func 0)";
    refuses(&broken(memory, &format!("{memory} {table}")), &["start", "table"]);
}

#[test]
fn memory_for_ever_is_bounded_at_load() {
    let greedy = "(loop $more (br_if $more (i32.ne (memory.grow (i32.const 1)) (i32.const -1)))) i32.const 1024";
    load(&broken("i32.const 1024", greedy)).expect("greed is no crime: it gets 16 MiB");
}
