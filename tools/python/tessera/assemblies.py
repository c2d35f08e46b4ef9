"""Meshes of all shapes of a model, at all their places."""

from __future__ import annotations

import ctypes
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from ._calls import call
from ._library import library
from .meshes import warn_of_rounding

if TYPE_CHECKING:
    from .meshes import Mesh
    from .models import Instance, Model


class Assembly:
    """A mesh per shape and the places of the shapes; of a model without shapes one mesh, and no places.

    >>> import tessera as ts
    >>> ts.read(goblet).tessellate(tolerance=1e-2).meshes[0].is_proven
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

    def __repr__(self) -> str:
        triangles = sum(len(mesh.faces) for mesh in self.meshes)
        return (
            f"<Assembly {len(self.meshes):,} mesh{'es' * (len(self.meshes) != 1)}, {len(self.instances):,} "
            f"instance{'s' * (len(self.instances) != 1)}, {triangles:,} triangles>"
        )
