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
headers=$1/engine/include/tessera
cp "$headers"/tessera_c*.h "$scratch/tessera"
plant() {
  local header=$1
  sed "$2" "$headers/$header" >"$scratch/tessera/$header"
  if cmp -s "$headers/$header" "$scratch/tessera/$header"; then
    echo "nothing was planted: $2" >&2
    exit 1
  fi
  if "$abi" check "$library" "$scratch" >"$scratch/report" 2>&1; then
    echo "a change was not found: $2" >&2
    cat "$scratch/report" >&2
    exit 1
  fi
  grep -q "the binary interface changed" "$scratch/report"
  cp "$headers/$header" "$scratch/tessera"
}
plant tessera_c.h 's/int32_t degree_u, degree_v; /int32_t degree_v, degree_u; /'
plant tessera_c.h 's/  double fit_tolerance;/  double more, fit_tolerance;/'
plant tessera_c.h 's/  uint64_t unused_loops;/  uint64_t unused_loops, more;/'
plant tessera_c.h \
  's/size_t count, const double\* points, size_t point_count);/size_t count, const float* points, size_t point_count);/'
plant tessera_c_queries.h 's/  double volume, volume_error; /  double volume_error, volume; /'
