#!/usr/bin/env bash
# Tests tools/test_summary.sh on results as ctest writes them.
#   test_summary_test.sh SCRIPT
set -euo pipefail

script=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# Writes results with these tests, each as NAME=STATUS. Their outputs have six lines.
results() {
  {
    printf '<?xml version="1.0" encoding="UTF-8"?>\n<testsuite name="Linux-c++" tests="9">\n'
    for test in "$@"; do
      printf '\t<testcase name="%s" classname="%s" time="0.5" status="%s">\n' "${test%=*}" "${test%=*}" "${test#*=}"
      [[ $test != *=fail ]] || printf '\t\t<failure message="Failed"/>\n'
      printf '\t\t<system-out>first\nsecond\n\na.sse2\n1 &lt; 2 &amp;&amp; &quot;b&quot;\n%s\n\nlast</system-out>\n\t</testcase>\n' "${test%=*}"
    done
    printf '</testsuite>\n'
  } >"$folder/results.xml"
}

expect() {
  local found
  found=$("$script" "$folder/results.xml")
  [[ $found == "$1" ]] || { printf 'found  "%s"\nwanted "%s"\n' "$found" "$1" >&2; exit 1; }
}

ending() { printf 'failed: %s\n  second\n  a.sse2\n  1 < 2 && "b"\n  %s\n  last' "$1" "$1"; }
results eval.sse2=run io.sse2=run eval.avx2=run io.avx2=fail eval.avx512=notrun io.avx512=notrun kernel.neon64=run Bpt.One=run
expect "instruction sets: sse2 2 passed, avx2 1 passed and 1 failed, avx512 2 skipped, neon64 1 passed
$(ending io.avx2)"
results kernel.neon64=notrun eval.avx2=run
expect "instruction sets: avx2 1 passed, neon64 1 skipped"
results Bpt.One=run
expect ""

results eval.avx2=run io.avx2=fail Bpt.One=fail Bpt.Two=run
expect "instruction sets: avx2 1 passed and 1 failed
$(ending io.avx2)
$(ending Bpt.One)"
results T.{1..12}=fail
[[ $("$script" "$folder/results.xml" | tail -n 1) == "and 2 tests more failed" ]] || { echo "no word of the tests left out" >&2; exit 1; }
