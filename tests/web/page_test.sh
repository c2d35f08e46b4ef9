#!/usr/bin/env bash
# Tests the page of tools/web in Chromium.
#   page_test.sh WASM-BUILD [NATIVE-TESSERA]
# The page is $TESSERA_WEB, or what the target tessera_web makes in WASM-BUILD, or build/wasm/web. Exit status 77, with a
# word why, where something is missing; 1 with TESSERA_REQUIRE_WEB=1 in the environment.
set -euo pipefail

build=$1
native=${2:-}
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
if [[ -z $page && -e $build/tessera.wasm ]]; then
  cmake --build "$build" --target tessera_web >/dev/null
  page=$build/web
fi
page=${page:-$root/build/wasm/web}
[[ -e $page/tessera/tessera.wasm ]] || skip "no page: cmake --preset wasm; cmake --build build/wasm --target tessera_web"
exec node "$source/page.mjs" "$browser" "$page" ${native:+"$native"}
