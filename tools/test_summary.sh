#!/usr/bin/env bash
# Prints which instruction sets ctest has tested, and how the output of each failed test ended.
set -euo pipefail

if [[ $# -ne 1 || $1 == -h || $1 == --help ]]; then
  cat <<'TEXT'
tools/test_summary.sh RESULTS.xml

Reads the results that `ctest --output-junit RESULTS.xml` has written. Counts the tests of each instruction set: those named
SUITE.sse2, SUITE.avx2, SUITE.avx512 and SUITE.neon64. A test is skipped if the machine lacks the instruction set, or the
programs that stand in for it. Then prints the last 5 lines of output of each failed test, for up to 10 of them. Prints nothing
if none of these tests was selected and none failed.
TEXT
  (($# == 1)) && exit 0 || exit 2
fi

awk '
/<testcase / {
  match($0, / name="[^"]*"/)
  failing = /status="fail"/ ? substr($0, RSTART + 7, RLENGTH - 8) : ""
}
failing != "" && /<system-out>/ {
  sub(/^.*<system-out>/, "")
  printing = 1
  split("", last)
  lines = 0
}
printing {
  printing = !sub(/<\/system-out>.*/, "")
  if (/[^ \t]/) last[++lines] = $0
  if (!printing && ++failed <= 10) {
    text = ""
    for (k = lines > 5 ? lines - 4 : 1; k <= lines; ++k) text = text "  " last[k] "\n"
    gsub(/&lt;/, "<", text)
    gsub(/&gt;/, ">", text)
    gsub(/&quot;/, "\"", text)
    gsub(/&apos;/, "\047", text)
    gsub(/&amp;/, "\\&", text)
    endings = endings "failed: " failing "\n" text
  }
  next
}
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
    isas = isas (isas == "" ? "" : ", ") isa " " text
  }
  if (isas != "") print "instruction sets: " isas
  printf "%s", endings
  if (failed > 10) print "and " failed - 10 " tests more failed"
}' "$1"
