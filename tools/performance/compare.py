"""compare: whether one build is slower than another, on a machine whose speed changes all the time.

The two take turns in processes of their own, A B B A and then B A A B, a few cases at a time, so that other work of the
machine affects both. Each time is the shortest of many calls. Cases that look slower are run again, for longer; only
these runs count, so that a false alarm needs two coincidences.
"""

import json

from . import builds, machine, ratios, suite
from .console import GOOD, REGRESSION, Failure, Progress, say, table

CASES_A_TURN = 6


def turns(cases, most=CASES_A_TURN):
    """The cases in groups that share a process: neighbours on one surface, which the process builds once."""
    groups = []
    for case in cases:
        surface = case.split("/")[1]
        if groups and len(groups[-1]) < most and groups[-1][0].split("/")[1] == surface:
            groups[-1].append(case)
        else:
            groups.append([case])
    return groups


def quads_of(base, head, cases, quads, seconds, progress, what):
    """For each case a list of quads of times per item."""
    found = {case: [] for case in cases}
    for group in turns(cases):
        for quad in range(quads):
            order = "ABBA" if quad % 2 == 0 else "BAAB"
            times = {"A": [], "B": []}
            progress.step(f"{what} {group[0]}" + (f" and {len(group) - 1} more" if len(group) > 1 else ""))
            for who in order:
                run = suite.run(base.program if who == "A" else head.program, group, seconds)
                times[who].append(run)
            for case in group:
                a, b = ([1 / run[case].rate if run[case].rate > 0 else 0 for run in times[who]] for who in "AB")
                if min(a + b) <= 0:
                    raise Failure(f"{case} reports no items a second")
                found[case].append((a[0], b[0], b[1], a[1]))
    return found


def cases_of(base, head, part, filter):
    """The cases that both programs have."""
    mine, others = suite.names(base.program, part, filter), set(suite.names(head.program, part, filter))
    both = [name for name in mine if name in others]
    if len(both) < len(mine) or len(both) < len(others):
        say(f"{len(mine) - len(both)} cases are in {base.label} alone, {len(others) - len(both)} in {head.label} alone")
    if not both:
        raise Failure(f"{base.label} and {head.label} have no case in common")
    return both


def measure(base, head, cases, quads, seconds, threshold):
    """A Verdict for each case."""
    progress = Progress(len(turns(cases)) * quads)
    first = quads_of(base, head, cases, quads, seconds, progress, "runs")
    verdicts = {case: ratios.Verdict(values) for case, values in first.items()}
    suspects = [case for case in cases if verdicts[case].is_suspect(threshold)]
    if suspects:
        progress.more(len(turns(suspects)) * 2 * quads)
        again = quads_of(base, head, suspects, 2 * quads, seconds, progress, "runs again")
        verdicts.update((case, ratios.Verdict(values)) for case, values in again.items())
    progress.end()
    return verdicts


def text_of(verdicts, threshold):
    rows = [("case", "time, head / base", "interval", "quads", "")]
    for case, v in sorted(verdicts.items(), key=lambda item: -item[1].ratio):
        rows.append((case, f"{v.ratio:.4f}", f"{v.low:.4f} to {v.high:.4f}", str(v.quads), v.word(threshold)))
    return table(rows, right=(1, 3))


def conclude(base, head, verdicts, arguments):
    """Prints the verdicts, writes them as JSON if wanted, and returns the exit status."""
    threshold = arguments.threshold / 100
    slower = [case for case, verdict in verdicts.items() if verdict.is_slower(threshold)]
    print(f"base: {base.label}\nhead: {head.label}\n{text_of(verdicts, threshold)}")
    print(f"{len(slower)} of {len(verdicts)} cases are slower by more than {arguments.threshold:g}%")
    if arguments.json:
        content = {"base": base.label, "head": head.label, "threshold": threshold, "machine": machine.describe(),
                   "cases": {case: {"ratio": v.ratio, "low": v.low, "high": v.high, "quads": v.quads,
                                    "verdict": v.word(threshold)} for case, v in verdicts.items()}}
        with open(arguments.json, "w", encoding="utf-8") as file:
            json.dump(content, file, indent=1)
    return REGRESSION if slower else GOOD


def command(arguments):
    common = dict(preset=arguments.preset, jobs=arguments.jobs, rebuild=arguments.rebuild)
    base = builds.build(arguments.base, options=arguments.base_option, **common)
    head = builds.build(arguments.head, options=arguments.head_option, **common)
    cases = cases_of(base, head, arguments.set, arguments.filter)
    if machine.busy():
        say(machine.busy() + "; cases take longer to tell apart")
    verdicts = measure(base, head, cases, arguments.quads, arguments.seconds, arguments.threshold / 100)
    return conclude(base, head, verdicts, arguments)
