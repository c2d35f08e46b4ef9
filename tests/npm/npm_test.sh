#!/usr/bin/env bash
# Tests the package for npm in Node.
#   npm_test.sh BUILD-FOLDER
# Exit status 77, with a word why, where wasm_build.sh has built nothing.
set -euo pipefail

if [[ ! -e $1/tessera.wasm ]]; then
  echo "skipped: tessera.wasm was not built"
  exit 77
fi
TESSERA_NPM=$1/npm exec node --test "$(dirname -- "${BASH_SOURCE[0]}")"/*.test.mjs
