"""Control nets of splines in NumPy: knots and points of one direction, along the first axis.

A net is homogeneous where it is rational: points times weights, then the weights. Formulas: Piegl and Tiller, The NURBS
Book, 2nd ed.; blossoms: Ramshaw, Blossoms are polar forms, 1989.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ._arrays import array_of, integer_of, number_of
from .errors import ArgumentError

MAX_DEGREE = 15


def homogeneous(points: np.ndarray, weights: np.ndarray | None) -> np.ndarray:
    """Returns the net of points and weights; the points themselves if there are no weights."""
    return points if weights is None else np.concatenate([points * weights[..., None], weights[..., None]], axis=-1)


def euclidean(net: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
    """Returns the points and weights of a net."""
    return (net, None) if net.shape[-1] == 3 else (net[..., :3] / net[..., 3:], net[..., 3])


def bezier_knots(degree: int) -> np.ndarray:
    return np.repeat([0.0, 1.0], degree + 1)


def frozen(array: np.ndarray) -> np.ndarray:
    """Returns a copy that cannot be written."""
    copy = np.array(array)
    copy.flags.writeable = False
    return copy


def finite_of(name: str, value: Any) -> np.ndarray:
    """Returns an array of doubles without NaN and infinity."""
    array = array_of(name, value)
    if not np.isfinite(array).all():
        at = np.argwhere(~np.isfinite(array))[0].tolist()
        where = "".join(f"[{k}]" for k in at)
        raise ArgumentError(f"{name}{where} is {array[tuple(at)]}, expected finite numbers", "non_finite")
    return array


def vector_of(name: str, value: Any) -> np.ndarray:
    """Returns three finite numbers."""
    vector = finite_of(name, value)
    if vector.shape != (3,):
        raise ArgumentError(f"{name}: expected 3 numbers, found shape {vector.shape}")
    return vector


def degree_of(name: str, value: Any) -> int:
    return integer_of(name, value, 1, MAX_DEGREE)


def _times(count: int) -> str:
    return f"{count} time{'s' * (count != 1)}"


def check_knots(name: str, knots: np.ndarray, degree: int, count: int) -> None:
    """Raises an error unless the knots suit a degree and a number of control points."""
    if knots.ndim != 1 or len(knots) != count + degree + 1:
        found = len(knots) if knots.ndim == 1 else f"shape {knots.shape}"
        raise ArgumentError(
            f"{name}: expected {count + degree + 1} knots ({count} points, degree {degree}), found {found}",
            "count_mismatch",
        )
    if count <= degree:
        raise ArgumentError(f"{name}: degree {degree} needs at least {degree + 1} points, found {count}")
    if (np.diff(knots) < 0).any():
        at = int(np.argmax(np.diff(knots) < 0)) + 1
        raise ArgumentError(f"{name}: knot {at} is {knots[at]:g}, below the one before it, {knots[at - 1]:g}")
    if not knots[degree] < knots[count]:
        raise ArgumentError(f"{name}: the domain from knot {degree} to knot {count} is empty")
    inner = knots[(knots > knots[degree]) & (knots < knots[count])]
    values, counts = np.unique(inner, return_counts=True)
    if (counts > degree).any():
        raise ArgumentError(f"{name}: inner knot {values[counts > degree][0]:g} stands more than {_times(degree)}")


def spans_of(knots: np.ndarray, degree: int, at: np.ndarray) -> np.ndarray:
    """Returns the index of the span [knots[k], knots[k + 1]) of each parameter; the last one at the end."""
    count = len(knots) - degree - 1
    last = np.searchsorted(knots, knots[count], "left") - 1
    return np.clip(np.searchsorted(knots, at, "right") - 1, degree, last)


def basis_of(knots: np.ndarray, degree: int, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns the span of each parameter and the values of its degree + 1 functions (The NURBS Book, A2.2)."""
    spans = spans_of(knots, degree, at)
    values = np.ones((degree + 1, len(at)))
    for p in range(1, degree + 1):
        saved = np.zeros(len(at))
        for r in range(p):
            right, left = knots[spans + r + 1], knots[spans + r + 1 - p]
            share = values[r] / (right - left)
            values[r] = saved + (right - at) * share
            saved = (at - left) * share
        values[p] = saved
    return spans, values.T


