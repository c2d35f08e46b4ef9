#!/usr/bin/env bash
# The binary interface of libtessera_c: compares it with tests/c/reference.abi, or makes that file anew.
#
# The functions are those that the library exports, their types those of the headers as C sees them. abidiff compares with
# no suppression: a struct that grew, as the interface allows, is reported too, and the reference is renewed by hand.
set -euo pipefail
root="$(cd "$(dirname "$0")/.." && pwd)"
reference="$root/tests/c/reference.abi"

usage() {
  cat <<TEXT
Usage: tools/c_abi.sh check LIBRARY [INCLUDE]   compare; 0: the same, or only functions added; 1: anything else
       tools/c_abi.sh renew LIBRARY [INCLUDE]   write the reference anew, after a change that was meant

LIBRARY is libtessera_c.so, INCLUDE the folder of tessera/tessera_c*.h [engine/include]. Needs cc, nm, abidw and abidiff
(Debian: abigail-tools); without them \`check\` exits with 77.
TEXT
}

if [[ ${1:-} == --help || ${1:-} == -h ]]; then
  usage
  exit 0
fi
if [[ $# -lt 2 || $# -gt 3 || ($1 != check && $1 != renew) ]]; then
  usage >&2
  exit 2
fi
library=$2
include=${3:-$root/engine/include}
for program in cc nm abidw abidiff; do
  if ! command -v "$program" >/dev/null; then
    echo "tools/c_abi.sh: found no program \"$program\" (apt-get install gcc binutils abigail-tools)" >&2
    exit 77
  fi
done
for file in "$library" "$include"/tessera/tessera_c{,_files,_shapes,_queries}.h; do
  if [[ ! -f $file ]]; then
    echo "tools/c_abi.sh: expected a file, found none: \"$file\"" >&2
    exit 2
  fi
done

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
{
  printf '#include "tessera/tessera_c_%s.h"\n' files shapes queries
  nm -D --defined-only "$library" | sed -n 's/.* T \(tsr_[a-z0-9_]*\)@@\(.*\)$/__typeof__(\1)* \1_of_\2;/p'
} >"$scratch/interface.c"
(cd "$scratch" && cc -std=gnu99 -g -fPIC -shared -I"$include" interface.c -o interface.so)
abidw --no-corpus-path --no-comp-dir-path --no-show-locs "$scratch/interface.so" |
  sed '/<elf-needed>/,/<\/elf-needed>/d' >"$scratch/found.abi"
if [[ $1 == renew ]]; then
  cp "$scratch/found.abi" "$reference"
  echo "wrote $reference"
  exit 0
fi
# Bits of the exit status: 1 and 2 are failures, 4 a change.
status=0
report=$(abidiff --no-show-locs "$reference" "$scratch/found.abi") || status=$?
if [[ $status -eq 0 ]]; then
  exit 0
fi
echo "$report"
if [[ $status -eq 4 ]] && grep -q "^Variables changes summary: 0 Removed, 0 Changed, [0-9]* Added variable" <<<"$report"; then
  echo "tools/c_abi.sh: functions were added; renew the reference when they are released"
  exit 0
fi
echo "tools/c_abi.sh: the binary interface changed: programs that were built before may break" >&2
exit 1
