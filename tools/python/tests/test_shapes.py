"""Models of simple surfaces against their mathematics, and against the library's own."""

import json
import math
import pickle

import numpy as np
import pytest

import tessera as ts

RNG = np.random.default_rng(7)


def points_of(model, count=400):
    """Points of the first surface at random parameters, the borders among them."""
    (u0, u1), (v0, v1) = model[0].domain
    u, v = RNG.random((2, count))
    u[:4], v[:4] = [0, 1, 0, 1], [0, 0, 1, 1]
    return model[0].evaluate(u0 + u * (u1 - u0), v0 + v * (v1 - v0), derivatives=1)


def of_library(**surface):
    return ts.parse(json.dumps({"format": "tessera", "version": 1, "surfaces": [surface]}))


def assert_same(model, other):
    (u0, u1), (v0, v1) = model[0].domain
    assert (model[0].domain == other[0].domain).all()
    u, v = u0 + RNG.random(200) * (u1 - u0), v0 + RNG.random(200) * (v1 - v0)
    gap = model[0].evaluate(u, v).position - other[0].evaluate(u, v).position
    assert np.abs(gap).max() < 1e-13 * np.abs(model.bounds).max()


AXES = [(0, 0, 1), (0, 0, -2), (1, 0, 0), (1, 2, -3), (0, 1, 0), (0.95, 0.1, 0)]


@pytest.mark.parametrize("axis", AXES)
def test_spheres_are_round(axis):
    centre = np.array([1.0, -2, 5])
    model = ts.sphere(2.5, centre, axis, name="ball")
    jets = points_of(model)
    away = jets.position - centre
    assert np.abs(np.linalg.norm(away, axis=1) - 2.5).max() < 1e-12
    assert model.names == ["ball"] and model[0].degree == (2, 2) and model[0].is_rational
    assert np.einsum("ni,ni->n", jets.normal, away / 2.5)[4:].min() > 1 - 1e-9  # outwards
    mesh = model.patches().tessellate(1e-3)
    assert mesh.open_edges == 0 and mesh.is_certified
    # A mesh within 1e-3 of the sphere has its volume to 0.1 %.
    a, b, c = (mesh.positions()[mesh.faces[:, k]] - centre for k in range(3))
    volume = np.einsum("ni,ni->n", a, np.cross(b, c)).sum() / 6
    assert volume == pytest.approx(4 / 3 * math.pi * 2.5**3, rel=2e-3)


@pytest.mark.parametrize("axis", AXES)
def test_cylinders_cones_and_tori(axis):
    centre, unit = np.array([3.0, 1, -1]), np.array(axis) / np.linalg.norm(axis)

    def heights_and_radii(model):
        jets = points_of(model)
        away = jets.position - centre
        height = away @ unit
        across = away - height[:, None] * unit
        radius = np.linalg.norm(across, axis=1)
        assert (np.einsum("ni,ni->n", jets.normal, across)[4:] > -1e-12 * radius[4:]).all()
        return height, radius

    height, radius = heights_and_radii(ts.cylinder(1.5, 4, centre, axis))
    assert np.abs(radius - 1.5).max() < 1e-12 and height.min() > -1e-12 and height.max() < 4 + 1e-12
    assert np.ptp(height) == pytest.approx(4)
    for top in (0.0, 0.5, 3.0):
        height, radius = heights_and_radii(ts.cone(1.5, 4, top, centre, axis))
        assert np.abs(radius - (1.5 + (top - 1.5) * height / 4)).max() < 1e-12
    ring = ts.torus(3, 1, centre, axis)
    away = points_of(ring).position - centre
    height = away @ unit
    radius = np.linalg.norm(away - height[:, None] * unit, axis=1)
    assert np.abs(np.hypot(radius - 3, height) - 1).max() < 1e-12
    assert ring.patches().tessellate(1e-2).open_edges == 0


def test_shapes_are_those_of_the_library():
    assert_same(ts.sphere(2, (0, 0, 1)), of_library(kind="sphere", radius=2, axis={"origin": [0, 0, 1]}))
    assert_same(ts.torus(3, 1), of_library(kind="torus", major=3, minor=1))
    assert_same(ts.cylinder(1, 4), of_library(kind="cylinder", radius=1, height=4))
    assert_same(ts.cone(1, 2), of_library(kind="cone", bottom=1, top=0, height=2))
    points = [[1, 0, 0], [2, 0, 1], [0.5, 0, 2], [1, 0, 3]]
    profile = {"kind": "bezier", "points": points}
    assert_same(ts.revolve(ts.Curve(3, None, points)), of_library(kind="revolution", profile=profile))


