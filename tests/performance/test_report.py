"""Tests record and report: the records that are kept, and the page made of them."""

import html.parser
import json
import re
import shutil
import tempfile
import unittest
import xml.etree.ElementTree
from pathlib import Path

from support import FAKE, perf, script
from performance import machine, plots, records, report

VOID = {"meta", "br", "line", "circle", "rect", "polyline"}


class Nesting(html.parser.HTMLParser):
    """Whether every element that needs an end has it."""

    def __init__(self, text):
        super().__init__()
        self.open, self.faults, self.seen = [], [], set()
        self.feed(text)
        self.faults += self.open

    def handle_starttag(self, tag, attributes):
        self.seen.add(tag)
        if tag not in VOID and tag not in ("td", "th", "tr"):
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.seen.add(tag)

    def handle_endtag(self, tag):
        if tag in VOID or tag in ("td", "th", "tr"):
            return
        if not self.open or self.open.pop() != tag:
            self.faults.append(tag)


class Reports(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "baselines").mkdir()

    def record(self, name, *words, **environment):
        file = self.folder / name
        status, out, err = perf("record", script(self.folder, "bench", **environment), "-o", file, "--seconds", "0.01", *words)
        self.assertEqual(status, 0, out + err)
        return file, json.loads(file.read_text())

    def report(self, *records, words=()):
        page = self.folder / "page" / "report.html"
        done = perf("report", *records, "-o", page, "--baselines", self.folder / "baselines", *words)
        return page, done

    def test_a_record_holds_what_figures_depend_on(self):
        _, content = self.record("a.json", "--roofline")
        self.assertEqual(content["facts"]["compiler"], "gcc 12.2.0")
        self.assertEqual(len(content["cases"]), 3)
        self.assertEqual(content["cases"]["read.obj/bspline/3/20MB/-/1"], {"rate": 1e9, "limit_fraction": 0.5})
        self.assertRegex(content["commit"], "^[0-9a-f]{7,}$")
        self.assertIn("isas", content["roofline"])

    def test_slowed_programs_are_not_recorded(self):
        status, _, err = perf("record", script(self.folder, "slow", FAKE_PLANTED=3), "-o", self.folder / "x.json")
        self.assertEqual((status, "nobody's" in err), (3, True), err)
        self.assertFalse((self.folder / "x.json").exists())

    def test_the_page_is_whole_and_needs_no_other_file(self):
        first, _ = self.record("a.json")
        second, _ = self.record("b.json", "--roofline", FAKE_SLOWER=20)
        peers = self.folder / "peers.json"
        row = {"task": "positions", "peer": "SISL <4.6>", "way": "s1506", "rate": 2e6, "against": "blocks", "ratio": 17.5}
        peers.write_text(json.dumps({"date": "2026-01-01", "machine": "m", "rows": [row]}))
        counts = self.folder / "baselines" / "valgrind_avx2" / "counts.json"
        counts.parent.mkdir()
        counts.write_text(json.dumps({"counts": {"extract/bspline/3/200x200": 123456}}))
        page, (status, out, err) = self.report(first, second, words=("--peers", peers))
        self.assertEqual(status, 0, out + err)
        text = page.read_text()
        nesting = Nesting(text)
        self.assertEqual(nesting.faults, [])
        self.assertTrue({"svg", "table", "h2"} <= nesting.seen)
        self.assertIsNone(re.search(r"(src|href)\s*=|url\(|@import", text))
        for words in ("123,456", "SISL &lt;4.6&gt;", "17.5", "Roofline", "class='n slower'>0.83"):
            self.assertIn(words, text)
        for svg in re.findall(r"<svg.*?</svg>", text, re.DOTALL):
            xml.etree.ElementTree.fromstring(svg)
        if shutil.which("rsvg-convert"):
            for name in ("history", "roofline", "peers"):
                self.assertEqual((page.parent / f"{name}.png").read_bytes()[:4], b"\x89PNG")

    def test_a_record_that_became_a_baseline_stands_once(self):
        first, content = self.record("a.json")
        (self.folder / "copy.json").write_text(json.dumps(content))
        self.assertEqual(len(records.read([first, self.folder / "copy.json"], self.folder)), 1)

    def test_records_of_other_machines_are_left_out(self):
        _, content = self.record("a.json")
        other = json.loads(json.dumps(content))
        other["machine"]["processor"], other["commit_time"] = "another", 0
        kept, others = records.choose([other, content])
        self.assertEqual((kept, others), ([content], [other]))

    def test_peers_of_another_machine_are_never_this_ones(self):
        record, content = self.record("a.json")
        row = {"task": "positions", "peer": "SISL", "way": "s1506", "rate": 2e6, "against": "blocks", "ratio": 17.5}
        peers = self.folder / "baselines" / "abacus" / "peers.json"
        peers.parent.mkdir()
        for place, shown in (("Abacus 2", False), (machine.title(content["machine"]), True)):
            peers.write_text(json.dumps({"date": "2026-01-01", "machine": place, "rows": [row]}))
            page, (status, out, err) = self.report(record)
            self.assertEqual((status, "made on Abacus 2" in err), (0, not shown), out + err)
            self.assertEqual(("s1506" in page.read_text(), "<h2>Peers</h2>" in page.read_text()), (shown, shown))
        peers.write_text(json.dumps({"date": "2026-01-01", "machine": "Abacus 2", "rows": [row]}))
        page, (status, out, err) = self.report(record, words=("--peers", peers))
        self.assertEqual((status, "<h2>Peers on another machine</h2>" in page.read_text()), (0, True), out + err)

    def test_what_is_broken_or_missing_is_named(self):
        bad = self.folder / "bad.json"
        for text, words in (("{", "not JSON"), ("{}", 'no "commit"'), ("[]", 'no "commit"')):
            bad.write_text(text)
            _, (status, _, err) = self.report(bad)
            self.assertEqual((status, words in err), (3, True), err)
        _, (status, _, err) = self.report(self.folder / "none.json")
        self.assertEqual((status, "there is no record" in err), (3, True), err)
        self.assertFalse((self.folder / "page").exists())

    def test_the_stand_in_can_be_recorded(self):
        status, out, _ = perf("record", FAKE, "-o", self.folder / "x.json", "--filter", "^read", "--seconds", "0.01")
        self.assertEqual((status, out.startswith("1 cases")), (0, True))


