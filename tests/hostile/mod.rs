//! Modules that mean harm, or are broken: each gets its named error, and the rest goes on.

mod answers;
mod bombs;
mod harm;
mod mutations;
mod pictures;
mod refused;

use std::{
    path::Path,
    sync::{Arc, OnceLock},
};

use bidir::{
    error::Result,
    plugin::{Engine, Module, Roster, Sandbox, ShaderId, Strictness},
};

const GOOD: &str = include_str!("modules/good.wat");

/// One engine for all: it takes a long stretch of addresses.
fn engine() -> &'static Engine {
    static ENGINE: OnceLock<Engine> = OnceLock::new();
    ENGINE.get_or_init(|| Engine::new().expect("a machine that runs WebAssembly"))
}

fn assembled(text: &str) -> Vec<u8> {
    wat::parse_str(text).expect("text that is well formed")
}

fn load_bytes(bytes: &[u8]) -> Result<Arc<Module>> {
    Module::from_bytes(engine(), Path::new("hostile.wasm"), bytes, None).map(Arc::new)
}

fn load(text: &str) -> Result<Arc<Module>> {
    load_bytes(&assembled(text))
}

/// The good module with one thing in it replaced.
fn broken(good: &str, bad: &str) -> String {
    assert!(GOOD.contains(good), "good.wat does not hold {good}");
    GOOD.replacen(good, bad, 1)
}

/// Refused when it is loaded: the message names the file and holds `words`.
fn refuses(module: &str, words: &[&str]) {
    let said = load(module).expect_err(&format!("loaded, and should not: {words:?}")).to_string();
    for word in ["hostile.wasm"].iter().chain(words) {
        assert!(said.contains(word), "\"{word}\" is not in: {said}");
    }
}

/// A sandbox with one shader, its parameter block as it stands.
fn sandbox(module: &Arc<Module>, block: &[u8], strictness: Strictness) -> (Sandbox, ShaderId) {
    let mut roster = Roster::default();
    let shader = roster.add(module, block);
    (Sandbox::new(Arc::new(roster), strictness), shader)
}

/// Random numbers (SplitMix64).
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    fn below(&mut self, end: usize) -> usize {
        (self.roll() % end as u64) as usize
    }

    fn number(&mut self) -> f32 {
        (self.roll() >> 40) as f32 / (1 << 24) as f32
    }
}

#[test]
fn the_module_that_the_others_break_is_good() {
    load(GOOD).expect("a good module");
}
