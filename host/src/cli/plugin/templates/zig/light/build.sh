#!/bin/sh
# Builds {{name}}.wasm. Needs Zig (pip install ziglang, or any zig as ZIG).
set -eu
cd "$(dirname "$0")"
${ZIG:-python3 -m ziglang} build-exe shader.zig -target wasm32-freestanding -O ReleaseFast -fstrip -fno-entry --stack 16384 \
    --export=bidir_abi --export=bidir_scratch --export=light_eval --export=light_emit -femit-bin={{name}}.wasm
