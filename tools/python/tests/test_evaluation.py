"""Points of surfaces: broadcasting, memory of the caller, bad arrays."""

import re

import numpy as np
import pytest

import tessera as ts
from conftest import wavy


@pytest.fixture
def surface():
    return ts.bezier(wavy(1, 1)[0])[0]


@pytest.mark.parametrize(
    "u, v, shape",
    [
        (0.5, 0.5, ()),
        ([0.5], 0.5, (1,)),
        (np.zeros((4, 1)), np.zeros(5), (4, 5)),
        (np.zeros((2, 0)), 0.5, (2, 0)),
        (np.zeros(6)[::2], np.zeros(6)[::-2], (3,)),
    ],
)
def test_parameters_broadcast(surface, u, v, shape):
    jets = surface.evaluate(u, v, derivatives=2)
    assert jets.position.shape == (*shape, 3) and jets.mean.shape == shape


def test_broadcast_parameters_give_the_points_of_full_ones(surface):
    u, v = np.linspace(0, 1, 5)[:, None], np.linspace(0, 1, 4)
    full_u, full_v = (np.ascontiguousarray(each) for each in np.broadcast_arrays(u, v))
    assert (surface.evaluate(u, v).position == surface.evaluate(full_u, full_v).position).all()
    assert (surface.evaluate(u[::-1], v).position == surface.evaluate(u, v).position[::-1]).all()


def test_out_is_written_again_and_may_be_a_part_of_more(surface):
    u = np.linspace(0, 1, 11)
    wanted = surface.evaluate(u, u, derivatives=1)
    memory = wanted.position
    assert surface.evaluate(u / 2, u, out=wanted) is wanted and wanted.position is memory
    assert (memory == surface.evaluate(u / 2, u).position).all()
    records = np.zeros((11, 8))
    surface.evaluate(u, u, out=ts.Jets(position=records[:, 2:5]))
    assert (records[:, 2:5] == surface.evaluate(u, u).position).all()
    assert (records[:, [0, 1, 5, 6, 7]] == 0).all()


def test_quantities_are_named(surface):
    jets = surface.evaluate(0.5, 0.5, quantities=["gaussian"])
    assert jets.quantities == ["gaussian"] and not hasattr(jets, "position")
    with pytest.raises(ts.ArgumentError, match="'colour' is no quantity"):
        surface.evaluate(0.5, 0.5, quantities=["colour"])
    with pytest.raises(ts.ArgumentError, match="derivatives is 3"):
        surface.evaluate(0.5, 0.5, derivatives=3)


def read_only(array):
    array.flags.writeable = False
    return array


@pytest.mark.parametrize(
    "array, error, words",
    [
        (np.empty((4, 3)), ValueError, r"expected shape \(5, 3\), found \(4, 3\)"),
        (np.empty((5, 3), np.float32), TypeError, "expected dtype float64, found float32"),
        (read_only(np.empty((5, 3))), ValueError, "read-only"),
        (np.empty((5, 3))[::-1], ValueError, "strides"),
        ([[0.0] * 3] * 5, TypeError, "expected an array of NumPy, found list"),
        (np.zeros(5 * 24 + 1, np.uint8)[1:].view(np.float64).reshape(5, 3), ValueError, "not aligned"),
    ],
)
def test_bad_outputs(surface, array, error, words):
    with pytest.raises(error, match=words) as caught:
        surface.evaluate(np.zeros(5), 0.5, out=ts.Jets(position=array))
    assert isinstance(caught.value, ts.Error)


def test_an_output_that_is_not_contiguous(surface):
    with pytest.raises(ts.ArgumentError, match="not contiguous"):
        surface.evaluate(np.zeros((2, 5)), 0.5, out=ts.Jets(position=np.empty((2, 7, 3))[:, :5]))


def test_bad_parameters(surface):
    with pytest.raises(ts.ArgumentError, match="do not fit each other"):
        surface.evaluate(np.zeros(3), np.zeros(4))
    with pytest.raises(ts.Error) as caught:
        surface.evaluate([0.5, np.nan], 0.5)
    assert caught.value.index == 1
    with pytest.raises(TypeError, match="u: expected float64 numbers"):
        surface.evaluate("a", 0.5)


def test_grids_of_patches():
    model = ts.bezier(wavy(2, 3))
    u, v = [0, 0.25, 1], [0.5, 0.75]
    patches = model.patches(double=True)
    grid = patches.grid(u, v, dtype=np.float64, derivatives=1)
    assert grid.position.shape == (6, 3, 2, 3)
    for k in range(6):
        wanted = model[k].evaluate(np.array(u)[:, None], v).position
        assert np.allclose(grid.position[k], wanted, atol=1e-13)
    small = patches.grid(u, v)
    assert small.position.dtype == np.float32
    assert np.allclose(small.position + patches.origin, grid.position, atol=1e-6)
    again = patches.grid(u, v, out=small)
    assert again is small
    with pytest.raises(ts.Error):
        model.patches().grid(u, v, dtype=np.float64)
    with pytest.raises(ts.ArgumentError, match="two lists"):
        patches.grid([[0]], v)


def test_dlpack_shares_memory(surface):
    position = surface.evaluate(np.zeros(4), 0.5).position
    assert np.shares_memory(np.from_dlpack(position), position)

    class Other:
        def __init__(self, array):
            self.array = array

        def __dlpack__(self, *arguments, **named):
            return self.array.__dlpack__(*arguments, **named)

        def __dlpack_device__(self):
            return self.array.__dlpack_device__()

    assert (surface.evaluate(Other(np.zeros(4)), 0.5).position == position).all()


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda m, p: m[0].evaluate(0.5, 0.5, out=np.zeros(3)), "out: expected Jets, found ndarray"),
        (lambda m, p: p.rays().closest([0, 0, 9], [0, 0, -1], out=ts.Jets()), "out: expected Hits, found Jets"),
        (lambda m, p: p.tessellate(1e-2, out=p), "out: expected Mesh, found PatchSet"),
        (lambda m, p: p.tessellate("fine"), "tolerance: expected a number, found 'fine'"),
        (lambda m, p: p.tessellate(rates="x"), "rates: expected an integer or one per direction, found 'x'"),
        (lambda m, p: p.tessellate(rates=(1, 2, 3)), "rates: expected an integer"),
        (lambda m, p: ts.bezier(wavy(1, 1)[0].astype(str)), "points: expected float64 numbers"),
        (lambda m, p: ts.nurbs(degree="2", knots=([0, 1],) * 2, points=np.zeros((3, 3, 3))), "degree: expected an"),
    ],
)
def test_wrong_types_are_named(call, message):
    model = ts.bezier(wavy(1, 1)[0])
    with pytest.raises(ts.ArgumentTypeError, match=re.escape(message)):
        call(model, model.patches())


def test_a_quantity_may_be_one_name_and_rates_integers_of_numpy(surface):
    assert surface.evaluate(0.5, 0.5, quantities="mean").quantities == ["mean"]
    patches = surface.model.patches()
    assert len(patches.tessellate(rates=np.int64(4)).faces) == len(patches.tessellate(rates=(4, 4)).faces) == 32
