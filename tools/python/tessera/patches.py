"""Bezier patches and sets of them, for evaluation and meshes."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from ._arrays import address_of, array_of, check_out, index_of, integer_of, positive_of
from ._calls import Handle, Progress, call
from ._library import library, struct
from .errors import ArgumentError
from .jets import Jets, evaluate_grid
from .meshes import Mesh, mesh_for_view
from .plans import View
from .view import Shown

_WHOLE, _POINTS, _DOUBLE = 1, 2, 4


class Patch:
    """A Bezier patch of a set. Assign ``points`` to edit it; meshes and scenes follow by update() and refit()."""

    def __init__(self, patches: PatchSetBase, index: int) -> None:
        self._patches, self.index = patches, index
        info = self._read(None, None)
        self.degree: tuple[int, int] = (info.degree_u, info.degree_v)
        self.is_rational = bool(info.is_rational)
        self.is_cut = bool(info.is_cut)
        self.surface: int = info.surface
        self.domain: np.ndarray = np.array(info.domain).reshape(2, 2)

    def _read(self, points: np.ndarray | None, weights: np.ndarray | None) -> Any:
        info = struct("tsr_patch_info")
        call(
            library.tsr_set_patch,
            self._patches._handle,
            self.index,
            ctypes.byref(info),
            address_of(points),
            address_of(weights),
        )
        return info

    @property
    def shape(self) -> tuple[int, int]:
        return self.degree[0] + 1, self.degree[1] + 1

    @property
    def points(self) -> np.ndarray:
        """The control points (nu, nv, 3), a copy that is read-only: assign all of them to edit the patch."""
        points = np.empty((*self.shape, 3))
        self._read(points, None)
        points.flags.writeable = False
        return points

    @points.setter
    def points(self, points: Any) -> None:
        points = array_of("points", points)
        if points.shape != (*self.shape, 3):
            raise ArgumentError(f"points: expected shape {(*self.shape, 3)}, found {points.shape}")
        self._patches.edit([self.index], points)

    @property
    def weights(self) -> np.ndarray:
        """The weights (nu, nv), a copy; 1 for a polynomial patch."""
        weights = np.empty(self.shape)
        self._read(None, weights)
        return weights

    def __repr__(self) -> str:
        kind = "rational " * self.is_rational + "Bezier"
        return f"<Patch {self.index}, {kind} of degree {self.degree}, surface {self.surface}{', cut' * self.is_cut}>"


class PatchSetBase(Handle, Shown):
    """The calls of a PatchSet that need no Model."""

    _kind = "set"

    def __init__(
        self,
        model: Handle,
        shape: int | None = None,
        whole: bool = False,
        points: bool = False,
        double: bool = False,
        fit_tolerance: float | None = None,
    ) -> None:
        self._options = (shape, whole, points, double, fit_tolerance)
        self._edited: set[int] = set()
        options = struct("tsr_set_options")
        options.shape = -1 if shape is None else integer_of("shape", shape, 0, 2**63 - 1)
        options.flags = _WHOLE * bool(whole) | _POINTS * bool(points) | _DOUBLE * bool(double)
        options.fit_tolerance = 0 if fit_tolerance is None else positive_of("fit_tolerance", fit_tolerance)
        self._make(library.tsr_set_new, model._handle, ctypes.byref(options))
        self._count: int = self._info().patches

    def __len__(self) -> int:
        return self._count

    def __getitem__(self, index: int) -> Patch:
        return Patch(self, index_of("patch", index, self._count))

    def __iter__(self) -> Iterator[Patch]:
        return (Patch(self, k) for k in range(self._count))

    @property
    def box(self) -> np.ndarray:
        """The box of all control points: its lowest and its highest corner, (2, 3)."""
        info = self._info()
        return np.array([info.low, info.high])

    @property
    def origin(self) -> np.ndarray:
        """The point that positions in float are relative to: those of meshes and of grids."""
        return np.array(self._info().origin)

    @property
    def fit_error(self) -> float:
        """The largest distance of patches from surfaces that have no exact ones; 0: all are exact."""
        return self._info().fit_error

    def edit(self, indices: Any, points: Any) -> None:
        """Sets all control points of some patches: ``points`` (n, nu, nv, 3), or the points of all in one (k, 3)."""
        which = np.ascontiguousarray(array_of("indices", indices, np.uint32).reshape(-1))
        points = np.ascontiguousarray(array_of("points", points))
        if points.ndim < 2 or points.shape[-1] != 3:
            raise ArgumentError(f"points: expected shape (..., 3), found {points.shape}")
        call(library.tsr_set_edit, self._handle, address_of(which), len(which), address_of(points), points.size // 3)
        self._edited.update(which.tolist())

    def grid(
        self,
        u: Any,
        v: Any,
        derivatives: int = 0,
        quantities: Sequence[str] | None = None,
        dtype: Any = np.float32,
        out: Jets | None = None,
    ) -> Jets:
        """Evaluates all patches at ``u`` x ``v``, both in [0, 1]: arrays of shape (patches, len(u), len(v), ...).

        Derivatives are by the patch's parameters. Positions in float32 are relative to ``origin``; for float64 make
        the set with ``double=True``.

        >>> import tessera as ts
        >>> ts.read(goblet).patches().grid([0, 0.5, 1], [0, 1]).position.shape
        (44, 3, 2, 3)
        """
        return evaluate_grid(self, self._count, u, v, dtype, derivatives, quantities, out)

    def tessellate(
        self,
        tolerance: float | Sequence[float] | np.ndarray | None = None,
        *,
        relative: bool = False,
        angle: float | None = None,
        pixels: float | None = None,
        view: View | None = None,
        rates: int | tuple[int, int] | None = None,
        quads: bool = False,
        share_vertices: bool = False,
        fewest: bool = False,
        crease_angle: float | None = None,
        weld: float | None = None,
        max_gap: float | None = None,
        max_triangles: int | None = None,
        close_edges: bool = True,
        uv: str | None = None,
        headroom: float = 0,
        dtype: Any = np.float32,
        out: Mesh | None = None,
        progress: Progress | None = None,
    ) -> Mesh:
        """Returns a mesh that keeps the limits, which is proven.

        - ``tolerance``: the largest distance between surfaces and mesh, a length; with ``relative`` a share of the size;
          or one for each surface
        - ``angle``: the largest turn of the normals in a triangle, in radians, up to pi/2
        - ``pixels``: the largest distance in the picture of ``view``
        - ``rates``: segments of every patch per direction, which prove nothing
        - ``max_triangles``: an error beyond; without any other limit: as good a mesh as so many triangles make
        - ``quads``: whole cells are quads; ``share_vertices``: patches share vertices by index; ``fewest``: fewer
          triangles at a hundred times the time; ``weld``, ``crease_angle``, ``max_gap``, ``close_edges``: how patches
          and faces meet
        - ``uv``: "surface" (default), "unit" or "patch": parameters of the surface, as shares of its domain, or of the
          patch; with ``share_vertices`` none by default, and with "surface" or "unit" vertices are apart across seams
        - ``headroom``: the part of the limits left for Mesh.update(), 0 to 0.9, so that it rarely changes triangles
        - ``dtype=np.float64``: vertices in double, in the model
        - ``out``: an earlier mesh, to write into the same memory if it is large enough
        - ``progress``: called with a share from 0 to 1; an exception in it ends the call

        >>> import tessera as ts
        >>> mesh = ts.read(goblet).patches().tessellate(tolerance=1e-2)
        >>> mesh.is_certified and mesh.bound <= 1e-2, mesh.faces.dtype, mesh.vertices.shape[1]
        (True, dtype('uint32'), 3)
        """
        wanted = dict(locals())
        for name in ("self", "out", "progress"):
            del wanted[name]
        mesh = Mesh() if out is None else out
        check_out(mesh, Mesh)
        mesh._make(self, wanted, progress)
        return mesh

    def __repr__(self) -> str:
        info = self._info()
        size = float(np.linalg.norm(np.subtract(info.high, info.low)))
        cut = f" ({info.cut_patches:,} cut)" if info.cut_patches else ""
        fit = f", fitted within {info.fit_error:.3g}" if info.fit_error else ""
        return (
            f"<PatchSet {info.patches:,} patch{'es' * (info.patches != 1)}{cut}, {info.surfaces:,} "
            f"surface{'s' * (info.surfaces != 1)}, size {size:.3g}{fit}>"
        )

    def _view(self) -> tuple[str, bytes]:
        return mesh_for_view(self)._view_as(repr(self))
