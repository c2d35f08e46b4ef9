#!/usr/bin/env bash
# Builds everything, warnings being errors, and runs every test. Installs first what is missing.
set -euo pipefail

usage() {
  cat <<'TEXT'
tools/test.sh [--preset dev|asan|tsan|release] [-- CTEST-ARGUMENTS...]

Installs what is missing (tools/setup.sh), configures and builds a preset in build/<preset> (dev by default), and runs
ctest on all cores. What stands after -- goes to ctest, for example: tools/test.sh -- -R PatchSet
Real models are tested too where TESSERA_TEST_DATA names their folder. Two of the tests, perf.counts_avx2 and _sse2, hold the
instructions of the dev preset to bench/baselines: a minute or two each, skipped where compiler or libraries are others'.
TEXT
}

preset=dev
ctest_arguments=()
while (($#)); do
  case $1 in
    --preset)
      (($# >= 2)) || { echo "test: --preset wants a name after it" >&2; exit 2; }
      preset=$2
      shift 2
      ;;
    --preset=*)
      preset=${1#--preset=}
      shift
      ;;
    -h | --help)
      usage
      exit 0
      ;;
    --)
      shift
      ctest_arguments=("$@")
      break
      ;;
    *)
      echo "test: unknown argument '$1' (see --help)" >&2
      exit 2
      ;;
  esac
done
cd "$(dirname -- "${BASH_SOURCE[0]}")/.."

tools/setup.sh --for test
if [[ -z ${CMAKE_CXX_COMPILER_LAUNCHER:-} ]] && command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
cmake --preset "$preset"
cmake --build --preset "$preset"
ctest --preset "$preset" -j "$(nproc)" "${ctest_arguments[@]}"
