#!/usr/bin/env bash
# The kernels for NEON give the bytes of AVX2 and AVX-512: builds kernel_jobs for AArch64 with Debian's cross compiler,
# runs it under qemu, and compares its lines with those of the native one.
#   neon64_test.sh NATIVE-KERNEL-JOBS BUILD-FOLDER
# Exit status 77, with a word why, where the compiler, qemu or an instruction set to compare with is missing.
set -euo pipefail

native=$1
build=$2
source=$(cd "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)

skip() {
  echo "skipped: $*"
  exit 77
}
command -v aarch64-linux-gnu-g++ >/dev/null || skip "no aarch64-linux-gnu-g++ (Debian: g++-aarch64-linux-gnu)"
qemu=$(command -v qemu-aarch64 || command -v qemu-aarch64-static) || skip "no qemu-aarch64 (Debian: qemu-user)"
mkdir -p "$build"
references=()
for isa in avx2 avx512; do
  status=0
  "$native" "$isa" >"$build/$isa.txt" || status=$?
  ((status == 0 || status == 2)) || { echo "the native program failed on $isa with status $status" >&2; exit 1; }
  ((status == 0)) && references+=("$isa")
done
((${#references[@]})) || skip "this machine has neither AVX2 nor AVX-512 to compare with"

cmake -S "$source" -B "$build/cross" -G Ninja -D CMAKE_BUILD_TYPE=Release -D TESSERA_WARNINGS_AS_ERRORS=ON \
  -D CMAKE_SYSTEM_NAME=Linux -D CMAKE_SYSTEM_PROCESSOR=aarch64 -D CMAKE_CXX_COMPILER=aarch64-linux-gnu-g++
cmake --build "$build/cross"
"$qemu" "$build/cross/kernel_jobs" neon64 >"$build/neon64.txt"

lines=$(wc -l <"$build/neon64.txt")
((lines > 1000)) || { echo "only $lines outputs were made" >&2; exit 1; }
for isa in "${references[@]}"; do
  if ! diff "$build/$isa.txt" "$build/neon64.txt" >"$build/$isa.diff"; then
    head -40 "$build/$isa.diff"
    echo "NEON's bytes differ from those of $isa in $(grep -c '^>' "$build/$isa.diff") of $lines outputs" >&2
    exit 1
  fi
done
echo "$lines outputs: the bytes of neon64 are those of ${references[*]}"
