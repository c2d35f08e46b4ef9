"""What a binary STL file shows of its mesh, by the bits of its positions. It shares no code with the library."""

from __future__ import annotations

import pathlib
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class MeshFacts:
    """``open_edges``: edges with an odd number of triangles; ``inconsistent_edges``: edges whose triangles do not run
    along them as often one way as the other. ``volume`` is negative if the normals point inwards."""

    triangles: int = 0
    open_edges: int = 0
    inconsistent_edges: int = 0
    area: float = 0.0
    volume: float = 0.0


def _corners(path: pathlib.Path) -> np.ndarray:
    """Returns the corners as floats, (3 * triangles, 3)."""
    raw = np.fromfile(path, dtype=np.uint8)
    count = int(raw[80:84].view(np.uint32)[0])
    records = raw[84 : 84 + 50 * count].reshape(count, 50)
    return np.ascontiguousarray(records[:, 12:48]).view(np.float32).reshape(count * 3, 3)


def _edges(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns for each edge how many triangles use it, and how many more run along it one way than the other."""
    bits = np.ascontiguousarray(corners + np.float32(0)).view(np.uint32).reshape(-1, 3)  # -0 becomes 0
    ids = np.unique(bits, axis=0, return_inverse=True)[1].reshape(-1, 3)
    edges = np.concatenate([ids[:, [0, 1]], ids[:, [1, 2]], ids[:, [2, 0]]])
    edges = edges[edges[:, 0] != edges[:, 1]]
    which = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)[1].reshape(-1)
    direction = np.where(edges[:, 0] < edges[:, 1], 1, -1)
    return np.bincount(which), np.bincount(which, weights=direction)


def facts_of(path: pathlib.Path) -> MeshFacts:
    """Reads a mesh and measures it."""
    corners = _corners(path)
    if not len(corners):
        return MeshFacts()
    points = corners.astype(np.float64)
    a, b, c = np.moveaxis((points - points.mean(axis=0)).reshape(-1, 3, 3), 1, 0)
    uses, balance = _edges(corners)
    return MeshFacts(
        triangles=len(corners) // 3,
        open_edges=int(np.sum(uses % 2 == 1)),
        inconsistent_edges=int(np.sum((uses % 2 == 0) & (balance != 0))),
        area=float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2),
        volume=float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6),
    )