@pytest.mark.parametrize("angle", [0.1, math.pi / 2, 2, math.pi, 4, 1.5 * math.pi, 5.5, 2 * math.pi])
def test_partial_turns(angle):
    curve = ts.Curve(2, [0, 0, 0, 1, 3, 3, 3], [[1, 0, 0], [2, 0, 1], [2, 0, 2], [1, 0, 4]], [1, 2, 0.5, 1])
    model = ts.revolve(curve, angle=angle)
    v = np.linspace(0, 3, 41)
    wanted = curve.evaluate(v)
    assert np.abs(model[0].evaluate(0, v).position - wanted).max() < 1e-14
    c, s = math.cos(angle), math.sin(angle)
    end = model[0].evaluate(1, v).position
    assert np.abs(end - wanted @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])).max() < 1e-14
    position = model[0].evaluate(np.linspace(0, 1, 57)[:, None], v).position
    assert np.abs(np.hypot(position[..., 0], position[..., 1]) - wanted[:, 0]).max() < 1e-13
    assert np.abs(position[..., 2] - wanted[:, 2]).max() < 1e-13
    turn = np.arctan2(position[..., 1], position[..., 0]) % (2 * math.pi)
    assert turn[1:-1].max() < angle and turn[1:-1].min() > 0
    if angle == 2 * math.pi:
        assert (model[0].points[0] == model[0].points[-1]).all()  # closed to the last bit
        assert len(model[0].points) == 9


def test_planes_and_extrusions():
    sheet = ts.plane((1, 2, 3), (2, 0, 0), (0, 0, 4), name="sheet")
    assert sheet[0].evaluate(0.25, 0.5).position.tolist() == [1.5, 2, 5]
    assert sheet.names == ["sheet"]
    arch = ts.arc(2, 0, math.pi)
    wall = ts.extrude(arch, (0, 1, 3))
    t = np.linspace(0, 1, 31)
    for v in (0, 0.5, 1):
        gap = wall[0].evaluate(t, v).position - arch.evaluate(t) - v * np.array([0, 1, 3])
        assert np.abs(gap).max() < 1e-14


BORDERS = {
    "c1": ts.Curve(2, None, [[0, 0, 0], [1, 0, 1], [2, 0, 0]]),
    "c2": ts.Curve(1, [0, 0, 2, 5, 5], [[0, 3, 0], [1, 3, 2], [2, 3, 1]]),
    "d1": ts.Curve(3, [0, 0, 0, 0, 0.4, 1, 1, 1, 1], [[0, 0, 0], [0, 1, 2], [1, 1, 0], [0, 2, 0], [0, 3, 0]]),
    "d2": ts.Curve(2, None, [[2, 0, 0], [3, 1, 1], [2, 3, 1]], [1, 0.5, 1]),
}


@pytest.mark.parametrize("blend", ["linear", "cubic"])
def test_coons_patches_have_their_borders(blend):
    model = ts.coons(**BORDERS, blend=blend, name="sail")
    t = np.linspace(0, 1, 101)
    for key, u, v in (("c1", t, 0), ("c2", t, 1), ("d1", 0, t), ("d2", 1, t)):
        curve = BORDERS[key].over(0, 1)
        assert np.abs(model[0].evaluate(u, v).position - curve.evaluate(t)).max() < 1e-13
    assert model.names == ["sail"] and "Coons" in model[0].kind
    copy = pickle.loads(pickle.dumps(model))
    assert (copy[0].points == model[0].points).all()
    # At the middle the bilinear formula, with curves' own values.
    if blend == "linear":
        c1, c2, d1, d2 = (BORDERS[key].over(0, 1).evaluate(0.5) for key in ("c1", "c2", "d1", "d2"))
        corners = np.mean([[0, 0, 0], [2, 0, 0], [0, 3, 0], [2, 3, 1]], axis=0)
        middle = model[0].evaluate(0.5, 0.5).position
        assert np.abs(middle - ((c1 + c2) / 2 + (d1 + d2) / 2 - corners)).max() < 1e-13


def test_ruled_surfaces_are_straight():
    first, second = ts.circle(2), ts.circle(1, (0, 0, 3)).over(2, 4)
    model = ts.ruled(first, second)
    t = np.linspace(0, 1, 51)
    lower, upper = first.evaluate(t), second.over(0, 1).evaluate(t)
    for v in (0, 0.3, 1):
        assert np.abs(model[0].evaluate(t, v).position - (1 - v) * lower - v * upper).max() < 1e-13


@pytest.mark.parametrize("shape", [(2, 2), (3, 5), (20, 31), (4, 2)])
@pytest.mark.parametrize("degree", [3, (1, 2), 5])
def test_interpolation_passes_through_its_points(shape, degree):
    x, y = np.meshgrid(np.linspace(0, 3, shape[0]) ** 2, np.linspace(0, 2, shape[1]), indexing="ij")
    points = np.stack([x, y, np.sin(2 * x) * np.cos(3 * y)], axis=-1) + RNG.normal(size=(*shape, 3)) * 0.02
    u, v = np.sort(RNG.random(shape[0]) * 4), np.linspace(-1, 1, shape[1])
    model = ts.interpolate(points, degree, u=u, v=v, name="field")
    gap = model[0].evaluate(u[:, None], v).position - points
    assert np.abs(gap).max() < 1e-12
    wanted = (degree, degree) if isinstance(degree, int) else degree
    assert model[0].degree == tuple(min(p, n - 1) for p, n in zip(wanted, shape))
    assert model[0].points.shape == points.shape


