//! Modules that are refused when they are loaded (rows 61 to 64), with what was expected.

use std::fs;

use bidir::plugin::Module;

use super::{Dice, GOOD, assembled, broken, engine, load, load_bytes, refuses};

const MEMORY: &str = r#"(memory (export "memory") 1)"#;
const SCRATCH: &str = "i32.const 1024";

#[test]
fn memories_tables_and_globals_have_limits() {
    refuses(&broken(MEMORY, r#"(memory (export "memory") 257)"#), &["its memory has 16842752 bytes, and may have 16777216"]);
    refuses(&broken(MEMORY, r#"(memory (export "memory") 65536)"#), &["its memory has 4294967296 bytes"]);
    refuses(&broken(MEMORY, &format!("{MEMORY} (table 10001 funcref)")), &["10001 table entries, and may have 10000"]);
    refuses(&broken(MEMORY, &format!("{MEMORY} (table 4294967295 funcref)")), &["table entries, and may have 10000"]);
    refuses(&broken(MEMORY, &format!("{MEMORY} (table 1 funcref) (table 1 funcref)")), &["2 tables, and may have 1"]);
    let globals = "(global i32 (i32.const 0))".repeat(1001);
    refuses(&broken(MEMORY, &format!("{MEMORY} {globals}")), &["1001 globals, and may have 1000"]);
    refuses(&broken(MEMORY, &format!("{MEMORY} (memory 1)")), &["one memory"]);
}

#[test]
fn every_import_is_refused_by_name() {
    for kind in ["(func)", "(memory 1)", "(global i32)", "(table 1 funcref)"] {
        let import = format!(r#"(import "env" "thing" {kind})"#);
        refuses(&broken("(memory (export", &format!("{import} (memory (export")), &[r#"imports "thing" from "env""#]);
    }
}

#[test]
fn a_missing_export_is_refused_with_its_signature() {
    let needed = [
        ("bidir_abi", "() -> (i32)"),
        ("bidir_scratch", "(i32) -> (i32)"),
        ("bsdf_eval", "(i32 i32 i32 f32 f32 f32 f32 f32 f32) -> ()"),
        ("bsdf_sample", "(i32 i32 i32 f32 f32 f32 f32 f32 f32) -> ()"),
    ];
    for (export, signature) in needed {
        let module = broken(&format!(r#"(export "{export}")"#), r#"(export "another")"#);
        refuses(&module, &[&format!("exports no \"{export}\""), signature]);
    }
    refuses(&broken(r#"(export "memory")"#, r#"(export "another")"#), &["one memory, and to export it as \"memory\""]);
}

#[test]
fn an_export_of_another_type_is_refused_with_both() {
    refuses(&broken("(result i32) i32.const 65536", "(result i64) i64.const 65536"), &["\"bidir_abi\" is () -> (i64)", "() -> (i32)"]);
    refuses(&broken("(param i32) (result i32)", "(param i32 i32) (result i32)"), &["\"bidir_scratch\" is (i32 i32) -> (i32)"]);
    refuses(&broken("(param f32 f32 f32 f32 f32 f32)", "(param f64 f32 f32 f32 f32 f32)"), &["\"bsdf_eval\" is (i32 i32 i32 f64"]);
    let other = r#"(global (export "bidir_abi") i32 (i32.const 65536)) (func"#;
    refuses(&broken(r#"(func (export "bidir_abi")"#, other), &["exports no \"bidir_abi\""]);
    let optional = r#"(func (export "bsdf_eval_n")) (func (export "bsdf_sample")"#;
    refuses(&broken(r#"(func (export "bsdf_sample")"#, optional), &["\"bsdf_eval_n\" is () -> ()", "(i32 i32 i32 i32) -> ()"]);
    let optional = r#"(func (export "bsdf_vertex") (param i32)) (func (export "bsdf_sample")"#;
    refuses(&broken(r#"(func (export "bsdf_sample")"#, optional), &["\"bsdf_vertex\" is (i32) -> ()", "(i32 i32 i32 f32 f32"]);
}

#[test]
fn another_version_is_refused_with_ours() {
    for (major, minor) in [(0u32, 9), (1, 1), (2, 0), (65535, 65535)] {
        let module = broken("i32.const 65536", &format!("i32.const {}", (major << 16 | minor) as i32));
        refuses(&module, &[&format!("version {major}.{minor} of the plugin ABI; this program takes 1.0 to 1.0")]);
    }
}

#[test]
fn a_module_cut_off_anywhere_is_refused() {
    let bytes = assembled(GOOD);
    // Without the names of its variables, which come last, it is whole.
    let names = bytes.windows(5).position(|window| window == b"\x04name").expect("names");
    for length in 0..names - 3 {
        let error = load_bytes(&bytes[..length]).expect_err(&format!("{length} bytes of {} load", bytes.len()));
        assert!(error.to_string().starts_with("hostile.wasm"), "{error}");
    }
}

#[test]
fn empty_and_random_files_are_refused() {
    assert!(load_bytes(&[]).expect_err("empty").to_string().contains("the file is empty"));
    let mut dice = Dice(58);
    for length in 1..500 {
        let mut bytes: Vec<u8> = (0..length).map(|_| dice.below(256) as u8).collect();
        let said = load_bytes(&bytes).expect_err("noise").to_string();
        assert!(said.contains("the file is not a WebAssembly module"), "{said}");
        // The same behind a good header.
        bytes.splice(0..0, *b"\0asm\x01\0\0\0");
        assert!(load_bytes(&bytes).expect_err("noise").to_string().starts_with("hostile.wasm"));
    }
    assert!(load_bytes(b"\0asm\x0d\0\x01\0").expect_err("a component").to_string().contains("a component, not a core module"));
}

#[test]
fn a_file_of_a_hundred_megabytes_is_refused_unread() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("large.wasm");
    fs::File::create(&path).expect("a file").set_len(100 << 20).expect("a long file");
    let said = Module::load(engine(), &path).expect_err("too large").to_string();
    assert!(said.contains("large.wasm") && said.contains("104857600 bytes, and a plugin may have 1048576"), "{said}");
    let bytes = vec![0; (1 << 20) + 1];
    assert!(load_bytes(&bytes).expect_err("too large").to_string().contains("1048577 bytes"));
}

#[test]
fn scratch_outside_memory_or_unaligned_is_refused() {
    let gives = |address: &str, words: &[&str]| {
        refuses(&broken(SCRATCH, &format!("i32.const {address}")), &[&["bidir_scratch"], words].concat());
    };
    gives("0", &["no room"]);
    gives("-16", &["at address 4294967280, but its memory ends at 65536"]);
    gives("65536", &["at address 65536, but its memory ends at 65536"]);
    gives("65488", &["64 bytes at address 65488, but its memory ends"]);
    for address in ["1", "4", "1032", "-1"] {
        gives(address, &["not a multiple of 16"]);
    }
    load(&broken(SCRATCH, "i32.const 65472")).expect("the last 64 bytes are as good as others");
}

#[test]
fn scratch_too_small_for_the_parameters_is_refused() {
    let parameters = r#"[\"delta_reflection\"], \"params\": [{\"name\": \"far\", \"type\": \"float\", \"offset\": 4092, \"default\": 0}]"#;
    let module = broken(r#"[\"delta_reflection\"]"#, parameters);
    load(&module).expect("4096 bytes of parameters");
    let far = module.replacen(SCRATCH, "i32.const 65472", 1);
    refuses(&far, &["bidir_scratch", "4160 bytes at address 65472, but its memory ends at 65536"]);
}

/// The good module under this manifest.
fn manifest(json: &str) -> String {
    let good = r#"{\"name\": \"mirror\", \"kind\": \"bsdf\", \"lobes\": [\"delta_reflection\"]}"#;
    broken(good, &json.replace('"', "\\\""))
}

fn parameters(list: &str) -> String {
    manifest(&format!(r#"{{"name": "x", "kind": "bsdf", "lobes": ["delta_reflection"], "params": [{list}]}}"#))
}

#[test]
fn a_bad_manifest_is_refused_with_the_reason() {
    refuses(&broken("bidir.manifest", "another.name"), &["it holds no section \"bidir.manifest\", and there is no hostile.json"]);
    refuses(&manifest("no json"), &["its manifest is not as the ABI page has it"]);
    refuses(&manifest(""), &["its manifest is not as the ABI page has it"]);
    let deep = format!(r#"{{"name": "x", "type": "float", "offset": 0, "default": {}"#, "[".repeat(100_000));
    refuses(&parameters(&deep), &["its manifest is not as the ABI page has it", "recursion"]);
    refuses(&manifest(r#"{"name": 5, "kind": "bsdf", "lobes": []}"#), &["its manifest", "expected a string"]);
    refuses(&manifest(r#"{"name": "x", "kind": "cloud"}"#), &["its manifest", "cloud"]);
    refuses(&manifest(r#"{"name": "x", "kind": "bsdf"}"#), &["names no \"lobes\""]);
    refuses(
        &manifest(r#"{"name": "x", "kind": "bsdf", "lobes": ["shiny"]}"#),
        &["the lobe \"shiny\", which is none of diffuse_reflection"],
    );
    refuses(&manifest(r#"{"name": "x", "kind": "light"}"#), &["\"emits_from\""]);
}

#[test]
fn bad_parameters_are_refused_by_name() {
    refuses(&parameters(r#"{"name": "far", "type": "float", "offset": 4096, "default": 0}"#), &["\"far\"", "past the 4096 bytes"]);
    refuses(&parameters(r#"{"name": "far", "type": "rgb", "offset": 4088, "default": 0}"#), &["\"far\"", "past the 4096 bytes"]);
    refuses(&parameters(r#"{"name": "far", "type": "float", "offset": 4294967292, "default": 0}"#), &["\"far\"", "past the 4096 bytes"]);
    refuses(&parameters(r#"{"name": "odd", "type": "float", "offset": 2, "default": 0}"#), &["\"odd\"", "not a multiple of 4"]);
    let (a, b) =
        (r#"{"name": "a", "type": "rgb", "offset": 0, "default": 0}"#, r#"{"name": "b", "type": "float", "offset": 8, "default": 0}"#);
    refuses(&parameters(&format!("{a}, {b}")), &["\"a\" and \"b\" of one name or in one place"]);
    refuses(&parameters(&format!("{a}, {a}")), &["\"a\" and \"a\" of one name or in one place"]);
    refuses(
        &parameters(r#"{"name": "x", "type": "float", "offset": 0, "default": "red"}"#),
        &["\"x\"", "default", "not of its type, float"],
    );
    refuses(&parameters(r#"{"name": "x", "type": "float", "offset": 0, "default": 2, "max": 1}"#), &["\"x\"", "whose default is 2"]);
    refuses(&parameters(r#"{"name": "x", "type": "float", "offset": 0, "default": 1e60}"#), &["\"x\"", "whose default is inf"]);
    refuses(&parameters(r#"{"name": "x", "type": "matrix", "offset": 0, "default": 1}"#), &["its manifest", "matrix"]);
}