class Peers(unittest.TestCase):
    ROW = {"task": "positions", "peer": "SISL 4.6.0", "way": "s1506", "rate": 2.5e6, "against": "blocks", "ratio": 17.512, "main": True}

    def test_one_line_for_each_way_of_a_peer(self):
        with tempfile.TemporaryDirectory() as folder:
            results, page = Path(folder, "results.jsonl"), Path(folder, "peers.json")
            results.write_text("\n".join(json.dumps(row) for row in (self.ROW, dict(self.ROW, against="x y z", ratio=123.4))) + "\n")
            status, out, err = perf("peers", results, "-o", page)
            self.assertEqual(status, 0, err)
            self.assertIn("| positions | SISL 4.6.0, s1506 | 2.5 M | blocks 17.5, x y z 123 |", out)
            self.assertEqual(len(json.loads(page.read_text())["rows"]), 2)

    def test_broken_results_are_named(self):
        with tempfile.TemporaryDirectory() as folder:
            results = Path(folder, "results.jsonl")
            for text, words in (("", "no comparison"), ("{", "line 1"), (json.dumps({"task": "x"}), 'no "peer"')):
                results.write_text(text)
                status, _, err = perf("peers", results)
                self.assertEqual((status, words in err), (3, True), err)
            status, _, err = perf("peers", results.parent / "none")
            self.assertEqual((status, "can't be read" in err), (3, True), err)


class Plots(unittest.TestCase):
    def test_labels_keep_apart(self):
        places = plots.apart([10, 11, 12, 50], 17)
        ordered = sorted(places)
        self.assertTrue(all(b - a >= 17 - 1e-9 for a, b in zip(ordered, ordered[1:])))

    def test_ticks_are_round_and_within(self):
        for low, high in ((0.93, 1.21), (0, 7), (0.4, 40)):
            ticks = plots.nice_ticks(low, high)
            self.assertTrue(2 <= len(ticks) <= 9, ticks)
            self.assertTrue(all(low - 1e-9 <= t <= high + 1e-9 for t in ticks))

    def test_means_are_geometric_and_of_common_cases(self):
        lines = report.lines_of([{"a.x/1": 1.0, "a.y/1": 1.0}, {"a.x/1": 4.0, "a.y/1": 1.0, "a.z/1": 9.0}])
        self.assertEqual(lines["a"][0], 1)
        self.assertAlmostEqual(lines["a"][1], 2)


if __name__ == "__main__":
    unittest.main()
