"""Models of files, of text and of arrays."""

from __future__ import annotations

import ctypes
import os
from typing import IO, Any, Union

import numpy as np

from ._arrays import address_of, array_of, pair_of
from ._calls import call, run
from ._library import library, struct
from ._nets import MAX_DEGREE
from .errors import ArgumentError, ArgumentTypeError, FileError
from .live import ModelFile
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


STEP_READERS = ("tessera", "opencascade", "either")
Bytes = Union[bytes, bytearray, memoryview]


def read(
    source: str | os.PathLike[str] | Bytes | IO[bytes],
    format: str | None = None,
    step_reader: str | None = None,
) -> Model:
    """Reads a file, its bytes, or a file that is open for reading bytes: .json, .step, .iges, .brep, .g2, .obj, .rib,
    .bpt, .bv, which may be packed by gzip.

    ``format``: the extension that decides, "step"; if None that of the name, which bytes have not. ``step_reader``: who
    reads STEP files, "tessera", "opencascade" (the program tessera-cad-reader) or "either" (the program where Tessera
    fails or warns).

    >>> import tessera as ts
    >>> with open(goblet, "rb") as file:
    ...     ts.read(file.read(), format="json")
    <Model 1 surface: 'goblet'>
    """
    options = (format, step_reader)
    if isinstance(source, (bytes, bytearray, memoryview)):
        return _read_bytes("bytes", bytes(source), options)
    if not isinstance(source, (str, os.PathLike)):
        return _read_stream(source, options)
    name = os.path.abspath(os.fspath(source))
    try:
        stamp = _stamp(name)
    except OSError:
        stamp = (0, 0)  # the library says what is wrong
    handle, given = ctypes.c_void_p(), _read_options(*options)
    run(library.tsr_model_read_file, ctypes.byref(handle), os.fsencode(name), ctypes.byref(given), makes=handle)
    return Model(
        handle,
        lambda: (_read_bytes, (name, _unchanged(name, stamp), options)),
        file=lambda: ModelFile(os.path.basename(name), _unchanged(name, stamp), format),
    )


def _read_stream(source: Any, options: tuple[str | None, str | None]) -> Model:
    if not hasattr(source, "read"):
        raise ArgumentTypeError(f"source: expected a path, bytes or a file, found {type(source).__name__}")
    content = source.read()
    if not isinstance(content, (bytes, bytearray, memoryview)):
        raise ArgumentTypeError(f'source: expected a file of bytes (mode "rb"), read() returned {type(content).__name__}')
    name = getattr(source, "name", None)
    return _read_bytes(name if isinstance(name, str) else "bytes", bytes(content), options)


def _read_options(format: str | None, step_reader: str | None) -> ctypes.Structure:
    options = struct("tsr_read_options")
    library.tsr_read_defaults(ctypes.byref(options))
    if format is not None:
        options.format = format.encode()
    if step_reader is not None:
        if step_reader not in STEP_READERS:
            raise ArgumentError(f"step_reader: expected one of {', '.join(STEP_READERS)}, found {step_reader!r}")
        options.step_reader = STEP_READERS.index(step_reader)
    return options


def _stamp(path: str) -> tuple[int, int]:
    found = os.stat(path)
    return found.st_mtime_ns, found.st_size


def _unchanged(path: str, stamp: tuple[int, int]) -> bytes:
    """Returns the bytes of a file that a model was read from."""
    if _stamp(path) != stamp:
        raise FileError(f"{path} changed since it was read, so its model cannot be pickled", "io_error")
    with open(path, "rb") as file:
        return file.read()


def _read_bytes(name: str, content: bytes, options: tuple[str | None, str | None]) -> Model:
    """Reads the bytes of a file, which may lie there no longer. The model keeps them, for pickle."""
    handle, given = ctypes.c_void_p(), _read_options(*options)
    run(
        library.tsr_model_read_bytes,
        ctypes.byref(handle),
        content,
        len(content),
        os.fsencode(name),
        ctypes.byref(given),
        makes=handle,
    )
    return Model(
        handle,
        lambda: (_read_bytes, (name, content, options)),
        file=lambda: ModelFile(os.path.basename(name), content, options[0]),
    )


def parse(text: str, name: str = "text") -> Model:
    """Reads the text of a JSON file, which has surfaces of every kind; ``name`` stands for the file in messages."""
    handle, content = ctypes.c_void_p(), text.encode()
    call(library.tsr_model_parse, ctypes.byref(handle), content, len(content), os.fsencode(name))
    return Model(handle, lambda: (parse, (text, name)), file=lambda: ModelFile(name, content, "json"))


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
