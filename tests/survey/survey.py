#!/usr/bin/env python3
"""Meshes every CAD file of a folder and compares the meshes with truth.json: areas, volumes and closed shells that
OpenCASCADE finds. FOLDER is the corpus, $TESSERA_TEST_DATA/cad_corpus by default.

Each file is run alone: `tessellate FILE -o x.stl --relative R --threads 1`. Prints a line for each fault, and the table
of their kinds. known_faults.json lists the faults that are known at each tolerance, with a reason: a fault that is not
there and a known one that is gone are failures. Exit status: 0 as known; 1 otherwise; 77 without a corpus.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time
from typing import Any

from judgement import KINDS, Fault, Run, fault_of
from mesh_facts import MeshFacts, facts_of

SKIPPED = 77
KNOWN = pathlib.Path(__file__).with_name("known_faults.json")
UNEXPLAINED = "not explained yet"


def run_of(tool: str, file: pathlib.Path, options: argparse.Namespace) -> Run:
    """Meshes one file, within limits of time and of address space."""
    with tempfile.TemporaryDirectory() as folder:
        mesh = pathlib.Path(folder) / "x.stl"
        limited = ["sh", "-c", 'ulimit -v "$0" && exec "$@"', str(int(options.memory * 2**20))]
        command = [tool, "tessellate", str(file), "-o", str(mesh), "--relative", str(options.relative), "--threads", "1"]
        began = time.monotonic()
        with subprocess.Popen(
            [*limited, *command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace"
        ) as process:
            code: int | str
            try:
                error = process.communicate(timeout=options.seconds)[1]
                code = process.returncode
            except subprocess.TimeoutExpired:
                process.kill()
                error, code = process.communicate()[1], "hang"
        seconds = time.monotonic() - began
        facts = facts_of(mesh) if code == 0 and mesh.exists() else MeshFacts()
        return Run(code, seconds, error[-600:].strip(), facts)


def survey(truths: dict[str, Any], options: argparse.Namespace) -> tuple[dict[str, Run], dict[str, Fault]]:
    """Runs all files, the largest first, and judges them."""
    files = {name: options.folder / name for name in truths if options.only in name}
    files = {name: file for name, file in files.items() if file.exists()}
    order = sorted(files, key=lambda name: -files[name].stat().st_size)
    runs: dict[str, Run] = {}
    faults: dict[str, Fault] = {}
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        futures = {pool.submit(run_of, options.tool, files[name], options): name for name in order}
        for future in concurrent.futures.as_completed(futures):
            name = futures[future]
            runs[name] = future.result()
            fault = fault_of(truths[name], runs[name], options.relative)
            if fault:
                faults[name] = fault
            if sys.stderr.isatty():
                print(f"\r{len(runs)} of {len(files)} files, {len(faults)} faults", end="", file=sys.stderr, flush=True)
    if sys.stderr.isatty():
        print(file=sys.stderr)
    return runs, faults


def print_table(runs: dict[str, Run], faults: dict[str, Fault]) -> None:
    for name in sorted(faults, key=lambda name: (KINDS.index(faults[name].kind), name)):
        print(f"{faults[name].kind:8} {name}: {faults[name].words}")
    counts = ", ".join(f"{sum(fault.kind == kind for fault in faults.values())} {kind}" for kind in KINDS)
    print(f"{len(runs)} files: {len(runs) - len(faults)} right, {counts}")


def read_known(path: pathlib.Path, relative: float) -> dict[str, dict[str, str]]:
    """Returns the known faults at a tolerance: kind and reason by file."""
    tables = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    return next((table for key, table in tables.items() if float(key) == relative), {})


def write_known(path: pathlib.Path, relative: float, faults: dict[str, Fault]) -> None:
    """Makes the table of a tolerance anew. Faults of the same kind keep their reason."""
    tables = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    old = read_known(path, relative)
    tables = {key: table for key, table in tables.items() if float(key) != relative}
    tables[f"{relative:g}"] = {
        name: {
            "kind": fault.kind,
            "reason": old[name]["reason"] if old.get(name, {}).get("kind") == fault.kind else UNEXPLAINED,
        }
        for name, fault in sorted(faults.items())
    }
    ordered = dict(sorted(tables.items(), key=lambda item: -float(item[0])))
    path.write_text(json.dumps(ordered, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


def differences(known: dict[str, dict[str, str]], runs: dict[str, Run], faults: dict[str, Fault]) -> list[str]:
    """Returns a sentence for each file that is not as known."""
    words = []
    for name in sorted({*known, *faults} & runs.keys()):
        was, fault = known.get(name), faults.get(name)
        if fault and (was is None or was["kind"] != fault.kind):
            words.append(f"new fault: {fault.kind} {name}" + (f" (it was known as {was['kind']})" if was else ""))
        elif was and fault is None:
            words.append(f"right now, so it must leave {KNOWN.name}: {was['kind']} {name}")
        elif was and was["reason"] == UNEXPLAINED:
            words.append(f"known without a reason: {was['kind']} {name}")
    return words


def options_of(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tool", metavar="TESSERA", help="the command line, with its CAD reader beside it")
    parser.add_argument("folder", nargs="?", type=pathlib.Path)
    parser.add_argument("--relative", type=float, default=1e-3, help="the tolerance as a share of the size [1e-3]")
    parser.add_argument("--seconds", type=float, default=60, help="the time for one file [60]")
    parser.add_argument("--memory", type=float, default=8, help="GiB of address space for one file [8]")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="files at once [one per processor]")
    parser.add_argument("--only", default="", metavar="TEXT", help="files whose path holds this text")
    parser.add_argument("--known", type=pathlib.Path, default=KNOWN, metavar="FILE", help="[known_faults.json]")
    parser.add_argument("--write-known", action="store_true", help="write the table of known faults anew")
    options = parser.parse_args(arguments)
    if options.write_known and options.only:
        parser.error("--write-known needs all files: leave out --only")
    data = os.environ.get("TESSERA_TEST_DATA")
    if options.folder is None and data:
        options.folder = pathlib.Path(data) / "cad_corpus"
    return options


def main(arguments: list[str]) -> int:
    options = options_of(arguments)
    if options.folder is None or not (options.folder / "truth.json").exists():
        where = options.folder or "TESSERA_TEST_DATA, which is not set"
        print(f"skipped: there is no corpus of CAD files with a truth.json ({where})")
        return SKIPPED
    if not os.access(options.tool, os.X_OK):
        print(f"{options.tool}: expected a program, found none")
        return 2
    truths = json.loads((options.folder / "truth.json").read_text(encoding="utf-8"))
    began = time.monotonic()
    runs, faults = survey(truths, options)
    print_table(runs, faults)
    print(f"at {options.relative:g} of the size, {time.monotonic() - began:.0f} s with {options.jobs} at once")
    if options.write_known:
        write_known(options.known, options.relative, faults)
        print(f"wrote {options.known}")
        return 0
    words = differences(read_known(options.known, options.relative), runs, faults)
    print("\n".join(words) if words else "as known")
    return 1 if words else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
