#!/usr/bin/env bash
# Compares Tessera with other programs, side by side in one run. Installs missing packages first.
set -euo pipefail

usage() {
  cat <<'TEXT'
tools/peers.sh [NAME...]

Installs the peers' Debian packages (tools/setup.sh --for peers), builds the library and the comparisons in build/peers,
and runs the named comparisons, or all. Each comparison checks that both programs agree on the result before it prints
their rates. If a peer is not installed, the comparison leaves it out and says so. At the end one table shows all ratios,
with date, machine and versions. build/peers/peers.json holds the table for tools/perf report.
The names:
TEXT
  for row in "${comparisons[@]}"; do
    printf '  %-18s %s\n' "${row%%|*}" "${row#*|}"
  done
}

fail() {
  printf 'peers: %s\n' "$*" >&2
  exit "${status:-1}"
}

# NAME|what it compares. Each is the source bench/peers/NAME.cpp.
comparisons=(
  "grid_evaluation|a bicubic B-spline surface at a grid: OpenSubdiv (libosd-dev), OpenCASCADE, SISL (libsisl-dev)"
  "ray_casting|a camera's rays on a bicubic surface: Embree's triangles, grids, subdivision; OpenCASCADE; SISL; POV-Ray (povray)"
  "nearest_points|nearest points of a bicubic surface, near it and anywhere in its box: OpenCASCADE, SISL"
  "occt_extraction|Bezier extraction of a 200 x 200 bicubic B-spline surface: OpenCASCADE (libocct-modeling-data-dev)"
  "occt_mesh|meshes of equal error of the same surfaces: OpenCASCADE (libocct-modeling-algorithms-dev)"
  "occt_lean_mesh|triangles at equal error, mainly of rational surfaces and models: OpenCASCADE (libocct-data-exchange-dev)"
  "occt_closed_mesh|closed meshes of CAD files at ten tolerances: open edges, gaps, triangles and time: OpenCASCADE"
  "occt_triangulate|triangulate() of tessera::occt, shapes in memory at equal error, one thread and two: OpenCASCADE"
  "step_reading|STEP files read, and read and meshed to .glb: OpenCASCADE (libocct-data-exchange-dev)"
  "occt_step_regions|regions of the faces of STEP files, by 2,000 points of each: OpenCASCADE"
  "occt_trimmed_rays|random rays at trimmed faces of CAD files: hits, differences by cause, time: OpenCASCADE"
  "occt_trimmed_mesh|trimmed faces of CAD files: triangles and time at equal error, areas, sides: OpenCASCADE"
)

# is_comparison NAME: whether it is in the table.
is_comparison() {
  local row
  for row in "${comparisons[@]}"; do
    [[ ${row%%|*} == "$1" ]] && return 0
  done
  return 1
}

names=()
for argument; do
  case $argument in
    -h | --help)
      usage
      exit 0
      ;;
    -*) status=2 fail "unknown argument '$argument' (see --help)" ;;
    *)
      is_comparison "$argument" || status=2 fail "no comparison '$argument' (see --help)"
      names+=("$argument")
      ;;
  esac
done
if ((${#names[@]} == 0)); then
  names=("${comparisons[@]%%|*}")
fi
cd "$(dirname -- "${BASH_SOURCE[0]}")/.."

tools/setup.sh --for peers || echo "peers: not everything could be installed; going on with what is here" >&2
if [[ -z ${CMAKE_CXX_COMPILER_LAUNCHER:-} ]] && command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
cmake --preset peers
rm -f build/peers/bench/peers/tessera_peer_*  # of peers that no longer exist
cmake --build --preset peers

results=build/peers/results.jsonl
rm -f "$results"
export TESSERA_PEERS_RESULTS=$PWD/$results
failed=()
for name in "${names[@]}"; do
  program=build/peers/bench/peers/tessera_peer_$name
  printf '\n== %s\n' "$name"
  if [[ ! -x $program ]]; then
    echo "not built: its peer is not installed"
  elif ! "$program"; then
    failed+=("$name")
  fi
done
if [[ -e $results ]]; then
  printf '\n== all ratios of this run\n'
  tools/perf peers "$results" -o build/peers/peers.json || failed+=("the table")
fi
((${#failed[@]} == 0)) || fail "failed: ${failed[*]}"
