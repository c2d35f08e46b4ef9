"""Meshes: their arrays, what is proven of them, and files."""

from __future__ import annotations

import contextlib
import ctypes
import importlib
import os
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from ._arrays import address_of, out_view
from ._calls import Handle, Progress, call, run
from ._library import library, struct
from .errors import ArgumentError, MissingError, StateError
from .plans import Plan, View, fill_view, is_double
from .view import MAX_TRIANGLES, Shown, view_of

_VIEWED = 5e-4  # of the size: less than a pixel of the view in notebooks


@dataclass(frozen=True)
class MeshReport:
    """The faults of a mesh, counted. Closed bodies have no open edges; no mesh of Tessera has T-junctions."""

    vertices: int
    distinct_positions: int
    triangles: int
    quads: int
    open_edges: int
    non_manifold_edges: int
    inconsistent_edges: int
    t_junctions: int
    flipped_triangles: int
    degenerate_triangles: int
    non_finite_vertices: int


class Mesh(Shown):
    """A mesh, made by PatchSet.tessellate(); Mesh() is empty. Its arrays are views of memory that it may write again.

    - ``vertices`` (n, 3): float32, relative to ``origin``; or float64, in the model
    - ``normals`` (n, 3): float32, unit; MissingError if vertices are shared across creases: ``has_normals`` is False
    - ``uv`` (n, 2): float32, parameters of the surface, or as ``uv`` of tessellate() says; MissingError if vertices are
      shared without them: ``has_uv`` is False
    - ``faces`` (m, 3), ``patches`` (m,): uint32, vertices counter-clockwise, and the patch of each triangle
    - ``quads`` (q, 4), ``quad_patches`` (q,): uint32
    - ``bound``: the proven distance between surfaces and mesh; ``gap``: how far faces fail to meet at edges of the
      model; ``angle``, ``pixels``: proven, 0 if not wanted; ``open_edges``: edges of one triangle

    >>> import tessera as ts
    >>> mesh = ts.read(goblet).patches().tessellate(rates=8)
    >>> mesh
    <Mesh 3,564 vertices, 5,568 triangles, unproven>
    """

    vertices: np.ndarray
    faces: np.ndarray
    patches: np.ndarray
    quads: np.ndarray
    quad_patches: np.ndarray
    origin: np.ndarray
    bound: float
    gap: float
    angle: float
    pixels: float
    is_certified: bool
    open_edges: int

    def __init__(self) -> None:
        self._store: dict[str, np.ndarray] = {}
        self._plan: Plan | None = None
        self._set: Handle | None = None
        self._wanted: dict[str, Any] = {}
        self._tolerance = float("inf")
        self.vertices = self._float = np.zeros((0, 3), np.float32)
        self._normals: np.ndarray | None = np.zeros((0, 3), np.float32)
        self._uv: np.ndarray | None = np.zeros((0, 2), np.float32)
        self.faces, self.patches = np.zeros((0, 3), np.uint32), np.zeros(0, np.uint32)
        self.quads, self.quad_patches = np.zeros((0, 4), np.uint32), np.zeros(0, np.uint32)
        self.origin = np.zeros(3)
        self.bound, self.gap, self.angle, self.pixels = float("inf"), 0.0, 0.0, 0.0
        self.is_certified, self.open_edges = False, 0

    def _make(self, patches: Handle, wanted: dict[str, Any], progress: Progress | None) -> None:
        plan = Plan(patches, wanted, _part_of(progress, 0.0))
        self._set, self._wanted, self._plan = patches, wanted, plan
        self._write(_part_of(progress, 0.5))

    def _write(self, progress: Progress | None) -> None:
        """Describes the plan, takes memory and writes the mesh."""
        assert self._plan is not None and self._set is not None
        info = self._take(self._plan._info())
        run(
            library.tsr_plan_write,
            self._plan._handle,
            ctypes.byref(self._struct()),
            progress=progress,
            is_long=info.triangles > 50_000,
        )

    def _take(self, info: Any) -> Any:
        """Takes what is proven from a plan, and memory for its mesh."""
        assert self._set is not None
        has_double = is_double(self._wanted)
        self._float = self._records("float", info.vertices, 3, np.float32)
        self.vertices = self._records("double", info.vertices, 3, np.float64) if has_double else self._float
        self._normals = self._records("normals", info.vertices, 3, np.float32) if info.has_normals else None
        has_uv = self._wanted.get("uv") is not None or not self._wanted.get("share_vertices")
        self._uv = self._records("uv", info.vertices, 2, np.float32) if has_uv else None
        self.faces = self._records("faces", info.triangles, 3, np.uint32)
        self.patches = self._records("patches", info.triangles, 1, np.uint32)
        self.quads = self._records("quads", info.quads, 4, np.uint32)
        self.quad_patches = self._records("quad_patches", info.quads, 1, np.uint32)
        self.origin = np.zeros(3) if has_double else np.array(self._set._info().origin)
        self.bound, self.gap, self.angle, self.pixels = info.bound, info.gap, info.angle, info.pixels
        self._tolerance = info.tolerance
        self.is_certified, self.open_edges = bool(info.is_certified), info.open_edges
        return info

    def _records(self, name: str, count: int, components: int, dtype: Any) -> np.ndarray:
        kept = self._store.get(name)
        if kept is None or len(kept) < count:
            kept = np.empty(count if components == 1 else (count, components), dtype)
            self._store[name] = kept
        return kept[:count]

    def _struct(self) -> Any:
        """Returns the tsr_mesh of the arrays."""
        mesh = struct("tsr_mesh")
        mesh.position = in_out(self._float)
        if self._normals is not None:
            mesh.normal = in_out(self._normals)
        if self._uv is not None:
            mesh.parameter = in_out(self._uv)
        if self.vertices is not self._float:
            mesh.position_f64 = in_out(self.vertices)
        mesh.triangles, mesh.triangle_patches = address_of(self.faces), address_of(self.patches)
        mesh.triangle_count = len(self.faces)
        if len(self.quads):
            mesh.quads, mesh.quad_patches = address_of(self.quads), address_of(self.quad_patches)
            mesh.quad_count = len(self.quads)
        return mesh

    def update(self, progress: Progress | None = None, *, view: View | None = None) -> bool:
        """Follows edits of the patches, and a ``view`` in the place of the one before: proves the limits again and
        moves the vertices. Returns whether the mesh has other triangles now; then its arrays are new views."""
        if self._set is None:
            raise StateError("the mesh was not made of patches", "stale")
        if view is not None:
            self._wanted = {**self._wanted, "view": view}
        if self._plan is None:  # a mesh that was pickled
            self._make(self._set, self._wanted, progress)
            return True
        if view is not None:
            options = struct("tsr_plan_options")
            library.tsr_plan_defaults(ctypes.byref(options))
            fill_view(options, view)
            call(library.tsr_plan_set_view, self._plan._handle, ctypes.byref(options))
        topology = ctypes.c_int32()
        run(
            library.tsr_plan_update,
            self._plan._handle,
            None,
            0,
            None,
            0,
            ctypes.byref(self._struct()),
            ctypes.byref(topology),
            progress=progress,
        )
        if topology.value:
            self._write(progress)
        else:
            self._take(self._plan._info())
        return bool(topology.value)

    def check(self) -> MeshReport:
        """Counts the faults of the mesh."""
        report = struct("tsr_mesh_report")
        call(library.tsr_mesh_check, ctypes.byref(self._struct()), ctypes.byref(report))
        return MeshReport(**{name: getattr(report, name) for name in MeshReport.__dataclass_fields__})

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes .obj, .ply, .stl, .glb or .gltf, with names and colours of the surfaces. Warns if the numbers of the
        file are too coarse for the tolerance: see rounding()."""
        of = None if self._set is None else self._set._handle
        call(library.tsr_mesh_save, ctypes.byref(self._struct()), of, os.fsencode(path))
        warn_of_rounding(path, self.rounding(path), self._tolerance)

    def rounding(self, path: str | os.PathLike[str]) -> float:
        """Returns how far a file with the extension of ``path`` may move vertices, since .stl holds floats in the
        model's coordinates, and .ply and .obj may. The mesh of the file keeps ``bound`` plus this."""
        of = None if self._set is None else self._set._handle
        found = ctypes.c_double()
        call(library.tsr_mesh_rounding, ctypes.byref(self._struct()), of, os.fsencode(path), ctypes.byref(found))
        return found.value

    def positions(self) -> np.ndarray:
        """Returns the vertices in the model, in double."""
        return self.vertices + self.origin

    def triangles(self) -> np.ndarray:
        """Returns the faces and both triangles of each quad, (m, 3)."""
        if not len(self.quads):
            return self.faces
        return np.concatenate([self.faces, self.quads[:, [0, 1, 2]], self.quads[:, [0, 2, 3]]])

    @property
    def normals(self) -> np.ndarray:
        """Unit normals, (n, 3)."""
        if self._normals is None:
            raise MissingError("the mesh has no normals: its vertices are shared, and no crease_angle was given")
        return self._normals

    @property
    def uv(self) -> np.ndarray:
        """Parameters, (n, 2)."""
        if self._uv is None:
            raise MissingError("the mesh has no uv: its vertices are shared, and no uv was asked for")
        return self._uv

    @property
    def has_normals(self) -> bool:
        return self._normals is not None

    @property
    def has_uv(self) -> bool:
        return self._uv is not None

    @property
    def bounds(self) -> np.ndarray:
        """The box of the vertices in the model: its lowest and its highest corner, (2, 3). Errors: StateError if there
        are none."""
        if not len(self.vertices):
            raise StateError("the mesh has no vertices, so it has no bounds", "invalid_argument")
        return np.array([self.vertices.min(axis=0), self.vertices.max(axis=0)], np.float64) + self.origin

    @property
    def is_closed(self) -> bool:
        """Whether there are triangles, and each of their edges belongs to two."""
        return bool(len(self.faces) or len(self.quads)) and self.open_edges == 0

    def to_trimesh(self) -> Any:
        """Returns a trimesh.Trimesh in the model's coordinates. Errors: ImportError without the package trimesh."""
        trimesh = _imported("trimesh")
        return trimesh.Trimesh(self.positions(), self.triangles(), vertex_normals=self._normals, process=False)

    def to_pyvista(self) -> Any:
        """Returns a pyvista.PolyData in the model's coordinates. Errors: ImportError without the package pyvista."""
        pyvista = _imported("pyvista")
        mesh = pyvista.PolyData.from_regular_faces(self.positions(), self.triangles().astype(np.int64))
        if self._normals is not None:
            mesh.point_data["Normals"] = self._normals
        return mesh

    def to_meshio(self) -> Any:
        """Returns a meshio.Mesh in the model's coordinates, with triangles and quads, "normals" and "uv" of the points
        where there are any, and the "patch" of each cell. Errors: ImportError without the package meshio."""
        meshio = _imported("meshio")
        cells, patches = [("triangle", self.faces.astype(np.int64))], [self.patches.astype(np.int64)]
        if len(self.quads):
            cells.append(("quad", self.quads.astype(np.int64)))
            patches.append(self.quad_patches.astype(np.int64))
        arrays = {"normals": self._normals, "uv": self._uv}
        data = {name: np.array(array) for name, array in arrays.items() if array is not None}
        return meshio.Mesh(self.positions(), cells, point_data=data, cell_data={"patch": patches})

    @property
    def nbytes(self) -> int:
        """The bytes that were written."""
        arrays = (self._float, self._normals, self._uv, self.faces, self.patches, self.quads, self.quad_patches)
        double = self.vertices.nbytes if self.vertices is not self._float else 0
        return double + sum(array.nbytes for array in arrays if array is not None)

    def __repr__(self) -> str:
        quads = f", {len(self.quads):,} quads" if len(self.quads) else ""
        distance = self.bound + self.gap
        parts = [f"proven within {distance:.3g}"] if self.is_certified and np.isfinite(distance) else []
        parts += [f"normals within {self.angle:.3g} rad"] * (self.angle > 0)
        parts += [f"within {self.pixels:.3g} pixels"] * (self.pixels > 0)
        proven = ", ".join(parts) if self.is_certified else "unproven"
        triangles = f"{len(self.faces):,} triangle{'s' * (len(self.faces) != 1)}"
        return f"<Mesh {len(self.vertices):,} vertices, {triangles}{quads}, {proven}>"

    def _view_as(self, name: str, note: str = "") -> tuple[str, bytes]:
        return view_of(name, np.asarray(self.vertices, np.float64), self.triangles(), self._normals, note)

    def _view(self) -> tuple[str, bytes]:
        if len(self.triangles()) <= MAX_TRIANGLES or self._set is None:
            return self._view_as(repr(self))
        mesh = mesh_for_view(self._set)
        return mesh._view_as(repr(self), f"; shown with {len(mesh.faces):,} triangles, within {mesh.bound:.3g}")

    def __getstate__(self) -> dict[str, Any]:
        state = {name: value for name, value in self.__dict__.items() if name not in ("_plan", "_store")}
        if self.vertices is self._float:
            del state["_float"]
        return state

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state, _plan=None, _store={})
        self.__dict__.setdefault("_float", self.vertices)
        self.__dict__.setdefault("_tolerance", float("inf"))


