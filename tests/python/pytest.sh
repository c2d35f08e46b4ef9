#!/usr/bin/env bash
# Runs tests of the package for Python with a library that was built: pytest.sh PACKAGE LIBRARY [TESTS]
# TESTS are those of the package by default.
set -euo pipefail
for python in /usr/bin/python3 python3; do
  if "$python" -c 'import numpy, pytest' 2>/dev/null; then
    cd "$1"
    exec env PYTHONPATH="$1" TESSERA_C_LIBRARY="$2" PYTHONDONTWRITEBYTECODE=1 "$python" -m pytest -q -rs "${@:3}"
  fi
done
echo "found no Python with NumPy and pytest (apt-get install python3-numpy python3-pytest)" >&2
exit 77
