"""Tests of the survey's judgement, by small meshes and truths."""

import json
import pathlib
import struct
import tempfile
import unittest

import survey
from judgement import Fault, Run, fault_of
from mesh_facts import MeshFacts, facts_of

CORNERS = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))
TETRAHEDRON = ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3))
TRUTH = {
    "faces": 4,
    "diagonal": 3**0.5,
    "area": 1.5 + 3**0.5 / 2,
    "area_quick": None,
    "parts": [{"closed": 1, "valid": 1, "faces": 4, "volume": 1 / 6, "volume_quick": 1 / 6}],
}


def facts(triangles):
    """The facts of a file with these triangles."""
    records = b"".join(
        struct.pack("<12fH", 0, 0, 0, *(x for corner in triangle for x in CORNERS[corner]), 0) for triangle in triangles
    )
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "x.stl"
        path.write_bytes(bytes(80) + struct.pack("<I", len(triangles)) + records)
        return facts_of(path)


def kind(run, truth=None):
    fault = fault_of(truth or TRUTH, run, 1e-3)
    return fault and fault.kind


class Facts(unittest.TestCase):
    def test_a_tetrahedron(self):
        found = facts(TETRAHEDRON)
        self.assertEqual((found.triangles, found.open_edges, found.inconsistent_edges), (4, 0, 0))
        self.assertAlmostEqual(found.area, TRUTH["area"], 6)
        self.assertAlmostEqual(found.volume, 1 / 6, 6)

    def test_faults_of_a_tetrahedron(self):
        self.assertEqual(facts(TETRAHEDRON[1:]).open_edges, 3)
        self.assertEqual(facts(((0, 1, 2), *TETRAHEDRON[1:])).inconsistent_edges, 3)
        self.assertAlmostEqual(facts([face[::-1] for face in TETRAHEDRON]).volume, -1 / 6, 6)
        self.assertEqual(facts([]), MeshFacts())


class Judgement(unittest.TestCase):
    def test_a_right_mesh(self):
        self.assertIsNone(kind(Run(0, 1, mesh=facts(TETRAHEDRON))))

    def test_each_kind(self):
        right = facts(TETRAHEDRON)
        self.assertEqual(kind(Run("hang", 60)), "hang")
        self.assertEqual(kind(Run(-11, 1)), "crash")
        self.assertEqual(kind(Run(139, 1)), "crash")
        self.assertEqual(kind(Run(1, 1, "no")), "refused")
        self.assertEqual(kind(Run(0, 1, mesh=facts(TETRAHEDRON[1:]))), "leak")
        self.assertEqual(kind(Run(0, 1, mesh=facts([face[::-1] for face in TETRAHEDRON]))), "flipped")
        self.assertEqual(kind(Run(0, 1, mesh=MeshFacts(4, area=right.area, volume=0.2))), "volume")
        self.assertEqual(kind(Run(0, 1, mesh=MeshFacts(4, area=1.5 * right.area, volume=right.volume))), "area")

    def test_files_without_faces_may_be_refused_but_not_crash(self):
        for truth in ({"error": "no shape"}, {"faces": 0}):
            self.assertIsNone(kind(Run(1, 1, "no"), truth))
            self.assertIsNone(kind(Run(0, 1), truth))
            self.assertEqual(kind(Run(-6, 1), truth), "crash")
            self.assertEqual(kind(Run("hang", 60), truth), "hang")

    def test_open_shells_may_be_open(self):
        parts = [{**TRUTH["parts"][0], "closed": 0}]
        self.assertIsNone(kind(Run(0, 1, mesh=facts(TETRAHEDRON)), {**TRUTH, "parts": parts}))


class Known(unittest.TestCase):
    RUNS = {"a": Run(0, 1), "b": Run(1, 1)}

    def test_differences(self):
        known = {"b": {"kind": "refused", "reason": "holds no valid face"}}
        refused, leak = Fault("refused", ""), Fault("leak", "")
        self.assertEqual(survey.differences(known, self.RUNS, {"b": refused}), [])
        self.assertIn("must leave", survey.differences(known, self.RUNS, {})[0])
        self.assertIn("new fault: leak a", survey.differences(known, self.RUNS, {"a": leak, "b": refused})[0])
        self.assertIn("it was known as refused", survey.differences(known, self.RUNS, {"b": leak})[0])
        self.assertEqual(survey.differences({"c": known["b"]}, self.RUNS, {}), [])  # c was not run

    def test_the_table_keeps_its_reasons(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "known.json"
            survey.write_known(path, 1e-3, {"a": Fault("leak", ""), "b": Fault("area", "")})
            self.assertIn("without a reason", survey.differences(survey.read_known(path, 1e-3), self.RUNS, {
                "a": Fault("leak", ""), "b": Fault("area", "")})[0])
            tables = json.loads(path.read_text())
            tables["0.001"]["a"]["reason"] = "why"
            path.write_text(json.dumps(tables))
            survey.write_known(path, 1e-2, {})
            survey.write_known(path, 1e-3, {"a": Fault("leak", "")})
            self.assertEqual(survey.read_known(path, 1e-3), {"a": {"kind": "leak", "reason": "why"}})
            self.assertEqual(list(json.loads(path.read_text())), ["0.01", "0.001"])


if __name__ == "__main__":
    unittest.main()
