#!/usr/bin/env bash
# Makes the packages that bring Tessera to machines without a compiler.
set -euo pipefail

if (($#)); then
  if [[ $1 == -h || $1 == --help ]]; then
    cat <<'TEXT'
tools/package.sh

Installs missing packages (tools/setup.sh --for package), builds the preset "package" in build/package, and writes into
out/packages

  *.deb      libtessera, libtessera-dev, tessera (the command line), tessera-cad-reader and python3-tessera, for Debian 12
  *.tar.gz   all of these with the libraries that they need: runs wherever it is unpacked
  *.whl      the package for every Python from 3.9 on, with the libraries that it needs

If build/wasm has them (cmake --preset wasm; targets tessera_web and tessera_npm), the packages hold the page of tessera view and
what live views of notebooks need.

The test "packages" (tools/test.sh -- -L packages) installs them and follows the README: in bare roots of Debian 12 if it
runs as root, debootstrap is installed and the network is there.
TEXT
    exit 0
  fi
  echo "package: takes no arguments (see --help)" >&2
  exit 2
fi
cd "$(dirname -- "${BASH_SOURCE[0]}")/.."

build=build/package
out=out/packages
tools/setup.sh --for package
if [[ -z ${CMAKE_CXX_COMPILER_LAUNCHER:-} ]] && command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
cmake --preset package
# Ninja shows the steps done, their number and the seconds.
NINJA_STATUS='[%f/%t, %e s] ' cmake --build --preset package

rm -rf "$out" "$build"/packages "$build"/archive
mkdir -p "$out"
cpack --config "$build/CPackConfig.cmake"
mv "$build"/packages/*.deb "$out"

version=$(sed -n 's/^#define TESSERA_VERSION "\([^"]*\)".*/\1/p' engine/include/tessera/version.h)
archive=tessera-$version-linux-$(uname -m)
cmake --install "$build" --prefix "$build/archive/$archive" >/dev/null
/usr/bin/python3 -B tools/python/libraries.py "$build/archive/$archive"
tar -C "$build/archive" --owner=0 --group=0 --sort=name -czf "$out/$archive.tar.gz" "$archive"

TESSERA_PYTHON_PREBUILT=$PWD/$build /usr/bin/python3 -m pip wheel -q --no-build-isolation --no-deps -w "$out" tools/python
printf '\nPackages:\n'
du -b --apparent-size "$out"/* | awk '{ printf "%8.2f MB  %s\n", $1 / 1e6, $2 }'
