//! Narrated programs, one lesson each: run one with `cargo run --release -p bidir-examples --example NAME`.
