"""Tests count: what it reads, compares, skips and prints."""

import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from support import FAKE, PERF, perf, script
from performance import count, json_file
from performance.console import Failure

FACTS = {"compiler": "gcc 12.2.0", "build_type": "Release", "flags": "-O3", "libraries": {"glibc": "2.36"},
         "valgrind": count.valgrind_version()}


class Comparing(unittest.TestCase):
    def test_one_percent_more_is_too_much(self):
        base = {"a": 1000, "b": 1000, "c": 1000}
        found = count.Comparison({"a": 1010, "b": 1011, "c": 980}, base, 0.01)
        self.assertEqual((found.grown, found.shrunk, found.is_good()), (["b"], ["c"], False))
        self.assertIn("MORE", found.text())
        self.assertEqual(found.faults(0.01), "1 counts grew by more than 1%: b 1.011 times")
        self.assertTrue(count.Comparison({"a": 1010, "b": 900, "c": 1000}, base, 0.01).is_good())

    def test_cases_that_come_and_go_are_faults_but_where_a_filter_left_them_out(self):
        found = count.Comparison({"a": 1, "new": 1}, {"a": 1, "old": 1}, 0.01)
        self.assertEqual((found.gone, found.new, found.is_good()), (["old"], ["new"], False))
        self.assertEqual(found.faults(0.01), "1 counts are new: new; 1 counts are gone: old")
        self.assertTrue(count.Comparison({"a": 1}, {"a": 1, "old": 1}, 0.01, filtered=True).is_good())

    def test_other_compilers_and_libraries_are_told(self):
        self.assertEqual(count.differences(FACTS, FACTS), [])
        other = dict(FACTS, compiler="gcc 13.2.0", libraries={"glibc": "2.38", "oneTBB": "2021.8"})
        self.assertEqual(count.differences(other, FACTS),
                         ["compiler gcc 13.2.0 (baseline: gcc 12.2.0)", "glibc 2.38 (baseline: 2.36)",
                          "oneTBB 2021.8 (baseline: None)"])

    def test_flags_of_debug_information_change_no_count(self):
        def unlike(flags, others):
            return count.differences(dict(FACTS, flags=flags), dict(FACTS, flags=others))
        for flags in ("-O2 -g1", "-g -O2", "-O2 -ggdb3 -gdwarf-4 -gz=zlib", "-O2"):
            self.assertEqual(unlike(flags, "-O2 -g"), [], flags)
        self.assertEqual(unlike("-O2 -g1", "-O3 -g"), ["flags -O2 (baseline: -O3)"])
        self.assertEqual(len(unlike("-O2 -g1 -fno-gcse", "-O2 -g")), 1)
        self.assertEqual(len(unlike("-D_GLIBCXX_ASSERTIONS -O2 -g", "-O2 -g")), 1)


class Reading(unittest.TestCase):
    def test_dumps_of_callgrind(self):
        with tempfile.TemporaryDirectory() as folder:
            dump = "desc: Trigger: Client Request: {}\n\nevents: Ir\nsummary: 0\n\nfn=x\n0 5\n\ntotals: {}\n"
            Path(folder, "counts.1").write_text(dump.format("evaluate.positions/teapot/3/9x9", 123))
            Path(folder, "counts.2").write_text(dump.format("read.obj/bspline/3/1MB", 4567))
            Path(folder, "counts").write_text("desc: Trigger: Program termination\ntotals: 9\n")
            self.assertEqual(count.read_dumps(folder),
                             {"evaluate.positions/teapot/3/9x9": 123, "read.obj/bspline/3/1MB": 4567})

    def test_baselines(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder, "deeper", "counts.json")
            self.assertIsNone(json_file.read(file))
            json_file.write(file, {"counts": {"a": 1}})
            self.assertEqual(json_file.read(file, ("counts",)), {"counts": {"a": 1}})
            self.assertEqual(os.listdir(file.parent), ["counts.json"])
            with self.assertRaisesRegex(Failure, 'no "compiler"'):
                json_file.read(file, ("compiler",))
            file.write_text("{")
            with self.assertRaisesRegex(Failure, "not JSON"):
                json_file.read(file)


