"""The baselines under bench/baselines: counts of instructions, by the instruction set of valgrind's machine
(valgrind_avx2, valgrind_sse2), and times, by the machine that they were taken on (intel-6-167_avx512).
"""

import json
from pathlib import Path

from .console import Failure
from .repository import ROOT
from .suite import read_json

FOLDER = ROOT / "bench" / "baselines"


def counts_file(isa, folder=FOLDER):
    return Path(folder) / f"valgrind_{isa}" / "counts.json"


def times_file(machine, isa, folder=FOLDER):
    return Path(folder) / f"{machine}_{isa}" / "times.json"


def read(path, keys=()):
    """An object of JSON with all required keys."""
    try:
        text = Path(path).read_text(encoding="utf-8")
    except FileNotFoundError:
        return None
    except (OSError, UnicodeDecodeError) as error:
        raise Failure(f"{path} can't be read: {error}") from None
    content = read_json(text, path)
    for key in keys:
        if not isinstance(content, dict) or key not in content:
            raise Failure(f"{path} has no \"{key}\"")
    return content


def write(path, content):
    """Writes the file whole or not at all. Each case is a line of text, so that a change is a line of a diff."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_suffix(".new")
    temporary.write_text(json.dumps(content, indent=1, sort_keys=True) + "\n", encoding="utf-8")
    temporary.replace(path)
