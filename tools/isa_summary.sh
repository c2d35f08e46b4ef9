#!/usr/bin/env bash
# Prints one line that says which instruction sets ctest has tested, and which ones were skipped.
set -euo pipefail

if [[ $# -ne 1 || $1 == -h || $1 == --help ]]; then
  cat <<'TEXT'
tools/isa_summary.sh RESULTS.xml

Reads the results that `ctest --output-junit RESULTS.xml` has written, and counts the tests of each instruction set: those named
SUITE.sse2, SUITE.avx2, SUITE.avx512 and SUITE.neon64. A test is skipped if the machine lacks the instruction set, or the
programs that stand in for it. Prints nothing if none of these tests was selected.
TEXT
  (($# == 1)) && exit 0 || exit 2
fi

awk '
/<testcase / {
  if (!match($0, /name="[^"]*\.(sse2|avx2|avx512|neon64)"/)) next
  isa = substr($0, RSTART, RLENGTH - 1)
  sub(/.*\./, "", isa)
  state = /status="run"/ ? "passed" : /status="fail"/ ? "failed" : "skipped"
  ++count[isa, state]
  seen[isa] = 1
}
END {
  split("sse2 avx2 avx512 neon64", order, " ")
  for (k = 1; k <= 4; ++k) {
    isa = order[k]
    if (!(isa in seen)) continue
    text = ""
    split("passed failed skipped", states, " ")
    for (s = 1; s <= 3; ++s)
      if (count[isa, states[s]]) text = text (text == "" ? "" : " and ") count[isa, states[s]] " " states[s]
    line = line (line == "" ? "" : ", ") isa " " text
  }
  if (line != "") print "instruction sets: " line
}' "$1"
