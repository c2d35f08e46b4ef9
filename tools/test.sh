#!/usr/bin/env bash
# Builds everything, with warnings as errors, and runs every test. Installs missing packages first.
set -euo pipefail

usage() {
  cat <<'TEXT'
tools/test.sh [--preset dev|plain|asan|tsan|release] [--target NAME]... [-- CTEST-ARGUMENTS...]
tools/test.sh --fuzz [SECONDS]

Installs missing packages (tools/setup.sh), configures and builds a preset in build/<preset> (dev by default), and runs
ctest on all cores.

  --preset NAME     the preset to build and test
  --target NAME     build only the named targets, to run some of the tests:
                      tools/test.sh --preset tsan --target tessera_test_threads --target tessera_planted_race -- -L threads
  --fuzz SECONDS    build the preset fuzz instead, and run each fuzz target for SECONDS (60) from its corpus
  --                pass all following arguments to ctest, for example: tools/test.sh -- -R PatchSet

The preset tsan builds oneTBB with the thread sanitizer too (tools/instrumented_tbb.sh), if its source can be fetched.
If TESSERA_TEST_DATA names a folder of real models, they are tested too. Tests of instruction sets that the machine lacks are
skipped, unless TESSERA_REQUIRE_ISAS names them, for example "sse2;avx2". The last line says which sets were tested and which
were skipped. The tests perf.counts_avx2 and perf.counts_sse2 compare the instructions of the preset dev with bench/baselines.
They take minutes each, and are skipped if valgrind is missing or if the compiler, the flags or the libraries differ. With
TESSERA_REQUIRE_COUNTS=1 they fail instead.
TEXT
}

preset=dev
fuzz_seconds=
targets=()
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
    --target)
      (($# >= 2)) || { echo "test: --target wants a name after it" >&2; exit 2; }
      targets+=(--target "$2")
      shift 2
      ;;
    --fuzz)
      preset=fuzz
      fuzz_seconds=60
      shift
      if [[ ${1:-} =~ ^[1-9][0-9]*$ ]]; then
        fuzz_seconds=$1
        shift
      fi
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

echo "test: the first build and all tests take about 40 minutes on two cores, and longer with sanitizers. Later builds compile only"
echo "test: what changed. --help says how to build and run some of the tests."
if [[ $fuzz_seconds ]]; then tools/setup.sh --for fuzz; else tools/setup.sh --for test; fi
if [[ -z ${CMAKE_CXX_COMPILER_LAUNCHER:-} ]] && command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
  export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros}  # it caches nothing of precompiled headers otherwise
fi
options=()
if [[ $preset == tsan ]]; then
  if tools/instrumented_tbb.sh; then
    options=("-DTBB_DIR=$PWD/build/tbb_tsan/install/lib/cmake/TBB" -DTESSERA_TBB_IS_INSTRUMENTED=ON)
  else
    echo "test: oneTBB is built without the thread sanitizer, because its source could not be fetched. The tests check Tessera's" >&2
    echo "test: own code, and assume that oneTBB runs no task before its call begins or after it ends." >&2
  fi
fi
cmake --preset "$preset" "${options[@]}"
[[ $fuzz_seconds ]] && targets=(--target tessera_fuzz)
# Ninja shows the steps done, their number and the seconds.
NINJA_STATUS='[%f/%t, %e s] ' cmake --build --preset "$preset" "${targets[@]}"

# Each target keeps new inputs outside its corpus, and fails on the first input that breaks a rule.
fuzz() {
  local target name arguments
  for target in build/fuzz/tests/fuzz/tessera_fuzz_*; do
    [[ -x $target && ! -d $target ]] || continue
    name=${target##*/tessera_fuzz_}
    arguments=("-max_total_time=$fuzz_seconds" -max_len=4096 -timeout=5 -rss_limit_mb=1024 -malloc_limit_mb=64 -print_final_stats=1)
    [[ -e tests/fuzz/$name.dict ]] && arguments+=("-dict=tests/fuzz/$name.dict")
    mkdir -p "build/fuzz/found/$name"
    echo "test: fuzz.$name for $fuzz_seconds seconds"
    "$target" "${arguments[@]}" "-artifact_prefix=build/fuzz/found/" "build/fuzz/found/$name" "tests/corpus/$name" \
      2>&1 | tail -n 12
  done
}
if [[ -n $fuzz_seconds ]]; then
  fuzz
  exit 0
fi
status=0
rm -f "build/$preset/Testing/results.xml"
ctest --preset "$preset" -j "$(nproc)" --output-junit Testing/results.xml "${ctest_arguments[@]}" || status=$?
[[ ! -e build/$preset/Testing/results.xml ]] || tools/test_summary.sh "build/$preset/Testing/results.xml"
exit "$status"
