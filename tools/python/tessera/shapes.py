"""Models of simple surfaces: exact, as NURBS. Each function returns a model of one surface with the name ``name``.

Directions u and v are such that normals, along du x dv, point outwards.
"""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np

from ._arrays import integer_of, number_of, positive_of
from ._nets import MAX_DEGREE, finite_of, interpolated, vector_of
from .curves import Curve, arc, frame_of, line, turned
from .errors import ArgumentError, ArgumentTypeError
from .models import Model
from .sources import model, parse
from .splines import Spline


def _checked(**curves: Any) -> list[Curve]:
    for name, value in curves.items():
        if not isinstance(value, Curve):
            raise ArgumentTypeError(f"{name}: expected a Curve, found {type(value).__name__}")
    return list(curves.values())


def plane(origin: Any = (0, 0, 0), u: Any = (1, 0, 0), v: Any = (0, 1, 0), name: str = "") -> Model:
    """Returns the parallelogram origin + s u + t v, s and t in [0, 1].

    >>> import tessera as ts
    >>> ts.plane(u=(2, 0, 0)).bounds.tolist()
    [[0.0, 0.0, 0.0], [2.0, 1.0, 0.0]]
    """
    origin, u, v = vector_of("origin", origin), vector_of("u", u), vector_of("v", v)
    if not np.linalg.norm(np.cross(u, v)) > 0:
        raise ArgumentError("u and v: expected two directions that differ, found a parallelogram without area")
    return model(Spline([[origin, origin + v], [origin + u, origin + u + v]], name=name))


def sphere(radius: float = 1.0, centre: Any = (0, 0, 0), axis: Any = (0, 0, 1), name: str = "") -> Model:
    """Returns a sphere: u in [0, 1] turns about the axis, v in [0, 1] runs from pole to pole.

    >>> import tessera as ts
    >>> ball = ts.sphere(2.0, centre=(0, 0, 1))
    >>> ball.bounds.tolist()
    [[-2.0, -2.0, -1.0], [2.0, 2.0, 3.0]]
    """
    return _turned_arc(positive_of("radius", radius), 0.0, centre, axis, -math.pi / 2, math.pi / 2, name)


def torus(major: float, minor: float, centre: Any = (0, 0, 0), axis: Any = (0, 0, 1), name: str = "") -> Model:
    """Returns a torus: ``major`` is the radius of the circle in the middle of the tube, ``minor`` the tube's."""
    major, minor = positive_of("major", major), positive_of("minor", minor)
    if minor >= major:
        raise ArgumentError(f"minor is {minor:g}, expected below major, which is {major:g}")
    return _turned_arc(minor, major, centre, axis, 0.0, 2 * math.pi, name)


def _turned_arc(radius: float, away: float, centre: Any, axis: Any, start: float, end: float, name: str) -> Model:
    """Revolves an arc in the plane of the axis, whose centre lies at a distance from it."""
    frame = frame_of(axis)
    profile = arc(radius, start, end)
    x, y = profile.points[:, 0] + away, profile.points[:, 1]  # y along the axis
    points = vector_of("centre", centre) + x[:, None] * frame[0] + y[:, None] * frame[2]
    return revolve(Curve(2, profile.knots, points, profile.weights), axis, origin=centre, name=name)


def cylinder(radius: float, height: float, centre: Any = (0, 0, 0), axis: Any = (0, 0, 1), name: str = "") -> Model:
    """Returns the side of a cylinder, without lids; ``centre`` is that of its lower end."""
    return cone(radius, height, radius, centre, axis, name)


def cone(
    radius: float, height: float, top: float = 0.0, centre: Any = (0, 0, 0), axis: Any = (0, 0, 1), name: str = ""
) -> Model:
    """Returns the side of a cone, without lids: ``radius`` at its lower end, whose centre is ``centre``, and the radius
    ``top``, 0 or more, at its upper end."""
    radius, height = positive_of("radius", radius), positive_of("height", height)
    top, centre, frame = positive_of("top", top, zero=True), vector_of("centre", centre), frame_of(axis)
    return revolve(
        line(centre + radius * frame[0], centre + top * frame[0] + height * frame[2]), axis, origin=centre, name=name
    )


def revolve(
    curve: Curve, axis: Any = (0, 0, 1), angle: float = 2 * math.pi, origin: Any = (0, 0, 0), name: str = ""
) -> Model:
    """Returns the surface that a curve sweeps about an axis through ``origin``, counter-clockwise as seen from the
    axis's tip: u in [0, 1] turns, by ``angle`` radians, and v is the curve's parameter (The NURBS Book, A8.1).

    >>> import tessera as ts
    >>> vase = ts.revolve(ts.Curve(3, None, [[1, 0, 0], [2, 0, 1], [0.5, 0, 2], [1, 0, 3]]))
    >>> vase[0].degree, vase[0].points.shape
    ((2, 3), (9, 4, 3))
    """
    (curve,) = _checked(curve=curve)
    frame, origin = frame_of(axis), vector_of("origin", origin)
    knots, turns, weights = turned(number_of("angle", angle))
    foot = origin + ((curve.points - origin) @ frame[2])[:, None] * frame[2]
    arm = curve.points - foot
    points = foot + turns[:, :1, None] * arm + turns[:, 1:, None] * np.cross(frame[2], arm)
    own = np.ones(len(arm)) if curve.weights is None else curve.weights
    return model(Spline(points, (2, curve.degree), (knots, curve.knots), weights[:, None] * own, name))


