"""Rays, which meet the surfaces themselves."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import Any

import numpy as np

from ._arrays import (
    TypedArrays,
    address_of,
    array_of,
    check_out,
    in_view,
    integer_of,
    out_view,
    positive_of,
    records_of,
    vectors_of,
)
from ._calls import Handle, call, run
from ._library import library, struct
from .errors import ArgumentError

_BYTE, _INDEX, _DOUBLE = np.dtype(np.uint8), np.dtype(np.uint32), np.dtype(np.float64)
#: The quantities of a hit: components and type.
QUANTITIES: dict[str, tuple[int, np.dtype]] = {
    "kind": (1, _BYTE),
    "flags": (1, _BYTE),
    "surface": (1, _INDEX),
    "patch": (1, _INDEX),
    "t": (1, _DOUBLE),
    "uv": (2, _DOUBLE),
    "patch_uv": (2, _DOUBLE),
    "position": (3, _DOUBLE),
    "normal": (3, _DOUBLE),
    "du": (3, _DOUBLE),
    "dv": (3, _DOUBLE),
    "residual": (1, _DOUBLE),
}
_USUAL = ("kind", "flags", "surface", "patch", "t", "uv", "position", "normal", "residual")
_UNCERTIFIED = 4
_LONG = 5_000  # rays, below which a call is over at once
MISS, HIT, INVALID_RAY = range(3)


class Hits(TypedArrays):
    """The hits of rays, an array per quantity. A miss has t = inf, indices of 0xffffffff and 0 elsewhere.

    ``kind``: MISS, HIT or INVALID_RAY; ``flags``: bits of TSR_HIT_* in tessera_c.h; ``surface``, ``patch``; ``t``;
    ``uv`` in the surface's parameters and ``patch_uv`` in the patch's; ``position`` and unit ``normal``; ``du``,
    ``dv`` by the surface's parameters; ``residual``: the distance from the ray. An array that was not asked for is a
    MissingError.
    Made of arrays of the caller, it is where to write to: ``Hits(t=array)``.
    """

    _known = QUANTITIES
    _usual = _USUAL

    kind: np.ndarray
    flags: np.ndarray
    surface: np.ndarray
    patch: np.ndarray
    t: np.ndarray
    uv: np.ndarray
    patch_uv: np.ndarray
    position: np.ndarray
    normal: np.ndarray
    du: np.ndarray
    dv: np.ndarray
    residual: np.ndarray

    @property
    def is_hit(self) -> np.ndarray:
        """Whether each ray meets a surface."""
        self._needs("is_hit", "kind")
        return self.kind == HIT

    @property
    def certified(self) -> np.ndarray:
        """Whether each ray has a hit that is proven to be the only root nearby."""
        self._needs("certified", "kind", "flags")
        return self.is_hit & (self.flags & _UNCERTIFIED == 0)

    def __repr__(self) -> str:
        if "kind" not in self.__dict__:
            return f"<Hits {', '.join(self.__dict__)}>"
        rays, hits = self.kind.size, np.count_nonzero(self.is_hit)
        return f"<Hits of {rays:,} ray{'s' * (rays != 1)}: {hits:,} hit{'s' * (hits != 1)}>"

    def _struct(self, shape: tuple[int, ...]) -> Any:
        out = struct("tsr_hits_out")
        out.is_double = 1
        return self._fill(out, shape)


class _Rays:
    """Rays as the library takes them, broadcast over the shapes of all arrays."""

    def __init__(self, origins: Any, directions: Any, tnear: Any, tfar: Any, spawn_offset: Any) -> None:
        is_float = all(getattr(value, "dtype", None) == np.float32 for value in (origins, directions))
        dtype = np.float32 if is_float else np.float64
        vectors = {
            "origin": vectors_of("origins", origins, dtype),
            "direction": vectors_of("directions", directions, dtype),
        }
        scalars = {"tnear": tnear, "tfar": tfar, "spawn_offset": spawn_offset}
        scalars = {name: array_of(name, value, dtype) for name, value in scalars.items() if value is not None}
        shapes = {name: array.shape[:-1] for name, array in vectors.items()}
        shapes.update((name, array.shape) for name, array in scalars.items())
        self.shape: tuple[int, ...] = shapes["direction"]
        try:
            if any(shape != self.shape for shape in shapes.values()):
                self.shape = np.broadcast_shapes(*shapes.values())
        except ValueError:
            found = ", ".join(f"{name} of {shape}" for name, shape in shapes.items())
            raise ArgumentError(f"the rays do not fit each other: {found}") from None
        self.struct = struct("tsr_rays")
        self.struct.is_double = not is_float
        self._kept: list[np.ndarray] = []
        for name, array in (*vectors.items(), *scalars.items()):
            self._put(name, array, 3 if name in vectors else 1)
        self.count: int = self.struct.direction.count

    def _put(self, name: str, array: np.ndarray, components: int) -> None:
        # One record holds for all rays, of directions alone it does not.
        shape = self.shape if components == 1 else (*self.shape, components)
        if array.shape != shape and (name == "direction" or array.size != components):
            array = np.broadcast_to(array, shape)
        flat = records_of(array, components)
        self._kept.append(flat)
        setattr(self.struct, name, in_view(flat))


class SceneBase(Handle):
    """The calls of a Scene that need no PatchSet."""

    _kind = "scene"

    def __init__(self, patches: Handle, tolerance: float | None, pieces: int, editable: bool) -> None:
        self._options = (tolerance, pieces, editable)
        options = struct("tsr_scene_options")
        library.tsr_scene_defaults(ctypes.byref(options))
        options.tolerance = 0 if tolerance is None else positive_of("tolerance", tolerance)
        options.is_editable = bool(editable)
        options.pieces = integer_of("pieces", pieces, 1, 8)
        self._make(library.tsr_scene_new, patches._handle, ctypes.byref(options))

    @property
    def box(self) -> np.ndarray:
        """The box of all that rays can meet, (2, 3)."""
        info = self._info()
        return np.array([info.low, info.high])

    @property
    def spawn_offset(self) -> float:
        """The spawn_offset that suits rays that start on a surface."""
        return self._info().spawn_offset

    def refit(self) -> None:
        """Follows edits of the patches."""
        run(library.tsr_scene_refit, self._handle)

    def closest(
        self,
        origins: Any,
        directions: Any,
        tnear: Any = None,
        tfar: Any = None,
        spawn_offset: Any = None,
        quantities: Sequence[str] | None = None,
        out: Hits | None = None,
    ) -> Hits:
        """Returns the closest hit of each ray. ``quantities``: which; ``out``: where to write to."""
        rays = _Rays(origins, directions, tnear, tfar, spawn_offset)
        hits = Hits.empty(rays.shape, quantities) if out is None else out
        check_out(hits, Hits)
        to = hits._struct(rays.shape)
        self._run(library.tsr_scene_closest, rays, to)
        return hits

    def occluded(
        self, origins: Any, directions: Any, tnear: Any = None, tfar: Any = None, spawn_offset: Any = None
    ) -> np.ndarray:
        """Returns whether anything lies on each ray."""
        rays = _Rays(origins, directions, tnear, tfar, spawn_offset)
        found = np.empty(rays.shape, _BYTE)
        self._run(library.tsr_scene_occluded, rays, out_view("occluded", found, _BYTE, rays.shape, 1))
        return found.view(bool)

    def all(
        self,
        origins: Any,
        directions: Any,
        tnear: Any = None,
        tfar: Any = None,
        spawn_offset: Any = None,
        quantities: Sequence[str] | None = None,
    ) -> tuple[np.ndarray, Hits]:
        """Returns ``first`` and all hits, ray after ray, by growing t: those of ray k are
        first[k] to first[k + 1] - 1."""
        rays = _Rays(origins, directions, tnear, tfar, spawn_offset)
        found = Handle()
        found._make(library.tsr_scene_all, self._handle, ctypes.byref(rays.struct), is_long=rays.count > _LONG)
        count = ctypes.c_size_t()
        first = np.empty(rays.count + 1, np.uint64)
        call(library.tsr_hits_read, found._handle, ctypes.byref(count), address_of(first), None)
        hits = Hits.empty(count.value, quantities)
        call(library.tsr_hits_read, found._handle, None, None, ctypes.byref(hits._struct((count.value,))))
        found.close()
        return first.astype(np.int64), hits

    def _run(self, function: Any, rays: _Rays, to: Any) -> None:
        is_long = rays.count > _LONG
        run(function, self._handle, ctypes.byref(rays.struct), ctypes.byref(to), is_long=is_long)
