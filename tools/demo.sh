#!/usr/bin/env bash
# Makes meshes and pictures of the Utah teapot and of a CAD part from a fresh clone: installs, builds, and runs.
set -euo pipefail

if (($#)); then
  if [[ $1 == -h || $1 == --help ]]; then
    cat <<'TEXT'
tools/demo.sh

Installs missing packages (tools/setup.sh --for demo), builds the command line in build/demo, and writes meshes and
pictures of the Utah teapot and of a bearing block from a STEP file into out/. Prints the time of each step, and how
long a first run takes.
TEXT
    exit 0
  fi
  echo "demo: takes no arguments (see --help)" >&2
  exit 2
fi
cd "$(dirname -- "${BASH_SOURCE[0]}")/.."

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

# Each line states how far the mesh lies from the surfaces at most, and whether it is closed.
write_meshes() {
  "$tessera" tessellate tools/models/teapot.bpt -o out/teapot.ply
  "$tessera" tessellate tools/models/bearing_block.step -o out/bearing_block.glb
}

draw_pictures() {
  "$tessera" raycast tools/models/teapot.bpt -o out/teapot.png --size 1280x800
  "$tessera" raycast tools/models/bearing_block.step -o out/bearing_block.png --size 1280x800
}

echo "demo: the first run compiles the library, about six minutes on two cores; later runs take seconds."
step "set-up" tools/setup.sh --for demo
step "build" build
mkdir -p out
step "summary" "$tessera" info tools/models/bearing_block.step
step "meshes" write_meshes
step "pictures" draw_pictures

printf '\nMeshes and pictures are in %s:\n' "$PWD/out"
printf '  %s\n' teapot.ply teapot.png bearing_block.glb bearing_block.png ''
for i in "${!names[@]}"; do
  printf '%-8s %4d.%03d s\n' "${names[i]}" $((times[i] / 1000000)) $((times[i] / 1000 % 1000))
done
