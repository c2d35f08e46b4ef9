"""The baselines under bench/baselines: counts of instructions, by the instruction set of valgrind's machine
(valgrind_avx2, valgrind_sse2), and times, by the machine that they were taken on (intel-6-167_avx512).
"""

from pathlib import Path

from .repository import ROOT

FOLDER = ROOT / "bench" / "baselines"


def counts_file(isa, folder=FOLDER):
    return Path(folder) / f"valgrind_{isa}" / "counts.json"


def times_file(machine, isa, folder=FOLDER):
    return Path(folder) / f"{machine}_{isa}" / "times.json"
