"""Models of files, of text and of arrays."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable
from typing import Any

import numpy as np

from ._arrays import address_of, array_of, pair_of
from ._calls import call, run
from ._library import library, struct
from ._nets import MAX_DEGREE
from .errors import ArgumentError, ArgumentTypeError, FileError
from .models import Model, Surface
from .splines import Spline, knots_pair


def _packed(name: str, value: Any, kept: list[Any]) -> np.ndarray:
    array = np.asarray(array_of(name, value), order="C")
    kept.append(array)
    return array


def _fill(to: Any, spline: Spline, kept: list[Any]) -> None:
    points = _packed("points", spline.points, kept)
    if points.ndim != 3 or points.shape[2] != 3:
        raise ArgumentError(f"points: expected shape (nu, nv, 3), found {points.shape}")
    to.struct_size = ctypes.sizeof(to)
    to.count_u, to.count_v = points.shape[:2]
    to.points = address_of(points)
    if spline.weights is not None:
        weights = _packed("weights", spline.weights, kept)
        if weights.shape != points.shape[:2]:
            raise ArgumentError(f"weights: expected shape {points.shape[:2]}, found {weights.shape}")
        to.weights = address_of(weights)
    if spline.knots is not None:
        pair = knots_pair(spline.knots)
        knots_u, knots_v = (_packed(f"knots[{k}]", pair[k], kept) for k in range(2))
        to.knots_u, to.knots_v = address_of(knots_u), address_of(knots_v)
        to.knot_count_u, to.knot_count_v = len(knots_u), len(knots_v)
    degree = spline.degree
    if degree is None and spline.knots is None:
        degree = (points.shape[0] - 1, points.shape[1] - 1)
    if degree is None:
        raise ArgumentTypeError("degree: expected one beside the knots")
    to.degree_u, to.degree_v = pair_of("degree", degree, 1, MAX_DEGREE)
    if spline.name:
        to.name = spline.name.encode()


def read(path: str | os.PathLike[str]) -> Model:
    """Reads a file: .json, .step, .iges, .brep, .g2, .obj, .rib, .bpt, .bv; the extension decides."""
    name = os.path.abspath(os.fspath(path))
    try:
        stamp = _stamp(name)
    except OSError:
        stamp = (0, 0)  # the library says what is wrong
    return _model_of(name, lambda: (_read_bytes, (name, _unchanged(name, stamp))))


def _model_of(path: str, made_by: Callable[[], tuple[Any, ...]]) -> Model:
    handle = ctypes.c_void_p()
    run(library.tsr_model_read, ctypes.byref(handle), os.fsencode(path), makes=handle)
    return Model(handle, made_by)


def _stamp(path: str) -> tuple[int, int]:
    found = os.stat(path)
    return found.st_mtime_ns, found.st_size


def _unchanged(path: str, stamp: tuple[int, int]) -> bytes:
    """Returns the bytes of a file that a model was read from."""
    if _stamp(path) != stamp:
        raise FileError(f"{path} changed since it was read, so its model cannot be pickled", "io_error")
    with open(path, "rb") as file:
        return file.read()


def _read_bytes(name: str, content: bytes) -> Model:
    """Reads the bytes of a file, which may lie there no longer."""
    import tempfile  # as long to import as half of this package

    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, os.path.basename(name))
        with open(path, "wb") as file:
            file.write(content)
        return _model_of(path, lambda: (_read_bytes, (name, content)))


def parse(text: str, name: str = "text") -> Model:
    """Reads the text of a JSON file, which has surfaces of every kind; ``name`` stands for the file in messages."""
    handle, content = ctypes.c_void_p(), text.encode()
    call(library.tsr_model_parse, ctypes.byref(handle), content, len(content), os.fsencode(name))
    return Model(handle, lambda: (parse, (text, name)))


def model(*surfaces: Spline | Surface | Model) -> Model:
    """Makes a model of spline surfaces, of surfaces of other models, and of all surfaces of models.

    >>> import tessera as ts
    >>> left, right = ts.sphere()[0].split(u=0.5)
    >>> ts.model(left, right, ts.torus(3, 1))
    <Model 3 surfaces>
    """
    return _model([spline for each in surfaces for spline in _splines_of(each)])


def _splines_of(each: Any) -> list[Spline]:
    """Returns the splines of an argument of model(), as copies."""
    if isinstance(each, Model):
        return [spline for surface in each for spline in _splines_of(surface)]
    if isinstance(each, Surface):
        if each.loops:
            raise ArgumentError(
                f"surface {each.name!r} has {each.loops} trimming loop{'s' * (each.loops != 1)}, which splines have "
                "not; take its .spline for the whole surface"
            )
        return [each.spline]
    if not isinstance(each, Spline):
        raise ArgumentTypeError(f"model: expected splines, surfaces or models, found {type(each).__name__}")
    knots = None if each.knots is None else tuple(map(np.array, knots_pair(each.knots)))
    weights = None if each.weights is None else np.array(array_of("weights", each.weights))
    return [Spline(np.array(array_of("points", each.points)), each.degree, knots, weights, each.name)]


def _model(splines: list[Spline]) -> Model:
    """Makes a model of splines whose arrays nobody changes."""
    kept: list[Any] = []  # the memory that the structs point to
    made = (type(struct("tsr_bspline")) * len(splines))()
    for index, spline in enumerate(splines):
        _fill(made[index], spline, kept)
    handle = ctypes.c_void_p()
    call(library.tsr_model_new, ctypes.byref(handle), made, len(splines))
    return Model(handle, lambda: (model, tuple(splines)), splines)


def bezier(points: Any, weights: Any = None, name: str = "") -> Model:
    """Makes a model of a Bezier patch, ``points`` (nu, nv, 3), or of many, (patches, nu, nv, 3).

    >>> import tessera as ts
    >>> ts.bezier([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 1]]], name="saddle").patches()
    <PatchSet 1 patch, 1 surface, size 1.73>
    """
    points = np.array(array_of("points", points))
    weights = None if weights is None else np.array(array_of("weights", weights))
    if points.ndim != 4:
        return _model([Spline(points, weights=weights, name=name)])
    if weights is not None and weights.shape != points.shape[:3]:
        raise ArgumentError(f"weights: expected shape {points.shape[:3]}, found {weights.shape}")
    return _model(
        [Spline(points[k], weights=None if weights is None else weights[k], name=name) for k in range(len(points))]
    )


def nurbs(
    degree: int | tuple[int, int], knots: Any, points: Any, weights: Any = None, name: str = ""
) -> Model:
    """Makes a model of a spline surface; see Spline. One list of knots holds for both directions.

    >>> import numpy as np, tessera as ts
    >>> knots = [0, 0, 0, 1, 2, 2, 2]
    >>> points = np.stack(np.meshgrid(range(4), range(4), [0.0], indexing="ij"), -1)[:, :, 0]
    >>> len(ts.nurbs(degree=2, knots=knots, points=points).patches())
    4
    """
    return model(Spline(points, degree, knots, weights, name))
