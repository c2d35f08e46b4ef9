"""Tests compare from outside, with programs that stand in for tessera_bench."""

import json
import os
import tempfile
import unittest

from support import FAKE, perf, script

QUICK = ("--quads", "4", "--seconds", "0.01")


class Compare(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.base = script(self.folder.name, "base", FAKE_NOISE=0.3)

    def head(self, **environment):
        return script(self.folder.name, "head", **environment)

    def expect(self, status, words, *arguments, **environment):
        got, out, err = perf(*arguments, **environment)
        self.assertEqual(got, status, out + err)
        self.assertIn(words, out + err)
        self.assertNotIn("Traceback", err)
        return out, err

    def test_equal_builds_are_equal(self):
        self.expect(0, "0 of 3 cases are slower", "compare", self.base, self.head(FAKE_NOISE=0.3), *QUICK)

    def test_a_slower_build_is_found_and_named(self):
        out, err = self.expect(1, "3 of 3 cases are slower", "compare", self.base, self.head(FAKE_SLOWER=3, FAKE_NOISE=0.3),
                               *QUICK)
        self.assertEqual(out.count("SLOWER"), 3)
        self.assertIn("runs again", err)

    def test_below_the_threshold_is_the_same(self):
        self.expect(0, "0 of 3", "compare", self.base, self.head(FAKE_SLOWER=3), "--threshold", "5", *QUICK)

    def test_a_faster_build_is_said_to_be(self):
        self.expect(0, "faster", "compare", self.base, self.head(FAKE_SLOWER=-5), *QUICK)

    def test_the_filter_restricts_and_json_holds_the_ratios(self):
        file = os.path.join(self.folder.name, "ratios.json")
        self.expect(1, "1 of 1 cases", "compare", self.base, self.head(FAKE_SLOWER=10), "--filter", r"\+normals", "--json", file,
                    *QUICK)
        with open(file, encoding="utf-8") as content:
            cases = json.load(content)["cases"]
        self.assertEqual(list(cases), ["evaluate.positions+normals.blocks/teapot/3/9x9/avx2/1"])
        self.assertAlmostEqual(next(iter(cases.values()))["ratio"], 1.1, places=2)

    def test_what_can_not_be_done_is_said(self):
        for fault, words in (("json", "not JSON"), ("wrong_json", "no list"), ("empty", "no results"), ("missing_case", "did not run"),
                             ("failed_case", "failed its check"), ("no_items", "no items")):
            with self.subTest(fault=fault):
                self.expect(3, words, "compare", self.base, self.head(FAKE_FAULT=fault), *QUICK)

    def test_an_unknown_commit_and_a_missing_program(self):
        self.expect(3, "'no-such-commit' is no commit", "compare", "no-such-commit", ".")
        self.expect(3, "is no commit", "compare", self.base, "/nowhere/tessera_bench")
        self.expect(3, "takes no options", "compare", self.base, self.base, "--head-option", "A=1")

    def test_wrong_arguments(self):
        self.expect(2, "required", "compare", "main")
        self.expect(2, "no regular expression", "compare", self.base, self.base, "--filter", "(")
        self.expect(3, "no case that", "compare", self.base, self.base, "--filter", "^nothing$")
        self.expect(2, "not within", "compare", self.base, self.base, "--quads", "1")
        self.expect(2, "is no number", "compare", self.base, self.base, "--threshold", "much")
        self.expect(2, "NAME=VALUE", "compare", self.base, self.base, "--head-option", "slow")
        self.expect(2, "COMMAND", )
        self.expect(2, "invalid choice", "compute")

    def test_help_names_the_statuses(self):
        for command in ((), ("compare",), ("count",), ("record",), ("report",), ("peers",)):
            self.expect(0, "exit status", *command, "--help")

    def test_the_stand_in_is_run_as_it_is(self):
        self.expect(0, "0 of 3", "compare", FAKE, FAKE, *QUICK)


if __name__ == "__main__":
    unittest.main()
