"""Models, their patch sets, scenes and assemblies: classes that lead to each other and back."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ._arrays import index_of, positive_of
from ._calls import Handle, call, made_bytes
from ._library import library, struct
from .jets import Jets, evaluate_surface
from .live import ModelFile, WithLiveView
from .measures import Measures
from .meshes import Mesh, mesh_for_view, warn_of_rounding
from .patches import PatchSetBase
from .rays import SceneBase
from .splines import CheckedSpline, Spline
from .surfaces import SurfaceBase, spline_of_patches
from .view import Shown, view_of

_UNIT, _WARNING, _SURFACE, _KIND, _SHAPE, _INSTANCE = range(6)


@dataclass(frozen=True)
class Instance:
    """A shape at its place: ``placement`` (4, 4) maps the shape into the model; ``colour`` is sRGB and alpha."""

    shape: int
    name: str
    placement: np.ndarray
    colour: tuple[float, float, float, float] | None
    first_surface: int


class Surface(SurfaceBase, Shown):
    """A surface of a model: ``name``, ``kind``, ``domain`` [[u0, u1], [v0, v1]], ``loops``, the number of trimming
    loops, and ``degree``, ``knots``, ``points``, ``weights`` of the spline that it is, whose arrays are read-only.

    >>> import tessera as ts
    >>> bowl = ts.read(goblet)["goblet"]
    >>> bowl.degree, bowl.points.shape, bowl.is_rational
    ((2, 3), (9, 34, 3), True)
    """

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

    def _find_spline(self) -> CheckedSpline:
        made = self.model._splines
        if made is not None:
            return made[self.index].checked()
        return spline_of_patches(self.model._points(), self.index, self.name)

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

    def _view(self) -> tuple[str, bytes]:
        patches = self.model.patches()
        mesh = mesh_for_view(patches)
        of_surface = [k for k in np.unique(mesh.patches) if patches[int(k)].surface == self.index]
        faces = mesh.faces[np.isin(mesh.patches, of_surface)]
        used, numbers = np.unique(faces, return_inverse=True)
        return view_of(repr(self), mesh.vertices[used].astype(float), numbers.reshape(-1, 3), mesh.normals[used])

    def __repr__(self) -> str:
        (u0, u1), (v0, v1) = self.domain
        loops = f", {self.loops} loop{'s' * (self.loops != 1)}" if self.loops else ""
        return f"<Surface {self.name!r}, {self.kind} on [{u0:g}, {u1:g}] x [{v0:g}, {v1:g}]{loops}>"


class Model(Handle, WithLiveView):
    """Surfaces, in the order of their file. ``model["name"]`` and ``model[index]`` return one.

    >>> import tessera as ts
    >>> ts.read(goblet)
    <Model 1 surface: 'goblet'>
    """

    _kind = "model"

    def __init__(
        self,
        handle: ctypes.c_void_p,
        made_by: Callable[[], tuple[Any, ...]],
        splines: Sequence[Spline] | None = None,
        file: Callable[[], ModelFile] | None = None,
    ) -> None:
        """``made_by`` returns a function and arguments that make the model again, for pickle; ``splines`` are its
        surfaces, if it was made of them; ``file`` returns the file that it was read from, if there is one."""
        self._handle, self._made_by, self._splines, self._file = handle, made_by, splines, file
        self._point_set: PatchSet | None = None
        self._bounds: np.ndarray | None = None

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
        red, green, blue, alpha = info.colour
        colour = (red, green, blue, alpha) if info.has_colour else None
        return Instance(info.shape, self._text(_INSTANCE, index), placement, colour, info.first_surface)

    @property
    def surfaces(self) -> list[Surface]:
        """The surfaces, in the order of their file."""
        return list(self)

    @property
    def bounds(self) -> np.ndarray:
        """The box of the control points of all patches, which holds the surfaces: its lowest and its highest corner,
        (2, 3). The box of a mesh, Mesh.bounds, is tighter."""
        if self._bounds is None:
            self._bounds = self.patches().box
        return self._bounds.copy()

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
        handle = ctypes.c_void_p()
        distance = positive_of("distance", distance, zero=True)
        call(library.tsr_model_join, ctypes.byref(handle), self._handle, distance)
        return Model(handle, lambda: (Model.join, (self, distance)), file=lambda: self._readable_file().joined(distance))

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
        return Assembly(self, tolerance, **options)

    def measure(self, accuracy: float = 1e-10, max_cells: int = 4096, enclosed: bool = False) -> Measures:
        """Returns the areas, the volume, the centroid, the inertia and the tight box, each with a bound of its error.

        ``accuracy``: the error as a share, 1e-14 to 1e-2; ``max_cells``: parts of a patch. ``enclosed``: the body is
        what all surfaces enclose, which leave no gap and have normals on one side, instead of the solids of the file.
        """
        return Measures(self, accuracy, max_cells, enclosed)

    def save(self, path: str | os.PathLike[str], **options: Any) -> None:
        """Writes the surfaces (.json, .obj, .bpt); with options, such as a tolerance, their meshes (.glb, .ply)."""
        if options:
            self.tessellate(**options).save(path)
        else:
            call(library.tsr_model_save, self._handle, os.fsencode(path))

    def _cad_bytes(self) -> bytes:
        return made_bytes(library.tsr_model_cad_bytes, self._handle)

    def __repr__(self) -> str:
        info = self._info()
        parts = [_counted(info.surfaces, "surface")]
        parts += [_counted(info.shapes, "shape")] * (info.shapes > 0)
        parts += [_counted(info.instances, "instance")] * (info.instances > 0)
        parts += [f"{info.trimmed} trimmed"] * (info.trimmed > 0)
        names = [name for name in (self._text(_SURFACE, k) for k in range(min(info.surfaces, 5))) if name]
        shown = ": " + _shown(names, info.surfaces - len(names)) if names else ""
        return f"<Model {', '.join(parts)}{shown}>"

    def _view(self) -> tuple[str, bytes]:
        return self.patches()._view()

    def __reduce__(self) -> tuple[Any, ...]:
        return self._made_by()


def _counted(count: int, noun: str) -> str:
    return f"{count:,} {noun}{'s' * (count != 1)}"


def _shown(names: list[str], more: int = 0) -> str:
    more += max(len(names) - 5, 0)
    return ", ".join(map(repr, names[:5])) + (f" and {more:,} more" if more > 0 else "")


def _listed(names: list[str]) -> str:
    named = list(filter(None, names))
    return f"{'is' if len(named) == 1 else 'are'} {_shown(named)}" if named else "are no names"


class PatchSet(PatchSetBase):
    """The patches of a model or of one of its shapes. ``patches[index]`` returns one."""

    def __init__(
        self,
        model: Model,
        shape: int | None = None,
        whole: bool = False,
        points: bool = False,
        double: bool = False,
        fit_tolerance: float | None = None,
    ) -> None:
        super().__init__(model, shape, whole, points, double, fit_tolerance)
        # The set of points belongs to its model, and keeps no reference to it.
        self.model = None if points else model

    def rays(self, tolerance: float | None = None, pieces: int = 1, editable: bool = False) -> Scene:
        """Returns a scene for rays. ``editable``: prepared for refit() after edits; rays take a fifth longer."""
        return Scene(self, tolerance, pieces, editable)

    def __reduce__(self) -> tuple[Any, ...]:
        edited = sorted(self._edited)
        points = [np.array(self[k].points).reshape(-1, 3) for k in edited]
        return _unpickled, (self.model, self._options, edited, points)


def _unpickled(model: Model, options: tuple[Any, ...], edited: list[int], points: list[np.ndarray]) -> PatchSet:
    patches = PatchSet(model, *options)
    if edited:
        patches.edit(edited, np.concatenate(points))
    return patches


class Scene(SceneBase, Shown):
    """Patches prepared for rays: origin + t * direction. Directions need no unit length. Arrays of shape (..., 3)
    broadcast, and so do ``tnear`` (0), ``tfar`` (infinity) and ``spawn_offset``: how far from the origin surfaces do
    not count.

    >>> import numpy as np, tessera as ts
    >>> scene = ts.read(goblet).patches().rays()
    >>> hits = scene.closest(origins=[0, -100, 1], directions=[0, 1, 0])
    >>> bool(hits.is_hit), bool(hits.certified), hits.position.shape
    (True, True, (3,))
    """

    def __init__(self, patches: PatchSet, tolerance: float | None, pieces: int, editable: bool) -> None:
        super().__init__(patches, tolerance, pieces, editable)
        self.patches = patches

    def __repr__(self) -> str:
        return f"<Scene of {self.patches!r}, {self._info().memory_bytes / 2**20:.1f} MiB>"

    def _view(self) -> tuple[str, bytes]:
        return mesh_for_view(self.patches)._view_as(repr(self))

    def __reduce__(self) -> tuple[Any, ...]:
        return Scene, (self.patches, *self._options)


class Assembly(Shown):
    """A mesh per shape and the places of the shapes; of a model without shapes one mesh, and no places.

    >>> import tessera as ts
    >>> ts.read(goblet).tessellate(tolerance=1e-2).meshes[0].is_certified
    True
    """

    def __init__(self, model: Model, tolerance: float | None = None, **options: Any) -> None:
        self.model = model
        shapes: list[int | None] = list(range(len(model.shapes)))
        self.meshes: list[Mesh] = [
            model.patches(shape).tessellate(tolerance, **options) for shape in (shapes or [None])
        ]
        self.instances: list[Instance] = model.instances if shapes else []

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes .obj, .ply, .stl, .glb or .gltf, with names and colours."""
        if not self.instances:
            self.meshes[0].save(path)
            return
        count = len(self.meshes)
        structs = [mesh._struct() for mesh in self.meshes]
        pointers = (ctypes.c_void_p * count)(*(ctypes.addressof(each) for each in structs))
        sets = (ctypes.c_void_p * count)(*(mesh._set._handle for mesh in self.meshes if mesh._set is not None))
        call(library.tsr_model_save_meshes, self.model._handle, pointers, sets, count, os.fsencode(path))
        if os.fsdecode(path).lower().endswith(".stl"):
            warn_of_rounding(path, 2.0**-23 * self._largest(), min(mesh._tolerance for mesh in self.meshes))

    def _largest(self) -> float:
        """Returns the largest coordinate of all places."""
        largest = 0.0
        for instance in self.instances:
            placed = instance.placement
            positions = self.meshes[instance.shape].positions()
            if len(positions):
                largest = max(largest, np.abs(positions @ placed[:3, :3].T + placed[:3, 3]).max())
        return largest

    def _view(self) -> tuple[str, bytes]:
        vertices, faces, normals = [], [], []
        first = 0
        for shape, placed in [(each.shape, each.placement) for each in self.instances] or [(0, np.eye(4))]:
            mesh, turn = self.meshes[shape], placed[:3, :3]
            positions, corners = mesh.positions() @ turn.T + placed[:3, 3], mesh.triangles()
            vertices.append(positions)
            faces.append(first + (corners if np.linalg.det(turn) > 0 else corners[:, ::-1]))
            if mesh.has_normals:
                of_shape = mesh.normals @ np.linalg.inv(turn)
                normals.append(of_shape / np.maximum(np.linalg.norm(of_shape, axis=1, keepdims=True), 1e-30))
            first += len(positions)
        shading = np.concatenate(normals) if len(normals) == len(vertices) else None
        return view_of(repr(self), np.concatenate(vertices), np.concatenate(faces), shading)

    def __repr__(self) -> str:
        triangles = sum(len(mesh.faces) for mesh in self.meshes)
        return (
            f"<Assembly {len(self.meshes):,} mesh{'es' * (len(self.meshes) != 1)}, {len(self.instances):,} "
            f"instance{'s' * (len(self.instances) != 1)}, {triangles:,} triangles>"
        )
