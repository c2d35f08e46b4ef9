"""check: whether the newest record is slower than those before it, by how much these differ among each other.

Records of a machine that does other things as well differ without a cause. So a case is slower only where its best rate
lies below those before by more than the threshold and by more than chance explains:

- four records before or more: three standard deviations of their best rates, by the median absolute deviation
- fewer: the larger range of passes within a record, and at least a fifth, because a machine's speed drifts
"""

import math
import statistics

from . import records
from .console import GOOD, REGRESSION, say, table

WINDOW = 20  # records before: older ones tell of other versions
ENOUGH, FEW = 4, math.log(1.2)


def range_of(entry):
    """How far the passes of a case lie apart, as a logarithm; 0 for a record of one pass."""
    passes = entry.get("passes") or [entry["rate"]]
    return math.log(max(passes) / min(passes))


class Judged:
    """A case of the newest record: `ratio` of its time to the usual one, and the ratio that chance allows."""

    def __init__(self, entry, before, threshold):
        rates = [math.log(e["rate"]) for e in before]
        usual = statistics.median(rates)
        allowed = math.log(1 + threshold)
        if len(rates) >= ENOUGH:
            allowed = max(allowed, 3 * 1.4826 * statistics.median(abs(rate - usual) for rate in rates))
        else:
            allowed = max(allowed, FEW, *(range_of(e) for e in [entry, *before]))
        self.records, self.ratio, self.allowed = len(rates), math.exp(usual) / entry["rate"], math.exp(allowed)

    def word(self):
        return "SLOWER" if self.ratio > self.allowed else "faster" if self.ratio < 1 / self.allowed else "same"


def judge(kept, threshold):
    """A Judged for each case of the newest record that a record before has, too."""
    newest, before = kept[-1], kept[-1 - WINDOW:-1]
    found = {}
    for case, entry in newest["cases"].items():
        others = [record["cases"][case] for record in before if case in record["cases"]]
        if others:
            found[case] = Judged(entry, others, threshold)
    return found


def command(arguments):
    kept, _ = records.chosen(arguments)
    if len(kept) < 2:
        say("perf: there is nothing to judge by: " + (records.NOTHING if not kept else "this is the first record of its "
            "program, machine and instruction set"))
        return GOOD
    judged = judge(kept, arguments.threshold / 100)
    rows = [("case", "time, newest / before", "allowed", "records", "")]
    for case, found in sorted(judged.items(), key=lambda item: -item[1].ratio):
        rows.append((case, f"{found.ratio:.3f}", f"{found.allowed:.3f}", str(found.records), found.word()))
    print(f"{records.program_of(kept[-1])} of {kept[-1]['commit']}, {kept[-1]['date']}\n{table(rows, right=(1, 2, 3))}")
    gone = sorted(kept[-2]["cases"].keys() - kept[-1]["cases"].keys())
    if gone:
        say(f"perf: the newest record lacks {len(gone)} {'case' if len(gone) == 1 else 'cases'} of the one before: "
            f"{gone[0]}" + (", ..." if len(gone) > 1 else ""))
    slower = [case for case, found in judged.items() if found.word() == "SLOWER"]
    print(f"{len(slower)} of {len(judged)} cases are slower than before")
    return REGRESSION if slower else GOOD
