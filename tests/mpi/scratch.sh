# Sourced by the tests of tessera_mpi: their arguments, a folder that is removed, and how they fail.
set -euo pipefail

mpiexec=$1 tessera=$2 tessera_mpi=$3 models=$4
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place"

fail() {
  printf '%s\n' "$*" >&2
  exit 1
}
