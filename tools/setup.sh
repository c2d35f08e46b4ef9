#!/usr/bin/env bash
# Installs the missing Debian 12 packages that Tessera is built with. Does nothing if all are installed.
set -euo pipefail

usage() {
  cat <<'TEXT'
tools/setup.sh [--for demo|cad|mpi|python|package|test|neon|wasm|fuzz|peers|gallery|docs]

Lists and installs the missing Debian packages that Tessera is built with, by apt-get, with sudo unless it runs as root.
If nothing is missing, it does nothing and needs neither network nor rights.

  --for demo      the libraries and the command line
  --for cad       the demo, and OpenCASCADE for IGES and BREP files and for programs of its own
  --for mpi       the demo, and Open MPI for models in parts on several machines
  --for python    the demo, OpenCASCADE, and what builds the package for Python
  --for package   these, and what makes Debian packages
  --for test      what the package for Python needs, and the tests (the default)
  --for neon      these, and the test of the NEON kernels: 300 MB of a cross compiler and an emulator; without them that
                  test is skipped
  --for wasm      the tests, and what builds and runs tessera.wasm: 280 MB of a compiler with its libraries for WebAssembly,
                  Node, and the source of muParser, which goes to build/sources; without them that test is skipped
  --for fuzz      the tests, and clang with libFuzzer for tools/test.sh --fuzz
  --for peers     the demo, and the programs that Tessera is compared with
  --for gallery   the demo, and the programs that put pictures on a sheet
  --for docs      the demo, and Doxygen for the reference
TEXT
}

fail() {
  printf 'setup: %s\n' "$*" >&2
  exit 1
}

# cmake/TesseraDependencies.cmake says what each package is for.
demo_packages=(g++ cmake ninja-build libtbb-dev libxsimd-dev libembree-dev libcli11-dev nlohmann-json3-dev libmuparser-dev
  zlib1g-dev libmeshoptimizer-dev libpng-dev libopenexr-dev)
cad_packages=(libocct-data-exchange-dev)
mpi_packages=(libopenmpi-dev openmpi-bin)
python_packages=("${cad_packages[@]}" patchelf python3-numpy python3-pip python3-setuptools python3-venv python3-wheel)
package_packages=("${python_packages[@]}" dpkg-dev file)
test_packages=("${python_packages[@]}" "${mpi_packages[@]}" abigail-tools binutils libgtest-dev libgmock-dev libbenchmark-dev libassimp-dev libtinygltf-dev mypy
  python3 python3-pytest python3-yaml universal-ctags valgrind)
neon_packages=(g++-aarch64-linux-gnu qemu-user)
wasm_packages=(clang-19 lld-19 libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 libclang-rt-19-dev-wasm32 wasi-libc
  libfast-float-dev nodejs node-typescript dpkg-dev)
fuzz_packages=(clang-19 libclang-rt-19-dev)
peer_packages=(libocct-modeling-data-dev libocct-modeling-algorithms-dev libocct-data-exchange-dev libosd-dev
  libsisl-dev povray python3)
gallery_packages=(imagemagick fonts-dejavu-core)
docs_packages=(doxygen python3)

purpose='test'
while (($#)); do
  case $1 in
    --for)
      (($# >= 2)) || fail "--for wants a word after it: demo, cad, mpi, python, package, test, neon, wasm, fuzz, peers, gallery or docs"
      purpose=$2
      shift 2
      ;;
    --for=*)
      purpose=${1#--for=}
      shift
      ;;
    -h | --help)
      usage
      exit 0
      ;;
    *) fail "unknown argument '$1' (see --help)" ;;
  esac
done
case $purpose in
  demo) packages=("${demo_packages[@]}") ;;
  cad) packages=("${demo_packages[@]}" "${cad_packages[@]}") ;;
  mpi) packages=("${demo_packages[@]}" "${mpi_packages[@]}") ;;
  python) packages=("${demo_packages[@]}" "${python_packages[@]}") ;;
  package) packages=("${demo_packages[@]}" "${package_packages[@]}") ;;
  test) packages=("${demo_packages[@]}" "${test_packages[@]}") ;;
  neon) packages=("${demo_packages[@]}" "${test_packages[@]}" "${neon_packages[@]}") ;;
  wasm) packages=("${demo_packages[@]}" "${test_packages[@]}" "${wasm_packages[@]}") ;;
  fuzz) packages=("${demo_packages[@]}" "${test_packages[@]}" "${fuzz_packages[@]}") ;;
  peers) packages=("${demo_packages[@]}" "${peer_packages[@]}") ;;
  gallery) packages=("${demo_packages[@]}" "${gallery_packages[@]}") ;;
  docs) packages=("${demo_packages[@]}" "${docs_packages[@]}") ;;
  *) fail "--for $purpose: no such purpose; there are demo, cad, mpi, python, package, test, neon, wasm, fuzz, peers, gallery and docs" ;;
