"""Spline surfaces as arrays, and their operations, which keep the surface as it is."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ._arrays import array_of, integer_of, pair_of
from ._nets import (
    MAX_DEGREE,
    bezier_knots,
    check_knots,
    elevate,
    euclidean,
    finite_of,
    frozen,
    homogeneous,
    insert,
    new_knots_of,
    split,
)
from .errors import ArgumentError, ArgumentTypeError


def knots_pair(knots: Any) -> tuple[np.ndarray, np.ndarray]:
    """Returns the knots of both directions, of one list for both or of one list per direction."""
    if not hasattr(knots, "__len__") or isinstance(knots, (str, bytes)):
        raise ArgumentTypeError(f"knots: expected one list of numbers, or one per direction, found {knots!r}")
    if len(knots) and all(np.ndim(knot) == 0 for knot in knots):
        return (array_of("knots", knots),) * 2
    if len(knots) != 2:
        raise ArgumentError(f"knots: expected one list of numbers, or one per direction, found {len(knots)} lists")
    first, second = (array_of(f"knots[{k}]", knots[k]) for k in range(2))
    if first.ndim != 1 or second.ndim != 1:
        raise ArgumentError(f"knots: expected two lists of numbers, found shapes {first.shape} and {second.shape}")
    return first, second


def affine_of(matrix: Any) -> tuple[np.ndarray, np.ndarray]:
    """Returns the linear part and the translation of a matrix (3, 3), (3, 4) or (4, 4)."""
    matrix = finite_of("matrix", matrix)
    if matrix.shape not in ((3, 3), (3, 4), (4, 4)):
        raise ArgumentError(f"matrix: expected shape (3, 3), (3, 4) or (4, 4), found {matrix.shape}")
    if len(matrix) == 4 and matrix[3].tolist() != [0, 0, 0, 1]:
        raise ArgumentError(f"matrix: expected [0, 0, 0, 1] as the last row, found {matrix[3].tolist()}")
    return matrix[:3, :3], matrix[:3, 3] if matrix.shape[1] == 4 else np.zeros(3)


@dataclass(frozen=True)
class Spline:
    """A spline surface: ``points`` (nu, nv, 3), ``degree`` an integer or one per direction, ``knots`` one array per
    direction or one for both, ``weights`` (nu, nv). Without knots it is a Bezier patch; without weights it is
    polynomial. ``ts.model()`` makes a model of splines.

    Operations return another spline. Their errors are ArgumentError with the name of what is wrong.

    >>> import tessera as ts
    >>> patch = ts.Spline([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 1]]])
    >>> patch.elevate(u=1).insert_knots(v=[0.25]).checked().points.shape
    (3, 3, 3)
    """

    points: Any
    degree: int | tuple[int, int] | None = None
    knots: Any = None
    weights: Any = None
    name: str = ""

    def checked(self) -> CheckedSpline:
        """Returns the spline with a degree and knots per direction, and arrays that are copies and read-only."""
        points = finite_of("points", self.points)
        if points.ndim != 3 or points.shape[2] != 3:
            raise ArgumentError(f"points: expected shape (nu, nv, 3), found {points.shape}")
        weights = None if self.weights is None else finite_of("weights", self.weights)
        if weights is not None and weights.shape != points.shape[:2]:
            raise ArgumentError(f"weights: expected shape {points.shape[:2]}, found {weights.shape}")
        if weights is not None and not (weights > 0).all():
            raise ArgumentError(f"weights: expected numbers above 0, found {weights.min():g}", "invalid_weight")
        degree = self.degree
        if degree is None and self.knots is not None:
            raise ArgumentTypeError("degree: expected one beside the knots")
        pair = pair_of(
            "degree", (points.shape[0] - 1, points.shape[1] - 1) if degree is None else degree, 1, MAX_DEGREE
        )
        knots = (bezier_knots(pair[0]), bezier_knots(pair[1])) if self.knots is None else knots_pair(self.knots)
        for k in range(2):
            check_knots(f"knots[{k}]", finite_of(f"knots[{k}]", knots[k]), pair[k], points.shape[k])
        return CheckedSpline(
            frozen(points),
            pair,
            (frozen(knots[0]), frozen(knots[1])),
            None if weights is None else frozen(weights),
            self.name,
        )

    @property
    def domain(self) -> np.ndarray:
        """The ranges of the parameters, [[u0, u1], [v0, v1]]."""
        own = self.checked()
        return np.array([[own.knots[k][own.degree[k]], own.knots[k][-own.degree[k] - 1]] for k in range(2)])

    def insert_knots(self, u: Any = (), v: Any = ()) -> CheckedSpline:
        """Returns the same surface with more knots: inner parameters, each at most degree times in all."""
        own = self.checked()
        for axis, (name, new) in enumerate((("u", u), ("v", v))):
            wanted = new_knots_of(name, new, own.knots[axis], own.degree[axis]) if np.size(new) else np.zeros(0)
            if len(wanted):
                knots, net = insert(own.knots[axis], own.degree[axis], own._net(axis), wanted)
                own = own._with(axis, knots, net, own.degree[axis])
        return own

    def elevate(self, u: int = 0, v: int = 0) -> CheckedSpline:
        """Returns the same surface with degrees that are higher by ``u`` and ``v``, up to 15."""
        own = self.checked()
        for axis, (name, times) in enumerate((("u", u), ("v", v))):
            degree = own.degree[axis]
            times = integer_of(name, times, 0, MAX_DEGREE - degree)
            if times:
                own = own._with(axis, *elevate(own.knots[axis], degree, own._net(axis), times), degree + times)
        return own

    def split(self, u: float | None = None, v: float | None = None) -> tuple[CheckedSpline, CheckedSpline]:
        """Returns the parts before and after a parameter: either ``u`` or ``v``. Each keeps its parameters."""
        if (u is None) == (v is None):
            raise ArgumentTypeError("split: expected u or v, found " + ("none" if u is None else "both"))
        axis, at = (0, u) if v is None else (1, v)
        own = self.checked()
        degree = own.degree[axis]
        first, second = split("uv"[axis], own.knots[axis], degree, own._net(axis), at)
        return own._with(axis, *first, degree), own._with(axis, *second, degree)

    def transform(self, matrix: Any) -> CheckedSpline:
        """Returns the image of the surface by an affine map: (3, 3), or (3, 4) or (4, 4) with the translation last."""
        linear, translation = affine_of(matrix)
        own = self.checked()
        return replace(own, points=frozen(own.points @ linear.T + translation))


@dataclass(frozen=True)
class CheckedSpline(Spline):
    """A spline with a degree and knots per direction, and arrays that are read-only."""

    points: np.ndarray
    degree: tuple[int, int]
    knots: tuple[np.ndarray, np.ndarray]
    weights: np.ndarray | None = None

    def checked(self) -> CheckedSpline:
        return self

    def _net(self, axis: int) -> np.ndarray:
        return np.moveaxis(homogeneous(self.points, self.weights), axis, 0)

    def _with(self, axis: int, knots: np.ndarray, net: np.ndarray, degree: int) -> CheckedSpline:
        """Returns the spline with another net, knots and degree of one direction."""
        points, weights = euclidean(np.moveaxis(net, 0, axis))
        degrees, both = list(self.degree), list(self.knots)
        degrees[axis], both[axis] = degree, frozen(knots)
        weights = None if weights is None else frozen(weights)
        return CheckedSpline(frozen(points), (degrees[0], degrees[1]), (both[0], both[1]), weights, self.name)
