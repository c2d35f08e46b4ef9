"""compare --program: whether a program that is not Tessera's is slower at one commit than at another.

Both commits of the repository in the current folder are built in folders of their own, and their programs take turns,
as in compare.py. A program prints what engine/docs/tracking-speed.md says. A run has all cases, so all are run again
where one looks slower.
"""

import os
import shlex
import subprocess
from pathlib import Path

from . import compare, machine, ratios, track
from .console import Failure, Progress, say
from .repository import ROOT, commit_of, describe, git


class OwnBuild:
    """A commit of the user's repository, or its tree as it is, with the words that start its program."""

    def __init__(self, name, arguments, here):
        words = shlex.split(arguments.own)
        self.folder = here
        self.label = "this tree"
        if name != ".":
            commit = commit_of(name, cwd=here)
            short, _, subject = describe(commit, cwd=here)
            self.label = f"{short} {subject}"
            common = Path(here, git("rev-parse", "--git-common-dir", cwd=here).strip())
            self.folder = check_out(commit, (common / "perf-builds").resolve(), here)
        if arguments.build:
            say(f"{self.label}: builds in {self.folder}")
            done = subprocess.run(arguments.build, shell=True, cwd=self.folder, capture_output=True, text=True, check=False)
            if done.returncode != 0:
                last = (done.stdout + done.stderr).splitlines()[-15:]
                raise Failure(f"{self.label} can't be built: '{arguments.build}' ended with {done.returncode}\n  "
                              + "\n  ".join(last))
        self.program = os.path.join(self.folder, words[0])
        self.words = words[1:]
        if not (os.path.isfile(self.program) and os.access(self.program, os.X_OK)):
            raise Failure(f"{self.label}: there is no program {self.program}; --build COMMAND says how it is made")

    def times(self, limit):
        """Seconds per item of each case, of one run."""
        cases, _ = track.run(self.program, self.words, limit)
        return {name: 1 / entry["rate"] for name, entry in cases.items()}


def check_out(commit, builds, here):
    folder = builds / commit[:12]
    if not folder.is_dir():
        git("worktree", "prune", cwd=here)
        builds.mkdir(parents=True, exist_ok=True)
        git("worktree", "add", "--force", "--detach", str(folder), commit, cwd=here)
    return str(folder)


def repository_here():
    """The root of the user's repository. Tessera's clone has programs of its own, and is left alone."""
    try:
        root = git("rev-parse", "--show-toplevel", cwd=os.getcwd()).strip()
    except Failure:
        raise Failure(f"{os.getcwd()} is in no git repository: start tools/perf in the program's repository") from None
    if Path(root).resolve() == ROOT:
        raise Failure(f"{root} is Tessera's clone: start tools/perf in the repository of your program, or leave out "
                      "--program to compare Tessera's own benchmarks")
    return root


def quads_of(base, head, quads, limit, progress, what):
    """For each case that both have a list of quads of times."""
    found = {}
    for quad in range(quads):
        order = "ABBA" if quad % 2 == 0 else "BAAB"
        runs = {"A": [], "B": []}
        for who in order:
            progress.step(f"{what} {base.label if who == 'A' else head.label}")
            runs[who].append((base if who == "A" else head).times(limit))
        both = set.intersection(*(set(run) for who in "AB" for run in runs[who]))
        if not both:
            raise Failure(f"{base.label} and {head.label} have no case in common")
        for case in sorted(both):
            a, b = ([run[case] for run in runs[who]] for who in "AB")
            found.setdefault(case, []).append((a[0], b[0], b[1], a[1]))
    return found


def measure(base, head, arguments, threshold):
    """A Verdict for each case."""
    progress = Progress(4 * arguments.quads)
    found = quads_of(base, head, arguments.quads, arguments.time_limit, progress, "runs")
    verdicts = {case: ratios.Verdict(values) for case, values in found.items()}
    if any(verdict.is_suspect(threshold) for verdict in verdicts.values()):
        progress.more(8 * arguments.quads)
        again = quads_of(base, head, 2 * arguments.quads, arguments.time_limit, progress, "runs again")
        verdicts.update((case, ratios.Verdict(values)) for case, values in again.items()
                        if verdicts[case].is_suspect(threshold))
    progress.end()
    return verdicts


def command(arguments):
    here = repository_here()
    base, head = (OwnBuild(name, arguments, here) for name in (arguments.base, arguments.head))
    if machine.busy():
        say(machine.busy() + "; cases take longer to tell apart")
    threshold = arguments.threshold / 100
    return compare.conclude(base, head, measure(base, head, arguments, threshold), arguments)
