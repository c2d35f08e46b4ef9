"""Models: the surfaces of a file or of arrays, with names, shapes and instances."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ._arrays import address_of, array_of, index_of, pair_of
from ._calls import Handle, call, run
from ._library import library, struct
from .errors import ArgumentError, ArgumentTypeError, FileError
from .jets import Jets, evaluate_surface
from .patches import PatchSet

if TYPE_CHECKING:
    from .assemblies import Assembly

MAX_DEGREE = 15
_UNIT, _WARNING, _SURFACE, _KIND, _SHAPE, _INSTANCE = range(6)


@dataclass(frozen=True)
class Spline:
    """A spline surface: ``points`` (nu, nv, 3), ``degree`` an integer or one per direction, ``knots`` one array per
    direction, ``weights`` (nu, nv). Without knots it is a Bezier patch; without weights it is polynomial."""

    points: Any
    degree: int | tuple[int, int] | None = None
    knots: tuple[Any, Any] | None = None
    weights: Any = None
    name: str = ""


@dataclass(frozen=True)
class Instance:
    """A shape at its place: ``placement`` (4, 4) maps the shape into the model; ``colour`` is sRGB and alpha."""

    shape: int
    name: str
    placement: np.ndarray
    colour: tuple[float, float, float, float] | None
    first_surface: int


class Surface:
    """A surface of a model."""

    def __init__(self, model: Model, index: int) -> None:
        self.model, self.index = model, index
        info = struct("tsr_surface_info")
        call(library.tsr_model_surface, model._handle, index, ctypes.byref(info))
        self.domain: np.ndarray = np.array(info.domain).reshape(2, 2)  # [[u0, u1], [v0, v1]]
        self.loops: int = info.loops

    @property
    def name(self) -> str:
        return self.model._text(_SURFACE, self.index)

    @property
    def kind(self) -> str:
        return self.model._text(_KIND, self.index)

    def evaluate(
        self, u: Any, v: Any, derivatives: int = 0, quantities: Sequence[str] | None = None, out: Jets | None = None
    ) -> Jets:
        """Evaluates at the parameters ``u``, ``v``, which are broadcast, in double. Loops do not count.

        ``derivatives``: 0 (positions), 1 (and du, dv, normals) or 2 (and second derivatives and curvatures);
        ``quantities`` names them one by one instead. ``out``: the result of an earlier call, to write to again.

        >>> import numpy as np, tessera as ts
        >>> bowl = ts.read(goblet)["goblet"]
        >>> jets = bowl.evaluate(np.linspace(*bowl.domain[0], 5)[:, None], [0.25, 0.5, 0.75], derivatives=2)
        >>> jets.position.shape, jets.gaussian.shape
        ((5, 3, 3), (5, 3))
        """
        return evaluate_surface(self.model._points(), len(self.model), self.index, u, v, derivatives, quantities, out)

    def __repr__(self) -> str:
        (u0, u1), (v0, v1) = self.domain
        loops = f", {self.loops} loop{'s' * (self.loops != 1)}" if self.loops else ""
        return f"<Surface {self.name!r}, {self.kind} on [{u0:g}, {u1:g}] x [{v0:g}, {v1:g}]{loops}>"


class Model(Handle):
    """Surfaces, in the order of their file. ``model["name"]`` and ``model[index]`` return one.

    >>> import tessera as ts
    >>> ts.read(goblet)
    <Model 1 surface: 'goblet'>
    """

    _kind = "model"

    def __init__(self, source: tuple[Any, ...]) -> None:
        self._source = source
        self._point_set: ctypes.c_void_p | None = None
        handle = ctypes.c_void_p()
        _make(handle, source)
        self._handle = handle
        self._info()

    def _text(self, kind: int, index: int) -> str:
        text = library.tsr_model_text(self._handle, kind, index)
        return "" if text is None else text.decode(errors="surrogateescape")

    def _points(self) -> PatchSet:
        if self._point_set is None:
            self._point_set = PatchSet(self, points=True, whole=True)
        return self._point_set

    def close(self) -> None:
        point_set, self._point_set = self._point_set, None
        if point_set is not None:
            point_set.close()
        super().close()

    @property
    def names(self) -> list[str]:
        """The names of the surfaces; "" where there is none."""
        return [self._text(_SURFACE, k) for k in range(len(self))]

    @property
    def unit(self) -> str:
        """The unit of all lengths, "mm"; "" if none is stated."""
        return self._text(_UNIT, 0)

    @property
    def warnings(self) -> list[str]:
        """One sentence for each part of the file that is skipped."""
        return [self._text(_WARNING, k) for k in range(self._info().warnings)]

    @property
    def shapes(self) -> list[str]:
        """The names of the shapes."""
        return [self._text(_SHAPE, k) for k in range(self._info().shapes)]

    @property
    def instances(self) -> list[Instance]:
        """The shapes at their places."""
        return [self._instance(k) for k in range(self._info().instances)]

    def _instance(self, index: int) -> Instance:
        info = struct("tsr_instance_info")
        call(library.tsr_model_instance, self._handle, index, ctypes.byref(info))
        placement = np.eye(4)
        placement[:3, :] = np.array(info.placement).reshape(4, 3).T
        colour = tuple(info.colour) if info.has_colour else None
        return Instance(info.shape, self._text(_INSTANCE, index), placement, colour, info.first_surface)

    def __len__(self) -> int:
        return self._info().surfaces

    def __getitem__(self, key: int | str) -> Surface:
        if isinstance(key, str):
            names = self.names
            if key not in names:
                raise KeyError(f"no surface is named {key!r}; there {_listed(names)}")
            return Surface(self, names.index(key))
        return Surface(self, index_of("surface", key, len(self)))

    def __iter__(self) -> Iterator[Surface]:
        return (Surface(self, k) for k in range(len(self)))

    def join(self, distance: float = 0.0) -> Model:
        """Returns a model whose faces share edges where these run side by side within ``distance``; 0: as suits."""
        return Model(("join", self, distance))

    def patches(
        self,
        shape: int | str | None = None,
        whole: bool = False,
        fit_tolerance: float | None = None,
        double: bool = False,
    ) -> PatchSet:
        """Returns the Bezier patches of all surfaces, or of one shape, in its own space.

        ``whole``: trimming loops do not count. ``fit_tolerance``: a length, for surfaces that have no exact patches;
        1e-6 of the size by default. ``double``: for grids in double.
        """
        if isinstance(shape, str):
            if shape not in self.shapes:
                raise KeyError(f"no shape is named {shape!r}; there {_listed(self.shapes)}")
            shape = self.shapes.index(shape)
        return PatchSet(self, shape=shape, whole=whole, fit_tolerance=fit_tolerance, double=double)

    def tessellate(self, tolerance: float | None = None, **options: Any) -> Assembly:
        """Returns a mesh of each shape, at all its places, or of all surfaces if there are no shapes. The options are
        those of PatchSet.tessellate()."""
        from .assemblies import Assembly

        return Assembly(self, tolerance, **options)

    def save(self, path: str | os.PathLike[str], **options: Any) -> None:
        """Writes the surfaces (.json, .obj, .bpt); with options, such as a tolerance, their meshes (.glb, .ply)."""
        if options:
            self.tessellate(**options).save(path)
        else:
            call(library.tsr_model_save, self._handle, os.fsencode(path))

    def __repr__(self) -> str:
        info = self._info()
        parts = [_counted(info.surfaces, "surface")]
        parts += [_counted(info.shapes, "shape")] * (info.shapes > 0)
        parts += [_counted(info.instances, "instance")] * (info.instances > 0)
        parts += [f"{info.trimmed} trimmed"] * (info.trimmed > 0)
        names = [name for name in (self._text(_SURFACE, k) for k in range(min(info.surfaces, 5))) if name]
        shown = ": " + _shown(names, info.surfaces - len(names)) if names else ""
        return f"<Model {', '.join(parts)}{shown}>"

    def _repr_html_(self) -> str:
        return self.patches()._repr_html_()

    def __reduce__(self) -> tuple[Any, ...]:
        source = self._source
        if source[0] == "read":
            source = ("bytes", source[1], _unchanged(*source[1:]))
        return Model, (source,)


def _counted(count: int, noun: str) -> str:
    return f"{count:,} {noun}{'s' * (count != 1)}"


def _shown(names: list[str], more: int = 0) -> str:
    more += max(len(names) - 5, 0)
    return ", ".join(map(repr, names[:5])) + (f" and {more:,} more" if more > 0 else "")


def _listed(names: list[str]) -> str:
    named = list(filter(None, names))
    return f"{'is' if len(named) == 1 else 'are'} {_shown(named)}" if named else "are no names"


def _unchanged(path: str, stamp: tuple[int, int]) -> bytes:
    """Returns the bytes of a file that a model was read from."""
    found = os.stat(path)
    if (found.st_mtime_ns, found.st_size) != stamp:
        raise FileError(f"{path} changed since it was read, so its model cannot be pickled", "io_error")
    with open(path, "rb") as file:
        return file.read()


def _make(handle: ctypes.c_void_p, source: tuple[Any, ...]) -> None:
    """Makes the model of a source: where it is read from, or what it is made of."""
    kind, *rest = source
    to = ctypes.byref(handle)
    if kind == "read":
        run(library.tsr_model_read, to, os.fsencode(rest[0]), makes=handle)
    elif kind == "bytes":
        import tempfile  # as long to import as half of this package

        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, os.path.basename(rest[0]))
            with open(path, "wb") as file:
                file.write(rest[1])
            run(library.tsr_model_read, to, os.fsencode(path), makes=handle)
    elif kind == "parse":
        text = rest[0].encode()
        call(library.tsr_model_parse, to, text, len(text), os.fsencode(rest[1]))
    elif kind == "join":
        call(library.tsr_model_join, to, rest[0]._handle, rest[1])
    else:
        _make_splines(to, rest[0])


def _make_splines(to: Any, splines: Sequence[Spline]) -> None:
    kept: list[Any] = []  # the memory that the structs point to
    made = (type(struct("tsr_bspline")) * len(splines))()
    for index, spline in enumerate(splines):
        _fill(made[index], spline, kept)
    call(library.tsr_model_new, to, made, len(splines))


def _packed(name: str, value: Any, kept: list[Any]) -> np.ndarray:
    array = np.ascontiguousarray(array_of(name, value))
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
        knots_u, knots_v = (_packed(f"knots[{k}]", spline.knots[k], kept) for k in range(2))
        if knots_u.ndim != 1 or knots_v.ndim != 1:
            raise ArgumentError(f"knots: expected two lists of numbers, found {knots_u.shape} and {knots_v.shape}")
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
        found = os.stat(name)
        stamp = (found.st_mtime_ns, found.st_size)
    except OSError:
        stamp = (0, 0)  # the library says what is wrong
    return Model(("read", name, stamp))


def parse(text: str, name: str = "text") -> Model:
    """Reads the text of a JSON file, which has surfaces of every kind; ``name`` stands for the file in messages."""
    return Model(("parse", text, name))


def model(*splines: Spline) -> Model:
    """Makes a model of spline surfaces."""
    return Model(("splines", splines))


def bezier(points: Any, weights: Any = None, name: str = "") -> Model:
    """Makes a model of a Bezier patch, ``points`` (nu, nv, 3), or of many, (patches, nu, nv, 3).

    >>> import tessera as ts
    >>> ts.bezier([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 1]]], name="saddle").patches()
    <PatchSet 1 patch, 1 surface, size 1.73>
    """
    points = np.array(array_of("points", points))
    weights = None if weights is None else np.array(array_of("weights", weights))
    if points.ndim != 4:
        return model(Spline(points, weights=weights, name=name))
    if weights is not None and weights.shape != points.shape[:3]:
        raise ArgumentError(f"weights: expected shape {points.shape[:3]}, found {weights.shape}")
    return model(
        *(Spline(points[k], weights=None if weights is None else weights[k], name=name) for k in range(len(points)))
    )


def nurbs(
    degree: int | tuple[int, int], knots: tuple[Any, Any], points: Any, weights: Any = None, name: str = ""
) -> Model:
    """Makes a model of a spline surface; see Spline.

    >>> import numpy as np, tessera as ts
    >>> knots = [0, 0, 0, 1, 2, 2, 2]
    >>> points = np.stack(np.meshgrid(range(4), range(4), [0.0], indexing="ij"), -1)[:, :, 0]
    >>> len(ts.nurbs(degree=2, knots=(knots, knots), points=points).patches())
    4
    """
    own = tuple(np.array(array_of(f"knots[{k}]", knots[k])) for k in range(2))
    weights = None if weights is None else np.array(array_of("weights", weights))
    return model(Spline(np.array(array_of("points", points)), degree, own, weights, name))
