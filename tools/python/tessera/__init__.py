"""Tessera: parametric surfaces to points, meshes and ray hits, as arrays of NumPy.

>>> import tessera as ts
>>> patches = ts.read(goblet).patches()
>>> mesh = patches.tessellate(tolerance=1e-3)
>>> mesh.vertices.dtype, mesh.faces.dtype
(dtype('float32'), dtype('uint32'))
"""

from ._calls import threads
from ._library import library as _functions
from .curves import Curve, arc, circle, line, polyline
from .errors import (
    ArgumentError,
    ArgumentTypeError,
    CancelledError,
    Error,
    FileError,
    MissingError,
    OutOfMemoryError,
    StateError,
    UnsupportedError,
)
from .jets import Jets
from .live import LiveView
from .limits import Limits, Measurement, limits, measure
from .measures import Area, Body, Box, Measures
from .meshes import Mesh, MeshReport
from .models import Assembly, Instance, Model, PatchSet, Scene, Surface
from .patches import Patch
from .plans import View
from .points import NearestPoints, PointScene, Sides, Solid
from .rays import HIT, INVALID_RAY, MISS, Hits
from .sections import PlaneSection, Polyline, Sections, sections
from .shapes import cone, coons, cylinder, extrude, interpolate, plane, revolve, ruled, sphere, torus
from .sources import bezier, model, nurbs, parse, read
from .splines import Spline

_number = _functions.tsr_version()
__version__ = f"{_number // 10000}.{_number // 100 % 100}.{_number % 100}"

__all__ = [
    "HIT",
    "INVALID_RAY",
    "MISS",
    "Area",
    "ArgumentError",
    "ArgumentTypeError",
    "Assembly",
    "Body",
    "Box",
    "CancelledError",
    "Curve",
    "Error",
    "FileError",
    "Hits",
    "Instance",
    "Jets",
    "Limits",
    "LiveView",
    "Measurement",
    "Measures",
    "Mesh",
    "MeshReport",
    "MissingError",
    "Model",
    "NearestPoints",
    "OutOfMemoryError",
    "Patch",
    "PatchSet",
    "PlaneSection",
    "PointScene",
    "Polyline",
    "Scene",
    "Sections",
    "Sides",
    "Solid",
    "Spline",
    "StateError",
    "Surface",
    "UnsupportedError",
    "View",
    "arc",
    "bezier",
    "circle",
    "cone",
    "coons",
    "cylinder",
    "extrude",
    "interpolate",
    "limits",
    "line",
    "measure",
    "model",
    "nurbs",
    "parse",
    "plane",
    "polyline",
    "read",
    "revolve",
    "ruled",
    "sections",
    "sphere",
    "threads",
    "torus",
]
