"""Sections: where parallel planes cut surfaces, as polylines whose points lie on these."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ._arrays import address_of, array_of, integer_of, out_view, positive_of, vectors_of
from ._calls import Handle, Progress, call
from ._library import library, struct
from .errors import ArgumentError, ArgumentTypeError
from .models import Model, PatchSet

_LIMITS = ("automatic", "below", "above")


@dataclass(frozen=True, eq=False)
class Polyline:
    """A curve of a section. ``points`` (n, 3) lie on the surface and in the plane; ``uv`` (n, 2) are their parameters in
    the surface of their patch, ``patch`` (n,); ``bridges_gap`` (n,): whether the segment that follows crosses a gap
    between two faces. ``is_closed``: a segment leads from the last point to the first; the two differ."""

    points: np.ndarray
    uv: np.ndarray
    patch: np.ndarray
    bridges_gap: np.ndarray
    is_closed: bool
    length: float


@dataclass(frozen=True, eq=False)
class PlaneSection:
    """The section of one plane: its ``polylines`` and their ``length`` together; ``bound``, which is proven: the largest
    distance of a chord from the curve; ``contacts`` (n, 3), where the plane touches a surface; ``coplanar``, the patches
    that lie in the plane, which have no polylines; ``open_count``, the polylines that are not closed; ``largest_gap``,
    between two ends that were joined across faces; ``limit``, the side that was taken, "below" or "above"."""

    offset: float
    polylines: list[Polyline]
    length: float
    bound: float
    contacts: np.ndarray
    coplanar: np.ndarray
    open_count: int
    largest_gap: float
    limit: str


class Sections:
    """The sections of parallel planes, in the order of the offsets: ``sections[index]`` returns one. ``tolerance`` is
    the one that was asked for, or the default; ``unproven`` are the patches whose section is not proven to be
    complete; polylines no larger than ``contact_size`` are contacts."""

    def __init__(self, planes: list[PlaneSection], tolerance: float, contact_size: float, unproven: np.ndarray) -> None:
        self.planes, self.tolerance, self.contact_size, self.unproven = planes, tolerance, contact_size, unproven

    def __len__(self) -> int:
        return len(self.planes)

    def __getitem__(self, index: int) -> PlaneSection:
        return self.planes[index]

    def __iter__(self) -> Iterator[PlaneSection]:
        return iter(self.planes)

    def __repr__(self) -> str:
        lines = sum(len(plane.polylines) for plane in self.planes)
        return (
            f"<Sections of {len(self):,} plane{'s' * (len(self) != 1)}: {lines:,} polyline{'s' * (lines != 1)}, "
            f"within {self.tolerance:g}>"
        )


class _Found(Handle):
    _kind = "sections"

    def read(self) -> tuple[Any, dict[str, np.ndarray]]:
        """Returns the tsr_sections_info and all arrays."""
        info, out = self._info(), struct("tsr_sections_out")
        sizes = {
            "first": (info.polylines + 1, 1, np.uint64),
            "is_closed": (info.polylines, 1, np.uint8),
            "length": (info.polylines, 1, np.float64),
            "position": (info.points, 3, np.float64),
            "uv": (info.points, 2, np.float64),
            "patch": (info.points, 1, np.uint32),
            "bridges_gap": (info.points, 1, np.uint8),
            "contact_position": (info.contacts, 3, np.float64),
            "coplanar": (info.coplanar, 1, np.uint32),
            "unproven": (info.unproven, 1, np.uint32),
        }
        arrays = {}
        for name, (count, components, dtype) in sizes.items():
            arrays[name] = np.empty(count if components == 1 else (count, components), dtype)
            setattr(out, name, out_view(name, arrays[name], np.dtype(dtype), (count,), components))
        call(library.tsr_sections_read, self._handle, ctypes.byref(out))
        return info, arrays

    def plane(self, index: int, polylines: list[Polyline], arrays: dict[str, np.ndarray]) -> PlaneSection:
        found = struct("tsr_plane_section")
        call(library.tsr_sections_plane, self._handle, index, ctypes.byref(found))
        lines, contacts, patches = found.first_polyline, found.first_contact, found.first_coplanar
        return PlaneSection(
            offset=found.offset,
            polylines=polylines[lines : lines + found.polyline_count],
            length=found.length,
            bound=found.bound,
            contacts=arrays["contact_position"][contacts : contacts + found.contact_count],
            coplanar=arrays["coplanar"][patches : patches + found.coplanar_count],
            open_count=found.open_count,
            largest_gap=found.largest_gap,
            limit=_LIMITS[found.limit],
        )


def _polylines(arrays: dict[str, np.ndarray]) -> list[Polyline]:
    first = arrays["first"].tolist()
    bridges = arrays["bridges_gap"].view(bool)
    made = []
    for k, (is_closed, length) in enumerate(zip(arrays["is_closed"].tolist(), arrays["length"].tolist())):
        own = slice(first[k], first[k + 1])
        made.append(
            Polyline(
                arrays["position"][own], arrays["uv"][own], arrays["patch"][own], bridges[own], bool(is_closed), length
            )
        )
    return made


def sections(
    patches: PatchSet | Model,
    normal: Any,
    offsets: Any,
    tolerance: float | None = None,
    contact: float | None = None,
    max_gap: float | None = None,
    max_points: int | None = None,
    limit: str = "automatic",
    progress: Progress | None = None,
) -> Sections:
    """Cuts patches, or all those of a model, by the planes of the points p with dot(normal, p) = offset, one for each of
    ``offsets``, a number or several.

    ``tolerance``: the largest distance of a chord from the curve, 1e-4 of the size by default; ``contact``: the height
    within which points count as the plane's; ``max_gap``: ends on one edge farther apart stay open, 5e-3 of the size by
    default; ``max_points``: of all polylines; ``limit``: which planes count where one runs along a face, those "below",
    those "above", or "automatic": below, above where there is nothing below.

    >>> import math, tessera as ts
    >>> plane = ts.sections(ts.sphere(2.0), normal=[0, 0, 1], offsets=1.0, tolerance=1e-3)[0]
    >>> [(line.is_closed, line.points.shape[1]) for line in plane.polylines], plane.bound <= 1e-3
    ([(True, 3)], True)
    >>> abs(plane.length - 2 * math.pi * math.sqrt(3)) < 0.01
    True
    """
    if isinstance(patches, Model):
        patches = patches.patches()
    if not isinstance(patches, PatchSet):
        raise ArgumentTypeError(f"patches: expected a PatchSet or a Model, found {type(patches).__name__}")
    direction = np.ascontiguousarray(vectors_of("normal", normal))
    if direction.shape != (3,):
        raise ArgumentError(f"normal: expected shape (3,), found {direction.shape}")
    planes = np.ascontiguousarray(array_of("offsets", offsets))
    if planes.ndim > 1:
        raise ArgumentError(f"offsets: expected a number or shape (n,), found {planes.shape}")
    planes = planes.reshape(-1)
    options = struct("tsr_section_options")
    library.tsr_section_defaults(ctypes.byref(options))
    if tolerance is not None:
        options.tolerance = positive_of("tolerance", tolerance)
    for name, value in (("contact", contact), ("max_gap", max_gap)):
        if value is not None:
            setattr(options, name, positive_of(name, value, zero=True))
    if max_points is not None:
        options.max_points = integer_of("max_points", max_points, 0, 2**63 - 1)
    if limit not in _LIMITS:
        raise ArgumentError(f"limit: expected one of {', '.join(map(repr, _LIMITS))}, found {limit!r}")
    options.limit = _LIMITS.index(limit)
    found = _Found()
    arguments = (address_of(direction), address_of(planes), len(planes), ctypes.byref(options))
    found._make(library.tsr_sections_new, patches._handle, *arguments, progress=progress)
    info, arrays = found.read()
    polylines = _polylines(arrays)
    cut = [found.plane(k, polylines, arrays) for k in range(info.planes)]
    found.close()
    return Sections(cut, info.tolerance, info.contact_size, arrays["unproven"])
