#!/usr/bin/env bash
# Builds oneTBB with the thread sanitizer from Debian's source package, for the preset tsan.
set -euo pipefail

usage() {
  cat <<'TEXT'
tools/instrumented_tbb.sh [FOLDER]

Fetches the source of Debian's onetbb by apt-get and builds it with -fsanitize=thread into FOLDER (build/tbb_tsan by
default), unless it is there already. Package lists and archives stay in FOLDER too, so the system's own do not change. The
thread sanitizer then sees how oneTBB orders its tasks. Without this build the sanitizer trusts oneTBB. The exit status is 3
if the source cannot be fetched (no network, or another system).
TEXT
}

if [[ ${1:-} == -h || ${1:-} == --help ]]; then
  usage
  exit 0
fi
cd "$(dirname -- "${BASH_SOURCE[0]}")/.."
mkdir -p "${1:-build/tbb_tsan}"
folder=$(cd "${1:-build/tbb_tsan}" && pwd)
[[ -e $folder/install/lib/cmake/TBB/TBBConfig.cmake ]] && exit 0

. /etc/os-release 2>/dev/null || true
if ! command -v apt-get >/dev/null || [[ -z ${VERSION_CODENAME:-} ]]; then
  echo "instrumented_tbb: this is not Debian" >&2
  exit 3
fi
echo "deb-src http://deb.debian.org/debian $VERSION_CODENAME main" >"$folder/sources.list"
mkdir -p "$folder/lists/partial" "$folder/cache/archives/partial"
apt_get() {
  apt-get -q -o Dir::Etc::sourcelist="$folder/sources.list" -o Dir::Etc::sourceparts=/dev/null \
    -o Dir::State::lists="$folder/lists" -o Dir::Cache="$folder/cache" "$@"
}
cd "$folder"
if ! apt_get update || ! apt_get source onetbb; then
  echo "instrumented_tbb: the source of onetbb could not be fetched" >&2
  exit 3
fi
source=$(echo onetbb-*/)
cmake -S "$source" -B objects -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -g1" \
  -DTBB_SANITIZE=thread -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF -DTBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON \
  -DCMAKE_INSTALL_PREFIX="$folder/install" -DCMAKE_INSTALL_LIBDIR=lib
cmake --build objects
cmake --install objects
