"""Tests the labels of the roofline by their coordinates in the SVG: none covers a line, a mark or another label."""

import json
import random
import shutil
import tempfile
import unittest
import xml.etree.ElementTree
from pathlib import Path

from support import ROOT, perf
from performance import plots, roofline
from performance.labels import Box, Labels, around

SVG = "{http://www.w3.org/2000/svg}"


class Picture:
    """Lines, marks and labels within the frame of a plot. The faint lines are the grid, which labels may cover."""

    def __init__(self, text):
        self.segments, self.marks, self.labels = [], [], []
        for part in xml.etree.ElementTree.fromstring(text):
            kind = part.tag.removeprefix(SVG)
            number = lambda key: float(part.get(key))
            if kind == "line" and part.get("stroke") != plots.FAINT:
                self.segments.append(tuple(map(number, ("x1", "y1", "x2", "y2"))))
            elif kind == "polyline":
                points = [tuple(map(float, pair.split(","))) for pair in part.get("points").split()]
                self.segments += [(*a, *b) for a, b in zip(points, points[1:])]
            elif kind == "circle":
                x, y, r = map(number, ("cx", "cy", "r"))
                self.marks.append(Box(x - r, y - r, x + r, y + r))
            elif kind == "text" and part.get("paint-order"):
                self.labels.append((part.text, self.box_of(part)))

    @staticmethod
    def box_of(part):
        """The box of the letters, with 0.6 of the size for each: the mean width of DejaVu Sans."""
        x, y, size = (float(part.get(key)) for key in ("x", "y", "font-size"))
        width = 0.6 * size * len(part.text)
        left = x - {"start": 0, "middle": 0.5, "end": 1}[part.get("text-anchor")] * width
        return Box(left, y - 0.75 * size, left + width, y + 0.2 * size)

    def faults(self):
        found = []
        for k, (words, box) in enumerate(self.labels):
            found += [f"'{words}' covers a line" for segment in self.segments if box.meets_segment(*segment)]
            found += [f"'{words}' covers a mark" for mark in self.marks if box.meets(mark)]
            found += [f"'{words}' covers '{other}'" for other, there in self.labels[k + 1:] if box.meets(there)]
        return found


def content_of(source):
    """A machine by chance, with points near its roofs, as measurements lie."""
    base = 10 ** source.uniform(9.5, 11.5)
    isas = [{"isa": isa, "float_operations": base * factor * source.uniform(0.8, 1.2), "plain_store": 5e9,
             "streaming_store": base / 8}
            for isa, factor in zip(("sse2", "avx2", "avx512"), (1, 2, source.choice((2, 4))))]
    isas.sort(key=lambda isa: isa["float_operations"])
    points = []
    for cached, rate in ((True, base), (False, base / 8)):
        for name, per_byte in (("positions", 1), ("+ normals", 2.08), ("+ du + dv", 1), ("+ curvatures", 1.275)):
            operations = min(isas[-1]["float_operations"], rate * per_byte) * source.uniform(0.3, 1)
            points.append({"name": name, "per_byte": per_byte, "operations": operations, "points": 1e9,
                           "in_cache": cached})
    return {"machine": "a machine", "cache_store": base, "isas": isas, "points": points}


