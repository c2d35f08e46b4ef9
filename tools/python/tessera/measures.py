"""Areas, volumes, centroids, inertia and tight boxes of a model, each with a bound of its error."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ._arrays import integer_of, positive_of
from ._calls import Handle, call
from ._library import library, struct
from .errors import ArgumentError

_AREAS, _BODIES, _BOX, _ENCLOSED = 1, 2, 4, 8
_NONE = 0xFFFFFFFF


@dataclass(frozen=True, eq=False)
class Area:
    """The kept part of a surface, or of several together. Each number is off by at most its error, each coordinate of
    the centroid by ``centroid_error``. ``is_proven``: whether that is proven, and not sampled."""

    area: float
    area_error: float
    centroid: np.ndarray
    centroid_error: float
    is_proven: bool


@dataclass(frozen=True, eq=False)
class Body:
    """A solid or a closed shell, of density 1. Each number is off by at most its error.

    ``instance``, ``shape``, ``solid``, ``shell``: where it is in the model, None where it is of no such; ``inertia``
    (3, 3) about the centroid, with its principal ``moments``, rising, and their unit ``axes``, one per row; ``gap``:
    the largest distance of two faces along an edge, whose slits are part of the errors.
    """

    instance: int | None
    shape: int | None
    solid: int | None
    shell: int | None
    volume: float
    volume_error: float
    centroid: np.ndarray
    centroid_error: float
    inertia: np.ndarray
    inertia_error: float
    moments: np.ndarray
    moments_error: float
    axes: np.ndarray
    gap: float
    is_proven: bool


@dataclass(frozen=True, eq=False)
class Box:
    """A box that contains a model: its corners ``low`` and ``high``, and how far each side is from the model at
    most."""

    low: np.ndarray
    high: np.ndarray
    low_error: np.ndarray
    high_error: np.ndarray
    is_proven: bool


class _Measured(Handle):
    _kind = "measures"

    def read(self, function: Any, name: str, *index: int) -> Any:
        """Returns a struct of the measures."""
        found = struct(name)
        call(function, self._handle, *index, ctypes.byref(found))
        return found


def _area_of(found: Any) -> Area:
    return Area(found.area, found.area_error, np.array(found.centroid), found.centroid_error, bool(found.is_proven))


def _body_of(found: Any) -> Body:
    xx, yy, zz, xy, yz, zx = found.inertia
    places = {name: getattr(found, name) for name in ("instance", "shape", "solid", "shell")}
    return Body(
        **{name: None if place == _NONE else place for name, place in places.items()},
        volume=found.volume,
        volume_error=found.volume_error,
        centroid=np.array(found.centroid),
        centroid_error=found.centroid_error,
        inertia=np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]]),
        inertia_error=found.inertia_error,
        moments=np.array(found.moments),
        moments_error=found.moments_error,
        axes=np.array(found.axes).reshape(3, 3),
        gap=found.gap,
        is_proven=bool(found.is_proven),
    )


class Measures:
    """The measures of a model. Areas, bodies and the box are each computed when they are first asked for.

    >>> import math, tessera as ts
    >>> ball = ts.sphere(2.0).measure(enclosed=True)
    >>> abs(ball.volume - 4 / 3 * math.pi * 8) <= ball.volume_error < 1e-6
    True
    >>> abs(ball.area - 4 * math.pi * 4) <= ball.area_error
    True
    """

    def __init__(self, model: Handle, accuracy: float, max_cells: int, enclosed: bool) -> None:
        self._model, self._enclosed = model, bool(enclosed)
        self._accuracy = positive_of("accuracy", accuracy)
        self._max_cells = integer_of("max_cells", max_cells, 1, 2**63 - 1)

    def _measured(self, flags: int) -> _Measured:
        options = struct("tsr_measure_options")
        options.accuracy, options.max_cells, options.flags = self._accuracy, self._max_cells, flags
        made = _Measured()
        made._make(library.tsr_measures_new, self._model._handle, ctypes.byref(options))
        return made

    @cached_property
    def _areas(self) -> _Measured:
        return self._measured(_AREAS)

    @cached_property
    def _of_bodies(self) -> _Measured:
        return self._measured(_ENCLOSED if self._enclosed else _BODIES)

    @cached_property
    def surfaces(self) -> list[Area]:
        """The kept part of each surface."""
        areas = self._areas
        count = areas._info().surfaces
        return [_area_of(areas.read(library.tsr_measures_area, "tsr_area", k)) for k in range(count)]

    @cached_property
    def surface(self) -> Area:
        """All surfaces together."""
        return _area_of(self._areas.read(library.tsr_measures_area, "tsr_area", -1))

    @property
    def faults(self) -> dict[int, str]:
        """Why the loops of some surfaces could not be used, by surface: these are measured whole, and not proven."""
        areas, surface = self._areas, ctypes.c_size_t()
        found = {}
        for k in range(areas._info().faults):
            text = library.tsr_measures_fault(areas._handle, k, ctypes.byref(surface))
            found[surface.value] = text.decode(errors="replace")
        return found

    @cached_property
    def bodies(self) -> list[Body]:
        """The solids of all instances, and their closed shells; with ``enclosed`` the one body of all surfaces."""
        bodies = self._of_bodies
        return [
            _body_of(bodies.read(library.tsr_measures_body, "tsr_body", k)) for k in range(bodies._info().bodies)
        ]

    @cached_property
    def body(self) -> Body:
        """All bodies together, which do not overlap. An ArgumentError if there is none."""
        if not self.bodies:
            raise ArgumentError(
                "the model has no solid and no closed shell: join() makes faces share their edges; "
                "measure(enclosed=True) takes for granted that the surfaces leave no gap"
            )
        return _body_of(self._of_bodies.read(library.tsr_measures_body, "tsr_body", -1))

    @cached_property
    def box(self) -> Box:
        """The smallest box, up to its errors."""
        found = self._measured(_BOX).read(library.tsr_measures_box, "tsr_box")
        sides = {name: np.array(getattr(found, name)) for name in ("low", "high", "low_error", "high_error")}
        return Box(**sides, is_proven=bool(found.is_proven))

    @property
    def area(self) -> float:
        """The area of all surfaces."""
        return self.surface.area

    @property
    def area_error(self) -> float:
        return self.surface.area_error

    @property
    def volume(self) -> float:
        """The volume of all bodies."""
        return self.body.volume

    @property
    def volume_error(self) -> float:
        return self.body.volume_error

    @property
    def centroid(self) -> np.ndarray:
        """The centroid of all bodies."""
        return self.body.centroid

    @property
    def inertia(self) -> np.ndarray:
        """The inertia of all bodies about their centroid, (3, 3), of density 1."""
        return self.body.inertia

    def __repr__(self) -> str:
        return f"<Measures of {self._model!r}>"

    def __reduce__(self) -> tuple[Any, ...]:
        return Measures, (self._model, self._accuracy, self._max_cells, self._enclosed)
