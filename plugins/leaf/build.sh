#!/bin/sh
# Builds leaf.c: sh build.sh [OUT.wasm]. Needs clang and wasm-ld (Debian: clang, lld).
set -eu
out=$(realpath -m "${1:-$(dirname "$0")/../prebuilt/leaf.wasm}")
cd "$(dirname "$0")"
"${CLANG:-clang}" --target=wasm32 -O3 -ffreestanding -ffp-contract=off -nostdlib -Wall -Wextra -Wno-unused-parameter \
    -Wl,--no-entry -Wl,--stack-first -Wl,-z,stack-size=16384 -Wl,--strip-all -o "$out" leaf.c
chmod 644 "$out"