def checked(content, counts, facts=None, required=""):
    """The result of check() for a baseline with this content: (status, output)."""
    program = ("import sys; sys.path.insert(0, sys.argv[1]); import json; from performance import count\n"
               "path, counts, facts = sys.argv[2], json.loads(sys.argv[3]), json.loads(sys.argv[4])\n"
               "sys.exit(count.check('avx2', counts, facts, path, 0.01, False))")
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "counts.json")
        if content is not None:
            json_file.write(file, content)
        done = subprocess.run([sys.executable, "-c", program, str(PERF.parent), str(file), json.dumps(counts),
                               json.dumps(facts or FACTS)], capture_output=True, text=True, check=False,
                              env=dict(os.environ, TESSERA_REQUIRE_COUNTS=required))
    return done.returncode, done.stdout + done.stderr


class Checking(unittest.TestCase):
    def test_good_bad_and_skipped(self):
        base = dict(FACTS, counts={"a": 1000})
        self.assertEqual(checked(base, {"a": 1005})[0], 0)
        status, said = checked(base, {"a": 1030})
        self.assertEqual(status, 1)
        self.assertIn("count --update", said)
        status, said = checked(base, {"a": 900})
        self.assertEqual(status, 0)
        self.assertIn("keeps them so", said)
        status, said = checked(base, {"a": 1030}, dict(FACTS, compiler="clang 14"))
        self.assertEqual(status, 77)
        self.assertIn("compiler clang 14", said)
        self.assertEqual(checked(None, {"a": 1})[0], 77)

    def test_counts_that_are_required_are_not_skipped(self):
        base = dict(FACTS, counts={"a": 1000})
        status, said = checked(base, {"a": 1000}, dict(FACTS, compiler="clang 14"), "1")
        self.assertEqual(status, 3)
        self.assertIn("compiler clang 14 (baseline: gcc 12.2.0); TESSERA_REQUIRE_COUNTS is set", said)
        self.assertEqual(checked(None, {"a": 1}, required="1")[0], 3)
        self.assertEqual(checked(base, {"a": 1000}, required="1")[0], 0)
        self.assertEqual(checked(base, {"a": 1030}, required="1")[0], 1)

    def test_without_valgrind(self):
        with tempfile.TemporaryDirectory() as empty:
            for required, wanted in (("", 77), ("0", 77), ("1", 3)):
                status, out, err = perf("count", "--check", "--program", FAKE, PATH=empty,
                                        TESSERA_REQUIRE_COUNTS=required)
                self.assertEqual((status, "valgrind is not installed" in out), (wanted, True), out + err)
            status, out, err = perf("count", "--program", FAKE, PATH=empty)
            self.assertEqual((status, "valgrind is not installed" in err), (3, True), out + err)

    @unittest.skipUnless(count.valgrind_version(), "needs valgrind")
    def test_programs_that_do_not_count(self):
        with tempfile.TemporaryDirectory() as folder:
            status, _, err = perf("count", "--program", script(folder, "old", FAKE_FAULT="no_facts"))
            self.assertEqual((status, "older than the counts" in err), (3, True), err)
            status, _, err = perf("count", "--program", folder + "/none")
            self.assertEqual((status, "there is no program" in err), (3, True), err)
            status, _, err = perf("count", "--update", "--program", script(folder, "slowed", FAKE_PLANTED=3))
            self.assertEqual((status, "that is no baseline" in err), (3, True), err)


class Reasons(unittest.TestCase):
    def git(self, *words):
        subprocess.run(["git", "-c", "user.name=t", "-c", "user.email=t@t", *words], cwd=self.folder, check=True,
                       capture_output=True)

    def commit(self, counts, message):
        json_file.write(self.file, dict(FACTS, counts=counts))
        self.git("add", "-A")
        self.git("commit", "-q", "--allow-empty", "-m", message)

    def found(self):
        return count.raised_without_reason(self.file, 0.01, self.folder)

    def test_a_raised_baseline_needs_a_body(self):
        with tempfile.TemporaryDirectory() as folder:
            self.folder, self.file = folder, Path(folder, "counts.json")
            self.git("init", "-q")
            self.commit({"a": 1000, "b": 1000}, "first")
            self.assertEqual(self.found(), [])  # there is nothing before
            self.commit({"a": 1100, "b": 990}, "slower")
            self.assertEqual(self.found(), ["a"])
            self.commit({"a": 1300, "b": 990}, "slower again\n\nExact arithmetic, 18% more instructions.")
            self.assertEqual(self.found(), [])
            self.commit({"a": 1305, "b": 500}, "faster")
            self.assertEqual(self.found(), [])


if __name__ == "__main__":
    unittest.main()
