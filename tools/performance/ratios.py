"""Ratios of the interleaved times of two programs, on a machine that also does other work."""

import math
import random
import statistics

RESAMPLES = 2000


def of_quads(quads):
    """Ratios of B's time to A's, one per quad (a1, b1, b2, a2) of times taken in the order A B B A.

    The geometric mean of both pairs: a speed that drifts evenly over the quad drops out.
    """
    return [math.sqrt((b1 * b2) / (a1 * a2)) for a1, b1, b2, a2 in quads]


def median_interval(values, confidence=0.95, seed=1):
    """The median, and its percentile bootstrap interval (Efron and Tibshirani, An Introduction to the Bootstrap, 1993,
    ch. 13). Deterministic: equal values give equal numbers.
    """
    middle = statistics.median(values)
    if len(values) < 2:
        return middle, middle, middle
    draw = random.Random(seed)
    medians = sorted(statistics.median(draw.choices(values, k=len(values))) for _ in range(RESAMPLES))
    tail = (1 - confidence) / 2
    return middle, medians[int(tail * RESAMPLES)], medians[min(RESAMPLES - 1, int((1 - tail) * RESAMPLES))]


class Verdict:
    """The result of a case: `ratio` of times with its interval from `low` to `high`."""

    def __init__(self, quads):
        self.quads = len(quads)
        self.ratio, self.low, self.high = median_interval(of_quads(quads))

    def is_suspect(self, threshold):
        """Whether the case is run again: the ratio is beyond half of the threshold."""
        return self.ratio > 1 + threshold / 2

    def is_slower(self, threshold):
        """Whether the ratio is beyond the threshold, and the interval is above 1."""
        return self.ratio > 1 + threshold and self.low > 1

    def is_faster(self, threshold):
        return self.ratio < 1 - threshold and self.high < 1

    def word(self, threshold):
        return "SLOWER" if self.is_slower(threshold) else "faster" if self.is_faster(threshold) else "same"
