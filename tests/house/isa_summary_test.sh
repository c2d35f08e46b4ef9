#!/usr/bin/env bash
# Tests tools/isa_summary.sh on results as ctest writes them.
#   isa_summary_test.sh SCRIPT
set -euo pipefail

script=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# Writes results with these tests, each as NAME=STATUS.
results() {
  {
    printf '<?xml version="1.0" encoding="UTF-8"?>\n<testsuite name="Linux-c++" tests="9">\n'
    for test in "$@"; do
      printf '\t<testcase name="%s" classname="%s" time="0.5" status="%s">\n\t\t<system-out>a.sse2</system-out>\n\t</testcase>\n' \
        "${test%=*}" "${test%=*}" "${test#*=}"
    done
    printf '</testsuite>\n'
  } >"$folder/results.xml"
}

expect() {
  local found
  found=$("$script" "$folder/results.xml")
  [[ $found == "$1" ]] || { printf 'found  "%s"\nwanted "%s"\n' "$found" "$1" >&2; exit 1; }
}

results eval.sse2=run io.sse2=run eval.avx2=run io.avx2=fail eval.avx512=notrun io.avx512=notrun kernel.neon64=run Bpt.One=run
expect "instruction sets: sse2 2 passed, avx2 1 passed and 1 failed, avx512 2 skipped, neon64 1 passed"
results kernel.neon64=notrun eval.avx2=run
expect "instruction sets: avx2 1 passed, neon64 1 skipped"
results Bpt.One=run
expect ""
