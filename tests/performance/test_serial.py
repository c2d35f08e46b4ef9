"""Tests serial: what it reads of callgrind, and its table."""

import unittest

from support import perf
from performance import serial

LOOP = "tbb::detail::r1::execute_and_wait(tbb::detail::d1::task&)"
DUMP = f"""desc: Trigger: --dump-before=tessera::cli::write_meshes(tessera::cli::Meshed const&)

fn=main
0 10
cfn={LOOP}
calls=2 0
0 300

fn=nested
0 20
cfn={LOOP}'2
calls=1 0
0 100
cfn=other
calls=1 0
0 7

fn={LOOP}
0 50
cfn={LOOP}
calls=1 0
0 1000

totals: 400
"""


class Reading(unittest.TestCase):
    def test_loops_within_loops_count_once(self):
        self.assertEqual(serial.instructions(DUMP), (400, 300))

    def test_a_dump_holds_the_stage_before_its_trigger(self):
        self.assertEqual(serial.stage_before(DUMP), "plan, mesh")
        self.assertEqual(serial.stage_before("desc: Trigger: Program termination\n"), "report, end")
        self.assertEqual(serial.stage_before("desc: Trigger: --dump-before=tessera::cli::load(x)\n"), "start")


class Printing(unittest.TestCase):
    def test_shares_are_of_the_run_on_one_thread(self):
        rows = serial.rows_of({"start": (100, 0), "write": (900, 800)}, {"start": (100, 0), "write": (450, 400)})
        cells = {row[0]: row[1:] for row in rows}
        self.assertEqual(cells["write"], ("900", "90.0%", "50", "5.6%", "5.0%"))
        self.assertEqual(cells["pack"], ("0", "0.0%", "0", "-", "0.0%"))
        self.assertEqual(cells["all"], ("1,000", "100.0%", "150", "", "15.0%"))


class Arguments(unittest.TestCase):
    def test_what_is_missing_is_named(self):
        status, _, errors = perf("serial", "--program", "/nowhere/tessera", "tessellate", "a.bpt")
        self.assertEqual(status, 3)
        self.assertIn("there is no /nowhere/tessera", errors)
        _, _, errors = perf("serial", "--program", "/bin/true", "info", "a.bpt")
        self.assertIn("tessellate MODEL -o MESH", errors)


if __name__ == "__main__":
    unittest.main()
