"""Tests the texts that show how to track speed: the recipe for continuous integration is run, and every command line of
tools/perf in the guides is parsed.
"""

import contextlib
import io
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from support import ROOT
from performance.commands import make_parser

try:
    import yaml
except ImportError:
    yaml = None

RECIPE = ROOT / "tools" / "performance" / "template" / "speed.yml"
GUIDES = [ROOT / "engine" / "docs" / "tracking-speed.md", ROOT / "bench" / "README.md"]
# The inputs of github-action-benchmark v1, from its action.yml.
INPUTS = set("""name tool output-file-path gh-pages-branch gh-repository benchmark-data-dir-path github-token ref
auto-push skip-fetch-gh-pages comment-on-pull-request comment-always summary-always save-data-file comment-on-alert
alert-threshold fail-on-alert fail-threshold alert-comment-cc-users external-data-json-path
max-items-in-chart""".split())


def command_lines(text):
    """The words of each command line that starts tools/perf, without the program."""
    for line in text.splitlines():
        found = re.match(r"\s*(?:\S*/)?tools/perf\s+(.*)", line)
        if found:
            yield shlex.split(found[1], comments=True)


def fault_of(words):
    """The parser's message on a command line, or nothing."""
    message = io.StringIO()
    try:
        with contextlib.redirect_stderr(message):
            make_parser().parse_args(words)
    except SystemExit:
        return message.getvalue()
    return ""


class Texts(unittest.TestCase):
    def test_guides_name_commands_and_options_that_exist(self):
        for guide in GUIDES:
            blocks = re.findall(r"^```sh\n(.*?)^```$", guide.read_text(), re.M | re.S)
            lines = [words for block in blocks for words in command_lines(block)]
            self.assertGreaterEqual(len(lines), 3, guide)
            for words in lines:
                self.assertEqual(fault_of(words), "", f"{guide}: {' '.join(words)}")

    def test_unknown_commands_and_options_are_found(self):
        for line in ("tools/perf trace ./a", "  tessera/tools/perf list --colour", "tools/perf export --format csv"):
            words, = command_lines(line)
            self.assertNotEqual(fault_of(words), "", line)


@unittest.skipUnless(yaml, "PyYAML is not installed (Debian's package python3-yaml)")
class Recipe(unittest.TestCase):
    def setUp(self):
        self.steps = yaml.safe_load(RECIPE.read_text())["jobs"]["speed"]["steps"]
        self.scripts = {step["name"]: step["run"] for step in self.steps if "run" in step}

    def test_it_names_what_exists(self):
        lines = [words for script in self.scripts.values() for words in command_lines(script)]
        self.assertEqual([words[0] for words in lines], ["track", "list", "report", "export"])
        for words in lines:
            self.assertEqual(fault_of(words), "", words)
        presets = {p["name"] for p in json.loads((ROOT / "CMakePresets.json").read_text())["configurePresets"]}
        text = RECIPE.read_text()
        self.assertLessEqual(set(re.findall(r"--preset (\w+)", text)), presets)
        setup = (ROOT / "tools" / "setup.sh").read_text()
        for purpose in re.findall(r"setup\.sh --for (\w+)", text):
            self.assertIn(f"  {purpose}) packages=", setup)
        action, = (step for step in self.steps if step.get("uses", "").startswith("benchmark-action/"))
        self.assertLessEqual(set(action["with"]), INPUTS)

    def run_script(self, name):
        done = subprocess.run(["bash", "-e", "-c", self.scripts[name]], cwd=self.folder, capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def git(self, *words, cwd=None, **environment):
        done = subprocess.run(["git", "-c", "user.name=t", "-c", "user.email=t@t", *words], cwd=cwd or self.folder,
                              capture_output=True, text=True, check=True, env=dict(os.environ, **environment))
        return done.stdout

    def test_two_runs_keep_their_records_in_the_branch(self):
        with tempfile.TemporaryDirectory() as folder:
            self.folder, origin = Path(folder, "work"), Path(folder, "origin.git")
            self.git("init", "-q", "--bare", str(origin), cwd=folder)
            self.git("clone", "-q", str(origin), str(self.folder), cwd=folder)
            setup = re.search(r"#   (git switch --orphan .*)", RECIPE.read_text())[1]
            setup = setup.replace("git commit", "git -c user.name=t -c user.email=t@t commit")
            subprocess.run(["bash", "-e", "-c", setup], cwd=self.folder, capture_output=True, check=True)
            self.git("switch", "-q", "--orphan", "main")
            self.git("clone", "-q", "--branch", "speed-history", str(origin), "history")
            (self.folder / "tessera").symlink_to(ROOT)
            program = self.folder / "build" / "speed" / "speed"
            program.parent.mkdir(parents=True)
            for rate in (5, 6):
                content = json.dumps({"benchmarks": [{"name": "a", "items_per_second": rate}]})
                program.write_text(f"#!{sys.executable}\nprint('{content}')\n")
                program.chmod(0o755)
                self.git("commit", "-q", "--allow-empty", "-m", f"rate {rate}",
                         GIT_COMMITTER_DATE=f"2026-01-0{rate} 12:00:00")
                self.run_script("Track")
                self.run_script("Keep")
            kept = self.git("ls-tree", "-r", "--name-only", "speed-history", cwd=origin).split()
            self.assertEqual(len([name for name in kept if re.fullmatch(r"records/.*\.json", name)]), 2, kept)
            self.assertIn("index.html", kept)
            figures = json.loads((self.folder / "build" / "figures.json").read_text())
            self.assertEqual([(entry["name"], entry["value"]) for entry in figures], [("a", 6)])


if __name__ == "__main__":
    unittest.main()
