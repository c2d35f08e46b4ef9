"""A view of a mesh for notebooks: one piece of HTML that needs no network."""

from __future__ import annotations

import base64
import html
import json
import pathlib
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .meshes import Mesh
    from .patches import PatchSet

#: Triangles of a view; of larger meshes it shows as good a mesh as so many triangles make.
MAX_TRIANGLES = 50_000


def html_of(shown: Mesh | PatchSet) -> str:
    """Returns a frame that shows a mesh, or a mesh of patches; at most 2 MB."""
    from .meshes import Mesh

    mesh, note = (shown, "") if isinstance(shown, Mesh) else (shown.tessellate(max_triangles=MAX_TRIANGLES), "")
    if len(mesh.triangles()) > MAX_TRIANGLES and mesh._set is not None:
        mesh = mesh._set.tessellate(max_triangles=MAX_TRIANGLES)
        note = f"; shown with {len(mesh.faces):,} triangles, within {mesh.bound:.3g}"
    page = page_of(mesh, repr(shown)[1:-1] + note)
    return (
        f'<iframe srcdoc="{html.escape(page)}" sandbox="allow-scripts" title="{html.escape(repr(shown))}" '
        'style="width: 100%; height: 420px; border: 1px solid #ddd"></iframe>'
    )


def page_of(mesh: Mesh, caption: str) -> str:
    """Returns a page that shows a mesh."""
    vertices = np.asarray(mesh.vertices, np.float64)
    low = vertices.min(axis=0) if len(vertices) else np.zeros(3)
    size = vertices.max(axis=0) - low if len(vertices) else np.zeros(3)
    scale = np.linalg.norm(size) or 1.0
    faces = mesh.triangles()
    positions = np.round((vertices - low) / np.where(size > 0, size, 1) * 65535).astype(np.uint16)
    normals = _octahedral(_normals(vertices, faces) if mesh.normals is None else mesh.normals)
    is_wide = len(vertices) > 65536
    data = {
        "count": int(faces.size),
        "wide": is_wide,
        "half_size": (size / scale).tolist(),
        "positions": _text(positions),
        "normals": _text(normals),
        "faces": _text(faces.astype(np.uint32 if is_wide else np.uint16)),
    }
    template = pathlib.Path(__file__).with_name("view.html").read_text(encoding="utf-8")
    return template.replace("@CAPTION@", html.escape(caption)).replace("@DATA@", json.dumps(data))


def _text(array: np.ndarray) -> str:
    return base64.b64encode(array.astype(array.dtype.newbyteorder("<")).tobytes()).decode()


def _octahedral(normals: np.ndarray) -> np.ndarray:
    """Returns two bytes per unit normal: its place on an octahedron that is unfolded to a square (Cigolle et al., A
    Survey of Efficient Representations for Independent Unit Vectors, JCGT 2014)."""
    length = np.abs(normals).sum(axis=1, keepdims=True)
    flat = normals / np.where(length > 0, length, 1)
    folded = (1 - np.abs(flat[:, [1, 0]])) * np.where(flat[:, :2] < 0, -1, 1)
    return np.round(np.where(flat[:, 2:] < 0, folded, flat[:, :2]) * 127).astype(np.int8)


def _normals(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Returns unit normals of vertices: the sum of their triangles', by area."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    across = np.cross(b - a, c - a)
    sums = np.zeros_like(vertices)
    for k in range(3):
        np.add.at(sums, faces[:, k], across)
    length = np.linalg.norm(sums, axis=1, keepdims=True)
    return sums / np.where(length > 0, length, 1)
