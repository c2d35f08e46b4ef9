"""Curves and splines: operations that keep the surface, and what they refuse."""

import math
import pickle

import numpy as np
import pytest

import tessera as ts
from conftest import model_file, wavy

RNG = np.random.default_rng(3)


def a_spline(rational=True, name=""):
    """A spline with inner knots of several multiplicities, not clamped in v."""
    knots = ([0, 0, 0, 0, 1, 2, 2, 3, 3, 3, 3], [-2, -1, 0, 1, 2, 2, 4, 5])
    return ts.Spline(
        RNG.normal(size=(7, 5, 3)), (3, 2), knots, 0.5 + RNG.random((7, 5)) if rational else None, name
    )


def assert_same_surface(spline, other, domain=None):
    (u0, u1), (v0, v1) = spline.domain if domain is None else domain
    u, v = u0 + RNG.random(300) * (u1 - u0), v0 + RNG.random(300) * (v1 - v0)
    gap = ts.model(spline)[0].evaluate(u, v).position - ts.model(other)[0].evaluate(u, v).position
    assert np.abs(gap).max() < 1e-12


@pytest.mark.parametrize("rational", [False, True])
def test_operations_keep_the_surface(rational):
    spline = a_spline(rational)
    more = spline.insert_knots(u=[0.5, 2, 2.5, 2.5, 2.5], v=[1.5, 1])
    assert more.points.shape == (12, 7, 3) and more.knots[1].tolist() == [-2, -1, 0, 1, 1, 1.5, 2, 2, 4, 5]
    assert_same_surface(spline, more)
    for u, v in ((1, 0), (0, 1), (2, 3)):
        high = spline.elevate(u, v)
        assert high.degree == (3 + u, 2 + v) and (high.domain == spline.domain).all()
        assert_same_surface(spline, high)
    # Each knot stands once more, so that the surface is as smooth as before.
    assert spline.elevate(u=1).knots[0].tolist() == [0] * 5 + [1, 1, 2, 2, 2] + [3] * 5
    for axis, at in (("u", 0.7), ("u", 2), ("v", 1), ("v", 1.5)):
        before, after = spline.split(**{axis: at})
        k = "uv".index(axis)
        assert before.domain[k, 1] == after.domain[k, 0] == at
        assert_same_surface(before, spline)
        assert_same_surface(after, spline)


def test_transform():
    turn = np.array([[0, -1, 0, 5], [1, 0, 0, 0], [0, 0, 2, -1], [0, 0, 0, 1.0]])
    spline = a_spline()
    moved = ts.model(spline.transform(turn))[0]
    u, v = RNG.random(50) * 3, RNG.random(50) * 2
    wanted = ts.model(spline)[0].evaluate(u, v).position @ turn[:3, :3].T + turn[:3, 3]
    assert np.abs(moved.evaluate(u, v).position - wanted).max() < 1e-13
    assert (spline.transform(turn[:3, :3]).points == spline.points @ turn[:3, :3].T).all()
    assert (spline.transform(turn[:3]).points == spline.transform(turn).points).all()


def test_surfaces_of_splines_return_them():
    spline = a_spline(name="patchwork")
    model = ts.model(spline, ts.Spline(wavy(1, 1)[0]))
    assert [each.name for each in model.surfaces] == ["patchwork", ""]
    surface = model["patchwork"]
    assert surface.degree == (3, 2) and surface.is_rational and surface.kind == "NURBS surface"
    assert (surface.points == spline.points).all() and (surface.weights == spline.weights).all()
    assert [knots.tolist() for knots in surface.knots] == list(map(list, spline.knots))
    assert model[1].degree == (3, 3) and not model[1].is_rational and (model[1].weights == 1).all()
    assert model[1].knots[0].tolist() == [0] * 4 + [1] * 4
    with pytest.raises(ValueError, match="read-only"):
        surface.points[0, 0, 0] = 1
    copy = pickle.loads(pickle.dumps(model))
    assert (copy[0].points == surface.points).all()


