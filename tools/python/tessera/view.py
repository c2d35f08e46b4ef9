"""A view of a mesh for notebooks: one piece of HTML that needs no network, and a picture where scripts do not run."""

from __future__ import annotations

import base64
import pathlib
from typing import Any

import numpy as np

from ._picture import picture_of

#: Triangles of a view. A larger mesh is shown by another one of its patches, or simplified.
MAX_TRIANGLES = 50_000


class Shown:
    """An object that notebooks show: as a view with scripts (HTML) and as a picture (PNG), which remains where scripts
    do not run, as in notebooks on GitHub and in PDF."""

    def _view(self) -> tuple[str, bytes]:
        """Returns the HTML and the PNG."""
        raise NotImplementedError

    def _repr_html_(self) -> str:
        return self._view()[0]

    def _repr_png_(self) -> bytes:
        return self._view()[1]

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, str]:
        html, png = self._view()
        return {"text/plain": repr(self), "text/html": html, "image/png": base64.b64encode(png).decode()}


def frame_of(page: str, name: str, png: bytes) -> str:
    """Returns HTML that shows a page in a frame without an origin, and behind it a picture, which is seen where the
    frame is taken out or where its scripts do not run."""
    import html  # here, so that the package is imported sooner

    place = "position: absolute; left: 0; top: 0; width: 100%; height: 100%; border: 0"
    return (
        '<div style="position: relative; height: 420px; border: 1px solid #ddd; background: #fff">'
        f'<img src="data:image/png;base64,{base64.b64encode(png).decode()}" alt="{html.escape(name)}" '
        f'style="{place}; object-fit: contain">'
        f'<iframe srcdoc="{html.escape(page)}" sandbox="allow-scripts" title="{html.escape(name)}" style="{place}">'
        "</iframe></div>"
    )


def page_of(caption: str, data: dict[str, Any], script: str) -> str:
    """Returns a page that shows the meshes of a source, which ``script`` makes of ``data``."""
    import html
    import json
    import re

    template = pathlib.Path(__file__).with_name("view.html").read_text(encoding="utf-8")
    text = json.dumps(data).replace("<", "\\u003c")  # no name ends the script
    values = {"@CAPTION@": html.escape(caption), "@LIVE@": script, "@DATA@": text}
    # In one pass: a name may hold a mark.
    return re.sub("|".join(values), lambda mark: values[mark[0]], template)


def view_of(
    name: str, vertices: np.ndarray, faces: np.ndarray, normals: np.ndarray | None, note: str = ""
) -> tuple[str, bytes]:
    """Returns HTML that shows triangles, at most 2 MB, and their picture as PNG. ``name``: what is shown, within
    brackets."""
    if len(faces) > MAX_TRIANGLES:
        vertices, faces, normals = *_clustered(vertices, faces), None
        note = f"; shown simplified, with {len(faces):,} triangles"
    normals = _normals(vertices, faces) if normals is None else normals
    data = _data_of(vertices, faces, normals)
    png = picture_of(vertices, faces, normals)
    return frame_of(page_of(name[1:-1] + note, data, "showInSight(stored());"), name, png), png


def _data_of(vertices: np.ndarray, faces: np.ndarray, normals: np.ndarray) -> dict[str, Any]:
    """Returns what the page draws: positions in 16 bits of their box."""
    low = vertices.min(axis=0) if len(vertices) else np.zeros(3)
    size = vertices.max(axis=0) - low if len(vertices) else np.zeros(3)
    scale = np.linalg.norm(size) or 1.0
    positions = np.round((vertices - low) / np.where(size > 0, size, 1) * 65535).astype(np.uint16)
    is_wide = len(vertices) > 65536
    return {
        "count": int(faces.size),
        "wide": is_wide,
        "half_size": (size / scale).tolist(),
        "positions": _text(positions),
        "normals": _text(_octahedral(normals)),
        "faces": _text(faces.astype(np.uint32 if is_wide else np.uint16)),
    }


def _clustered(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns fewer vertices and triangles: those that differ after vertices of a cell are one (Rossignac and Borrel,
    Multi-resolution 3D approximations for rendering complex scenes, 1993)."""
    low = vertices.min(axis=0)
    size = (vertices.max(axis=0) - low).max() or 1.0
    cells = 512
    while True:
        cell = np.floor((vertices - low) / size * cells).astype(np.int64) @ [1, 1 << 20, 1 << 40]
        _, index, count = np.unique(cell, return_inverse=True, return_counts=True)
        few = np.sort(index[faces], axis=1)
        first = np.unique(few, axis=0, return_index=True)[1]
        kept = first[(few[first, 0] < few[first, 1]) & (few[first, 1] < few[first, 2])]
        if len(kept) <= MAX_TRIANGLES:
            sums = np.stack([np.bincount(index, vertices[:, axis]) for axis in range(3)], axis=1)
            return sums / count[:, None], index[faces[kept]]
        cells = cells * 3 // 4


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
