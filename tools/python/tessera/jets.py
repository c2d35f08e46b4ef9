"""Points, derivatives and curvatures of surfaces as arrays."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import Any

import numpy as np

from ._arrays import NamedArrays, array_of, check_out, in_view, integer_of, names_of, out_view, records_of
from ._calls import Handle, run
from ._library import library, struct
from .errors import ArgumentError

#: The quantities and their components.
QUANTITIES = {
    "position": 3,
    "du": 3,
    "dv": 3,
    "duu": 3,
    "duv": 3,
    "dvv": 3,
    "normal": 3,
    "first_form": 3,
    "second_form": 3,
    "gaussian": 1,
    "mean": 1,
    "first_curvature": 1,
    "second_curvature": 1,
    "first_direction": 3,
    "second_direction": 3,
}
_ORDERS = (
    ("position",),
    ("position", "du", "dv", "normal"),
    tuple(QUANTITIES),
)
_LONG = 20_000  # points, below which a call is over at once


class Jets(NamedArrays):
    """The output of an evaluation: one array per quantity, of shape (..., 3) or (...). The array of a quantity that was
    not asked for is a MissingError; ``quantities`` lists those that are there.

    ``position``, ``du``, ``dv``, ``duu``, ``duv``, ``dvv``; ``normal``, unit, along du x dv; ``first_form`` (E, F, G)
    and ``second_form`` (L, M, N); ``gaussian`` and ``mean`` curvature; ``first_curvature`` >= ``second_curvature`` and
    their unit tangents ``first_direction``, ``second_direction``. Made of arrays of the caller, it is where to write
    to: ``Jets(position=array)``.
    """

    _known = QUANTITIES

    position: np.ndarray
    du: np.ndarray
    dv: np.ndarray
    duu: np.ndarray
    duv: np.ndarray
    dvv: np.ndarray
    normal: np.ndarray
    first_form: np.ndarray
    second_form: np.ndarray
    gaussian: np.ndarray
    mean: np.ndarray
    first_curvature: np.ndarray
    second_curvature: np.ndarray
    first_direction: np.ndarray
    second_direction: np.ndarray

    @property
    def quantities(self) -> list[str]:
        """The names of the arrays."""
        return list(self.__dict__)

    @property
    def nbytes(self) -> int:
        return sum(array.nbytes for array in self.__dict__.values())

    def __repr__(self) -> str:
        shapes = (f"{name} {array.shape}" for name, array in self.__dict__.items())
        return f"<Jets {', '.join(shapes)}>"


def _new_jets(shape: tuple[int, ...], dtype: Any, derivatives: int, quantities: Sequence[str] | None) -> Jets:
    if quantities is None:
        quantities = _ORDERS[integer_of("derivatives", derivatives, 0, 2)]
    arrays = {}
    for name in names_of(quantities):
        components = QUANTITIES.get(name)
        if components is None:
            raise ArgumentError(f"{name!r} is no quantity; there are {', '.join(QUANTITIES)}")
        arrays[name] = np.empty(shape if components == 1 else (*shape, components), dtype)
    return Jets(**arrays)


def _jets_out(jets: Jets, shape: tuple[int, ...], dtype: Any) -> Any:
    check_out(jets, Jets)
    out = struct("tsr_jets")
    dtype = np.dtype(dtype)
    out.is_double = dtype == np.float64
    for name, array in jets.__dict__.items():
        setattr(out, name, out_view(name, array, dtype, shape, QUANTITIES[name]))
    return out


def evaluate_surface(
    points: Handle,
    surfaces: int,
    surface: int,
    u: Any,
    v: Any,
    derivatives: int,
    quantities: Sequence[str] | None,
    out: Jets | None,
) -> Jets:
    """Evaluates one surface of a set at scattered points; see Surface.evaluate()."""
    u, v = array_of("u", u), array_of("v", v)
    try:
        u, v = (u, v) if u.shape == v.shape else np.broadcast_arrays(u, v)
    except ValueError:
        raise ArgumentError(f"u of shape {u.shape} and v of shape {v.shape} do not fit each other") from None
    shape = u.shape
    jets = _new_jets(shape, np.float64, derivatives, quantities) if out is None else out
    to = _jets_out(jets, shape, np.float64)
    u, v = records_of(u, 1), records_of(v, 1)
    which = None if surfaces == 1 else np.full(len(u), surface, np.uint32)
    of = None if which is None else in_view(which)
    run(
        library.tsr_set_evaluate,
        points._handle,
        None if of is None else ctypes.byref(of),
        ctypes.byref(in_view(u)),
        ctypes.byref(in_view(v)),
        ctypes.byref(to),
        is_long=len(u) > _LONG,
    )
    return jets


def evaluate_grid(
    patches: Handle,
    count: int,
    u: Any,
    v: Any,
    dtype: Any,
    derivatives: int,
    quantities: Sequence[str] | None,
    out: Jets | None,
) -> Jets:
    """Evaluates all ``count`` patches of a set at a grid; see PatchSet.grid()."""
    u, v = (np.ascontiguousarray(array_of(name, value)) for name, value in (("u", u), ("v", v)))
    if u.ndim != 1 or v.ndim != 1:
        raise ArgumentError(f"u and v: expected two lists of numbers, found shapes {u.shape} and {v.shape}")
    shape = (count, len(u), len(v))
    jets = _new_jets(shape, dtype, derivatives, quantities) if out is None else out
    to = _jets_out(jets, shape, dtype)
    run(
        library.tsr_set_grid,
        patches._handle,
        u.__array_interface__["data"][0],
        len(u),
        v.__array_interface__["data"][0],
        len(v),
        ctypes.byref(to),
        is_long=count * len(u) * len(v) > _LONG,
    )
    return jets
