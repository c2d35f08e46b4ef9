"""Tests track, list and export: programs that are not Tessera's, from their output to the page of the report."""

import json
import os
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from support import ROOT, perf

TEMPLATE = os.environ.get("TESSERA_SPEED_PROGRAM")
GOOD = {"context": {"compiler": "gcc 12.2.0", "isa": "avx2", "date": "2026-01-01"},
        "benchmarks": [{"name": "draw/1", "items_per_second": 2e6, "limit_fraction": 0.25},
                       {"name": "pick", "real_time": 4, "time_unit": "us"},
                       {"name": "pick", "real_time": 2, "time_unit": "us"},
                       {"name": "pick_mean", "run_type": "aggregate", "real_time": -1}]}


class Tracking(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.records = self.folder / "perf-records"

    def program(self, body, name="game"):
        path = self.folder / name
        path.write_text(f"#!{sys.executable}\n{body}\n")
        path.chmod(0o755)
        return path

    def printing(self, content, name="game"):
        return self.program(f"print({(content if isinstance(content, str) else json.dumps(content))!r})", name)

    def track(self, program, *options, arguments=()):
        return perf("track", "--records", self.records, *options, program, *arguments, folder=ROOT)

    def record(self, content, name="game", *options):
        """Tracks a program that prints `content`; returns the file of the record."""
        before = set(self.records.glob("*"))
        status, out, err = self.track(self.printing(content, name), *options)
        self.assertEqual(status, 0, out + err)
        new, = set(self.records.glob("*")) - before
        return new

    def refuse(self, program, *words, options=()):
        status, out, err = self.track(program, *options)
        self.assertEqual(status, 3, out + err)
        for word in words:
            self.assertIn(word, err)
        self.assertNotIn("Traceback", err)
        self.assertFalse(self.records.exists())


class Track(Tracking):
    def test_a_record_of_another_program(self):
        content = json.loads(self.record(GOOD).read_text())
        self.assertEqual(content["program"], "game")
        self.assertEqual(content["facts"], {"compiler": "gcc 12.2.0", "isa": "avx2"})
        self.assertEqual(content["cases"], {"draw/1": {"rate": 2e6, "limit_fraction": 0.25}, "pick": {"rate": 5e5}})
        head = subprocess.run(["git", "rev-parse", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
        self.assertTrue(head.startswith(content["commit"]))

    def test_arguments_reach_the_program_and_the_best_pass_counts(self):
        body = ("import json, pathlib, sys\n"
                "assert sys.argv[1:] == ['--benchmark_format=json', '-o']\n"
                "file = pathlib.Path(sys.argv[0] + '.runs'); n = len(file.read_text()) if file.exists() else 0\n"
                "file.write_text('x' * (n + 1))\n"
                "print(json.dumps({'benchmarks': [{'name': 'a', 'items_per_second': [10, 30, 20][n]}]}))")
        status, out, err = self.track(self.program(body), "--passes", 3, "--name", "my game", "--of", "v1/2",
                                      arguments=("--benchmark_format=json", "-o"))
        self.assertEqual(status, 0, out + err)
        file, = self.records.glob("*")
        content = json.loads(file.read_text())
        self.assertEqual((content["program"], content["commit"]), ("my game", "v1/2"))
        self.assertEqual(content["cases"]["a"]["rate"], 30)

    def test_records_of_one_second_are_both_kept(self):
        files = {self.record(GOOD) for _ in range(3)}
        self.assertEqual(len(files), 3)

    def test_output_that_is_no_result_is_named(self):
        for text, word in (("", "printed nothing"), ("hello\nworld", "begins with 'hello'"),
                           ("{\"benchmarks\": [", "is not JSON"),
                           ("[" * 100000, "is not JSON"), ("[1]", 'without a list "benchmarks"'),
                           ("{\"benchmarks\": 3}", 'without a list "benchmarks"'), ("{\"benchmarks\": []}", "no case"),
                           ("{\"benchmarks\": [{}]}", 'benchmarks[0] without a "name"')):
            with self.subTest(text=text[:30]):
                self.refuse(self.printing(text), word)
        self.refuse(self.program("import sys; sys.stdout.buffer.write(b'\\xff\\xfe\\x00')"), "is not JSON")

    def test_figures_that_are_no_rates_are_named(self):
        for entry, word in (({"items_per_second": float("nan")}, "items_per_second nan"),
                            ({"items_per_second": float("inf")}, "items_per_second inf"),
                            ({"items_per_second": -1}, "items_per_second -1"),
                            ({"items_per_second": 0}, "items_per_second 0"),
                            ({"items_per_second": "5"}, "items_per_second 5"), ({"real_time": -2}, "real_time -2"),
                            ({}, "real_time None"), ({"real_time": 1, "time_unit": "h"}, "time_unit 'h'"),
                            ({"items_per_second": 1, "limit_fraction": float("nan")}, "limit_fraction nan")):
            with self.subTest(entry=entry):
                self.refuse(self.printing({"benchmarks": [dict(entry, name="draw")]}), "case 'draw'", word)
        wrong = {"name": "draw", "items_per_second": 1, "error_occurred": True, "error_message": "12 pixels differ"}
        self.refuse(self.printing({"benchmarks": [wrong]}), "case 'draw' failed its check: 12 pixels differ")

    def test_programs_that_fail_are_named(self):
        self.refuse(self.program("import sys; sys.exit('no display')"), "exit status 1", "no display")
        self.refuse(self.program("import os; os.kill(os.getpid(), 11)"), "signal 11, SIGSEGV")
        self.refuse(self.folder / "none", "is no program")
        plain = self.folder / "plain"
        plain.write_text("text")
        self.refuse(plain, "is no program")
        plain.chmod(0o755)
        plain.write_bytes(b"\x7fELF")
        self.refuse(plain, "does not start")

    def test_a_program_that_hangs_is_stopped_with_its_children(self):
        child = self.folder / "child"
        body = ("import subprocess, time\nprocess = subprocess.Popen(['sleep', '60'])\n"
                f"open({str(child)!r}, 'w').write(str(process.pid))\ntime.sleep(60)")
        begun = time.monotonic()
        self.refuse(self.program(body), "did not end within 2 s", "--time-limit", options=("--time-limit", 2))
        self.assertLess(time.monotonic() - begun, 30)
        for _ in range(100):  # until the system has removed it
            state = Path("/proc", child.read_text(), "stat")
            if not state.exists() or state.read_text().rsplit(")", 1)[1].split()[0] == "Z":
                return
            time.sleep(0.1)
        self.fail("the child of the stopped program still runs")

    def test_cases_that_are_not_in_all_passes_are_named(self):
        body = ("import json, os\nfile = __file__ + '.ran'\n"
                "name = 'b' if os.path.exists(file) else 'a'\nopen(file, 'w').close()\n"
                "print(json.dumps({'benchmarks': [{'name': name, 'items_per_second': 1}]}))")
        self.refuse(self.program(body), "is not in all runs", options=("--passes", 2))

    def test_outside_of_a_repository_the_version_is_asked_for(self):
        program = self.printing(GOOD)
        done = lambda *words: perf("track", *words, program, folder=self.folder,
                                   GIT_CEILING_DIRECTORIES=str(self.folder.parent))
        status, _, err = done()
        self.assertEqual((status, "--of TEXT" in err), (3, True), err)
        status, _, err = done("--of", "1.2.0")
        self.assertEqual(status, 0, err)
        self.assertEqual(len(list(self.records.glob("*1.2.0.json"))), 1)

    def test_a_folder_that_can_not_be_written_is_named(self):
        status, _, err = perf("track", "-o", "/proc/none/a.json", self.printing(GOOD), folder=ROOT)
        self.assertEqual((status, "can't be written" in err), (3, True), err)

    def test_record_leads_to_track(self):
        body = "import sys; sys.exit('unknown argument')"
        status, _, err = perf("record", self.program(body), "-o", self.folder / "x.json")
        self.assertEqual((status, "tools/perf track" in err), (3, True), err)
        status, _, err = perf("record", self.printing(GOOD), "-o", self.folder / "x.json")
        self.assertEqual((status, "tools/perf track" in err), (3, True), err)


class Records(Tracking):
    def test_list_names_date_commit_machine_and_cases(self):
        file = self.record(GOOD)
        status, out, err = perf("list", self.records)
        self.assertEqual(status, 0, err)
        head, line = out.splitlines()
        content = json.loads(file.read_text())
        self.assertEqual(head.split(), ["date", "commit", "program", "machine", "cases", "file"])
        processor = content["machine"]["processor"]
        for word in (content["date"], content["commit"], "game", processor, "avx2", "  2  ", str(file)):
            self.assertIn(word, line)

    def test_a_record_cut_short_is_named_by_every_command(self):
        whole, cut = self.record(GOOD), self.records / "cut.json"
        cut.write_text(whole.read_text()[:150])
        status, out, err = perf("list", self.records)
        self.assertEqual((status, "game" in out, "cut.json is not JSON" in err), (3, True, True), out + err)
        for command in ("report", "export"):
            status, _, err = perf(command, self.records, "-o", self.folder / "out")
            self.assertEqual((status, "cut.json is not JSON" in err, "record again" in err), (3, True, True), err)
        self.assertFalse((self.folder / "out").exists())

    def test_records_with_wrong_fields_are_named(self):
        good = json.loads(self.record(GOOD).read_text())
        for change, word in (({"machine": "mine"}, '"machine" is str'), ({"cases": []}, '"cases" is list'),
                             ({"cases": {"a": {"rate": float("nan")}}}, "'a' is nan"),
                             ({"cases": {"a": 5}}, "'a' is None"),
                             ({"cases": {"a": {"rate": -3}}}, "'a' is -3"), ({"date": 5}, '"date" is int')):
            with self.subTest(change=change):
                bad = self.folder / "bad.json"
                bad.write_text(json.dumps(dict(good, **change)))
                status, _, err = perf("report", bad, "-o", self.folder / "out")
                self.assertEqual((status, word in err, "Traceback" in err), (3, True, False), err)

    def test_an_empty_folder_is_named(self):
        self.records.mkdir()
        for command in ("list", "report", "export"):
            status, _, err = perf(command, self.records)
            self.assertEqual((status, "holds no record" in err), (3, True), err)

    def test_export_is_what_github_action_benchmark_reads(self):
        self.record(GOOD)
        for figure, values, unit in (("rate", [2e6, 5e5], "items/s"), ("time", [500, 2000], "ns/item")):
            status, out, err = perf("export", "--format", "github-action-benchmark", "--figure", figure, self.records)
            self.assertEqual(status, 0, err)
            entries = json.loads(out)
            self.assertEqual([(e["name"], e["value"], e["unit"]) for e in entries],
                             list(zip(["draw/1", "pick"], values, [unit] * 2)))
            self.assertTrue(all(e.keys() <= {"name", "unit", "value", "range", "extra"} for e in entries))
            self.assertIn("0.25 of the machine's limit", entries[0]["extra"])
        file = self.folder / "figures.json"
        self.assertEqual(perf("export", self.records, "-o", file)[0], 0)
        self.assertEqual(len(json.loads(file.read_text())), 2)

    def test_a_history_of_another_machine_is_left_out_and_named(self):
        first = self.record(GOOD)
        other = json.loads(first.read_text())
        other["machine"]["processor"], other["commit_time"] = "Abacus <2>", 0
        (self.records / "other.json").write_text(json.dumps(other))
        page = self.folder / "page.html"
        status, out, err = perf("report", self.records, "-o", page)
        self.assertEqual((status, out.startswith("1 record:")), (0, True), out + err)
        self.assertIn("1 record is left out", err)
        self.assertIn("Abacus <2>", err)
        self.assertIn("Abacus &lt;2&gt;", page.read_text())
        status, out, err = perf("report", self.records, "-o", page, "--machine", "abacus")
        self.assertEqual((status, out.startswith("1 record:"), "this machine is" in err), (0, True, True), out + err)
        status, _, err = perf("export", self.records, "--machine", "cray")
        self.assertEqual((status, "no record fits --machine cray" in err, "Abacus" in err), (3, True, True), err)

    def test_programs_are_kept_apart(self):
        self.record(GOOD, "game")
        self.record(dict(GOOD, benchmarks=[{"name": "x", "items_per_second": 1}]), "viewer")
        status, out, err = perf("export", self.records, "--program", "viewer")
        self.assertEqual((status, [e["name"] for e in json.loads(out)]), (0, ["x"]), err)
        status, out, err = perf("export", self.records, "--program", "game")
        self.assertEqual((status, len(json.loads(out))), (0, 2), err)

    def test_the_page_keeps_cases_that_the_newest_record_lacks(self):
        old = json.loads(self.record(GOOD).read_text())
        old.update(date="2025-12-31 10:00", commit="abc1234", commit_time=1)
        old["cases"]["gone/<1>"] = {"rate": 4321}
        (self.records / "old.json").write_text(json.dumps(old))
        page = self.folder / "page.html"
        status, out, err = perf("report", self.records, "-o", page)
        self.assertEqual(status, 0, out + err)
        text = page.read_text()
        self.assertIn("3 cases, 1 of them not in the newest record", text)
        row = next(row for row in text.split("<tr>") if row.startswith("<td>gone/&lt;1&gt;"))
        self.assertIn("not in the newest record; last on 2025-12-31 with commit abc1234", row)
        self.assertIn("4.32 k", row)
        self.assertNotIn("Instructions", text)  # Tessera's counts are not this program's


@unittest.skipUnless(TEMPLATE, "TESSERA_SPEED_PROGRAM does not name the built template")
class Template(Tracking):
    def test_the_template_is_tracked_from_record_to_report(self):
        for passes in (1, 2):
            status, out, err = self.track(TEMPLATE, "--passes", passes)
            self.assertEqual((status, out.startswith("2 cases of speed")), (0, True), out + err)
        status, out, err = perf("list", self.records)
        self.assertEqual((status, len(out.splitlines())), (0, 3), out + err)
        page = self.folder / "page.html"
        status, out, err = perf("report", self.records, "-o", page)
        self.assertEqual((status, out.startswith("2 records")), (0, True), out + err)
        for words in ("speed, measured", "grids/9", "grids/33"):
            self.assertIn(words, page.read_text())
        status, out, err = perf("export", self.records)
        self.assertEqual([e["name"] for e in json.loads(out)], ["grids/33", "grids/9"], err)
        self.assertTrue(all("limit" in e["extra"] for e in json.loads(out)))


if __name__ == "__main__":
    unittest.main()
