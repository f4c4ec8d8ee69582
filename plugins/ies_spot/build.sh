#!/bin/sh
# Builds iesspot.ts: sh build.sh [OUT.wasm]. Needs Node.js and AssemblyScript (npm: assemblyscript@0.28.20).
set -eu
out=$(realpath -m "${1:-$(dirname "$0")/../prebuilt/iesspot.wasm}")
cd "$(dirname "$0")"
"${ASC:-asc}" iesspot.ts --runtime stub --use abort= -O3 --noAssert --converge --initialMemory 1 --transform ./manifest.mjs \
    --outFile "$out"