def _part_of(progress: Progress | None, start: float) -> Progress | None:
    """Returns a function of half of the work."""
    if progress is None:
        return None
    whole = progress
    return lambda share: whole(start + share / 2)


def _imported(name: str) -> Any:
    """Imports a package that Tessera does not need."""
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        if error.name != name:
            raise
        raise ImportError(f"Mesh.to_{name}() needs the package {name}: pip install {name}", name=name) from None


def mesh_for_view(patches: Handle) -> Mesh:
    """Returns a mesh that is fine enough for the view, or as fine as its triangles allow, or the coarsest of all."""
    wanted: list[dict[str, Any]] = [{"tolerance": _VIEWED, "relative": True}, {}]
    for limits in wanted:
        with contextlib.suppress(ArgumentError):  # it takes more triangles
            return _made(patches, max_triangles=MAX_TRIANGLES, **limits)
    return _made(patches, rates=1)


def _made(patches: Handle, **wanted: Any) -> Mesh:
    mesh = Mesh()
    mesh._make(patches, wanted, None)
    return mesh


def warn_of_rounding(path: str | os.PathLike[str], rounding: float, tolerance: float) -> None:
    """Warns if rounding takes more than a sixteenth of a tolerance."""
    if 16 * rounding > tolerance:
        warnings.warn(
            f"{os.fsdecode(path)}: floats of this file move vertices by up to {rounding:.3g}, because the model lies "
            f"far from zero; the tolerance is {tolerance:.3g}. A .glb keeps it, and so do .ply and .obj",
            stacklevel=3,
        )


def in_out(array: np.ndarray) -> Any:
    """Returns the tsr_out of an array of the mesh."""
    return out_view("mesh", array, array.dtype, array.shape[:1], array.shape[1])