class Roofline(unittest.TestCase):
    def test_labels_cover_nothing(self):
        source = random.Random(7)
        contents = [content_of(source) for _ in range(200)]
        for file in (ROOT / "bench" / "baselines").glob("*/times.json"):
            contents += [drawn for drawn in [json.loads(file.read_text()).get("roofline")] if drawn]
        for content in contents:
            picture = Picture(roofline.draw(content))
            self.assertEqual(picture.faults(), [], content)
            self.assertEqual(len(picture.labels), 2 + len(content["isas"]) + len(content["points"]))
            self.assertEqual(len(picture.marks), len(content["points"]))
            self.assertGreaterEqual(len(picture.segments), 2 * 2 + len(content["isas"]) - 2)

    def test_the_check_finds_what_overlaps(self):
        style = "y='10' font-size='10' text-anchor='start' paint-order='stroke'"
        text = lambda x, words: f"<text x='{x}' {style}>{words}</text>"
        faults = lambda *parts: Picture(f"<svg xmlns='http://www.w3.org/2000/svg'>{''.join(parts)}</svg>").faults()
        self.assertEqual(faults(text(0, "abc"), text(15, "d")), ["'abc' covers 'd'"])
        self.assertEqual(faults(text(0, "abc"), "<polyline points='0,0 20,10'/>"), ["'abc' covers a line"])
        self.assertEqual(faults(text(0, "abc"), "<circle cx='20' cy='8' r='4'/>"), ["'abc' covers a mark"])
        self.assertEqual(faults(text(0, "abc"), text(19, "d"), "<polyline points='0,12.5 20,13'/>"), [])


class Command(unittest.TestCase):
    def test_a_measured_file_becomes_a_picture(self):
        with tempfile.TemporaryDirectory() as folder:
            measured = Path(folder, "machine.json")
            measured.write_text(json.dumps(content_of(random.Random(1))))
            status, out, err = perf("roofline", measured)
            self.assertEqual((status, out.strip()), (0, str(measured.with_suffix(".svg"))), err)
            self.assertEqual(len(Picture(measured.with_suffix(".svg").read_text()).marks), 8)
            picture = Path(folder, "machine.png")
            status, _, err = perf("roofline", measured, "-o", picture)
            if shutil.which("rsvg-convert"):
                self.assertEqual((status, picture.read_bytes()[:4]), (0, b"\x89PNG"), err)
            else:
                self.assertEqual((status, "not installed" in err), (3, True), err)

    def test_broken_files_are_named(self):
        good = content_of(random.Random(1))
        point = good["points"][0]
        with tempfile.TemporaryDirectory() as folder:
            measured = Path(folder, "machine.json")
            self.expect_fault(measured, "there is no")
            for content, word in (([], "the object"), ({}, "cache_store"), (dict(good, isas=[]), "isas"),
                                  (dict(good, points=[dict(point, operations=float("nan"))]), "operations in points"),
                                  (dict(good, points=[dict(point, name=5)]), "a name in points"),
                                  (dict(good, points=[dict(point, in_cache=None)]), "in_cache")):
                measured.write_text(json.dumps(content))
                self.expect_fault(measured, word)
            measured.write_text(json.dumps(good)[:300])
            self.expect_fault(measured, "not JSON")
            measured.write_text(json.dumps(good))
            self.expect_fault(measured, "must end in", "-o", Path(folder, "machine.gif"))

    def expect_fault(self, measured, word, *options):
        status, _, err = perf("roofline", measured, *options)
        self.assertEqual((status, word in err, "Traceback" in err), (3, True, False), err)


class Boxes(unittest.TestCase):
    def test_segments_meet_boxes(self):
        box = Box(10, 10, 20, 20)
        for segment in ((0, 0, 30, 30), (12, 12, 13, 13), (0, 25, 25, 0), (15, 0, 15, 11)):
            self.assertTrue(box.meets_segment(*segment), segment)
        for segment in ((0, 5, 30, 5), (0, 0, 9, 30), (15, 0, 15, 9), (0, 19, 11, 31)):
            self.assertFalse(box.meets_segment(*segment), segment)

    def test_many_marks_on_one_place_get_labels_apart(self):
        labels = Labels(Box(0, 0, 600, 400))
        labels.keep_off_mark(300, 200, 7)
        places = labels.place_all([("label", 12, list(around(300, 200)))] * 8)
        boxes = [Box.of_text(x, y, "label", 12, anchor) for x, y, anchor in places]
        self.assertFalse(any(a.meets(b) for k, a in enumerate(boxes) for b in boxes[k + 1:]))

    def test_without_room_there_is_no_label(self):
        self.assertIsNone(Labels(Box(0, 0, 5, 5)).place("label", 12, around(2, 2)))


if __name__ == "__main__":
    unittest.main()
