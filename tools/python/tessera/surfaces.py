"""Surfaces as splines: their degrees, knots and points, and operations on them."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._nets import frozen
from .errors import UnsupportedError
from .patches import Patch, PatchSetBase
from .splines import CheckedSpline


class SurfaceBase:
    """All of Surface that needs no Model: what it is as a spline.

    A model that was made of splines returns them as they were. A surface of a file, or of another kind, is the spline
    of its Bezier patches: the same surface with the same parameters, whose inner knots stand as often as the degree
    says, without trimming loops. Surfaces by functions are what was fitted to them (PatchSet.fit_error).
    """

    _kept: CheckedSpline | None = None

    def _find_spline(self) -> CheckedSpline:
        raise NotImplementedError

    @property
    def spline(self) -> CheckedSpline:
        """The surface as a spline with knots, whose arrays are read-only. Errors: UnsupportedError if it is none, since
        its patches differ in degree or do not meet."""
        if self._kept is None:
            self._kept = self._find_spline()
        return self._kept

    @property
    def degree(self) -> tuple[int, int]:
        """The degrees in u and v."""
        return self.spline.degree

    @property
    def knots(self) -> tuple[np.ndarray, np.ndarray]:
        """The knots of u and of v, each (points + degree + 1,)."""
        return self.spline.knots

    @property
    def points(self) -> np.ndarray:
        """The control points (nu, nv, 3), not multiplied by weights."""
        return self.spline.points

    @property
    def weights(self) -> np.ndarray:
        """The weights (nu, nv); 1 for a polynomial surface."""
        return np.ones(self.points.shape[:2]) if self.spline.weights is None else self.spline.weights

    @property
    def is_rational(self) -> bool:
        """Whether there are weights."""
        return self.spline.weights is not None

    def insert_knots(self, u: Any = (), v: Any = ()) -> CheckedSpline:
        """Returns the same surface with more knots; see Spline.insert_knots()."""
        return self.spline.insert_knots(u, v)

    def elevate(self, u: int = 0, v: int = 0) -> CheckedSpline:
        """Returns the same surface with degrees that are higher by ``u`` and ``v``; see Spline.elevate()."""
        return self.spline.elevate(u, v)

    def split(self, u: float | None = None, v: float | None = None) -> tuple[CheckedSpline, CheckedSpline]:
        """Returns the parts before and after a parameter; see Spline.split()."""
        return self.spline.split(u, v)

    def transform(self, matrix: Any) -> CheckedSpline:
        """Returns the image of the surface by an affine map; see Spline.transform()."""
        return self.spline.transform(matrix)


def spline_of_patches(patches: PatchSetBase, surface: int, name: str) -> CheckedSpline:
    """Returns the spline of the patches of a surface in a set, which lie side by side in the order of surfaces."""
    first = _first_of(patches, surface)
    own: list[Patch] = []
    while first + len(own) < len(patches) and (patch := patches[first + len(own)]).surface == surface:
        own.append(patch)
    label = f"surface {name!r}" if name else f"surface {surface}"
    if not own:
        raise UnsupportedError(f"{label} has no patches", "unsupported")
    u = sorted({float(patch.domain[0, 0]) for patch in own}) + [max(float(patch.domain[0, 1]) for patch in own)]
    v = sorted({float(patch.domain[1, 0]) for patch in own}) + [max(float(patch.domain[1, 1]) for patch in own)]
    (p, q), is_rational = own[0].degree, any(patch.is_rational for patch in own)
    if len(own) != (len(u) - 1) * (len(v) - 1) or any(patch.degree != (p, q) for patch in own):
        raise UnsupportedError(f"{label} is no spline: its patches differ in degree, or are no grid", "unsupported")
    net = np.full((p * (len(u) - 1) + 1, q * (len(v) - 1) + 1, 4), np.nan)
    for patch in own:
        i, j = p * u.index(float(patch.domain[0, 0])), q * v.index(float(patch.domain[1, 0]))
        place = net[i : i + p + 1, j : j + q + 1]
        values = np.concatenate([patch.points, patch.weights[..., None]], axis=2)
        if not (np.isnan(place) | (place == values)).all():
            raise UnsupportedError(f"{label} is no spline: its patches do not meet", "unsupported")
        place[...] = values
    knots_u, knots_v = (
        frozen(np.concatenate([breaks[:1], np.repeat(breaks, degree), breaks[-1:]]))
        for breaks, degree in ((u, p), (v, q))
    )
    weights = frozen(net[..., 3]) if is_rational else None
    return CheckedSpline(frozen(net[..., :3]), (p, q), (knots_u, knots_v), weights, name)


def _first_of(patches: PatchSetBase, surface: int) -> int:
    """Returns the first patch of a surface."""
    low, high = 0, len(patches)
    while low < high:
        middle = (low + high) // 2
        if patches[middle].surface < surface:
            low = middle + 1
        else:
            high = middle
    return low
