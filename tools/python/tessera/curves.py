"""Curves, from which surfaces are made."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ._arrays import integer_of, number_of, positive_of
from ._nets import (
    MAX_DEGREE,
    bezier_knots,
    check_knots,
    degree_of,
    elevate,
    euclidean,
    evaluate,
    finite_of,
    frozen,
    homogeneous,
    insert,
    new_knots_of,
    split,
    vector_of,
)
from .errors import ArgumentError
from .splines import affine_of


@dataclass(frozen=True, eq=False)
class Curve:
    """A spline curve: ``points`` (n, 3), ``knots`` (n + degree + 1,) and ``weights`` (n,), above 0. Without knots it is
    a Bezier curve on [0, 1]; without weights it is polynomial. Arrays are copied, and read-only.

    Errors: ArgumentError where lengths do not fit, knots decrease, or a number is not finite.

    >>> import tessera as ts
    >>> arch = ts.Curve(2, None, [[0, 0, 0], [1, 0, 2], [2, 0, 0]])
    >>> arch.evaluate(0.5).tolist()
    [1.0, 0.0, 1.0]
    """

    degree: int
    knots: Any
    points: Any
    weights: Any = None

    def __post_init__(self) -> None:
        points = finite_of("points", self.points)
        if points.ndim != 2 or points.shape[1] != 3:
            raise ArgumentError(f"points: expected shape (n, 3), found {points.shape}")
        degree = degree_of("degree", self.degree)
        knots = bezier_knots(degree) if self.knots is None else finite_of("knots", self.knots)
        check_knots("knots", knots, degree, len(points))
        weights = None if self.weights is None else finite_of("weights", self.weights)
        if weights is not None and weights.shape != points.shape[:1]:
            raise ArgumentError(f"weights: expected shape {points.shape[:1]}, found {weights.shape}")
        if weights is not None and not (weights > 0).all():
            raise ArgumentError(f"weights: expected numbers above 0, found {weights.min():g}", "invalid_weight")
        own = {"degree": degree, "knots": frozen(knots), "points": frozen(points)}
        own["weights"] = None if weights is None else frozen(weights)
        for name, value in own.items():
            object.__setattr__(self, name, value)

    @property
    def domain(self) -> tuple[float, float]:
        """The range of the parameter."""
        return float(self.knots[self.degree]), float(self.knots[-self.degree - 1])

    def evaluate(self, t: Any) -> np.ndarray:
        """Returns the points at parameters of the domain, of shape (..., 3)."""
        t = finite_of("t", t)
        low, high = self.domain
        if t.size and not (low <= t.min() and t.max() <= high):
            found = t.min() if t.min() < low else t.max()
            raise ArgumentError(f"t is {found:g}, expected a parameter of the domain [{low:g}, {high:g}]")
        values = evaluate(self.knots, self.degree, self._net(), t.reshape(-1))
        return euclidean(values)[0].reshape(*t.shape, 3)

    def insert_knots(self, t: Any) -> Curve:
        """Returns the same curve with more knots: inner parameters, each at most degree times in all."""
        new = new_knots_of("t", t, self.knots, self.degree)
        return self._with(self.degree, *insert(self.knots, self.degree, self._net(), new))

    def elevate(self, times: int = 1) -> Curve:
        """Returns the same curve with a degree that is higher by ``times``, up to 15."""
        times = integer_of("times", times, 0, MAX_DEGREE - self.degree)
        return self._with(self.degree + times, *elevate(self.knots, self.degree, self._net(), times))

    def split(self, t: float) -> tuple[Curve, Curve]:
        """Returns the parts before and after a parameter. Each keeps its parameters."""
        first, second = split("t", self.knots, self.degree, self._net(), t)
        return self._with(self.degree, *first), self._with(self.degree, *second)

    def reversed(self) -> Curve:
        """Returns the curve from its end to its start, on the same domain."""
        knots = sum(self.domain) - self.knots[::-1]
        return Curve(self.degree, knots, self.points[::-1], None if self.weights is None else self.weights[::-1])

    def transform(self, matrix: Any) -> Curve:
        """Returns the image of the curve by an affine map: (3, 3), or (3, 4) or (4, 4) with the translation last."""
        linear, translation = affine_of(matrix)
        return Curve(self.degree, self.knots, self.points @ linear.T + translation, self.weights)

    def over(self, low: float, high: float) -> Curve:
        """Returns the same curve with parameters of another domain."""
        low, high = number_of("low", low), number_of("high", high)
        if not low < high:
            raise ArgumentError(f"the domain [{low:g}, {high:g}] is empty")
        first, last = self.domain
        if (low, high) == (first, last):
            return self
        share = (self.knots - first) / (last - first)
        knots = np.where(share == 1, high, low + share * (high - low))  # the end to the last bit
        return Curve(self.degree, knots, self.points, self.weights)

    def __repr__(self) -> str:
        low, high = self.domain
        kind = "spline" if self.weights is None else "rational spline"
        return f"<Curve, {kind} of degree {self.degree} with {len(self.points)} points on [{low:g}, {high:g}]>"

    def _net(self) -> np.ndarray:
        return homogeneous(self.points, self.weights)

    def _with(self, degree: int, knots: np.ndarray, net: np.ndarray) -> Curve:
        return Curve(degree, knots, *euclidean(net))


def line(start: Any, end: Any) -> Curve:
    """Returns the straight segment between two points, on [0, 1]."""
    return Curve(1, None, [vector_of("start", start), vector_of("end", end)])


def polyline(points: Any) -> Curve:
    """Returns the straight segments through points (n, 3). Point k lies at the parameter k."""
    points = finite_of("points", points)
    if points.ndim != 2 or points.shape[1] != 3 or len(points) < 2:
        raise ArgumentError(f"points: expected shape (n, 3) with n of 2 or more, found {points.shape}")
    last = len(points) - 1
    return Curve(1, np.concatenate([[0], np.arange(last + 1), [last]]), points)


def circle(radius: float = 1.0, centre: Any = (0, 0, 0), axis: Any = (0, 0, 1)) -> Curve:
    """Returns the full circle about an axis, counter-clockwise as seen from its tip, on [0, 1]; exact."""
    return arc(radius, 0.0, 2 * math.pi, centre, axis)


def arc(radius: float, start: float, end: float, centre: Any = (0, 0, 0), axis: Any = (0, 0, 1)) -> Curve:
    """Returns an arc from the angle ``start`` to the angle ``end``, in radians, at most a full turn, on [0, 1]; exact.

    The angle 0 is along x for the axis z, and along frame_of(axis)[0] for others.
    """
    frame = frame_of(axis)
    radius, centre = positive_of("radius", radius), vector_of("centre", centre)
    first = number_of("start", start)
    knots, turns, weights = turned(number_of("end", end) - first, "end - start")
    cosine, sine = _cosine_sine(np.array(first))
    x = turns[:, :1] * cosine - turns[:, 1:] * sine
    y = turns[:, :1] * sine + turns[:, 1:] * cosine
    return Curve(2, knots, centre + radius * (x * frame[0] + y * frame[1]), weights)


def frame_of(axis: Any) -> np.ndarray:
    """Returns three orthogonal unit vectors as rows, the last along the axis: x, y, z for the axis z."""
    axis = vector_of("axis", axis)
    length = np.linalg.norm(axis)
    if not length > 0:
        raise ArgumentError("axis is 0, expected a direction")
    axis = axis / length
    # The x axis where the angle is zero, as near as it can be; z -> x for the axis x, so that the choice never fails.
    near = np.array([1.0, 0, 0]) if abs(axis[0]) < 0.9 else np.array([0, 1.0, 0])
    first = near - (near @ axis) * axis
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(axis, first), axis])


def turned(angle: float, name: str = "angle") -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns the knots, the control points (x, y) and the weights of the unit arc from the angle 0 (The NURBS Book,
    A7.1): one piece for each quarter of a turn."""
    full = 2 * math.pi
    if not 0 < angle <= full * (1 + 1e-15):
        raise ArgumentError(f"{name} is {angle:g}, expected above 0 and at most 2 pi, in radians")
    pieces = max(1, math.ceil(angle / (full / 4) - 1e-9))
    steps = np.arange(2 * pieces + 1) * (angle / (2 * pieces))
    half = math.cos(angle / (2 * pieces))
    weights = np.where(np.arange(2 * pieces + 1) % 2, half, 1.0)
    points = np.stack(_cosine_sine(steps), axis=1) / weights[:, None]
    if abs(angle / (full / 4) - pieces) < 1e-15 * pieces:  # whole quarters, to the last bit
        points[1::2] = np.sign(points[1::2])
        weights[1::2] = math.sqrt(0.5)
    knots = np.concatenate([[0], np.repeat(np.arange(pieces + 1) / pieces, 2), [1]])
    return knots, points, weights


def _cosine_sine(angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns cosines and sines; exact at quarters of a turn."""
    quarters = angle / (math.pi / 2)
    nearest = np.round(quarters)
    is_quarter = np.abs(quarters - nearest) < 1e-15 * np.maximum(np.abs(quarters), 1)
    index = nearest.astype(np.int64) % 4
    cosine = np.where(is_quarter, np.array([1.0, 0, -1, 0])[index], np.cos(angle))
    return cosine, np.where(is_quarter, np.array([0.0, 1, 0, -1])[index], np.sin(angle))
