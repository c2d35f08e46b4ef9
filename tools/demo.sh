#!/usr/bin/env bash
# Makes a mesh and a picture of the Utah teapot from a fresh clone: installs missing packages, builds, and runs.
set -euo pipefail

if (($#)); then
  if [[ $1 == -h || $1 == --help ]]; then
    cat <<'TEXT'
tools/demo.sh

Installs missing packages (tools/setup.sh --for demo), builds the command line in build/demo, prints a summary of the
Utah teapot and writes out/teapot.ply and out/teapot.png. Prints the time of each step, and how long a first run takes.
TEXT
    exit 0
  fi
  echo "demo: takes no arguments (see --help)" >&2
  exit 2
fi
cd "$(dirname -- "${BASH_SOURCE[0]}")/.."

model=tools/models/teapot.bpt
mesh=out/teapot.ply
picture=out/teapot.png
tessera=build/demo/tools/tessera
names=()
times=()

microseconds() { printf '%s' "${EPOCHREALTIME/[.,]/}"; }

# step NAME COMMAND...: runs the command and records its time.
step() {
  local name=$1 start
  shift
  printf '\n== %s\n' "$name"
  start=$(microseconds)
  "$@"
  names+=("$name")
  times+=($(($(microseconds) - start)))
}

build() {
  if [[ -z ${CMAKE_CXX_COMPILER_LAUNCHER:-} ]] && command -v ccache >/dev/null; then
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache
  fi
  cmake --preset demo
  # Ninja shows the steps done, their number and the seconds.
  NINJA_STATUS='[%f/%t, %e s] ' cmake --build --preset demo
}

write_mesh() {
  "$tessera" tessellate "$model" -o "$mesh" --grid 16x16
  "$tessera" check "$mesh"
}

echo "demo: the first run compiles the library, 10 to 30 minutes on two cores; later runs take seconds."
step "set-up" tools/setup.sh --for demo
step "build" build
mkdir -p out
step "summary" "$tessera" info "$model"
step "mesh" write_mesh
step "picture" "$tessera" raycast "$model" -o "$picture" --size 1280x800

printf '\nThe teapot as a mesh:    %s\n' "$PWD/$mesh"
printf 'The teapot as a picture: %s\n\n' "$PWD/$picture"
for i in "${!names[@]}"; do
  printf '%-8s %4d.%03d s\n' "${names[i]}" $((times[i] / 1000000)) $((times[i] / 1000 % 1000))
done
