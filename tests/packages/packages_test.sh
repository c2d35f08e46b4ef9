#!/usr/bin/env bash
# Installs the packages in out/packages as the README says, and follows it: packages_test.sh SOURCES FOLDER
# Each kind of package gets a bare root of Debian 12, which debootstrap makes in FOLDER. Skipped (exit status 77) where
# there are no packages, or where it does not run as root or finds no debootstrap.
set -euo pipefail

sources=$1
folder=$2
packages=$sources/out/packages
root=$folder/root
skip() {
  echo "$1"
  exit 77
}
compgen -G "$packages/*.deb" >/dev/null || skip "there are no packages in $packages: tools/package.sh makes them"
((EUID == 0)) || skip "bare roots need the rights of root"
command -v debootstrap >/dev/null || skip "bare roots need the program debootstrap"
echo "packages of $(date -r "$packages" '+%F %T')"

# The bare root is kept for the next run.
if [[ ! -d $folder/bare ]]; then
  rm -rf "$folder/part"
  mkdir -p "$folder"
  debootstrap --variant=minbase bookworm "$folder/part" >"$folder/debootstrap.log" ||
    { tail -n 5 "$folder/debootstrap.log" >&2 && exit 1; }
  mv "$folder/part" "$folder/bare"
fi
trap 'rm -rf "$root"' EXIT

# new_root: the bare root again, with the packages and what the README uses of a clone.
new_root() {
  rm -rf "$root"
  cp -a "$folder/bare" "$root"
  mkdir -p "$root/clone/tools" "$root/clone/tests/house"
  cp "$sources/README.md" "$root/clone"
  cp -r "$sources/tools/models" "$root/clone/tools"
  cp "$sources/tests/house/guides.py" "$root/clone/tests/house"
  cp -r "$packages" "$root/packages"
}

# within FOLDER COMMANDS: runs them there in the root.
within() {
  unshare --fork --pid --mount-proc="$root/proc" chroot "$root" /usr/bin/env -i HOME=/root LANG=C.UTF-8 \
    PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive bash -euo pipefail -c "cd /$1; $2"
}

# expect WORDS COMMANDS: the commands, run in the clone, print the words.
expect() {
  local found
  found=$(within clone "$2" 2>&1) || { printf '%s\nfailed: %s\n' "$found" "$2" >&2 && exit 1; }
  [[ $found == *"$1"* ]] || { printf '%s\nexpected "%s" of: %s\n' "$found" "$1" "$2" >&2 && exit 1; }
}

apt() {
  within packages "$1" >"$folder/apt.log" 2>&1 || { tail -n 30 "$folder/apt.log" >&2 && exit 1; }
}

# readme_install NAME: the README's line that installs the package NAME, without sudo and questions.
readme_install() {
  sed -n "s/^sudo apt install \(.*\.\/$1_\*[^#]*\).*/apt-get install -y \1/p" "$sources/README.md"
}

readme_commands=$(grep '^tessera ' "$sources/README.md")
python='import tessera; print(tessera.read("tools/models/goblet.json").patches().tessellate(1e-3).is_certified)'

new_root
apt "apt-get update"
start=$SECONDS
apt "$(readme_install tessera)"
installed=$((SECONDS - start))
expect "proven" "tessera tessellate tools/models/bearing_block.step -o block.glb"
echo "command line: installed in $installed s; after $((SECONDS - start)) s there is the mesh of a STEP part"
expect "/usr/libexec/tessera/tessera-cad-reader" "tessera --version"
expect "" "$readme_commands"
apt "apt-get remove -y tessera-cad-reader"
expect "CAD reader (IGES, BREP, STEP on request): not found" "tessera --version"
expect "proven" "tessera tessellate tools/models/bearing_block.step -o block.glb"
expect "proven" "tessera tessellate tools/models/teapot.bpt -o teapot.glb --tolerance 0.001"

new_root
apt "apt-get update && $(readme_install libtessera-dev)"
apt "apt-get install -y pkg-config python3"
expect "" "python3 tests/house/guides.py README.md /clone/part_mesh /usr cmake 'Unix Makefiles' g++"
# shellcheck disable=SC2016
expect "triangles within 0.001 of the surfaces" \
  'g++ -std=c++20 part_mesh/main.cpp $(pkg-config --cflags --libs tessera-io) -o by_pkg_config && ./by_pkg_config tools/models/teapot.bpt'
echo "libraries: the README's program, by CMake and by pkg-config"
apt "apt-get remove -y libtessera && tar xzf ./*.tar.gz"
expect "" "python3 tests/house/guides.py README.md /clone/part_mesh /packages/tessera-*/ cmake 'Unix Makefiles' g++"
echo "archive: the README's program, by CMake"

new_root
apt "apt-get update && $(readme_install python3-tessera)"
expect "True" "python3 -c '$python'"
echo "Python: the package"

new_root
apt "apt-get update && apt-get install -y --no-install-recommends python3-numpy python3-pip"
apt "tar xzf ./*.tar.gz"
expect "True" "PYTHONPATH=\$(echo /packages/tessera-*/lib/python3/dist-packages) python3 -c '$python'"
apt "pip install --no-index --break-system-packages ./*.whl"
expect "True" "python3 -c '$python'"
echo "Python: the archive and the wheel"

new_root
apt "tar xzf ./*.tar.gz"
# shellcheck disable=SC2016
place='PATH=$(echo /packages/tessera-*/bin):$PATH'
expect ": /packages/tessera-" "$place; tessera --version"
expect "" "$place; $readme_commands"
echo "archive: the README's command lines"
