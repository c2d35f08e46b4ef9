"""Rays against a sphere and a field, whose hits are known."""

import importlib.util
import os
import pathlib
import pickle
import subprocess
import sys

import numpy as np
import pytest

import tessera as ts
from conftest import model_file, wavy


@pytest.fixture
def sphere():
    patches = ts.read(model_file("sphere.json")).patches()
    low, high = patches.box
    return patches, (low + high) / 2, (high - low)[2] / 2


def random_rays(count, centre, radius):
    random = np.random.default_rng(7)
    origins = random.normal(size=(count, 3))
    origins = centre + 3 * radius * origins / np.linalg.norm(origins, axis=1)[:, None]
    targets = centre + radius * random.uniform(-1.2, 1.2, (count, 3))
    return origins, targets - origins


def test_hits_of_a_sphere(sphere):
    patches, centre, radius = sphere
    origins, directions = random_rays(6000, centre, radius)
    hits = patches.rays().closest(origins, directions)
    a = (directions**2).sum(axis=1)
    b = (directions * (origins - centre)).sum(axis=1)
    c = ((origins - centre) ** 2).sum(axis=1) - radius**2
    root = b * b - a * c
    clear = np.abs(root) > 1e-9 * b * b
    assert (hits.is_hit == (root > 0))[clear].all()
    both = hits.is_hit & clear
    assert np.allclose(hits.t[both], ((-b - np.sqrt(np.maximum(root, 0))) / a)[both], rtol=1e-9)
    assert np.isinf(hits.t[~hits.is_hit]).all() and (hits.patch[~hits.is_hit] == 0xFFFFFFFF).all()
    outward = (hits.position[both] - centre) / radius
    assert np.allclose(np.abs((outward * hits.normal[both]).sum(axis=1)), 1, atol=1e-9)
    assert hits.certified[both].mean() > 0.99
    assert repr(hits) == f"<Hits of 6,000 rays: {hits.is_hit.sum():,} hits>"


def test_all_and_occluded(sphere):
    patches, centre, radius = sphere
    origins, directions = random_rays(500, centre, radius)
    scene = patches.rays()
    first, every = scene.all(origins, directions)
    closest = scene.closest(origins, directions)
    counts = np.diff(first)
    assert first[-1] == every.t.size and set(counts) <= {0, 1, 2}
    assert ((counts > 0) == closest.is_hit).all()
    assert (every.t[first[:-1][counts > 0]] == closest.t[closest.is_hit]).all()
    assert (scene.occluded(origins, directions) == closest.is_hit).all()
    assert not scene.occluded(origins, directions, tfar=1e-3).any()


def test_rays_broadcast(sphere):
    patches, centre, radius = sphere
    scene = patches.rays()
    x, y = np.meshgrid(np.linspace(-1, 1, 4), np.linspace(-1, 1, 3))
    directions = np.stack([x, y, np.full_like(x, -3)], axis=-1)
    eye = centre + [0, 0, 3 * radius]
    hits = scene.closest(eye, directions)
    assert hits.t.shape == (3, 4) and hits.uv.shape == (3, 4, 2)
    full = scene.closest(np.broadcast_to(eye, (3, 4, 3)), directions, tnear=np.zeros((3, 1)))
    assert (full.t == hits.t).all()
    parallel = scene.closest(eye + np.array([[0, 0, 0], [0.1, 0, 0]]), [0, 0, -1])
    assert parallel.t.shape == (2,) and parallel.is_hit.all()
    assert scene.closest(np.zeros((0, 3)), [0, 0, 1]).t.shape == (0,)
    single = scene.closest(eye.astype(np.float32), directions.astype(np.float32))
    assert np.allclose(single.t[hits.is_hit], hits.t[hits.is_hit], rtol=1e-4)
    records = np.zeros((12, 7))
    records[:, 1:4] = directions.reshape(-1, 3)
    assert (scene.closest(eye, records[:, 1:4]).t == hits.t.reshape(-1)).all()


def test_out_and_quantities(sphere):
    patches, centre, radius = sphere
    origins, directions = random_rays(100, centre, radius)
    scene = patches.rays()
    only = scene.closest(origins, directions, quantities=["t", "du"])
    assert not hasattr(only, "kind") and only.du.shape == (100, 3)
    with pytest.raises(ts.ArgumentError, match="needs the quantity kind"):
        only.is_hit
    distances = np.empty(100)
    assert scene.closest(origins, directions, out=ts.Hits(t=distances)).t is distances
    assert (distances == only.t).all()
    for bad, error in ((np.empty(99), ValueError), (np.empty(100, np.float32), TypeError)):
        with pytest.raises(error):
            scene.closest(origins, directions, out=ts.Hits(t=bad))
    with pytest.raises(ts.ArgumentError, match="'depth' is no quantity"):
        ts.Hits(depth=distances)


def test_bad_rays(sphere):
    scene = sphere[0].rays()
    with pytest.raises(ts.ArgumentError, match=r"origins: expected shape \(..., 3\), found \(4, 2\)"):
        scene.closest(np.zeros((4, 2)), [0, 0, 1])
    with pytest.raises(ts.ArgumentError, match="do not fit each other"):
        scene.closest(np.zeros((4, 3)), np.zeros((5, 3)))
    with pytest.raises(ts.ArgumentTypeError, match="directions"):
        scene.closest(np.zeros((4, 3)), [["x", "y", "z"]])
    hits = scene.closest([0, 0, 9], [[0, 0, -1], [0, 0, 0], [np.nan, 0, 1]])
    assert hits.kind.tolist() == [ts.HIT, ts.INVALID_RAY, ts.INVALID_RAY]


def test_a_scene_keeps_its_patches_and_is_pickled():
    scene = ts.bezier(wavy(2, 2)).patches().rays()
    wanted = scene.closest([0.5, 0.5, 9], [0, 0, -1])
    copy = pickle.loads(pickle.dumps(scene))
    assert copy.closest([0.5, 0.5, 9], [0, 0, -1]).t == wanted.t
    assert scene.box.shape == (2, 3) and scene.spawn_offset > 0


@pytest.mark.skipif(importlib.util.find_spec("open3d") is None, reason="there is no Open3D")
@pytest.mark.parametrize("first", ["tessera", "open3d"])
def test_beside_open3d(first):
    """In a process of its own: Open3D stays in it."""
    program = pathlib.Path(__file__).with_name("beside_open3d.py")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    subprocess.run([sys.executable, program, first, model_file("goblet.json")], env=environment, check=True)
