#!/usr/bin/env bash
# Runs a program for Python with an interpreter that has NumPy: with_numpy.sh PROGRAM [ARGUMENTS]
set -euo pipefail
for python in /usr/bin/python3 python3; do
  if "$python" -c 'import numpy' 2>/dev/null; then
    exec env PYTHONDONTWRITEBYTECODE=1 "$python" "$@"
  fi
done
echo "skipped: found no Python with NumPy (apt-get install python3-numpy)"
exit 77
