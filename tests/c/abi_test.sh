#!/usr/bin/env bash
# The binary interface is that of the reference, and changes that were planted are found.
# Usage: abi_test.sh SOURCES LIBRARY
set -euo pipefail
abi="$1/tools/c_abi.sh"
library=$2
"$abi" check "$library" || exit $?

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/tessera"
header=$1/engine/include/tessera/tessera_c.h
plant() {
  sed "$1" "$header" >"$scratch/tessera/tessera_c.h"
  if cmp -s "$header" "$scratch/tessera/tessera_c.h"; then
    echo "nothing was planted: $1" >&2
    exit 1
  fi
  if "$abi" check "$library" "$scratch" >"$scratch/report" 2>&1; then
    echo "a change was not found: $1" >&2
    cat "$scratch/report" >&2
    exit 1
  fi
  grep -q "the binary interface changed" "$scratch/report"
}
plant 's/int32_t degree_u, degree_v; /int32_t degree_v, degree_u; /'
plant 's/  double fit_tolerance;/  double more, fit_tolerance;/'
plant 's/  uint64_t unused_loops;/  uint64_t unused_loops, more;/'
plant 's/size_t count, const double\* points, size_t point_count);/size_t count, const float* points, size_t point_count);/'
