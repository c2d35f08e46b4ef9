#!/usr/bin/env bash
# Compares what Tessera computes when built by several compilers and levels of optimisation: one instruction set must
# give the same bytes.
set -euo pipefail

usage() {
  cat <<'TEXT'
tools/compilers.sh [--rays] [--kernels] [--jobs N] [--keep] [COMPILER:FLAGS ...]

Builds the core by each compiler with each set of flags, in build/compilers, runs tests/same_bytes on it, and prints a table:
a line for each family of results and instruction set, a column for each build; "same" where the hash is that of the first
column. Fails where one differs. Without builds named, those of the compilers that are installed: g++:-O0 g++:-O1 g++:-O2
g++:-O3 clang++-14:-O0 clang++-14:-O2 and the newest clang at -O2. Words of FLAGS are separated by commas: g++:-O2,-DNDEBUG

  --rays      rays too (by Embree, where it is found)
  --kernels   the vector kernels at that level too; by itself the build compiles them at -O3 whatever else is said
  --jobs N    compile N files at a time (1)
  --keep      keep the builds: each takes some 100 MB
TEXT
}

fail() {
  printf 'compilers: %s\n' "$*" >&2
  exit 1
}

rays=OFF
kernels=''
jobs=1
keep=''
builds=()
while (($#)); do
  case $1 in
    --rays) rays=ON ;;
    --kernels) kernels=yes ;;
    --keep) keep=yes ;;
    --jobs)
      (($# >= 2)) || fail "--jobs wants a number after it"
      jobs=$2
      shift
      ;;
    -h | --help)
      usage
      exit 0
      ;;
    *:*) builds+=("$1") ;;
    *) fail "unknown argument '$1' (see --help)" ;;
  esac
  shift
done
cd "$(dirname -- "${BASH_SOURCE[0]}")/.."

if ((${#builds[@]} == 0)); then
  builds=(g++:-O0 g++:-O1 g++:-O2 g++:-O3)
  newest=$(compgen -c clang++- | grep -E '^clang\+\+-[0-9]+$' | sort -u -t- -k2 -n | tail -1 || true)
  for compiler in clang++-14 "$newest"; do
    command -v "$compiler" >/dev/null && builds+=("$compiler:-O0" "$compiler:-O2")
  done
fi

folder=$PWD/build/compilers
mkdir -p "$folder"
# Keeps only the last of several levels of optimisation, so that a compiler cache sees the effective one.
cat > "$folder/last_level" <<'TEXT'
#!/usr/bin/env bash
for word; do [[ $word == -O[0-3s] ]] && level=$word; done
words=()
for word; do [[ $word == -O[0-3s] ]] || words+=("$word"); done
exec $(command -v ccache || true) "${words[@]}" ${level:-}
TEXT
chmod +x "$folder/last_level"

results=()
for build in "${builds[@]}"; do
  compiler=${build%%:*} flags=${build#*:}
  command -v "$compiler" >/dev/null || fail "there is no compiler '$compiler'"
  place=$folder/${build//[^A-Za-z0-9+-]/_}
  level=-O3
  [[ $kernels ]] && level=$(tr ',' '\n' <<<"$flags" | grep -E '^-O' | tail -1)
  echo "compilers: $build" >&2
  {
    cmake -S tests/same_bytes -B "$place" -G Ninja -D CMAKE_BUILD_TYPE= -D CMAKE_CXX_COMPILER="$compiler" \
      -D CMAKE_CXX_FLAGS="${flags//,/ }" -D SAME_BYTES_RAYS=$rays -D TESSERA_KERNEL_LEVEL="${level:--O3}" \
      -D CMAKE_CXX_COMPILER_LAUNCHER="$folder/last_level"
    cmake --build "$place" --target same_bytes -j "$jobs"
  } > "$place.log" 2>&1 || { tail -40 "$place.log" >&2; fail "$build does not build: see $place.log"; }
  "$place/same_bytes" > "$place.txt"
  results+=("$place.txt")
  [[ $keep ]] || rm -rf "$place"
done

python3 - "${results[@]}" -- "${builds[@]}" <<'TEXT'
import sys
split = sys.argv.index('--')
files, names = sys.argv[1:split], sys.argv[split + 1:]
columns = [{tuple(line.split()[:2]): line.split()[2] for line in open(file)} for file in files]
rows = list(columns[0])
cells = [[' '.join(row), columns[0][row]] + ['same' if c.get(row) == columns[0][row] else c.get(row, '-') for c in columns[1:]]
         for row in rows]
table = [['', *names]] + cells
widths = [max(len(row[k]) for row in table) for k in range(len(table[0]))]
for row in table:
    print('  '.join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip())
differing = [row[0] for row in cells if any(cell != 'same' for cell in row[2:])]
print(f'{len(rows) - len(differing)} of {len(rows)} the same in {len(names)} builds')
sys.exit(1 if differing else 0)
TEXT