def extrude(curve: Curve, vector: Any, name: str = "") -> Model:
    """Returns the surface that a curve sweeps along a vector: u is the curve's parameter, v in [0, 1]."""
    (curve,), vector = _checked(curve=curve), vector_of("vector", vector)
    if not vector.any():
        raise ArgumentError("vector is 0, expected a direction and its length")
    weights = None if curve.weights is None else np.stack([curve.weights] * 2, axis=1)
    points = np.stack([curve.points, curve.points + vector], axis=1)
    return model(Spline(points, (curve.degree, 1), (curve.knots, [0, 0, 1, 1]), weights, name))


def ruled(first: Curve, second: Curve, name: str = "") -> Model:
    """Returns the straight segments between two curves: u is the first curve's parameter, to whose domain the second
    is brought, and v in [0, 1] runs from the first to the second."""
    first, second = _checked(first=first, second=second)
    return _parsed("ruled", name, first=first, second=second.over(*first.domain))


def coons(c1: Curve, c2: Curve, d1: Curve, d2: Curve, *, blend: str = "linear", name: str = "") -> Model:
    """Returns the Coons patch of four borders: ``c1`` = r(u, v0) and ``c2`` = r(u, v1), ``d1`` = r(u0, v) and
    ``d2`` = r(u1, v).

    The domain is that of ``c1`` and of ``d1``, to which ``c2`` and ``d2`` are brought. ``blend``: "linear", or "cubic"
    for the partially bicubic patch. The borders must meet at the corners, within 1e-9 of their size; otherwise
    ArgumentError names the corner and the gap.
    """
    c1, c2, d1, d2 = _checked(c1=c1, c2=c2, d1=d1, d2=d2)
    if blend not in ("linear", "cubic"):
        raise ArgumentError(f"blend: expected 'linear' or 'cubic', found {blend!r}")
    curves = {"c1": c1, "c2": c2.over(*c1.domain), "d1": d1, "d2": d2.over(*d1.domain)}
    return _parsed("coons", name, {"f": blend, "g": blend}, **curves)


def _parsed(kind: str, name: str, more: dict[str, Any] | None = None, **curves: Curve) -> Model:
    """Makes a surface of curves by the library, which converts it exactly."""
    surface: dict[str, Any] = {"kind": kind, **(more or {})}
    if name:
        surface["name"] = name
    for key, curve in curves.items():
        made = {"kind": "b_spline" if curve.weights is None else "nurbs", "degree": curve.degree}
        made.update(knots=curve.knots.tolist(), points=curve.points.tolist())
        if curve.weights is not None:
            made["weights"] = curve.weights.tolist()
        surface[key] = made
    try:
        return parse(json.dumps({"format": "tessera", "version": 1, "surfaces": [surface]}), kind)
    except ArgumentError as error:  # without the place in the text, which the caller has not seen
        message = error.message.replace(f"{kind}:1: /surfaces/0", kind, 1)
        raise ArgumentError(message, error.code) from None


def interpolate(
    points: Any, degree: int | tuple[int, int] = 3, u: Any = None, v: Any = None, name: str = ""
) -> Model:
    """Returns the B-spline surface through a grid of points (m, n, 3), which is bicubic by default.

    ``u`` (m,), ``v`` (n,): the parameters of the rows and of the columns, increasing; by default in [0, 1], by the mean
    of the chords' lengths. Knots are means of parameters (The NURBS Book, A9.4 and equation 9.8). Where there are few
    points the degree is lower: m - 1, n - 1.

    >>> import numpy as np, tessera as ts
    >>> x, y = np.meshgrid(np.linspace(0, 3, 20), np.linspace(0, 2, 15), indexing="ij")
    >>> hills = ts.interpolate(np.stack([x, y, np.sin(x) * y], axis=-1))
    >>> hills[0].degree, hills[0].points.shape
    ((3, 3), (20, 15, 3))
    """
    points = finite_of("points", points)
    if points.ndim != 3 or points.shape[2] != 3 or min(points.shape) < 2:
        raise ArgumentError(f"points: expected shape (m, n, 3) with m and n of 2 or more, found {points.shape}")
    wanted = degree if np.ndim(degree) else (degree, degree)
    degrees, knots, net = [], [], points
    for axis, given in enumerate((u, v)):
        rows = np.moveaxis(points, axis, 0)
        p = min(integer_of("degree", wanted[axis], 1, MAX_DEGREE), len(rows) - 1)  # type: ignore[index]
        at = _parameters("uv"[axis], rows, given)
        inner = [at[j : j + p].mean() for j in range(1, len(at) - p)]
        knots.append(np.concatenate([np.repeat(at[0], p + 1), inner, np.repeat(at[-1], p + 1)]))
        degrees.append(p)
        net = np.moveaxis(interpolated(knots[axis], p, at, np.moveaxis(net, axis, 0)), 0, axis)
    return model(Spline(net, (degrees[0], degrees[1]), (knots[0], knots[1]), None, name))


def _parameters(name: str, rows: np.ndarray, given: Any) -> np.ndarray:
    """Returns the parameters of rows [row][point][3]."""
    if given is not None:
        at = finite_of(name, given)
        if at.shape != rows.shape[:1]:
            raise ArgumentError(f"{name}: expected shape {rows.shape[:1]}, found {at.shape}")
        if not (np.diff(at) > 0).all():
            raise ArgumentError(f"{name}: expected increasing parameters")
        return at
    chords = np.linalg.norm(np.diff(rows, axis=0), axis=2)
    lengths = chords.sum(axis=0)
    if not lengths.any():
        raise ArgumentError(f"points: all points along {name} are equal, expected a surface")
    shares = (chords[:, lengths > 0] / lengths[lengths > 0]).mean(axis=1)
    if not (shares > 0).all():
        row = int(np.argmin(shares > 0))
        raise ArgumentError(f"points: {row} and {row + 1} along {name} are equal, expected different ones")
    at = np.concatenate([[0.0], np.cumsum(shares)])
    at[-1] = 1.0
    return at
