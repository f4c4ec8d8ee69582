#!/bin/sh
# Builds {{name}}.wasm. Needs clang and wasm-ld (Debian: apt-get install clang lld).
set -eu
cd "$(dirname "$0")"
"${CLANG:-clang}" --target=wasm32 -O3 -ffreestanding -ffp-contract=off -nostdlib -Wall -Wextra -Wno-unused-parameter \
    -Wl,--no-entry -Wl,--stack-first -Wl,-z,stack-size=16384 -Wl,--strip-all -o {{name}}.wasm shader.c
