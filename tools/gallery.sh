#!/usr/bin/env bash
# A picture of every model, and one sheet of them all.
set -euo pipefail

usage() {
  cat <<'TEXT'
tools/gallery.sh [--size WxH] [--sheet PICTURE] [MODEL...]

Installs what is missing (tools/setup.sh --for gallery), builds the command line in build/demo, casts a picture of each
model (all of tools/models by default) into out/gallery/NAME.png, and puts them on one sheet, out/gallery.png by default.

  --size WxH        of each picture, 480x360 by default; on the sheet they are half as wide and high
  --sheet PICTURE   where the sheet goes
TEXT
}

fail() {
  printf 'gallery: %s\n' "$*" >&2
  exit 2
}

size=480x360
sheet=
models=()
while (($#)); do
  case $1 in
    -h | --help)
      usage
      exit 0
      ;;
    --size | --sheet)
      (($# >= 2)) || fail "$1 wants a word after it"
      if [[ $1 == --size ]]; then size=$2; else sheet=$(realpath -m -- "$2"); fi
      shift 2
      ;;
    -*) fail "unknown argument '$1' (see --help)" ;;
    *)
      models+=("$(realpath -- "$1")")
      shift
      ;;
  esac
done
[[ $size =~ ^[1-9][0-9]*x[1-9][0-9]*$ ]] || fail "--size wants WxH, found '$size'"
cd "$(dirname -- "${BASH_SOURCE[0]}")/.."
sheet=${sheet:-$PWD/out/gallery.png}
((${#models[@]})) || models=(tools/models/*.json tools/models/*.bpt)

tools/setup.sh --for gallery
if [[ -z ${CMAKE_CXX_COMPILER_LAUNCHER:-} ]] && command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
cmake --preset demo
cmake --build --preset demo

mkdir -p out/gallery "$(dirname -- "$sheet")"
tiles=()
for model in "${models[@]}"; do
  name=$(basename -- "${model%.*}")
  build/demo/tools/tessera raycast "$model" -o "out/gallery/$name.png" --size "$size"
  tiles+=(-label "${name//_/ }" "out/gallery/$name.png")
done
montage "${tiles[@]}" -resize 50% -tile 8x -quality 88 -geometry +5+5 -font DejaVu-Sans -pointsize 13 -background '#f4f4f4' "$sheet"
echo "gallery: ${#models[@]} models on $sheet"
