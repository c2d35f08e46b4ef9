"""Points beside surfaces: the nearest points of these, and which points lie inside of solids."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import Any

import numpy as np

from ._arrays import TypedArrays, array_of, check_out, in_view, integer_of, out_view, records_of, vectors_of
from ._calls import Handle, run
from ._library import library, struct
from .errors import ArgumentError, ArgumentTypeError
from .models import Model, PatchSet, Scene

_BYTE, _INDEX, _DOUBLE = np.dtype(np.uint8), np.dtype(np.uint32), np.dtype(np.float64)
_QUANTITIES: dict[str, tuple[int, np.dtype]] = {
    "kind": (1, _BYTE),
    "flags": (1, _BYTE),
    "surface": (1, _INDEX),
    "patch": (1, _INDEX),
    "distance": (1, _DOUBLE),
    "uv": (2, _DOUBLE),
    "patch_uv": (2, _DOUBLE),
    "position": (3, _DOUBLE),
    "normal": (3, _DOUBLE),
}
_CERTIFIED, _AMBIGUOUS, _BORDER = 1, 2, 4
_FOUND = 1
_OUTSIDE, _INSIDE, _UNKNOWN, _INVALID = range(4)
_SIDES: dict[str, tuple[int, np.dtype]] = {"side": (1, _BYTE), "is_certified": (1, _BYTE)}
_LONG = 1_000  # points, below which a call is over at once


class NearestPoints(TypedArrays):
    """The nearest points of surfaces, an array per quantity. Unless a point is found, its distance is inf, its indices
    are 0xffffffff and the rest is 0.

    ``distance``; ``position`` and unit ``normal`` (..., 3); ``surface``, ``patch``; ``uv`` in the surface's parameters,
    also as ``u`` and ``v``, and ``patch_uv`` in the patch's (..., 2); ``kind``: 0 none, 1 found, 2 an invalid point;
    ``flags``: bits of TSR_NEAREST_* in tessera_c_queries.h. An array that was not asked for is a MissingError.
    Made of arrays of the caller, it is where to write to: ``NearestPoints(distance=array)``.
    """

    _known = _QUANTITIES
    _usual = ("kind", "flags", "surface", "patch", "distance", "uv", "position", "normal")

    kind: np.ndarray
    flags: np.ndarray
    surface: np.ndarray
    patch: np.ndarray
    distance: np.ndarray
    uv: np.ndarray
    patch_uv: np.ndarray
    position: np.ndarray
    normal: np.ndarray

    @property
    def found(self) -> np.ndarray:
        """Whether a surface lies within the largest distance. False for points that are not finite."""
        self._needs("found", "kind")
        return self.kind == _FOUND

    @property
    def certified(self) -> np.ndarray:
        """Whether it is proven, up to rounding, that no point is nearer, or, where none is found, that there is none."""
        return self._flag("certified", _CERTIFIED)

    @property
    def ambiguous(self) -> np.ndarray:
        """Whether another point of the surface is as near."""
        return self._flag("ambiguous", _AMBIGUOUS)

    @property
    def border(self) -> np.ndarray:
        """Whether the point lies on a border or a crease, so that the line to it is not perpendicular."""
        return self._flag("border", _BORDER)

    @property
    def u(self) -> np.ndarray:
        return self.uv[..., 0]

    @property
    def v(self) -> np.ndarray:
        return self.uv[..., 1]

    def _flag(self, name: str, bit: int) -> np.ndarray:
        self._needs(name, "flags")
        return self.flags & bit != 0

    def __repr__(self) -> str:
        if "kind" not in self.__dict__:
            return f"<NearestPoints {', '.join(self.__dict__)}>"
        count, found = self.kind.size, np.count_nonzero(self.found)
        return f"<NearestPoints of {count:,} point{'s' * (count != 1)}: {found:,} found>"


class Sides(TypedArrays):
    """On which side of a solid points lie: ``side``, 0 outside, 1 inside, 2 unknown, 3 an invalid point."""

    _known = _SIDES
    _usual = tuple(_SIDES)

    side: np.ndarray
    is_certified: np.ndarray

    @property
    def inside(self) -> np.ndarray:
        return self.side == _INSIDE

    @property
    def outside(self) -> np.ndarray:
        return self.side == _OUTSIDE

    @property
    def unknown(self) -> np.ndarray:
        """Whether the surface is open, and the winding number is 0.5 or -0.5, within 1e-6."""
        return self.side == _UNKNOWN

    @property
    def certified(self) -> np.ndarray:
        """Whether the side is proven, unless the point lies on the surface up to rounding."""
        return self.is_certified.view(bool)

    def __repr__(self) -> str:
        count, inside = self.side.size, np.count_nonzero(self.inside)
        return f"<Sides of {count:,} point{'s' * (count != 1)}: {inside:,} inside>"


class _Points:
    """Points as the library takes them."""

    def __init__(self, points: Any, max_distance: Any = None, patches: int = 1) -> None:
        dtype = np.float32 if getattr(points, "dtype", None) == np.float32 else np.float64
        positions = vectors_of("points", points, dtype)
        self.shape: tuple[int, ...] = positions.shape[:-1]
        self.struct = struct("tsr_query_points")
        self.struct.is_double = dtype == np.float64
        self._kept: list[np.ndarray] = []
        if max_distance is not None:
            reach = array_of("max_distance", max_distance)
            try:
                self.shape = np.broadcast_shapes(self.shape, reach.shape)
            except ValueError:
                raise ArgumentError(
                    f"max_distance: its shape {reach.shape} does not fit points of {self.shape}"
                ) from None
            if dtype == np.float32 and not (reach == reach.astype(dtype)).all():
                # The two are of one type: a distance that float rounds needs points in double.
                positions, self.struct.is_double = positions.astype(np.float64), 1
            self._put("max_distance", reach.astype(positions.dtype, copy=False), 1)
        self._put("position", positions, 3)
        self.struct.patches = patches
        self.count: int = self.struct.position.count

    def _put(self, name: str, array: np.ndarray, components: int) -> None:
        shape = self.shape if components == 1 else (*self.shape, components)
        if array.shape != shape and (name == "position" or array.size != 1):
            array = np.broadcast_to(array, shape)
        flat = records_of(array, components)
        self._kept.append(flat)
        setattr(self.struct, name, in_view(flat))

    @property
    def is_long(self) -> bool:
        return self.count > _LONG


def _patches_of(value: Any) -> PatchSet:
    if isinstance(value, Model):
        return value.patches()
    if not isinstance(value, PatchSet):
        raise ArgumentTypeError(f"patches: expected a PatchSet or a Model, found {type(value).__name__}")
    return value


class PointScene(Handle):
    """Patches, or all those of a model, prepared for the search of nearest points.

    >>> import numpy as np, tessera as ts
    >>> near = ts.PointScene(ts.sphere(2.0)).nearest(np.array([[0, 0, 5], [1, 0, 0]]))
    >>> near.distance.round(9).tolist(), near.certified.tolist()
    ([3.0, 1.0], [True, True])
    """

    _kind = "point_scene"

    def __init__(self, patches: PatchSet | Model) -> None:
        self.patches = _patches_of(patches)
        self._make(library.tsr_point_scene_new, self.patches._handle)

    def refit(self) -> None:
        """Follows edits of the patches."""
        run(library.tsr_point_scene_refit, self._handle)

    def nearest(
        self,
        points: Any,
        max_distance: Any = None,
        quantities: Sequence[str] | None = None,
        out: NearestPoints | None = None,
        patches: int | None = None,
    ) -> NearestPoints:
        """Returns the point of the surfaces, within their trimming loops, that is nearest to each of ``points``
        (..., 3). ``max_distance``: surfaces farther away count as none, one number or one per point; ``quantities``:
        which; ``out``: where to write to; ``patches``: the nearest points of so many patches, in arrays (..., patches),
        the nearest first."""
        each = 1 if patches is None else integer_of("patches", patches, 1, 2**20)
        wanted = _Points(points, max_distance, each)
        shape = wanted.shape if patches is None else (*wanted.shape, each)
        nearest = NearestPoints.empty(shape, quantities) if out is None else out
        check_out(nearest, NearestPoints)
        to = struct("tsr_nearest_out")
        to.is_double = 1
        nearest._fill(to, shape)
        run(
            library.tsr_point_scene_nearest,
            self._handle,
            ctypes.byref(wanted.struct),
            ctypes.byref(to),
            is_long=wanted.is_long,
        )
        return nearest

    def __repr__(self) -> str:
        return f"<PointScene of {self.patches!r}, {self._info().memory_bytes / 2**20:.1f} MiB>"

    def __reduce__(self) -> tuple[Any, ...]:
        return PointScene, (self.patches,)


class Solid(Handle):
    """A surface, of a model, a patch set or a scene for rays, prepared for the question which points lie inside. Where it
    is open, winding numbers tell sides, none of which is certified. After an edit of the patches refit the scene, and
    make the solid anew.

    >>> import tessera as ts
    >>> ball = ts.Solid(ts.sphere(2.0))
    >>> ball.is_closed, ball.contains([[0, 0, 1], [0, 0, 3]]).tolist()
    (True, [True, False])
    >>> ball.signed_distance([[1, 0, 0], [0, 0, 3]]).round(9).tolist()
    [-1.0, 1.0]
    """

    _kind = "solid"

    def __init__(self, patches: Scene | PatchSet | Model) -> None:
        self.scene = patches if isinstance(patches, Scene) else _patches_of(patches).rays()
        self._points: PointScene | None = None
        self._make(library.tsr_solid_new, self.scene._handle)

    @property
    def is_closed(self) -> bool:
        """Whether the surface is closed."""
        return bool(self._info().is_closed)

    @property
    def open_borders(self) -> int:
        """The number of edges and borders where the surface is open."""
        return self._info().open_borders

    def sides(self, points: Any) -> Sides:
        """Returns on which side each of ``points`` (..., 3) lies, and whether that is proven."""
        wanted = _Points(points)
        sides = Sides.empty(wanted.shape)
        to = sides._fill(struct("tsr_sides_out"), wanted.shape)
        run(
            library.tsr_solid_contains,
            self._handle,
            ctypes.byref(wanted.struct),
            ctypes.byref(to),
            is_long=wanted.is_long,
        )
        return sides

    def contains(self, points: Any) -> np.ndarray:
        """Returns whether each of ``points`` (..., 3) lies inside: False also where that is unknown, and for points that
        are not finite. sides() tells these apart, and which answers are certified."""
        return self.sides(points).inside

    def winding_numbers(self, points: Any) -> np.ndarray:
        """Returns the generalized winding number of each of ``points`` (..., 3): the solid angle that the surface covers,
        seen from there, as a share of the whole sphere. It is 1 inside of a closed surface and 0 outside, and in between
        where the surface is open; NaN for points that are not finite."""
        wanted = _Points(points)
        numbers = np.empty(wanted.shape)
        to = out_view("numbers", numbers, _DOUBLE, wanted.shape, 1)
        run(
            library.tsr_solid_winding_numbers,
            self._handle,
            ctypes.byref(wanted.struct),
            ctypes.byref(to),
            is_long=wanted.is_long,
        )
        return numbers

    def signed_distance(self, points: Any) -> np.ndarray:
        """Returns the distance of each of ``points`` (..., 3) from the surface, negative inside; NaN where the side is
        unknown, and for points that are not finite."""
        wanted = _Points(points)
        if self._points is None:
            self._points = PointScene(self.scene.patches)
        distances = np.empty(wanted.shape)
        to = out_view("distances", distances, _DOUBLE, wanted.shape, 1)
        run(
            library.tsr_solid_distances,
            self._handle,
            self._points._handle,
            ctypes.byref(wanted.struct),
            ctypes.byref(to),
            is_long=wanted.is_long,
        )
        return distances

    def __repr__(self) -> str:
        count = self.open_borders
        state = "closed" if self.is_closed else f"open along {count:,} border{'s' * (count != 1)}"
        return f"<Solid of {self.scene.patches!r}, {state}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Solid, (self.scene,)
