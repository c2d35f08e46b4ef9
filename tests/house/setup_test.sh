#!/usr/bin/env bash
# tools/setup.sh among stand-ins for Debian's programs: what it asks of them, and what it says.
#   setup_test.sh SETUP-SCRIPT
set -euo pipefail

setup=$1
bash=$(command -v bash)
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
mkdir "$place/bin" "$place/elsewhere"
for program in env cat grep rm sed; do
  ln -s "$(command -v "$program")" "$place/bin/$program"
  ln -s "$(command -v "$program")" "$place/elsewhere/$program"
done

# A package is missing while its name is a line of $place/missing. apt-get install takes the lines away.
cat >"$place/bin/dpkg-query" <<TEXT
#!$bash
grep -qx -- "\${*: -1}" "$place/missing" && exit 1
printf 'ii '
TEXT
cat >"$place/bin/dpkg" <<TEXT
#!$bash
[[ \$* == "--configure -a" && \$DEBIAN_FRONTEND == noninteractive ]] && rm -f "$place/interrupted"
TEXT
cat >"$place/bin/apt-get" <<TEXT
#!$bash
echo "\$*" >>"$place/calls"
[[ \$DEBIAN_FRONTEND == noninteractive && ! -e "$place/interrupted" ]] || exit 1
[[ -e "$place/no_network" ]] && exit 100
[[ -e "$place/unknown" && " \$* " == *" \$(cat "$place/unknown") "* ]] && exit 100
for word; do sed -i "/^\$word\$/d" "$place/missing"; done
TEXT
printf '#!%s\nexec "$@"\n' "$bash" >"$place/bin/sudo"
chmod +x "$place"/bin/*

# attempt PATH ARGUMENTS...: runs the script; its exit status in $status, its output in $output.
attempt() {
  local path=$1
  shift
  : >"$place/calls"
  status=0
  output=$(PATH=$path "$bash" "$setup" "$@" 2>&1) || status=$?
}
expect() {  # expect STATUS WORDS: the last attempt's
  if [[ $status != "$1" || $output != *"$2"* ]]; then
    printf 'expected status %s and "%s"; got status %s and:\n%s\n' "$1" "$2" "$status" "$output" >&2
    exit 1
  fi
}
expect_calls() {  # expect_calls NUMBER: of apt-get
  local calls
  calls=$(wc -l <"$place/calls")
  if ((calls != $1)); then
    printf 'expected %s calls of apt-get; got:\n%s\n' "$1" "$(cat "$place/calls")" >&2
    exit 1
  fi
}

: >"$place/missing"
attempt "$place/bin" --for demo
expect 0 "nothing is missing"
expect_calls 0

printf 'ninja-build\nlibgtest-dev\n' >"$place/missing"
attempt "$place/bin" --for demo  # the demo needs no GoogleTest
expect 0 "installed ninja-build"
expect_calls 2
grep -qx -- ".* install --no-install-recommends ninja-build" "$place/calls"
attempt "$place/bin" --for test
expect 0 "installed libgtest-dev"

printf 'libocct-modeling-data-dev\nlibgtest-dev\n' >"$place/missing"
attempt "$place/bin" --for test  # the tests need no peer
expect 0 "installed libgtest-dev"
printf 'libocct-modeling-data-dev\nlibgtest-dev\n' >"$place/missing"
attempt "$place/bin" --for=peers  # nor the comparisons GoogleTest
expect 0 "installed libocct-modeling-data-dev"
grep -qx -- ".* install --no-install-recommends libocct-modeling-data-dev" "$place/calls"

printf 'libosd-dev\nlibsisl-dev\n' >"$place/missing"
echo libosd-dev >"$place/unknown"
attempt "$place/bin" --for peers  # one unavailable peer does not prevent the others
expect 1 "could not install libosd-dev:"
grep -qx libsisl-dev "$place/missing" && { echo "libsisl-dev was not installed" >&2; exit 1; }
rm "$place/unknown"

printf 'qemu-user\nlibosd-dev\n' >"$place/missing"
touch "$place/interrupted"  # an earlier installation was cut off
attempt "$place/bin" --for neon
expect 0 "installed qemu-user"

# The source of muParser lies in the checkout, or is fetched.
mkdir -p "$place/checkout/tools" "$place/checkout/build/sources/muparser/src"
cp "$setup" "$place/checkout/tools/setup.sh"
touch "$place/checkout/build/sources/muparser/src/muParserBase.cpp"
checked_in=$setup
setup=$place/checkout/tools/setup.sh
printf 'lld-19\nqemu-user\n' >"$place/missing"
attempt "$place/bin" --for wasm
expect 0 "installed lld-19"
attempt "$place/bin" --for wasm
expect 0 "nothing is missing"
rm -r "$place/checkout/build"
for program in id mkdir mktemp mv sort; do ln -s "$(command -v "$program")" "$place/bin/$program"; done
touch "$place/no_network"
attempt "$place/bin" --for wasm
expect 1 "could not get the source of muparser"
rm "$place/no_network"
setup=$checked_in

printf 'imagemagick\nlibgtest-dev\n' >"$place/missing"
attempt "$place/bin" --for gallery
expect 0 "installed imagemagick"

printf 'cmake\n' >"$place/missing"
touch "$place/no_network"
attempt "$place/bin"
expect 1 "could not install cmake"

attempt "$place/elsewhere"
expect 1 "not Debian"
attempt "$place/bin" --for fun
expect 1 "no such purpose"
attempt "$place/bin" --for
expect 1 "wants a word"
attempt "$place/bin" fast
expect 1 "unknown argument"
echo "tools/setup.sh: all as it must be"
