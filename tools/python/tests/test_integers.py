"""Integers that C would wrap: each is checked, with an error that names it."""

import numpy as np
import pytest

import tessera as ts
from conftest import wavy

WRAPPED = (-1, -(2**31), 2**31, 2**32 + 2, 2**63, 2**64 + 2)


@pytest.fixture
def patches():
    return ts.bezier(wavy(2, 2)).patches()


def refused(name, call, *values):
    for value in values:
        with pytest.raises(ts.ArgumentError, match=rf"{name} is {value}, expected an integer from "):
            call(value)
    for value in (1.5, "3", None):
        with pytest.raises(ts.ArgumentTypeError, match=f"{name}: expected an integer"):
            call(value)


def test_limits_of_a_mesh(patches):
    with pytest.raises(ts.ArgumentError, match="max_triangles is -1, expected"):
        patches.tessellate(1e-2, max_triangles=-1)
    for count in (0, -(2**63), 2**64):
        with pytest.raises(ts.ArgumentError, match=f"max_triangles is {count}, expected"):
            patches.tessellate(1e-2, max_triangles=count)
    with pytest.raises(ts.ArgumentTypeError, match="max_triangles: expected an integer"):
        patches.tessellate(1e-2, max_triangles=1e9)
    for rate in (*WRAPPED, 0, 4097):
        for rates in ((rate, 3), (3, rate), rate):
            with pytest.raises(ts.ArgumentError, match=f"rates is {rate}, expected an integer from 1 to 4096"):
                patches.tessellate(rates=rates)
    assert len(patches.tessellate(rates=(np.int64(2), 3)).faces) == 4 * 2 * 3 * 2


def test_sizes_of_a_picture(patches):
    for name in ("width", "height"):
        refused(
            rf"view\.{name}",
            lambda value, of=name: patches.tessellate(pixels=1, view=ts.View((0, 0, 9), (0, 0, 0), **{of: value})),
            *WRAPPED,
            0,
        )


def test_pieces_of_a_scene(patches):
    refused("pieces", lambda value: patches.rays(pieces=value), *WRAPPED, 0, 9)


def test_degrees():
    knots = [0, 0, 0, 1, 1, 1]
    points = np.zeros((3, 3, 3))
    points[..., 0], points[..., 1] = np.meshgrid(range(3), range(3), indexing="ij")
    for degree in (*WRAPPED, 0, 16):
        with pytest.raises(ts.ArgumentError, match=f"degree is {degree}, expected an integer from 1 to 15"):
            ts.nurbs(degree, (knots, knots), points)
    assert len(ts.nurbs(2, (knots, knots), points).patches()) == 1


def test_places(patches):
    model = ts.bezier(wavy(2, 2))
    for index in (4, -5, 2**32, 2**64 + 2, -(2**64)):
        with pytest.raises(IndexError):
            patches[index]
        with pytest.raises(IndexError):
            model[index]
    assert patches[-1].index == 3 and model[-4].index == 0
    for of in (patches, model):
        with pytest.raises(ts.ArgumentTypeError, match="expected an integer"):
            of[1.0]
    for shape in (-1, -(2**63), 2**63, 2**64):
        with pytest.raises(ts.ArgumentError, match=f"shape is {shape}, expected"):
            model.patches(shape)
    with pytest.raises(ts.ArgumentError, match="the model has 0 shapes"):
        model.patches(0)
    for index in WRAPPED[2:]:
        with pytest.raises(ts.Error, match="patch|numbers from 0|expected uint32 numbers"):
            patches.edit([index], np.zeros((1, 4, 4, 3)))


def test_threads_and_other_counts(patches):
    def on(count):
        with ts.threads(count):
            pass

    refused("threads", on, *WRAPPED, 1025, 10_000_000)
    refused("store_bytes", ts.limits, -1, 2**64)
    refused("repeats", lambda count: ts.measure(lambda: None, count), -1, 0, 2**40)
    refused("derivatives", lambda order: patches.grid([0], [0], derivatives=order), *WRAPPED, 3)
    with ts.threads(1024):
        assert patches.tessellate(1e-1).is_certified


def test_flags_are_true_or_false():
    model = ts.bezier(wavy(1, 1))
    with pytest.raises(ts.Error):  # a set without doubles, although 5 has the bit of those
        model.patches(whole=5).grid([0], [0], dtype=np.float64)
