#!/usr/bin/env python3
"""The package for Python beside SciPy and Open3D, on one thread: the same points and rays of bicubic B-spline surfaces.

Usage: PYTHONPATH=tools/python bench/python/peer_report.py [--spans N] [--points N] [--rays N] [--seconds S]
TESSERA_C_LIBRARY names the library of a build, as for python_report.py. SciPy is Debian's python3-scipy, 1.0 or newer;
Open3D is the package open3d, 0.16 or newer, or Debian's python3-open3d with the library of open3d_ray_masks.c. A peer
that is not installed is left out.

SciPy's RectBivariateSpline makes three splines x, y and z of (u, v) with the same knots, and Tessera gets their knots
and coefficients. Before a figure is printed, all values of both are compared: they differ by at most 1e-12 of the
largest value of the quantity. Then both take turns, each into new arrays. A rate belongs to the shortest processor time
of several, so that other programs on the machine count little.

Open3D's RaycastingScene casts the rays at triangles that Tessera has proven to lie within TOLERANCE of the surface, and
Tessera at the surface itself. Both return distances, parameters, elements and normals. A ray that passes the border or
a silhouette within the tolerance may hit one alone, or a fold behind.
"""

import argparse
import os
import sys
import time

import numpy as np
from python_report import ROUNDS, SECONDS

import tessera as ts

LARGEST_DIFFERENCE = 1e-12  # of the largest value of a quantity
TOLERANCE = 1e-4  # of the triangles, for a surface of side 1
FAR = 10 * TOLERANCE  # between hits of a ray: it grazes a fold
MOST_OTHER_HITS = 1e-3  # of the rays: those at borders and silhouettes
AXES = {"position": (0, 0), "du": (1, 0), "dv": (0, 1)}  # how often each is differentiated by u and v
ELSEWHERE = """geomdl: not compared here. Its list of issues tells of an evaluation by steps of 0.01 that was stopped
  after five minutes (geomdl #73), and of no use of NumPy (geomdl #91): reports of others, not figures of this run.
Rays: tools/peers.sh ray_casting compares exact rays with Embree's triangles in C++.
Meshes: tools/peers.sh occt_mesh compares them with OpenCASCADE's in C++, at equal errors (peers/occt_mesh.cpp)."""


def wavy(spans):
    """Coordinates x, y and z of a wavy grid over the square of side 1."""
    across = np.linspace(0, 1, spans + 3)  # a cubic spline of n points has n - 3 spans
    u, v = np.meshgrid(across, across, indexing="ij")
    return u + 0.02 * np.sin(9 * v), v + 0.02 * np.cos(7 * u), 0.1 * np.sin(20 * u) * np.cos(20 * v)


def splines_of(interpolate, spans):
    """SciPy's splines x, y and z through a wavy grid."""
    across = np.linspace(0, 1, spans + 3)
    return [interpolate.RectBivariateSpline(across, across, values) for values in wavy(spans)]


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


def rays_of(count):
    """Returns (n, 6) origins and directions in float from above; some miss the surface."""
    random = np.random.default_rng(6)
    rays = np.empty((count, 6), np.float32)
    rays[:, :2], rays[:, 2] = random.uniform(-0.1, 1.1, (count, 2)), 1
    rays[:, 3:5], rays[:, 5] = random.uniform(-0.5, 0.5, (count, 2)), -1
    return rays


def wavy_surface(spans):
    """The spline surface whose control points are the wavy grid."""
    knots = np.concatenate([[0] * 3, np.linspace(0, 1, spans + 1), [1] * 3])
    return ts.nurbs(degree=3, knots=(knots, knots), points=np.stack(wavy(spans), axis=-1))


def compare_hits(mine, theirs, rays):
    """Prints how two sets of hits differ, which must be little. Both are infinite at a miss."""
    is_mine, is_theirs = np.isfinite(mine), np.isfinite(theirs)
    both = is_mine & is_theirs
    distances = np.abs(mine[both] - theirs[both]) * np.linalg.norm(rays[both, 3:].astype(np.float64), axis=1)
    far = np.count_nonzero(distances > FAR)
    only_mine, only_theirs = np.count_nonzero(is_mine & ~both), np.count_nonzero(is_theirs & ~both)
    alone = f"{only_mine:,} in Tessera alone, {only_theirs:,} in Open3D alone"
    print(f"  {np.count_nonzero(both):,} rays hit in both, {alone}")
    print(f"  distances along the ray: median {np.median(distances):.1e}, largest {distances.max():.1e}; ", end="")
    print(f"{far:,} above {FAR:g}, the largest of the others {distances[distances <= FAR].max():.1e}")
    if not only_mine + only_theirs + far <= MOST_OTHER_HITS * len(rays):
        sys.exit("peer_report: rays: the hits differ at more rays than borders and silhouettes explain")


def casts_rays(open3d):
    """Whether a ray hits a triangle: see open3d_ray_masks.c."""
    scene = open3d.t.geometry.RaycastingScene()
    tensor = open3d.core.Tensor
    scene.add_triangles(tensor(np.eye(3, dtype=np.float32)), tensor(np.arange(3, dtype=np.uint32)[None]))
    ray = tensor(np.array([[0, 0, 0, 1, 1, 1]], np.float32))
    return np.isfinite(scene.cast_rays(ray)["t_hit"].numpy()[0])


def compare_rays(open3d, arguments):
    patches = wavy_surface(arguments.spans).patches()
    mesh = patches.tessellate(TOLERANCE, share_vertices=True)
    triangles = open3d.t.geometry.RaycastingScene()
    tensor = open3d.core.Tensor
    triangles.add_triangles(tensor(mesh.positions().astype(np.float32)), tensor(mesh.faces))
    scene = patches.rays()
    rays = rays_of(arguments.rays)
    origins, directions = rays[:, :3].copy(), rays[:, 3:].copy()
    kept = tensor(rays)

    def by_open3d():
        return triangles.cast_rays(kept, nthreads=1)["t_hit"].numpy()

    def by_tessera():
        return scene.closest(origins, directions, quantities=["t", "patch", "uv", "normal"]).t

    print(f"{arguments.rays:,} rays, {len(patches):,} patches, {len(mesh.faces):,} triangles within {mesh.bound:.1e}:")
    compare_hits(by_tessera(), by_open3d(), rays)
    theirs, mine = (arguments.rays / seconds / 1e6 for seconds in race([by_open3d, by_tessera], arguments.seconds))
    rates = f"Open3D {theirs:.3f} M/s at triangles   Tessera {mine:.3f} M/s at the surface   ratio {mine / theirs:.2f}"
    print(f"  {rates}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--spans", type=int, default=100, help="spans along a side of the surface [100]")
    parser.add_argument("--points", type=int, default=1_000_000, help="scattered points [1,000,000]")
    parser.add_argument("--rays", type=int, default=1_000_000, help="rays [1,000,000]")
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
    try:
        import open3d
    except ImportError:
        print("Open3D: not installed, left out")
    else:
        print(f"Open3D {open3d.__version__}")
        if casts_rays(open3d):
            with ts.threads(1):
                compare_rays(open3d, arguments)
        else:
            print("  its rays hit nothing, because this Embree heeds their mask, which is 0: left out.")
            print("  bench/python/open3d_ray_masks.c tells how to set the masks")
    print(f"load {os.getloadavg()[0]:.1f} at the end")
    print(ELSEWHERE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
