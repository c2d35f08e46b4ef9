#!/usr/bin/env python3
"""Proves on this machine that tools/perf finds slow-downs: builds a commit as it is and with 3% and 10% planted in the
grid kernel (TESSERA_PLANT_SLOWDOWN), and shows that compare and count catch both and that ten comparisons of the build
with itself raise no alarm. Takes half an hour, most of it the first build. Exit status 1 where the proof fails.
"""

import argparse
import sys

import support  # noqa: F401  (the path to the parts)
from performance import builds, compare, count, suite
from performance.console import Failure, say

# Grids, in which slow-downs are planted, and two cases that are unaffected.
PLANTED = r"^evaluate\.(positions|positions\+normals|curvatures)\.blocks/bicubic1000/3/9x9/"
ELSEWHERE = r"^(points\.positions\.random/bicubic5000/|extract/bspline/3/)"
OPTION = "TESSERA_PLANT_SLOWDOWN={}"
THRESHOLD = 0.015


def row(*cells):
    print("| " + " | ".join(cells) + " |", flush=True)


def compared(base, head, cases, quads):
    return compare.measure(base, head, cases, quads, 0.1, THRESHOLD)


def spread(verdicts, cases):
    values = [verdicts[case].ratio for case in cases]
    return f"{100 * (min(values) - 1):+.1f} to {100 * (max(values) - 1):+.1f}%"


def prove_compare(base, slowed, cases, others, arguments):
    good = True
    row("time, head over base", "grids", "called slower", "other cases", "called slower")
    row("---", "---", "---", "---", "---")
    for percent, head in slowed.items():
        verdicts = compared(base, head, cases + others, arguments.quads)
        found = [[c for c in group if verdicts[c].is_slower(THRESHOLD)] for group in (cases, others)]
        row(f"{percent}% planted", spread(verdicts, cases), f"{len(found[0])} of {len(cases)}", spread(verdicts, others),
            f"{len(found[1])} of {len(others)}")
        good = good and len(found[0]) == len(cases) and not found[1]
    for k in range(arguments.runs):
        verdicts = compared(base, base, cases + others, arguments.quads)
        found = [[c for c in group if verdicts[c].is_slower(THRESHOLD)] for group in (cases, others)]
        row(f"with itself, {k + 1}", spread(verdicts, cases), f"{len(found[0])} of {len(cases)}", spread(verdicts, others),
            f"{len(found[1])} of {len(others)}")
        good = good and not any(found)
    return good


def prove_count(base, slowed):
    good = True
    row("instructions, head over base", *(f"{percent}% planted" for percent in slowed))
    row("---", *("---" for _ in slowed))
    filter = r"^(evaluate\.(positions|positions\+normals|curvatures)\.blocks/bicubic1000|extract/bspline)"
    for isa in count.ISAS:
        before = count.count(base.program, isa, filter)
        after = {percent: count.count(head.program, isa, filter) for percent, head in slowed.items()}
        for case in sorted(before):
            growth = [after[percent][case] / before[case] - 1 for percent in slowed]
            row(f"{case}, {isa}", *(f"{100 * g:+.2f}%" for g in growth))
            caught = [g > 0.01 for g in growth]
            good = good and (all(caught) if case.startswith("evaluate") else not any(caught))
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--commit", default="HEAD", help="what is built (default: HEAD)")
    parser.add_argument("--runs", type=int, default=10, help="comparisons of the build with itself (default: 10)")
    parser.add_argument("--quads", type=int, default=6, help="turns A B B A of each case (default: 6)")
    parser.add_argument("--jobs", type=int, help="compile so many files at a time")
    parser.add_argument("--only", choices=("compare", "count"), help="that part alone")
    arguments = parser.parse_args()
    base = builds.build(arguments.commit, jobs=arguments.jobs)
    slowed = {percent: builds.build(arguments.commit, options=[OPTION.format(percent)], jobs=arguments.jobs)
              for percent in (3, 10)}
    isa = suite.facts(base.program)["isa"]
    find = lambda pattern: [c for c in suite.names(base.program, "full", pattern) if c.endswith((f"/{isa}/1", "/-/1"))]
    good = True
    if arguments.only != "count":
        good = prove_compare(base, slowed, find(PLANTED), find(ELSEWHERE), arguments)
    if arguments.only != "compare":
        good = prove_count(base, slowed) and good
    print("proven" if good else "NOT proven")
    return 0 if good else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except Failure as failure:
        say(f"prove: {failure}")
        sys.exit(failure.status)
