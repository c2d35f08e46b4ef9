#!/usr/bin/env bash
# Builds tessera.wasm by the preset "wasm" and compares its results in Node with those of the native library.
#   wasm_test.sh NATIVE-RESULTS NATIVE-KERNEL-JOBS BUILD-FOLDER
# Exit status 77, with a word why, where a tool is missing; 1 with TESSERA_REQUIRE_WASM=1 in the environment.
set -euo pipefail

results=$1
jobs=$2
build=$3
source=$(cd "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$source/../.." && pwd)

skip() {
  echo "skipped: $* (tools/setup.sh --for wasm)"
  [[ ${TESSERA_REQUIRE_WASM:-0} != 1 ]] || exit 1
  exit 77
}
command -v clang++-19 >/dev/null || skip "no clang++-19"
command -v wasm-ld-19 >/dev/null || skip "no wasm-ld-19"
command -v node >/dev/null || skip "no node"
[[ -e /usr/lib/llvm-19/lib/wasm32-wasi/libc++.a ]] || skip "no libc++ for wasm32"
[[ -e $root/build/sources/muparser/src/muParserBase.cpp ]] || skip "no source of muParser in build/sources"

cmake --preset wasm -S "$root" -B "$build" >/dev/null
cmake --build "$build" --target tessera_wasm tessera_wasm_kernel_jobs

"$jobs" sse2 >"$build/sse2.txt" || skip "no SSE2 to compare with"
node --no-warnings "$source/wasi_program.mjs" "$build/kernel_jobs.wasm" wasm128 >"$build/wasm128.txt"
lines=$(wc -l <"$build/wasm128.txt")
((lines > 1000)) || { echo "only $lines outputs were made" >&2; exit 1; }
if ! diff "$build/sse2.txt" "$build/wasm128.txt" >"$build/kernels.diff"; then
  head -40 "$build/kernels.diff"
  echo "the bytes of wasm128 differ from those of sse2 in $(grep -c '^>' "$build/kernels.diff") of $lines outputs" >&2
  exit 1
fi
echo "$lines outputs of kernels: the bytes of wasm128 are those of sse2"
node "$source/compare.mjs" "$build/tessera.wasm" "$results" "$root" ${TESSERA_TEST_DATA:+"$TESSERA_TEST_DATA"}
