#!/usr/bin/env bash
# Compares the results of tessera.wasm in Node with those of the native library.
#   wasm_test.sh NATIVE-RESULTS NATIVE-KERNEL-JOBS BUILD-FOLDER
# Exit status 77, with a word why, where wasm_build.sh has built nothing.
set -euo pipefail

results=$1
jobs=$2
build=$3
source=$(cd "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$source/../.." && pwd)

skip() {
  echo "skipped: $*"
  exit 77
}
[[ -e $build/tessera.wasm ]] || skip "tessera.wasm was not built"

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
