#!/usr/bin/env bash
# Builds tessera.wasm, the package for npm and the kernels by the preset "wasm", for the tests here and in tests/npm.
#   wasm_build.sh BUILD-FOLDER
# Exit status 77, with a word why, where a tool is missing; 1 with TESSERA_REQUIRE_WASM=1 in the environment.
set -euo pipefail

build=$1
root=$(cd "$(dirname -- "${BASH_SOURCE[0]}")/../.." && pwd)

skip() {
  echo "skipped: $* (tools/setup.sh --for wasm)"
  rm -f "$build/tessera.wasm"
  [[ ${TESSERA_REQUIRE_WASM:-0} != 1 ]] || exit 1
  exit 77
}
command -v clang++-19 >/dev/null || skip "no clang++-19"
command -v wasm-ld-19 >/dev/null || skip "no wasm-ld-19"
command -v node >/dev/null || skip "no node"
[[ -e /usr/lib/llvm-19/lib/wasm32-wasi/libc++.a ]] || skip "no libc++ for wasm32"
[[ -e $root/build/sources/muparser/src/muParserBase.cpp ]] || skip "no source of muParser in build/sources"

cmake --preset wasm -S "$root" -B "$build" >/dev/null
cmake --build "$build" --target tessera_npm tessera_wasm_kernel_jobs
