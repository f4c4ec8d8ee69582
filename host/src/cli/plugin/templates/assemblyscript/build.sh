#!/bin/sh
# Builds {{name}}.wasm. Needs Node.js and AssemblyScript (npm install --global assemblyscript).
set -eu
cd "$(dirname "$0")"
"${ASC:-asc}" shader.ts --runtime stub --use abort= -O3 --noAssert --converge --initialMemory 1 --transform ./manifest.mjs \
    --outFile {{name}}.wasm
