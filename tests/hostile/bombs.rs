//! Modules that are small, valid, and slow to compile: refused first, or compiled in bounded time. Compiling cannot be stopped.

use std::{
    fmt::Write,
    time::{Duration, Instant},
};

use super::{GOOD, assembled, load_bytes};

/// Time for compiling on a machine that does other things as well.
const LONG: Duration = Duration::from_secs(20);

/// The good module with these functions at its end; how it fared.
fn explode(name: &str, functions: &str) -> Result<(), String> {
    let end = GOOD.trim_end().strip_suffix(')').expect("a module's end");
    let bytes = assembled(&format!("{end}{functions})"));
    let start = Instant::now();
    let outcome = load_bytes(&bytes).map(|_| ()).map_err(|error| error.to_string());
    println!("{name}: {} bytes, {:?}, {outcome:?}", bytes.len(), start.elapsed());
    assert!(start.elapsed() < LONG, "{name} took {:?}", start.elapsed());
    outcome
}

fn function(locals: usize, body: &str) -> String {
    format!("(func (local {}) {body})", "i32 ".repeat(locals))
}

/// `depth` loops inside each other; the innermost changes all locals, then may go back to each of the loops.
fn loops(locals: usize, depth: usize) -> String {
    let mut body = "loop ".repeat(depth);
    for local in 0..locals {
        let _ = write!(body, "local.get {local} i32.const 1 i32.add local.set {local} ");
    }
    for label in 0..depth {
        let _ = write!(body, "local.get {} br_if {label} ", label % locals);
    }
    body + &"end ".repeat(depth)
}

#[test]
fn many_locals_through_many_loops_are_refused() {
    let said = explode("4,000 loops with 1,000 locals", &function(1000, &loops(1000, 4000))).expect_err("a bomb");
    assert!(said.contains("hostile.wasm: the module has 17 loops inside each other, and may have 16"), "{said}");
    let said = explode("40 × 16 loops with 1,000 locals", &function(1000, &loops(1000, 16)).repeat(40)).expect_err("a bomb");
    assert!(said.contains("branches times locals, and may have 1000000"), "{said}");
}

#[test]
fn loops_within_the_limits_compile_in_bounded_time() {
    explode("30 × 16 loops with 1,000 locals", &function(1000, &loops(1000, 16)).repeat(30)).expect("within the limits");
    explode("140 × 16 loops with 200 locals", &function(200, &loops(200, 16)).repeat(140)).expect("within the limits");
}

#[test]
fn blocks_inside_each_other_are_bounded() {
    let nested = |depth: usize| function(1, &format!("{}{}", "block ".repeat(depth), "end ".repeat(depth)));
    assert!(explode("20,000 blocks", &nested(20_000)).expect_err("a bomb").contains("blocks inside each other"));
    explode("16 × 1,000 blocks", &nested(1000).repeat(16)).expect("within the limits");
}

#[test]
fn wide_blocks_are_refused() {
    let wide = format!("(func (param {}))", "i32 ".repeat(101));
    assert!(explode("101 parameters", &wide).expect_err("a bomb").contains("101 parameters and results of one type, and may have 100"));
}

#[test]
fn branches_on_all_locals_compile_in_bounded_time() {
    let mut body = String::new();
    for i in 0..900 {
        let _ = write!(
            body,
            "local.get {} if i32.const {i} local.set {} else local.get {} local.set {} end ",
            i % 500,
            i % 499,
            i % 7,
            i % 500
        );
    }
    explode("900 ifs with 500 locals", &function(500, &body)).expect("within the limits");
}

#[test]
fn a_table_of_all_branches_compiles_in_bounded_time() {
    let labels: String = (0..30_000).map(|i| format!("{} ", i % 100)).collect();
    let body = format!("{} local.get 0 br_table {labels} {}", "block ".repeat(100), "end ".repeat(100));
    explode("a table of 30,000", &function(10, &body)).expect("within the limits");
}

#[test]
fn ten_thousand_functions_compile_in_bounded_time() {
    let body = "local.get 0 i32.const 3 i32.mul local.get 1 i32.add i32.load local.tee 2 i32.const 7 i32.xor local.set 1 ".repeat(3);
    explode("9,900 functions", &function(4, &body).repeat(9_900)).expect("within the limits");
    assert!(explode("10,001 functions", &"(func)".repeat(9_997)).expect_err("too many").contains("10001 functions, and may have 10000"));
}

#[test]
fn one_long_expression_compiles_in_bounded_time() {
    let long = format!("local.get 0 {} local.set 0", "local.get 0 i32.mul ".repeat(20_000));
    explode("long products", &function(1, &long).repeat(16)).expect("within the limits");
    let deep = format!("{} local.set 0", "local.get 0 ".repeat(13_000) + "local.get 0 " + &"i32.mul ".repeat(13_000));
    explode("deep products", &function(1, &deep).repeat(16)).expect("within the limits");
    let memory = "local.get 0 local.get 0 i32.load local.tee 0 i32.store ".repeat(5_000);
    explode("loads and stores", &function(1, &memory).repeat(16)).expect("within the limits");
    let roots = "local.get 0 f64.convert_i32_s f64.sqrt f64.floor i32.trunc_sat_f64_s local.set 0 ".repeat(6_000);
    explode("roots", &function(1, &roots).repeat(16)).expect("within the limits");
}
