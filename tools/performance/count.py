"""count: instructions of fixed work, which are the same on a busy machine as on an idle one.

tessera_bench --count runs each case once to warm up and once under callgrind, on one thread. valgrind does not know
AVX-512, so AVX2 code from the same source stands in for it.
"""

import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

from . import baselines, builds, json_file, suite
from .console import FAILED, GOOD, REGRESSION, SKIPPED, Failure, say, table
from .repository import ROOT, git

ISAS = ("avx2", "sse2")
KEYS = ("compiler", "build_type", "flags", "libraries", "valgrind")
REQUIRED = "TESSERA_REQUIRE_COUNTS"


def valgrind_version():
    if not shutil.which("valgrind"):
        return None
    done = subprocess.run(["valgrind", "--version"], capture_output=True, text=True, check=False)
    return done.stdout.strip().replace("valgrind-", "") or None


def read_dumps(folder):
    """Maps names to instructions, from the files that callgrind wrote, one per case."""
    counts = {}
    for file in sorted(Path(folder).glob("counts.*")):
        text = file.read_text(encoding="utf-8", errors="replace")
        name = re.search(r"^desc: Trigger: Client Request: (.+)$", text, re.MULTILINE)
        total = re.search(r"^totals: (\d+)", text, re.MULTILINE)
        if name and total:
            counts[name.group(1).strip()] = int(total.group(1))
    return counts


