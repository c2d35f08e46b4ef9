#!/usr/bin/env bash
# Makes a picture of every model, and one sheet of them all.
set -euo pipefail

usage() {
  cat <<'TEXT'
tools/gallery.sh [--size WxH] [--sheet PICTURE] [MODEL...]
tools/gallery.sh --silhouette [--size WxH] [--sheet PICTURE] [MODEL]

Installs missing packages (tools/setup.sh --for gallery), builds the command line in build/demo, draws a picture of each
model (all of tools/models by default) into out/gallery/NAME.png, and puts all pictures on one sheet.

  --size WxH        the size of each picture, 480x360 by default; on the sheet they are half as wide and high
  --sheet PICTURE   the file of the sheet, out/gallery.png by default
  --silhouette      draw a sheet of one model (the teapot) instead, out/silhouette.png by default: grid mode with 4 and 16
                    segments per patch and exact mode side by side, with a part of each outline magnified
TEXT
}

fail() {
  printf 'gallery: %s\n' "$*" >&2
  exit 2
}

size=480x360
sheet=
models=()
silhouette=
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
    --silhouette)
      silhouette=yes
      shift
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
if [[ $silhouette ]]; then
  sheet=${sheet:-$PWD/out/silhouette.png}
  ((${#models[@]})) || models=(tools/models/teapot.bpt)
  ((${#models[@]} == 1)) || fail "--silhouette wants one model, found ${#models[@]}"
else
  sheet=${sheet:-$PWD/out/gallery.png}
  ((${#models[@]})) || models=(tools/models/*.json tools/models/*.bpt)
fi

tools/setup.sh --for gallery
if [[ -z ${CMAKE_CXX_COMPILER_LAUNCHER:-} ]] && command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
cmake --preset demo
cmake --build --preset demo

mkdir -p out/gallery "$(dirname -- "$sheet")"
tiles=()
if [[ $silhouette ]]; then
  for mode in "grid --rate 4" "grid --rate 16" exact; do
    picture="out/gallery/silhouette_${mode//[ -]/_}.png"
    # shellcheck disable=SC2086  # a mode is one word or three
    build/demo/tools/tessera raycast "${models[0]}" -o "$picture" --size "$size" --shade normals --mode $mode
    # The upper border of the model in the picture, magnified.
    read -r width height left top < <(convert "$picture" -fuzz 5% -trim -format '%w %h %X %Y' info:)
    magnified="${picture%.png}_near.png"
    convert "$picture" -crop "$((width / 4))x$((height / 4))$left$top" +repage -filter point -resize 400% \
      -resize "$size" "$magnified"
    tiles+=(-label "$mode" "$picture" -label "$mode, its left upper corner" "$magnified")
  done
  montage "${tiles[@]}" -tile 2x -geometry +5+5 -font DejaVu-Sans -pointsize 13 -background '#f4f4f4' "$sheet"
  echo "gallery: ${models[0]} in grid and exact mode on $sheet"
  exit 0
fi
for model in "${models[@]}"; do
  name=$(basename -- "${model%.*}")
  build/demo/tools/tessera raycast "$model" -o "out/gallery/$name.png" --size "$size"
  tiles+=(-label "${name//_/ }" "out/gallery/$name.png")
done
montage "${tiles[@]}" -resize 50% -tile 8x -quality 88 -geometry +5+5 -font DejaVu-Sans -pointsize 13 -background '#f4f4f4' "$sheet"
echo "gallery: ${#models[@]} models on $sheet"
