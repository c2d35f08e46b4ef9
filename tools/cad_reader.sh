#!/usr/bin/env bash
# Installs OpenCASCADE and builds the program that reads CAD files.
set -euo pipefail

if (($#)); then
  if [[ $1 == -h || $1 == --help ]]; then
    cat <<'TEXT'
tools/cad_reader.sh

Installs OpenCASCADE (tools/setup.sh --for cad) and builds tessera-cad-reader, which reads IGES and BREP files for
tessera, and STEP files on request, in build/demo. The command line of build/demo finds it there; for another, name it
by TESSERA_CAD_READER, or install both by "cmake --install build/demo".
TEXT
    exit 0
  fi
  echo "cad_reader: takes no arguments (see --help)" >&2
  exit 2
fi
cd "$(dirname -- "${BASH_SOURCE[0]}")/.."

tools/setup.sh --for cad
if [[ -z ${CMAKE_CXX_COMPILER_LAUNCHER:-} ]] && command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
cmake --preset demo -D TESSERA_BUILD_CAD_READER=ON
cmake --build --preset demo --target tessera_cad_reader
printf '\nCAD files are read by %s\n' "$PWD/build/demo/tools/tessera-cad-reader"
