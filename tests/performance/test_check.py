"""Tests check: a planted slow-down is found, and records that differ by chance alone are not."""

import json
import os
import random
import tempfile
import unittest
from pathlib import Path

from support import perf

MACHINE = {"processor": "a machine", "cores": 2}


class Check(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.count = 0

    def record(self, rates, **more):
        """Writes a record; `rates`: by case, of its passes."""
        self.count += 1
        folder = self.folder / "perf-records"
        folder.mkdir(exist_ok=True)
        content = {"program": "game", "commit": f"c{self.count}", "commit_time": self.count, "date": f"2026-01-{self.count:02}",
                   "machine": MACHINE, "facts": {"isa": "avx2"},
                   "cases": {name: {"rate": max(passes), "passes": passes} for name, passes in rates.items()}, **more}
        (folder / f"{self.count:03}.json").write_text(json.dumps(content))

    def check(self, *options):
        return perf("check", *options, folder=self.folder)

    def noisy(self, draw, rate, passes=3, noise=0.04):
        """Rates of passes on a machine that slows down by chance."""
        return [rate * (1 - abs(draw.gauss(0, noise))) for _ in range(passes)]

    def test_finds_what_was_planted_and_nothing_else(self):
        for before in (1, 2, 6, 15):
            for seed in range(10):
                draw = random.Random(100 * before + seed)
                with self.subTest(before=before, seed=seed):
                    self.setUp()
                    for _ in range(before):
                        self.record({"draw": self.noisy(draw, 1e6), "pick": self.noisy(draw, 2e3)})
                    self.record({"draw": self.noisy(draw, 1e6), "pick": self.noisy(draw, 2e3)})
                    status, out, err = self.check()
                    self.assertEqual(status, 0, out + err)
                    self.assertIn("0 of 2 cases are slower", out)
                    self.record({"draw": self.noisy(draw, 1e6 / 1.5), "pick": self.noisy(draw, 2e3)})
                    status, out, err = self.check()
                    self.assertEqual(status, 1, out + err)
                    self.assertIn("1 of 2 cases are slower", out)
                    self.assertRegex(out, r"draw +1\.[3-6]\d\d .*SLOWER")

    def test_a_loud_machine_is_no_slow_down(self):
        self.record({"draw": [1e6, 6e5, 5e5]})
        self.record({"draw": [7e5, 6e5]})
        self.assertEqual(self.check()[0], 0)

    def test_the_first_record_is_judged_by_nothing(self):
        self.record({"draw": [1e6]})
        status, _, err = self.check()
        self.assertEqual(status, 0)
        self.assertIn("the first record", err)

    def test_other_machines_and_programs_are_left_out(self):
        self.record({"draw": [1e9]}, machine={"processor": "another", "cores": 64})
        self.record({"draw": [1e9]}, program="tool")
        self.record({"draw": [1e6]})
        status, _, err = self.check()
        self.assertEqual(status, 0)
        self.assertIn("the first record", err)

    def test_cases_that_are_gone_are_told(self):
        self.record({"draw": [1e6], "pick": [1e6]})
        self.record({"draw": [1e6], "new": [1e6]})
        status, out, err = self.check()
        self.assertEqual(status, 0)
        self.assertIn("lacks 1 case of the one before: pick", err)
        self.assertIn("0 of 1 cases", out)

    def test_faster_is_good(self):
        self.record({"draw": [1e6]})
        self.record({"draw": [2e6]})
        status, out, _ = self.check()
        self.assertEqual(status, 0)
        self.assertIn("faster", out)

    def test_bad_passes_are_an_error_with_the_file(self):
        self.record({"draw": [1e6]})
        file = self.folder / "perf-records" / "001.json"
        file.write_text(file.read_text().replace("[1000000.0]", "[0]"))
        status, _, err = self.check()
        self.assertEqual(status, 3)
        self.assertIn("001.json: the passes of case 'draw'", err)

    def test_wrong_thresholds_are_wrong_arguments(self):
        self.assertEqual(self.check("--threshold", "-1")[0], 2)




if __name__ == "__main__":
    unittest.main()