def test_surfaces_of_files_are_splines_of_their_patches():
    for name in ("goblet", "sphere", "coons_sail", "quadric_ellipsoid", "join_c1", "b_spline_multiple_knots"):
        for surface in ts.read(model_file(f"{name}.json")).surfaces:
            (u0, u1), (v0, v1) = surface.domain
            u, v = u0 + RNG.random(100) * (u1 - u0), v0 + RNG.random(100) * (v1 - v0)
            made = ts.model(surface)
            assert (made[0].domain == surface.domain).all() and made[0].name == surface.name
            gap = made[0].evaluate(u, v).position - surface.evaluate(u, v).position
            assert np.abs(gap).max() < 1e-12 * np.abs(made.bounds).max(), name
            degree, knots = surface.degree, surface.knots
            assert [len(knots[k]) - degree[k] - 1 for k in range(2)] == list(surface.points.shape[:2])


def test_loops_are_not_lost_in_silence(trimmed):
    with pytest.raises(ts.ArgumentError, match="trimming loop"):
        ts.model(trimmed)
    assert ts.model(trimmed[0].spline)[0].loops == 0


def test_models_of_models_and_parts():
    left, right = ts.sphere(name="ball")[0].split(u=0.5)
    model = ts.model(ts.torus(3, 1, name="ring"), left, right)
    assert model.names == ["ring", "ball", "ball"]
    away = np.linalg.norm(model[2].evaluate(RNG.random(50) * 0.5 + 0.5, RNG.random(50)).position, axis=1)
    assert np.abs(away - 1).max() < 1e-14
    with pytest.raises(TypeError, match="expected splines, surfaces or models, found list"):
        ts.model([left, right])


def test_callers_may_change_the_arrays_of_splines():
    points = wavy(1, 1)[0]
    model = ts.model(ts.Spline(points))
    points[:] = 0
    assert model[0].points.any() and pickle.loads(pickle.dumps(model))[0].points.any()


def test_curves():
    curve = ts.Curve(3, [0, 0, 0, 0, 1, 1, 4, 4, 4, 4], RNG.normal(size=(6, 3)), 0.5 + RNG.random(6))
    t = np.concatenate([RNG.random(200) * 4, [0, 1, 4]])
    at = curve.evaluate(t)
    assert curve.evaluate(t.reshape(7, 29)).shape == (7, 29, 3) and curve.evaluate(2.0).shape == (3,)
    assert np.abs(curve.insert_knots([0.5, 1, 3]).evaluate(t) - at).max() < 1e-13
    assert np.abs(curve.elevate(3).evaluate(t) - at).max() < 1e-12
    assert np.abs(curve.reversed().evaluate(4 - t) - at).max() < 1e-13
    assert np.abs(curve.over(-1, 1).evaluate(np.clip(t / 2 - 1, -1, 1)) - at).max() < 1e-12
    before, after = curve.split(2.5)
    assert np.abs(before.evaluate(t[t <= 2.5]) - at[t <= 2.5]).max() < 1e-13
    assert np.abs(after.evaluate(t[t >= 2.5]) - at[t >= 2.5]).max() < 1e-13
    assert np.abs(curve.transform(2 * np.eye(3)).evaluate(t) - 2 * at).max() < 1e-13
    copy = pickle.loads(pickle.dumps(curve))
    assert (copy.points == curve.points).all() and repr(copy) == repr(curve)
    # By another way: the library's own evaluation of the surface that the curve sweeps.
    swept = ts.extrude(curve, (0, 0, 1))[0]
    assert np.abs(swept.evaluate(t, 0).position - at).max() < 1e-13