def evaluate(knots: np.ndarray, degree: int, net: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Returns the homogeneous values at parameters, (len(at), ...)."""
    spans, values = basis_of(knots, degree, at)
    sums = np.zeros((len(at), *net.shape[1:]))
    for k in range(degree + 1):
        sums += values[:, k].reshape(-1, *[1] * (net.ndim - 1)) * net[spans - degree + k]
    return sums


def insert(knots: np.ndarray, degree: int, net: np.ndarray, new: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Inserts knots one after the other (Boehm 1980)."""
    for t in new:
        k = int(np.searchsorted(knots, t, "right")) - 1
        low = np.arange(k - degree + 1, k + 1 - int((knots == t).sum()))
        share = ((t - knots[low]) / (knots[low + degree] - knots[low])).reshape(-1, *[1] * (net.ndim - 1))
        mixed = share * net[low] + (1 - share) * net[low - 1]
        net = np.concatenate([net[: k - degree + 1], mixed, net[low[-1] :]])
        knots = np.insert(knots, k + 1, t)
    return knots, net


def new_knots_of(name: str, value: Any, knots: np.ndarray, degree: int) -> np.ndarray:
    """Returns knots to insert, sorted; raises an error unless they lie within the domain, at most ``degree`` times."""
    new = np.sort(finite_of(name, value).reshape(-1))
    first, last = knots[degree], knots[-degree - 1]
    for t in new:
        if not first < t < last:
            raise ArgumentError(f"{name}: {t:g} is no inner parameter of the domain [{first:g}, {last:g}]")
        if (knots == t).sum() + (new == t).sum() > degree:
            raise ArgumentError(f"{name}: knot {t:g} would stand more than {_times(degree)}")
    return new


def split(
    name: str, knots: np.ndarray, degree: int, net: np.ndarray, value: Any
) -> tuple[tuple[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]:
    """Returns the knots and nets of both sides of a parameter."""
    t = number_of(name, value)
    missing = max(degree - int((knots == t).sum()), 1)
    if not knots[degree] < t < knots[-degree - 1]:
        new_knots_of(name, [t] * missing, knots, degree)  # raises
    knots, net = insert(knots, degree, net, np.full(degree - int((knots == t).sum()), t))
    k = int(np.searchsorted(knots, t, "left"))
    return (
        (np.concatenate([knots[:k], np.full(degree + 1, t)]), net[:k]),
        (np.concatenate([[t], knots[k:]]), net[k - 1 :]),
    )


def elevate(knots: np.ndarray, degree: int, net: np.ndarray, times: int) -> tuple[np.ndarray, np.ndarray]:
    """Raises the degree; every knot stands ``times`` times more."""
    for p in range(degree, degree + times):
        knots, net = _elevated(knots, p, net)
    return knots, net


def _elevated(knots: np.ndarray, degree: int, net: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Raises the degree by 1. A control point is the blossom of its knots: f'(t1 .. tp+1), which is the mean of f over
    all choices of p of them."""
    values, counts = np.unique(knots, return_counts=True)
    new = np.repeat(values, counts + 1)
    # Knots before and after the domain, of splines that are not clamped, stand once more, too: some are left over.
    low, high = knots[degree], knots[-degree - 1]
    first = int(np.searchsorted(new, low, "right")) - 1 - (degree + 1)
    last = int(np.searchsorted(new, high, "left")) + degree + 1
    new = new[first : last + 1]
    count = len(new) - degree - 2
    windows = new[np.arange(count)[:, None] + np.arange(1, degree + 2)]  # the knots of each control point
    spans = spans_of(knots, degree, np.clip(windows.mean(axis=1), low, high))
    sums = np.zeros((count, *net.shape[1:]))
    for k in range(degree + 1):
        sums += _blossoms(knots, degree, net, spans, np.delete(windows, k, axis=1))
    return new, sums / (degree + 1)


def _blossoms(knots: np.ndarray, degree: int, net: np.ndarray, spans: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Returns the blossoms of the polynomials of spans: de Boor's algorithm with another parameter in each step."""
    points = net[spans[:, None] + np.arange(-degree, 1)]
    for r in range(1, degree + 1):
        low = spans[:, None] + np.arange(r - degree, 1)
        share = (at[:, r - 1 : r] - knots[low]) / (knots[low + degree + 1 - r] - knots[low])
        share = share.reshape(*share.shape, *[1] * (net.ndim - 1))
        points = share * points[:, 1:] + (1 - share) * points[:, :-1]
    return points[:, 0]


def interpolated(knots: np.ndarray, degree: int, at: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Returns the net of the spline that takes ``values`` at the parameters ``at``, as many as control points.

    Eliminates without pivots within the band, which is stable since the matrix is totally positive (de Boor and Pinkus,
    Backward error analysis for totally positive linear systems, 1977).
    """
    count = len(at)
    spans, rows = basis_of(knots, degree, at)
    band = np.zeros((count, 2 * degree + 1))  # band[i, degree + j - i] is element (i, j)
    for k in range(degree + 1):
        band[np.arange(count), spans - degree + k - np.arange(count) + degree] = rows[:, k]
    net = values.copy()
    for i in range(count):
        for below in range(i + 1, min(i + degree + 1, count)):
            share = band[below, degree + i - below] / band[i, degree]
            if share:
                width = degree + 1
                band[below, degree + i - below : degree + i - below + width] -= share * band[i, degree:]
                net[below] -= share * net[i]
    for i in reversed(range(count)):
        right = min(degree, count - 1 - i)
        if right:
            net[i] -= np.tensordot(band[i, degree + 1 : degree + 1 + right], net[i + 1 : i + 1 + right], 1)
        net[i] /= band[i, degree]
    return net
