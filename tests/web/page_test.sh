#!/usr/bin/env bash
# Tests the page of tools/web in Chromium.
#   page_test.sh WASM-BUILD [NATIVE-TESSERA]
# The page is $TESSERA_WEB, or is made of the package in WASM-BUILD, or is build/wasm/web. Exit status 77, with a
# word why, where something is missing; 1 with TESSERA_REQUIRE_WEB=1 in the environment.
set -euo pipefail

build=$1
native=${2:-}
[[ -x $native ]] || native=  # a build without the command line
source=$(cd "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$source/../.." && pwd)

skip() {
  echo "skipped: $*"
  [[ ${TESSERA_REQUIRE_WEB:-0} != 1 ]] || exit 1
  exit 77
}
command -v node >/dev/null || skip "no node"
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || skip "no chromium"
[[ -d $root/tools/web/node_modules/puppeteer-core ]] || skip "no puppeteer-core: npm ci in tools/web"
page=${TESSERA_WEB:-}
if [[ -z $page && -e $build/npm/tessera.wasm ]]; then
  page=$build/web
  node "$root/tools/web/assemble.mjs" "$build/npm" "$page"
fi
page=${page:-$root/build/wasm/web}
[[ -e $page/tessera/tessera.wasm ]] || skip "no page: cmake --preset wasm; cmake --build build/wasm --target tessera_web"
node "$source/three.mjs" "$page"
exec node "$source/page.mjs" "$browser" "$page" ${native:+"$native"}