def count(program, isa, filter=None):
    """Instructions of each counted case on one ISA."""
    with tempfile.TemporaryDirectory() as folder:
        command = ["valgrind", "--tool=callgrind", "--instr-atstart=no", "--compress-strings=no",
                   f"--callgrind-out-file={folder}/counts", str(program), "--count"]
        if filter is not None:
            command.append("--benchmark_filter=" + filter)
        try:
            process = subprocess.Popen(command, env=dict(os.environ, TESSERA_ISA=isa), text=True,
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        except FileNotFoundError:
            raise Failure("valgrind is not installed (Debian's package valgrind; tools/setup.sh)") from None
        faults = []
        for line in process.stdout:
            if line.startswith("counting "):
                say(f"{isa}: {line.strip()}")
            elif line.startswith("failed: "):
                faults.append(line[len("failed: "):].strip())
        errors = process.stderr.read()
        process.wait()
        if faults:
            raise Failure(f"{program}: " + "; ".join(faults))
        if process.returncode != 0:
            raise Failure(f"{program} --count ended with status {process.returncode} under valgrind: {errors[-800:]}")
        counts = read_dumps(folder)
    if not counts:
        raise Failure(f"{program} counted nothing" + (f" that '{filter}' finds" if filter else "")
                      + ": " + errors.strip().splitlines()[-1])
    return counts


def facts_of(program):
    """The facts that counts depend on, the planted slow-down included, which a baseline must not have."""
    found = suite.facts(program)
    if "compiler" not in found:
        raise Failure(f"{program} has no --facts: it is older than the counts")
    return dict({key: found.get(key) for key in KEYS}, valgrind=valgrind_version()), found.get("planted_slowdown", 0)


def comparable(facts, key):
    """A fact, without what changes no instruction: -g and its variants write debug information alone."""
    found = facts.get(key)
    return re.sub(r"(^|\s)-g\S*", "", found).strip() if key == "flags" and isinstance(found, str) else found


def differences(facts, others):
    """The differences, in words, that prevent a comparison of two builds' counts."""
    out = []
    for key in KEYS:
        mine, theirs = comparable(facts, key), comparable(others, key)
        if isinstance(mine, dict) and isinstance(theirs, dict):
            out += [f"{name} {mine.get(name)} (baseline: {theirs.get(name)})" for name in sorted({*mine, *theirs})
                    if mine.get(name) != theirs.get(name)]
        elif mine != theirs:
            out.append(f"{key} {mine} (baseline: {theirs})")
    return out


class Comparison:
    """Counts and a baseline's. `threshold`: the share by which a count may grow."""

    def __init__(self, counts, baseline, threshold, filtered=False):
        self.rows = []  # (name, before, now, ratio)
        self.grown, self.shrunk = [], []
        self.gone = [] if filtered else sorted(set(baseline) - set(counts))
        self.new = sorted(set(counts) - set(baseline))
        for name in sorted(counts):
            if name not in baseline:
                continue
            ratio = counts[name] / baseline[name]
            self.rows.append((name, baseline[name], counts[name], ratio))
            if ratio > 1 + threshold:
                self.grown.append(name)
            elif ratio < 1 - threshold:
                self.shrunk.append(name)

    def is_good(self):
        return not (self.grown or self.gone or self.new)

    def faults(self, threshold):
        """What is not good, in a line that names the cases."""
        grown = [f"{name} {ratio:.3f} times" for name, _, _, ratio in self.rows if name in self.grown]
        return "; ".join(f"{len(cases)} {word}: {', '.join(cases)}" for word, cases in (
            (f"counts grew by more than {100 * threshold:g}%", grown), ("counts are new", self.new),
            ("counts are gone", self.gone)) if cases)

    def text(self):
        rows = [("case", "baseline", "now", "ratio", "")]
        for name, before, now, ratio in self.rows:
            word = "MORE" if name in self.grown else "fewer" if name in self.shrunk else ""
            rows.append((name, f"{before:,}", f"{now:,}", f"{ratio:.4f}", word))
        rows += [(name, "-", "", "", "NEW") for name in self.new] + [(name, "", "-", "", "GONE") for name in self.gone]
        return table(rows, right=(1, 2, 3))


def raised_without_reason(path, threshold, root=ROOT):
    """The cases whose baseline the last commit raised by more than `threshold`, though its message has no body. Empty
    if there is no history.
    """
    try:
        name = str(Path(path).resolve().relative_to(Path(root).resolve()))
        before, now = (json_file.parse(git("show", f"{commit}:{name}", cwd=root), name) for commit in ("HEAD^", "HEAD"))
        body = git("log", "-1", "--format=%b", cwd=root).strip()
        merge = len(git("log", "-1", "--format=%P", cwd=root).split()) > 1
    except (Failure, ValueError):
        return []
    if body or merge or differences(now, before):
        return []
    old, new = before.get("counts", {}), now.get("counts", {})
    return [case for case in sorted(new) if case in old and new[case] > (1 + threshold) * old[case]]


def skipped(reason):
    """Prints why counts are not compared. Returns the exit status: SKIPPED, or FAILED on a machine that must compare."""
    if os.environ.get(REQUIRED, "0") not in ("", "0"):
        print(f"{reason}; {REQUIRED} is set, so this is a failure")
        return FAILED
    print(f"skipped: {reason}")
    return SKIPPED


def check(isa, counts, facts, path, threshold, filtered):
    """Compares counts with the baseline and prints the result; returns the exit status."""
    baseline = json_file.read(path, ("counts", *KEYS))
    if baseline is None:
        return skipped(f"{isa}: there is no baseline {path}")
    unlike = differences(facts, baseline)
    if unlike:
        return skipped(f"{isa}: the baseline's counts are not this build's: " + ", ".join(unlike))
    comparison = Comparison(counts, baseline["counts"], threshold, filtered)
    print(f"{isa}: instructions, against {path}\n{comparison.text()}")
    unexplained = raised_without_reason(path, threshold)
    if unexplained:
        print(f"{isa}: the last commit raised the baseline of {', '.join(unexplained)}; its message must say why")
    if not comparison.is_good():
        print(f"{isa}: {comparison.faults(threshold)}. If that is meant, 'tools/perf count --update' in the same commit, "
              f"whose body says why")
    elif comparison.shrunk:
        print(f"{isa}: {len(comparison.shrunk)} counts are smaller: 'tools/perf count --update' keeps them so")
    return GOOD if comparison.is_good() and not unexplained else REGRESSION


def repeated(program, isa, filter, times):
    """Counts, and the largest share by which a count differs between `times` processes."""
    runs = [count(program, isa, filter) for _ in range(times)]
    spread = max(max(run[name] for run in runs) / min(run[name] for run in runs) - 1 for name in runs[0])
    return runs[0], spread


def command(arguments):
    if valgrind_version() is None:
        message = "valgrind is not installed (Debian's package valgrind; tools/setup.sh)"
        if arguments.check:
            return skipped(message)
        raise Failure(message)
    program = arguments.program or builds.default_program(arguments.preset)
    facts, planted = facts_of(program)
    if planted and arguments.update:
        raise Failure(f"{program} was built with TESSERA_PLANT_SLOWDOWN={planted}: that is no baseline")
    results = []
    for isa in arguments.isa or ISAS:
        path = baselines.counts_file(isa, arguments.baselines)
        if arguments.check and json_file.read(path, ("counts", *KEYS)) and differences(facts, json_file.read(path)):
            results.append(check(isa, {}, facts, path, arguments.threshold / 100, True))  # prints why
            continue
        counts, spread = repeated(program, isa, arguments.filter, arguments.repeat)
        if arguments.repeat > 1:
            print(f"{isa}: {arguments.repeat} runs differ by {100 * spread:.4f}% at the most")
        if arguments.check:
            results.append(check(isa, counts, facts, path, arguments.threshold / 100, arguments.filter is not None))
        else:
            print(table([("case", isa), *((name, f"{n:,}") for name, n in sorted(counts.items()))], right=(1,)))
        if arguments.update:
            before = json_file.read(path) or {}
            kept = {} if arguments.filter is None else before.get("counts", {})
            json_file.write(path, dict(facts, counts=dict(kept, **counts)))
            print(f"{isa}: written to {path}")
    return max((r for r in results if r != SKIPPED), default=SKIPPED if results else GOOD)


assert GOOD < REGRESSION < FAILED < SKIPPED
