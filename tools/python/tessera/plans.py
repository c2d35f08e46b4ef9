"""Plans: how a set is divided into triangles, and the camera that a plan may be made for."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from typing import Any

import numpy as np

from ._arrays import address_of, array_of, integer_of, number_of, pair_of, positive_of, vectors_of
from ._calls import Handle, Progress
from ._library import library, struct
from .errors import ArgumentError, ArgumentTypeError

_RELATIVE, _SHARE, _QUADS, _FEWEST, _SMALLEST, _DOUBLE, _APART = (1 << k for k in range(7))
_UV = {"surface": 128, "unit": 256, "patch": 512}
MAX_RATE, MAX_PIXELS = 4096, 1 << 20
_LONG = 200  # patches, below which a plan is made at once


@dataclass(frozen=True)
class View:
    """A camera. ``field_of_view``: radians, across the shorter side of the picture; ``extent``: parallel rays instead,
    and the length that the shorter side shows; ``near_distance``: a thousandth of the target's distance by default."""

    eye: Any
    target: Any
    up: Any = (0.0, 0.0, 1.0)
    field_of_view: float | None = None
    extent: float | None = None
    near_distance: float | None = None
    width: int = 1280
    height: int = 800


class Plan(Handle):
    """How a set is divided into triangles."""

    _kind = "plan"

    def __init__(self, patches: Handle, wanted: dict[str, Any], progress: Progress | None) -> None:
        options = struct("tsr_plan_options")
        library.tsr_plan_defaults(ctypes.byref(options))
        kept = _fill(options, wanted)
        is_long = (wanted.get("rates") is None and patches._info().patches > _LONG) or wanted.get("fewest", False)
        self._make(library.tsr_plan_new, patches._handle, ctypes.byref(options), progress=progress, is_long=is_long)
        del kept  # the options point into it


def _fill(options: Any, wanted: dict[str, Any]) -> np.ndarray | None:
    """Fills a tsr_plan_options. ``wanted``: options of PatchSet.tessellate(), and its defaults where one is missing.
    Returns the memory of tolerances that the options point into."""
    of_surfaces = None
    tolerance: Any = wanted.get("tolerance")
    if np.ndim(tolerance) > 0:
        of_surfaces = np.ascontiguousarray(array_of("tolerance", tolerance)).ravel()
        options.surface_tolerances, options.surface_tolerance_count = address_of(of_surfaces), len(of_surfaces)
        wanted = {**wanted, "tolerance": None}
    for name in ("tolerance", "angle", "pixels"):
        if wanted.get(name) is not None:  # 0 stands for none in C
            setattr(options, name, positive_of(name, wanted[name]))
    for name in ("crease_angle", "weld", "max_gap", "headroom"):
        if wanted.get(name) is not None:
            setattr(options, name, number_of(name, wanted[name]))
    if wanted.get("max_triangles") is not None:
        options.max_triangles = integer_of("max_triangles", wanted["max_triangles"], 1, 2**64 - 1)
    if wanted.get("rates") is not None:
        options.rate_u, options.rate_v = pair_of("rates", wanted["rates"], 1, MAX_RATE)
    is_limited = of_surfaces is not None or any(
        wanted.get(name) is not None for name in ("tolerance", "angle", "pixels", "rates")
    )
    flags = {
        _RELATIVE: wanted.get("relative"),
        _SHARE: wanted.get("share_vertices"),
        _QUADS: wanted.get("quads"),
        _FEWEST: wanted.get("fewest"),
        _SMALLEST: wanted.get("max_triangles") is not None and not is_limited,
        _DOUBLE: is_double(wanted),
        _APART: not wanted.get("close_edges", True),
    }
    if (uv := wanted.get("uv")) is not None:
        if uv not in _UV:
            raise ArgumentError(f"uv: expected one of {', '.join(map(repr, _UV))}, found {uv!r}")
        flags[_UV[uv]] = True
    options.flags = sum(flag for flag, is_set in flags.items() if is_set)
    view = wanted.get("view")
    if wanted.get("pixels") is not None and view is None:
        raise ArgumentError("pixels: expected a view beside it: view=View(eye=..., target=...)")
    if view is not None:
        fill_view(options, view)
    return of_surfaces


def fill_view(options: Any, view: View) -> None:
    """Fills the camera of a tsr_plan_options."""
    if not isinstance(view, View):
        raise ArgumentTypeError(f"view: expected a View, found {type(view).__name__}")
    for name in ("eye", "target", "up"):
        vector = vectors_of(f"view.{name}", getattr(view, name))
        if vector.shape != (3,):
            raise ArgumentError(f"view.{name}: expected shape (3,), found {vector.shape}")
        getattr(options, name)[:] = vector.tolist()
    for name in ("field_of_view", "extent", "near_distance"):
        if getattr(view, name) is not None:
            setattr(options, name, number_of(f"view.{name}", getattr(view, name)))
    for name in ("width", "height"):
        setattr(options, name, integer_of(f"view.{name}", getattr(view, name), 1, MAX_PIXELS))


def is_double(wanted: dict[str, Any]) -> bool:
    dtype = np.dtype(wanted.get("dtype", np.float32))
    if dtype not in (np.float32, np.float64):
        raise ArgumentTypeError(f"dtype: expected float32 or float64, found {dtype}")
    return dtype == np.float64
