#!/usr/bin/env python3
"""What the package for Python costs: the same task in Python and in C++, in turn, in one process and the same memory,
best of several; small calls; and the import. All bytes that both write are compared before a figure is printed.

Usage: PYTHONPATH=tools/python bench/python/python_report.py TASKS [SIDE]
TASKS: the library tessera_python_tasks of a build; SIDE: patches along a side of the surface [100]
The target tessera_python_report of a build runs this script with its libraries.
"""

import ctypes
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

import tessera as ts

ROUNDS = 9  # at least
SECONDS = 10  # at least, for each task


def seconds_of(work):
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def written_by(work, outputs):
    """Clears the arrays that a task writes. Returns the seconds that it takes, the best of three calls, and the bytes that
    it writes. The calls from Python and from C++ come from two threads, and the first one in a row waits until oneTBB's
    workers have left the other."""
    for output in outputs:
        output[:] = 0
    seconds = min(seconds_of(work) for _ in range(3))
    return seconds, [output.tobytes() for output in outputs]


def compare(what, in_python, in_cpp, outputs):
    """Times both in turn. The outputs are the arrays that both write."""
    best_python = best_cpp = float("inf")
    start, rounds = time.perf_counter(), 0
    while rounds < ROUNDS or time.perf_counter() - start < SECONDS:
        rounds += 1
        seconds, wanted = written_by(in_cpp, outputs)
        best_cpp = min(best_cpp, seconds)
        seconds, found = written_by(in_python, outputs)
        best_python = min(best_python, seconds)
        if wanted != found:
            sys.exit(f"python_report: {what}: Python and C++ write other bytes")
    times = f"{1e3 * best_python:10.2f} ms in Python {1e3 * best_cpp:10.2f} ms in C++"
    print(f"{what:32} {times}   ratio {best_python / best_cpp:.3f}")


def surface_of(side):
    """A spline surface of side x side bicubic patches, z = sin x cos y."""
    knots = np.concatenate([[0] * 3, np.arange(side + 1), [side] * 3])
    x, y = np.meshgrid(np.arange(side + 3.0), np.arange(side + 3.0), indexing="ij")
    return ts.nurbs(degree=3, knots=(knots, knots), points=np.stack([x, y, np.sin(x) * np.cos(y)], axis=-1))


class Tasks:
    """The tasks in C++, of the surfaces of a file."""

    def __init__(self, library, file):
        self._library = ctypes.CDLL(library)
        self._library.tasks_new.restype = ctypes.c_void_p
        self._handle = ctypes.c_void_p(self._library.tasks_new(str(file).encode()))

    def run(self, name, *arguments):
        """Runs a task. Arguments are counts, and arrays whose memory it reads or writes."""
        given = [
            ctypes.c_void_p(value.ctypes.data) if isinstance(value, np.ndarray) else ctypes.c_size_t(value)
            for value in arguments
        ]
        function = getattr(self._library, f"tasks_{name}")

        def work():
            if function(self._handle, *given):
                sys.exit(f"python_report: {name} failed in C++")

        return work


def time_mesh(patches, tasks):
    rate = 16
    mesh = patches.tessellate(rates=rate)
    outputs = [mesh.vertices, mesh.normals, mesh.uv, mesh.faces, mesh.patches]
    in_cpp = tasks.run("mesh", rate, len(mesh.vertices), len(mesh.faces), *outputs)
    what = f"mesh, {len(mesh.faces):,} triangles"
    compare(what, lambda: patches.tessellate(rates=rate, out=mesh), in_cpp, outputs)


def time_points(surface, tasks, count):
    u, v = np.random.default_rng(5).uniform(0, surface.domain[0, 1], (2, count))
    jets = surface.evaluate(u, v)
    in_cpp = tasks.run("points", count, u, v, jets.position)
    compare(f"{count:,} scattered points", lambda: surface.evaluate(u, v, out=jets), in_cpp, [jets.position])


def time_rays(patches, tasks, count):
    random = np.random.default_rng(6)
    low, high = patches.rays().box
    origins = np.column_stack([random.uniform(low[:2], high[:2], (count, 2)), np.full(count, 5.0)])
    directions = np.column_stack([random.uniform(-0.5, 0.5, (count, 2)), np.full(count, -1.0)])
    scene = patches.rays()
    hits = scene.closest(origins, directions, quantities=["t", "position", "normal"])
    outputs = [hits.t, hits.position, hits.normal]
    in_cpp = tasks.run("closest", count, origins, directions, *outputs)
    compare(f"{count:,} rays", lambda: scene.closest(origins, directions, out=hits), in_cpp, outputs)


def time_calls(model, patches):
    scene, surface, patch = patches.rays(), model[0], patches[0]
    calls = {
        "patch.points": lambda: patch.points,
        "surface.evaluate, 1 point": lambda: surface.evaluate(1.5, 2.5),
        "the same, with curvatures": lambda: surface.evaluate(1.5, 2.5, derivatives=2),
        "scene.closest, 1 ray": lambda: scene.closest([1, 1, 5], [0, 0, -1]),
    }
    for what, work in calls.items():
        seconds = min(seconds_of(lambda work=work: [work() for _ in range(100)]) / 100 for _ in range(10 * ROUNDS))
        print(f"{what:32} {1e6 * seconds:10.1f} us")


def time_import():
    code = "import numpy, time; start = time.perf_counter(); import tessera; print(time.perf_counter() - start)"
    command = [sys.executable, "-c", code]
    seconds = min(float(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout) for _ in range(ROUNDS))
    print(f"{'import tessera, after NumPy':32} {1e3 * seconds:10.1f} ms")


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        return 2
    model = surface_of(int(sys.argv[2]) if len(sys.argv) == 3 else 100)
    patches = model.patches()
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "surface.json")
        model.save(file)
        tasks = Tasks(sys.argv[1], file)
    time_import()
    time_calls(model, patches)
    time_mesh(patches, tasks)
    time_points(model[0], tasks, 1_000_000)
    time_rays(patches, tasks, 1_000_000)
    return 0


if __name__ == "__main__":
    sys.exit(main())
