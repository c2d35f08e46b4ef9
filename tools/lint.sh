#!/usr/bin/env bash
# Checks the project's C++ against its .clang-format and .clang-tidy.
set -euo pipefail

usage() {
  cat <<'TEXT'
tools/lint.sh [--format] [--tidy] [--fix] [--quick] [--build FOLDER] [FILES...]

Checks C++ files against .clang-format (clang-format 14) and .clang-tidy: the named files, or all tracked ones. Prints each
fault, and fails if there is one.

  --format         check the format only, in seconds; the default
  --tidy           run clang-tidy only, about a minute for ten files
  --fix            format the files instead of checking them
  --quick          tidy without the path-sensitive checks (clang-analyzer-*), which take most of the time
  --build FOLDER   the build whose compile_commands.json says how files are compiled (build/edit)
TEXT
}

fail() {
  printf 'lint: %s\n' "$*" >&2
  exit 2
}

format='' tidy='' fix='' quick='' build=build/edit
files=()
while (($#)); do
  case $1 in
    --format) format=yes ;;
    --tidy) tidy=yes ;;
    --fix) fix=yes ;;
    --quick) quick=yes ;;
    --build)
      (($# >= 2)) || fail "--build wants a folder after it"
      build=$2
      shift
      ;;
    -h | --help)
      usage
      exit 0
      ;;
    -*) fail "unknown argument '$1' (see --help)" ;;
    *) files+=("$1") ;;
  esac
  shift
done
[[ $tidy ]] || format=yes
# File names are relative to the caller's folder.
for k in "${!files[@]}"; do files[k]=$(realpath "${files[k]}"); done
cd "$(dirname -- "${BASH_SOURCE[0]}")/.."
if ((${#files[@]} == 0)); then
  mapfile -t files < <(git ls-files '*.cpp' '*.h' 2>/dev/null || find bench engine tests tools -name '*.cpp' -o -name '*.h')
  files=("${files[@]/#/$PWD/}")
fi

# Versions of clang-format differ in their results; the project uses version 14.
find_version_14() {
  local program
  for program in "$1-14" "$1"; do
    if command -v "$program" >/dev/null && "$program" --version | grep -q 'version 14\.'; then
      echo "$program"
      return
    fi
  done
}

wrong=0
if [[ $format ]]; then
  program=$(find_version_14 clang-format)
  if [[ -z $program ]]; then
    echo "lint: there is no clang-format 14 here; the format is not looked at"
    [[ $tidy ]] || exit 77
  elif [[ $fix ]]; then
    "$program" -i "${files[@]}"
  else
    # Formats copies, many at once: starting takes longer than a file. (Its --dry-run objects to comments after inline
    # namespaces that it leaves as they are.)
    copies=$(mktemp -d)
    trap 'rm -rf "$copies"' EXIT
    printf '%s\0' "${files[@]}" | xargs -0 cp --parents -t "$copies" $(find "$PWD" -name .clang-format -not -path '*/build/*')
    (cd "$copies" && find . -type f -name '*.*' ! -name .clang-format -print0 | xargs -0 -n 100 -P "$(nproc)" "$program" -i)
    for file in "${files[@]}"; do
      cmp -s "$copies/$file" "$file" || { echo "lint: ${file#"$PWD/"} is not formatted (tools/lint.sh --fix)"; wrong=1; }
    done
  fi
fi
if [[ $tidy ]]; then
  command -v clang-tidy >/dev/null || fail "there is no clang-tidy here"
  [[ -f $build/compile_commands.json ]] || fail "$build has no compile_commands.json: configure it first (cmake --preset edit)"
  # Clang does not know gcc's options of code generation.
  commands=$(mktemp -d)
  trap 'rm -rf "$commands" "${copies:-}"' EXIT
  sed 's/ -mmemset-strategy=[^ ]*//' "$build/compile_commands.json" > "$commands/compile_commands.json"
  checks=()
  [[ $quick ]] && checks=(--checks=-clang-analyzer-*)
  for file in "${files[@]}"; do
    # Headers are checked where they are included.
    [[ $file == *.cpp ]] && grep -q "/${file#"$PWD/"}\"" "$build/compile_commands.json" || continue
    # Options for gcc's warnings that clang does not know must not fail the file.
    clang-tidy --quiet -p "$commands" --warnings-as-errors='*' --extra-arg=-Wno-unknown-warning-option "${checks[@]}" "$file" \
      2>/dev/null || wrong=1
  done
fi
exit "$wrong"
