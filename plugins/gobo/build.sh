#!/bin/sh
# Builds gobo.zig: sh build.sh [OUT.wasm]. Needs Zig (PyPI: ziglang==0.17.1).
set -eu
out=$(realpath -m "${1:-$(dirname "$0")/../prebuilt/gobo.wasm}")
cd "$(dirname "$0")"
${ZIG:-python3 -m ziglang} build-exe gobo.zig -target wasm32-freestanding -O ReleaseFast -fstrip -fno-entry --stack 16384 \
    --export=bidir_abi --export=bidir_scratch --export=light_eval --export=light_emit -femit-bin="$out"
chmod 644 "$out"