def test_interpolation_by_chords_reproduces_planes_and_closes_poles():
    x, y = np.meshgrid([0.0, 1, 5, 6, 7, 9], [0.0, 2, 3, 7], indexing="ij")
    flat = ts.interpolate(np.stack([x, y, 2 * x - y], axis=-1))
    position = points_of(flat).position
    assert np.abs(position[:, 2] - 2 * position[:, 0] + position[:, 1]).max() < 1e-12
    # A grid of a hemisphere, whose first row is one point.
    theta, phi = np.meshgrid(np.linspace(0, math.pi / 2, 25), np.linspace(0, 2 * math.pi, 40), indexing="ij")
    dome = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    model = ts.interpolate(dome)
    assert np.abs(np.linalg.norm(points_of(model).position, axis=1) - 1).max() < 1e-4  # fourth order in the spacing
    assert np.abs(model[0].points[0] - [0, 0, 1]).max() < 1e-14


def test_many_points_are_interpolated_soon():
    x, y = np.meshgrid(np.linspace(0, 3, 400), np.linspace(0, 2, 500), indexing="ij")
    points = np.stack([x, y, np.sin(9 * x) * y], axis=-1)
    model = ts.interpolate(points, u=x[:, 0], v=y[0])
    assert np.abs(model[0].evaluate(x[::7, 3], y[0, 3]).position - points[::7, 3]).max() < 1e-12


CIRCLE = ts.circle()
NAN = float("nan")


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: ts.sphere(0), "radius is 0, expected a finite number above 0"),
        (lambda: ts.sphere(-1), "radius is -1, expected"),
        (lambda: ts.sphere(NAN), "radius is nan, expected a finite number"),
        (lambda: ts.sphere("2 m"), "radius: expected a number, found '2 m'"),
        (lambda: ts.sphere(1, (0, 0)), r"centre: expected 3 numbers, found shape \(2,\)"),
        (lambda: ts.sphere(1, (0, NAN, 0)), r"centre\[1\] is nan, expected finite numbers"),
        (lambda: ts.sphere(1, axis=(0, 0, 0)), "axis is 0, expected a direction"),
        (lambda: ts.torus(1, 1), "minor is 1, expected below major, which is 1"),
        (lambda: ts.cylinder(1, 0), "height is 0"),
        (lambda: ts.cone(1, 1, -1), "top is -1, expected a finite number of 0 or more"),
        (lambda: ts.plane(u=(1, 0, 0), v=(2, 0, 0)), "parallelogram without area"),
        (lambda: ts.revolve(CIRCLE, angle=0), "angle is 0, expected above 0 and at most 2 pi"),
        (lambda: ts.revolve(CIRCLE, angle=7), "angle is 7, expected"),
        (lambda: ts.revolve([[0, 0, 0]]), "curve: expected a Curve, found list"),
        (lambda: ts.extrude(CIRCLE, (0, 0, 0)), "vector is 0"),
        (lambda: ts.coons(CIRCLE, CIRCLE, CIRCLE, 3), "d2: expected a Curve, found int"),
        (lambda: ts.coons(CIRCLE, CIRCLE, CIRCLE), "d2"),
        (lambda: ts.coons(*[ts.line((0, 0, 0), (1, 1, k)) for k in range(4)]), "gap|close|meet"),
        (lambda: ts.coons(**BORDERS, blend="quartic"), "blend: expected 'linear' or 'cubic'"),
        (lambda: ts.interpolate(np.zeros((3, 3))), r"expected shape \(m, n, 3\) with m and n of 2 or more"),
        (lambda: ts.interpolate(np.zeros((1, 3, 3))), r"found \(1, 3, 3\)"),
        (lambda: ts.interpolate(np.full((3, 3, 3), NAN)), r"points\[0\]\[0\]\[0\] is nan"),
        (lambda: ts.interpolate(np.zeros((3, 3, 3))), "all points along u are equal"),
        (lambda: ts.interpolate(RNG.random((4, 4, 3))[[0, 1, 1, 3]]), "points: 1 and 2 along u are equal"),
        (lambda: ts.interpolate(RNG.random((4, 4, 3)), u=[0, 1, 2]), r"u: expected shape \(4,\), found \(3,\)"),
        (lambda: ts.interpolate(RNG.random((4, 4, 3)), v=[0, 1, 1, 2]), "v: expected increasing parameters"),
        (lambda: ts.interpolate(RNG.random((4, 4, 3)), degree=0), "degree is 0, expected an integer from 1 to 15"),
    ],
)
def test_bad_shapes(make, words):
    with pytest.raises((ts.Error, TypeError), match=words):
        make()
