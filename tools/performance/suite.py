"""Runs tessera_bench and reads its results."""

import re
import tempfile
from pathlib import Path

from . import json_file
from .console import Failure
from .process import ending, start

SUFFIX = "/manual_time"  # Google Benchmark's, in lists of names


class Case:
    """One case of one run: `rate`, items per second by the shortest time of a call, and the other counters."""

    def __init__(self, entry):
        self.name = entry["name"].removesuffix(SUFFIX) if hasattr(str, "removesuffix") else entry["name"].split(SUFFIX)[0]
        self.error = entry.get("error_message") if entry.get("error_occurred") else None
        self.rate = entry.get("items_per_second", 0)
        self.limit_fraction = entry.get("limit_fraction")
        self.bytes = entry.get("bytes_per_second")


def hint(program):
    return f"\nA program that is not Tessera's is tracked by 'tools/perf track {program}'"


def names(program, part="full", filter=None):
    """The cases of a set that match the regular expression, in their order."""
    done = start(program, f"--set={part}", "--benchmark_list_tests=true")
    if done.returncode != 0:
        raise Failure(f"{program} --benchmark_list_tests ended with {ending(done)}{hint(program)}")
    found = [line[: -len(SUFFIX)] if line.endswith(SUFFIX) else line for line in done.stdout.split()]
    odd = [name for name in found if name.count("/") < 5]
    if odd:
        raise Failure(f"{program} lists the case '{odd[0]}'; wanted operation/surface/degree/size/isa/threads"
                      f"{hint(program)}")
    if filter is not None:
        try:
            found = [name for name in found if re.search(filter, name)]
        except re.error as error:
            raise Failure(f"--filter '{filter}' is no regular expression: {error}", 2) from None
    if not found:
        raise Failure(f"{program} has no case" + (f" that '{filter}' finds" if filter is not None else ""))
    return found


def exactly(cases):
    """The filter of Google Benchmark that matches only these names."""
    return "^(" + "|".join(re.sub(r"([.+])", r"\\\1", name) for name in cases) + f")({SUFFIX})?$"


def run(program, cases, seconds, limits=False):
    """Runs cases for about `seconds` each; returns a dictionary of names to Case."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "out.json"
        done = start(program, "--set=full", f"--benchmark_min_time={seconds}", f"--benchmark_filter={exactly(cases)}",
                     f"--benchmark_out={file}", "--benchmark_out_format=json",
                     environment={} if limits else {"TESSERA_BENCH_LIMITS": "0"})
        text = file.read_text(encoding="utf-8") if file.exists() else ""
    if not text:
        raise Failure(f"{program} wrote no results and ended with {ending(done)}")
    content = json_file.parse(text, f"what {program} wrote")
    if not isinstance(content, dict) or not isinstance(content.get("benchmarks"), list):
        raise Failure(f"{program} wrote JSON that Google Benchmark does not write: no list \"benchmarks\"")
    found = {}
    for entry in content["benchmarks"]:
        case = Case(entry)
        if case.error:
            raise Failure(f"{program}: {case.name} failed its check: {case.error}")
        if case.rate != 0 and not json_file.is_positive(case.rate):
            raise Failure(f"{program}: {case.name} has the items_per_second {case.rate}; it must be a finite number "
                          "above 0")
        found[case.name] = case
    missing = [name for name in cases if name not in found]
    if missing:
        raise Failure(f"{program} did not run {missing[0]} (exit status {done.returncode})"
                      + (f" and {len(missing) - 1} more" if len(missing) > 1 else ""))
    return found


def facts(program):
    """The facts that the figures depend on; empty for programs that are too old to print them."""
    done = start(program, "--facts")
    if done.returncode != 0:
        return {}
    return json_file.parse(done.stdout, f"what {program} --facts printed")
