"""Tests compare --program: two commits of a repository that is not Tessera's, in turns."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from support import ROOT, perf

# A program whose time per item is that of the file `nanoseconds`, within a hundredth, which differs from run to run.
PROGRAM = f"""#!{sys.executable} -SE
import json, pathlib, random
here = pathlib.Path(__file__).parent
time = float((here / "nanoseconds").read_text()) * random.uniform(0.995, 1.005)
print(json.dumps({{"benchmarks": [{{"name": "draw", "items_per_second": 1e9 / time}},
                                  {{"name": "pick", "real_time": 4 * random.uniform(0.995, 1.005), "time_unit": "us"}}]}}))
"""


class OwnProgram(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name) / "game"
        self.folder.mkdir()
        self.git("init", "-q")

    def git(self, *words):
        subprocess.run(["git", "-c", "user.name=A", "-c", "user.email=a@example.org", *words], cwd=self.folder,
                       check=True, capture_output=True)

    def commit(self, nanoseconds, tag):
        program = self.folder / "speed.in"
        program.write_text(PROGRAM)
        (self.folder / "nanoseconds").write_text(str(nanoseconds))
        self.git("add", "-A")
        self.git("commit", "-q", "--allow-empty", "-m", f"takes {nanoseconds}")
        self.git("tag", tag)

    def compare(self, *words, build="cp speed.in speed && chmod +x speed"):
        return perf("compare", *words, "--build", build, "--program", "./speed", "--quads", "4", folder=self.folder)

    def test_a_planted_slow_down_is_found_and_a_pair_without_is_not(self):
        self.commit(100, "v1")
        self.commit(150, "v2")
        self.commit(100, "v3")
        for _ in range(int(os.environ.get("TESSERA_COMPARE_REPEATS", "1"))):
            status, out, err = self.compare("v1", "v2")
            self.assertEqual(status, 1, out + err)
            self.assertRegex(out, r"draw .*SLOWER")
            self.assertRegex(out, r"pick .*same")
            status, out, err = self.compare("v1", "v3")
            self.assertEqual(status, 0, out + err)
        (self.folder / "nanoseconds").write_text("200")
        status, out, _ = self.compare("v1", ".")  # the tree as it is
        self.assertEqual(status, 1)
        self.assertIn("head: this tree", out)
        self.assertEqual(subprocess.run(["git", "status", "--porcelain"], cwd=self.folder, capture_output=True, text=True,
                                        check=True).stdout.split(), ["M", "nanoseconds", "??", "speed"])

    def refuse(self, words, *said, **options):
        status, out, err = self.compare(*words, **options)
        self.assertEqual(status, 3, out + err)
        for word in said:
            self.assertIn(word, err)
        self.assertNotIn("Traceback", err)

    def test_wrong_calls(self):
        self.commit(100, "v1")
        self.refuse(("v1", "v9"), "'v9' is no commit of")
        self.refuse(("v1", "."), "can't be built: 'exit 7' ended with 7", build="exit 7")
        self.refuse(("v1", "."), "there is no program", build="true")
        self.refuse(("v1", "."), "ended with", build="printf '#!/bin/sh\\nexit 3\\n' >speed && chmod +x speed")
        status, _, err = perf("compare", "HEAD", ".", "--program", "build/speed", folder=ROOT)
        self.assertEqual(status, 3)
        self.assertIn("is Tessera's clone", err)
        with tempfile.TemporaryDirectory() as nowhere:
            status, _, err = perf("compare", "HEAD", ".", "--program", "speed", folder=nowhere)
        self.assertEqual(status, 3)
        self.assertIn("is in no git repository", err)


if __name__ == "__main__":
    unittest.main()
