#!/usr/bin/env bash
# Skipped where the tests of MPI are not run, so that this shows; fails if TESSERA_REQUIRE_MPI is 1.
#   available.sh MPIEXEC ON|OFF
set -euo pipefail

if [[ $2 == ON || $2 == TRUE ]] && command -v "$1"; then
  exit 0
fi
echo "MPI or mpiexec was not found when the build was configured: tools/setup.sh --for mpi installs them"
[[ ${TESSERA_REQUIRE_MPI:-} == 1 ]] && exit 1
exit 77
