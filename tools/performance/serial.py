"""serial: how much of each stage of the command line runs on one thread, by instructions.

callgrind counts `tessera ... --threads 1`, and `--threads 2` with each thread apart. What the main thread of the second
does outside of oneTBB's loops is serial: it takes as long on any number of threads. Loops of one piece are serial, too.
"""

import os
import re
import subprocess
import tempfile
from pathlib import Path

from .console import GOOD, Failure, table
from .repository import ROOT

LOOP = "tbb::detail::r1::execute_and_wait("  # all loops of oneTBB wait in it
# The stages of tessellate begin with these calls; the time before the first is the start of the program.
STAGES = {"read, convert": "tessera::cli::load(", "pack": "tessera::cli::pack_for_meshes(",
          "plan, mesh": "tessera::cli::mesh_sets(", "write": "tessera::cli::write_meshes(",
          "report, end": "tessera::cli::mesh_faults("}


def instructions(text):
    """The instructions in a dump of callgrind, and those of its outermost loops."""
    total = re.search(r"^totals: (\d+)", text, re.MULTILINE)
    loops, outside, lines = 0, True, iter(text.splitlines())
    for line in lines:
        if line.startswith("fn="):
            outside = LOOP not in line
        elif line.startswith("cfn=" + LOOP) and outside and not line.endswith("'2"):
            next(lines)  # calls=...
            loops += int(next(lines).split()[1])
    return int(total.group(1)) if total else 0, loops


def stage_before(text):
    """The stage that a dump holds: its dump was triggered by the call that begins the next one."""
    names = ["start", *STAGES]
    for index, call in enumerate(STAGES.values()):
        if re.search(r"^desc: Trigger: --dump-before=" + re.escape(call), text, re.MULTILINE):
            return names[index]
    return names[-1]


def run(program, arguments, threads):
    """Maps each stage to the main thread's instructions and those in its loops."""
    with tempfile.TemporaryDirectory() as folder:
        command = ["valgrind", "--tool=callgrind", "--compress-strings=no", "--compress-pos=no",
                   "--separate-threads=yes", f"--separate-recs2={LOOP}*", f"--callgrind-out-file={folder}/counts",
                   *(f"--dump-before={call}*" for call in STAGES.values()), str(program), *arguments,
                   "--threads", str(threads)]
        try:
            done = subprocess.run(command, env=dict(os.environ, TESSERA_ISA="avx2"), capture_output=True, text=True,
                                  check=False)
        except FileNotFoundError:
            raise Failure("valgrind is not installed (Debian's package valgrind; tools/setup.sh)") from None
        if done.returncode != 0:
            raise Failure(f"{program} ended with status {done.returncode} under valgrind: {done.stderr[-800:]}")
        found = {}
        for file in sorted(Path(folder).glob("counts*-01")):
            text = file.read_text(encoding="utf-8", errors="replace")
            stage = stage_before(text)
            before = found.get(stage, (0, 0))
            found[stage] = tuple(a + b for a, b in zip(before, instructions(text)))
    if not found:
        raise Failure(f"callgrind wrote nothing about {program}")
    return found


def rows_of(one, two):
    """Cells of the table: each stage's instructions, those that are serial, and both as shares of the whole."""
    whole = sum(total for total, _ in one.values())
    rows, all_serial = [("stage", "instructions", "of all", "serial", "of the stage", "of all")], 0
    for stage in ("start", *STAGES):
        total, _ = one.get(stage, (0, 0))
        mine, loops = two.get(stage, (0, 0))
        serial = mine - loops
        all_serial += serial
        rows.append((stage, f"{total:,}", f"{total / whole:.1%}", f"{serial:,}",
                     f"{serial / total:.1%}" if total else "-", f"{serial / whole:.1%}"))
    rows.append(("all", f"{whole:,}", "100.0%", f"{all_serial:,}", "", f"{all_serial / whole:.1%}"))
    return rows


def command(arguments):
    program = Path(arguments.program or ROOT / "build" / arguments.preset / "tools" / "tessera")
    if not program.is_file():
        raise Failure(f"there is no {program}: build it, or name a program by --program")
    words = [word for word in arguments.arguments if word != "--"]
    if not words or words[0] != "tessellate" or "--threads" in words:
        raise Failure("name a command 'tessellate MODEL -o MESH', without --threads")
    print(table(rows_of(run(program, words, 1), run(program, words, 2)), right=(1, 2, 3, 4, 5)))
    return GOOD
