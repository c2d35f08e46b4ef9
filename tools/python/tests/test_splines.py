"""Splines: operations that keep the surface, and what they refuse."""

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


def test_callers_may_change_the_arrays_of_splines():
    points = wavy(1, 1)[0]
    model = ts.model(ts.Spline(points))
    points[:] = 0
    assert model[0].points.any() and pickle.loads(pickle.dumps(model))[0].points.any()


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: a_spline().transform(np.ones((4, 4))), "as the last row"),
        (lambda: a_spline().split(), "expected u or v, found none"),
        (lambda: a_spline().split(1, 1), "expected u or v, found both"),
        (lambda: a_spline().split(v=7), "v: 7 is no inner parameter"),
        (lambda: a_spline().insert_knots(u=2.0).insert_knots(u=2.0), "u: knot 2 would stand more than 3 times"),
        (lambda: a_spline().insert_knots(u=[math.nan]), r"u\[0\] is nan"),
    ],
)
def test_bad_operations(make, words):
    with pytest.raises(ts.Error, match=words):
        make()
