"""Shared by the tests: tools/perf from outside, and its parts from inside."""

import os
import subprocess
import sys
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[2]
PERF = ROOT / "tools" / "perf"
FAKE = Path(__file__).resolve().parent / "fake_bench.py"
sys.path.insert(0, str(ROOT / "tools"))


def perf(*words, folder=None, **environment):
    """Runs tools/perf in a folder: (exit status, standard output, standard error)."""
    done = subprocess.run([sys.executable, str(PERF), *map(str, words)], cwd=folder, capture_output=True, text=True,
                          check=False, env=dict(os.environ, **environment))
    return done.returncode, done.stdout, done.stderr


def script(folder, name, **environment):
    """The fake program with an environment of its own."""
    path = Path(folder) / name
    settings = "".join(f"export {key}='{value}'\n" for key, value in environment.items())
    path.write_text(f"#!/bin/sh\n{settings}exec '{sys.executable}' '{FAKE}' \"$@\"\n")
    path.chmod(0o755)
    return path
