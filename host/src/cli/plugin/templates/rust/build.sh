#!/bin/sh
# Builds {{name}}.wasm. Needs the target: rustup target add wasm32-unknown-unknown.
set -eu
cd "$(dirname "$0")"
cargo build --release --target wasm32-unknown-unknown --target-dir target
cp target/wasm32-unknown-unknown/release/{{name}}.wasm {{name}}.wasm
