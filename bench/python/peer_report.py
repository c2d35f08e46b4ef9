#!/usr/bin/env python3
"""The package for Python beside SciPy: the same bicubic B-spline surface at the same scattered points, on one thread.

Usage: PYTHONPATH=tools/python bench/python/peer_report.py [--spans N] [--points N] [--seconds S]
TESSERA_C_LIBRARY names the library of a build, as for python_report.py. SciPy is Debian's python3-scipy, 1.0 or newer.

SciPy's RectBivariateSpline makes three splines x, y and z of (u, v) with the same knots, and Tessera gets their knots
and coefficients. Before a figure is printed, all values of both are compared: they differ by at most 1e-12 of the
largest value of the quantity. Then both take turns, each into new arrays. A rate belongs to the shortest processor time
of several, so that other programs on the machine count little.
"""

import argparse
import os
import sys
import time

import numpy as np
from python_report import ROUNDS, SECONDS

import tessera as ts

LARGEST_DIFFERENCE = 1e-12  # of the largest value of a quantity
AXES = {"position": (0, 0), "du": (1, 0), "dv": (0, 1)}  # how often each is differentiated by u and v
ELSEWHERE = """geomdl: not compared here. Its list of issues tells of an evaluation by steps of 0.01 that was stopped
  after five minutes (geomdl #73), and of no use of NumPy (geomdl #91): reports of others, not figures of this run.
Rays: no peer in Python is timed here, Open3D's RaycastingScene neither. tools/peers.sh ray_casting compares exact rays
  with Embree's triangles in C++.
Meshes: tools/peers.sh occt_mesh compares them with OpenCASCADE's in C++, at equal errors (peers/occt_mesh.cpp)."""


def splines_of(interpolate, spans):
    """SciPy's splines x, y and z of a wavy surface over the square of side 1."""
    across = np.linspace(0, 1, spans + 3)  # a cubic spline through n points has n - 3 spans
    u, v = np.meshgrid(across, across, indexing="ij")
    z = 0.1 * np.sin(20 * u) * np.cos(20 * v)
    coordinates = u + 0.02 * np.sin(9 * v), v + 0.02 * np.cos(7 * u), z
    return [interpolate.RectBivariateSpline(across, across, values) for values in coordinates]


def surface_of(splines):
    """Tessera's surface with the knots and coefficients of SciPy's splines."""
    knots = splines[0].get_knots()
    shape = [len(line) - 4 for line in knots]
    points = np.stack([spline.get_coeffs().reshape(shape) for spline in splines], axis=-1)
    return ts.nurbs(degree=3, knots=knots, points=points)[0]


def by_scipy(splines, u, v, quantities):
    """Evaluates the splines. Returns an array of shape (n, 3) per quantity."""
    found = []
    for name in quantities:
        by_u, by_v = AXES[name]
        values = np.empty((len(u), 3))
        for axis, spline in enumerate(splines):
            values[:, axis] = spline.ev(u, v, dx=by_u, dy=by_v)
        found.append(values)
    return found


def by_tessera(surface, u, v, quantities):
    jets = surface.evaluate(u, v, quantities=quantities)
    return [getattr(jets, name) for name in quantities]


def largest_difference(wanted, found):
    """The largest difference of values, over the largest value of its quantity."""
    return max(np.abs(a - b).max() / np.abs(a).max() for a, b in zip(wanted, found))


def race(works, seconds):
    """Runs works in turns. Returns the shortest processor time of each."""
    best = [float("inf")] * len(works)
    start, rounds = time.perf_counter(), 0
    while rounds < ROUNDS or time.perf_counter() - start < seconds:
        rounds += 1
        for index, work in enumerate(works):
            begun = time.process_time()
            work()
            best[index] = min(best[index], time.process_time() - begun)
    return best


def compare_points(interpolate, arguments):
    splines = splines_of(interpolate, arguments.spans)
    surface = surface_of(splines)
    u, v = np.random.default_rng(5).uniform(0, 1, (2, arguments.points))
    for quantities in (["position"], ["position", "du", "dv"]):
        what = f"{arguments.points:,} scattered points, {' + '.join(quantities)}"
        works = [lambda: by_scipy(splines, u, v, quantities), lambda: by_tessera(surface, u, v, quantities)]
        difference = largest_difference(works[0](), works[1]())
        if not difference <= LARGEST_DIFFERENCE:
            sys.exit(f"peer_report: {what}: the values differ by {difference:.1e} of the largest one")
        scipy_rate, rate = (arguments.points / seconds / 1e6 for seconds in race(works, arguments.seconds))
        rates = f"SciPy {scipy_rate:7.3f} M/s   Tessera {rate:7.3f} M/s   ratio {rate / scipy_rate:.1f}"
        print(f"{what}: {rates}   (values differ by {difference:.1e})")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spans", type=int, default=100, help="spans along a side of the surface [100]")
    parser.add_argument("--points", type=int, default=1_000_000, help="scattered points [1,000,000]")
    parser.add_argument("--seconds", type=float, default=SECONDS, help=f"at least, for each task [{SECONDS}]")
    arguments = parser.parse_args()
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors, one thread each")
    try:
        import scipy
        from scipy import interpolate
    except ImportError:
        print("SciPy: not installed, left out")
    else:
        print(f"SciPy {scipy.__version__}, NumPy {np.__version__}, {arguments.spans} x {arguments.spans} bicubic spans")
        with ts.threads(1):
            compare_points(interpolate, arguments)
    print(f"load {os.getloadavg()[0]:.1f} at the end")
    print(ELSEWHERE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
