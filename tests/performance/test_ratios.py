"""Tests the statistics on data with known results."""

import math
import random
import unittest
from unittest import mock

import support  # noqa: F401
from performance import compare, ratios
from performance.suite import Case


class Machine:
    """Times on a machine that drifts, is busy in bursts, and gives each process a speed of its own."""

    def __init__(self, seed, slower):
        self.random, self.slower, self.clock = random.Random(seed), slower, 0
        self.phase, self.busy = self.random.uniform(0, 6), 0

    def run(self, program, cases, seconds, limits=False):
        self.clock += 1
        if self.random.random() < 0.1:
            self.busy = self.random.randrange(1, 4)  # turns that others take a share of
        self.busy -= self.busy > 0
        process = self.random.gauss(0, 0.006)
        drift = 0.05 * math.sin(self.clock / 25 + self.phase)
        out = {}
        for case in cases:
            burst = abs(self.random.gauss(0, 0.1)) if self.busy else 0
            noise = process + drift + burst + abs(self.random.gauss(0, 0.004))
            truth = 1 + (self.slower if program == "head" else 0)
            out[case] = Case({"name": case, "items_per_second": 1e9 / truth / math.exp(noise)})
        return out


class Program:
    def __init__(self, name):
        self.program = self.label = name


def slower_cases(seed, slower, cases):
    machine = Machine(seed, slower)
    with mock.patch("performance.suite.run", machine.run), mock.patch("performance.console.say"), \
            mock.patch("performance.ratios.RESAMPLES", 400):
        verdicts = compare.measure(Program("base"), Program("head"), cases, 6, 0.1, 0.015)
    return [case for case in cases if verdicts[case].is_slower(0.015)]


CASES = [f"evaluate.{k}/teapot/3/9x9/avx2/1" for k in range(4)]


class Interval(unittest.TestCase):
    def test_covers_the_true_median_as_often_as_it_says(self):
        source = random.Random(3)
        covered = 0
        for _ in range(300):
            _, low, high = ratios.median_interval([source.lognormvariate(math.log(1.03), 0.02) for _ in range(15)])
            covered += low <= 1.03 <= high
        self.assertGreater(covered, 0.90 * 300)
        self.assertLess(covered, 300)

    def test_is_the_same_for_the_same_values(self):
        values = [1.01, 0.99, 1.02, 1.0, 1.05]
        self.assertEqual(ratios.median_interval(values), ratios.median_interval(values))

    def test_holds_the_median_and_shrinks_with_more_values(self):
        source = random.Random(5)
        widths = []
        for count in (8, 200):
            middle, low, high = ratios.median_interval([source.gauss(1, 0.05) for _ in range(count)])
            self.assertTrue(low <= middle <= high)
            widths.append(high - low)
        self.assertLess(widths[1], widths[0] / 2)

    def test_of_one_value_is_that_value(self):
        self.assertEqual(ratios.median_interval([1.5]), (1.5, 1.5, 1.5))

    def test_one_wild_value_moves_neither_median_nor_verdict(self):
        verdict = ratios.Verdict([(1.0, 1.0, 1.001, 1.0)] * 8 + [(1.0, 50.0, 50.0, 1.0)])
        self.assertLess(verdict.ratio, 1.002)
        self.assertFalse(verdict.is_slower(0.015))


class Quads(unittest.TestCase):
    def test_an_even_drift_drops_out(self):
        drifting = [(s * 1.00, s * 1.03 * 1.01, s * 1.03 * 1.02, s * 1.03) for s in (1, 2, 5)]
        for ratio in ratios.of_quads(drifting):
            self.assertAlmostEqual(ratio, 1.03, places=3)


class Decisions(unittest.TestCase):
    def test_planted_slow_downs_are_found_in_every_case(self):
        for slower in (0.03, 0.10):
            found = sum(len(slower_cases(seed, slower, CASES)) for seed in range(25))
            self.assertGreaterEqual(found, 0.9 * 25 * len(CASES), f"{slower:.0%}")

    def test_equal_builds_raise_hardly_an_alarm(self):
        alarms = sum(len(slower_cases(seed, 0, CASES)) for seed in range(100))
        self.assertLessEqual(alarms, 2, "of 400 cases")

    def test_a_faster_build_is_no_alarm(self):
        self.assertEqual(sum(len(slower_cases(seed, -0.05, CASES)) for seed in range(20)), 0)

    def test_neighbours_on_a_surface_share_a_process(self):
        names = [f"a/{surface}/3/1/-/1" for surface in "xxxyyx"] + [f"b/z/3/{k}/-/1" for k in range(8)]
        self.assertEqual([len(group) for group in compare.turns(names)], [3, 2, 1, 6, 2])
        self.assertEqual([name for group in compare.turns(names) for name in group], names)


if __name__ == "__main__":
    unittest.main()