esac

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  fail "this is not Debian (no apt-get). Install what these Debian packages hold, then build with CMake: ${packages[*]}"
fi

# Whether the package is installed and configured.
is_installed() {
  [[ $(dpkg-query -W -f='${db:Status-Abbrev}' "$1" 2>/dev/null) == ii* ]]
}

# The source of muParser, of which Debian has no library for WebAssembly.
tools=${BASH_SOURCE[0]%/*}
[[ $tools != "${BASH_SOURCE[0]}" ]] || tools=.
sources=$tools/../build/sources
lacks_source() {
  [[ $purpose == wasm && ! -e $sources/muparser/src/muParserBase.cpp ]]
}

missing=()
for package in "${packages[@]}"; do
  is_installed "$package" || missing+=("$package")
done
if ((${#missing[@]} == 0)) && ! lacks_source; then
  echo "setup: nothing is missing"
  exit 0
fi

# shellcheck source=/dev/null
if [[ -r /etc/os-release ]] && ! (. /etc/os-release && [[ ${ID:-} == debian && ${VERSION_ID:-} == 12 ]]); then
  echo "setup: this is not Debian 12, for which the package names are written; trying them all the same"
fi

as_root=()
if ((EUID != 0)); then
  command -v sudo >/dev/null ||
    fail "missing: ${missing[*]}. Installing them needs root, and there is no sudo: run '${BASH_SOURCE[0]} --for $purpose' as root"
  as_root=(sudo)
fi
as_root+=(env DEBIAN_FRONTEND=noninteractive)
apt() {
  "${as_root[@]}" apt-get -q -y -o DPkg::Lock::Timeout=300 "$@"
}

# Unpacks the source of muParser from where this machine has its packages from, with lists of its own.
get_source() {
  local scratch
  scratch=$(mktemp -d)
  mkdir -p "$scratch/lists/partial" "$scratch/cache/archives/partial"
  local options=(-q -o Dir::Etc::SourceList="$scratch/sources.list" -o Dir::Etc::SourceParts=/dev/null
    -o Dir::State::Lists="$scratch/lists" -o Dir::Cache="$scratch/cache" -o APT::Sandbox::User="$(id -un)")
  {
    apt-get indextargets --format 'deb-src $(SITE) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' |
      sort -u >"$scratch/sources.list"
    (cd "$scratch" && apt-get "${options[@]}" update && apt-get "${options[@]}" source muparser)
  } || {
    rm -rf "$scratch"
    fail "apt-get could not get the source of muparser: what it says above is why (no network, perhaps?)"
  }
  mkdir -p "$sources"
  rm -rf "$sources/muparser"
  mv "$scratch"/muparser-*/ "$sources/muparser"
  rm -rf "$scratch"
  echo "setup: unpacked the source of muParser in build/sources"
}

if ((${#missing[@]} == 0)); then
  get_source
  exit 0
fi
echo "setup: installs ${missing[*]}"
# apt-get installs nothing while an earlier installation is half done.
"${as_root[@]}" dpkg --configure -a || echo "setup: dpkg --configure -a failed; trying all the same" >&2
apt update || echo "setup: apt-get update failed; going on with the package lists that are here" >&2
if ! apt install --no-install-recommends "${missing[@]}"; then
  if [[ $purpose == peers ]]; then  # one by one: a missing peer must not prevent the others
    for package in "${missing[@]}"; do
      apt install --no-install-recommends "$package" || echo "setup: $package could not be installed" >&2
    done
  fi
fi
lacking=()
for package in "${missing[@]}"; do
  is_installed "$package" || lacking+=("$package")
done
((${#lacking[@]} == 0)) ||
  fail "apt-get could not install ${lacking[*]}: what it says above is why (no network, perhaps?)"
echo "setup: installed ${missing[*]}"
if lacks_source; then
  get_source
fi