def test_lines_and_arcs():
    assert ts.line((0, 0, 0), (2, 4, 6)).evaluate(0.5).tolist() == [1, 2, 3]
    corners = RNG.normal(size=(5, 3))
    assert (ts.polyline(corners).evaluate(np.arange(5)) == corners).all()
    t = np.linspace(0, 1, 201)
    for axis in ((0, 0, 1), (1, 2, -3), (1, 0, 0)):
        ring = ts.circle(2, (1, 1, 1), axis).evaluate(t)
        assert np.abs(np.linalg.norm(ring - 1, axis=1) - 2).max() < 1e-14
        assert np.abs((ring - 1) @ axis).max() < 1e-14 * 10 and (ring[0] == ring[-1]).all()
    for start, end in ((0.3, 1), (-math.pi / 2, math.pi / 2), (1, 1 + 1.9 * math.pi), (-3, 3)):
        bow = ts.arc(3, start, end).evaluate(t)
        assert np.abs(np.hypot(bow[:, 0], bow[:, 1]) - 3).max() < 1e-14 * 3
        for k, angle in ((0, start), (-1, end)):
            assert np.abs(bow[k] - 3 * np.array([math.cos(angle), math.sin(angle), 0])).max() < 1e-14 * 3
        turns = np.unwrap(np.arctan2(bow[:, 1], bow[:, 0]))
        assert (np.diff(turns) > 0).all() and turns[-1] - turns[0] == pytest.approx(end - start)


SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0]]


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: ts.Curve(2, None, SQUARE[:2]), "expected 5 knots .2 points, degree 2., found 6"),
        (lambda: ts.Curve(2, [0, 0, 1, 1], SQUARE), "expected 6 knots"),
        (lambda: ts.Curve(1, [0, 0, 2, 1, 2], SQUARE), "knot 3 is 1, below the one before it, 2"),
        (lambda: ts.Curve(1, [0, 0, 0, 0, 0], SQUARE), "domain from knot 1 to knot 3 is empty"),
        (lambda: ts.Curve(1, [0, 0, 1, 1, 2, 2], [*SQUARE, [0, 1, 0]]), "inner knot 1 stands more than 1 time$"),
        (lambda: ts.Curve(0, None, SQUARE), "degree is 0"),
        (lambda: ts.Curve(2, None, [[0, 0], [1, 1], [2, 0]]), r"points: expected shape \(n, 3\), found \(3, 2\)"),
        (lambda: ts.Curve(2, None, SQUARE, [1, 1]), r"weights: expected shape \(3,\), found \(2,\)"),
        (lambda: ts.Curve(2, None, SQUARE, [1, 0, 1]), "weights: expected numbers above 0, found 0"),
        (lambda: ts.Curve(2, None, [[0, 0, 0], [1, math.inf, 0], [1, 1, 0]]), r"points\[1\]\[1\] is inf"),
        (lambda: ts.line((0, 0), (1, 1)), r"start: expected 3 numbers"),
        (lambda: ts.polyline([[0, 0, 0]]), "n of 2 or more"),
        (lambda: ts.circle(0), "radius is 0"),
        (lambda: ts.arc(1, 2, 1), "end - start is -1, expected above 0"),
        (lambda: ts.circle().evaluate(1.5), r"t is 1.5, expected a parameter of the domain \[0, 1\]"),
        (lambda: ts.circle().split(1), "1 is no inner parameter"),
        (lambda: ts.circle().insert_knots([0.5]), "knot 0.5 would stand more than 2 times"),
        (lambda: ts.circle().elevate(14), "times is 14, expected an integer from 0 to 13"),
        (lambda: ts.circle().transform(np.eye(2)), r"matrix: expected shape \(3, 3\), \(3, 4\) or \(4, 4\)"),
        (lambda: a_spline().transform(np.ones((4, 4))), "as the last row"),
        (lambda: a_spline().split(), "expected u or v, found none"),
        (lambda: a_spline().split(1, 1), "expected u or v, found both"),
        (lambda: a_spline().split(v=7), "v: 7 is no inner parameter"),
        (lambda: a_spline().insert_knots(u=2.0).insert_knots(u=2.0), "u: knot 2 would stand more than 3 times"),
        (lambda: a_spline().insert_knots(u=[math.nan]), r"u\[0\] is nan"),
    ],
)
def test_bad_curves_and_operations(make, words):
    with pytest.raises(ts.Error, match=words):
        make()
