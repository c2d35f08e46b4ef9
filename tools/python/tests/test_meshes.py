"""Meshes: what is proven, memory, edits, files, other packages."""

import json
import pickle
import sys
import warnings

import numpy as np
import pytest

import tessera as ts
from conftest import wavy


def test_a_mesh_keeps_its_tolerance(goblet):
    mesh = goblet.patches().tessellate(tolerance=1e-2)
    assert mesh.is_certified and 0 < mesh.bound <= 1e-2
    assert mesh.vertices.dtype == mesh.normals.dtype == np.float32 and mesh.faces.dtype == np.uint32
    assert mesh.faces.max() < len(mesh.vertices) and mesh.patches.max() < len(goblet.patches())
    assert np.allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-5)
    report = mesh.check()
    assert report.triangles == len(mesh.faces) and report.t_junctions == 0 and report.open_edges == mesh.open_edges
    assert "proven within" in repr(mesh) and f"{len(mesh.faces):,} triangles" in repr(mesh)
    # The corners lie on the surface, by other means: rays along the normals.
    scene = goblet.patches().rays()
    some = mesh.positions()[::97]
    normals = mesh.normals[::97].astype(float)
    hits = scene.closest(some - normals * 1e-2, normals, tfar=2e-2)
    found = hits.is_hit
    assert found.mean() > 0.9
    assert np.abs(hits.t[found] - 1e-2).max() < 1e-4


def test_bounds_and_closed_meshes(goblet):
    for dtype in (np.float32, np.float64):
        mesh = ts.bezier(wavy(2, 3) + [1e6, 0, 0]).patches().tessellate(1e-3, dtype=dtype)
        assert mesh.bounds.dtype == np.float64 and mesh.bounds.shape == (2, 3)
        assert mesh.bounds[0].tolist() == mesh.positions().min(axis=0).tolist()
        assert mesh.bounds[:, 0].tolist() == [1e6, 1e6 + 2] and not mesh.is_closed
    box = goblet.bounds
    mesh = goblet.patches().tessellate(1e-3)
    assert (box[0] <= mesh.bounds[0] + 1e-3).all() and (mesh.bounds[1] - 1e-3 <= box[1]).all()
    assert mesh.is_closed and goblet.patches().tessellate(1e-2, quads=True).is_closed
    box[:] = 0
    assert goblet.bounds[1, 2] > 1  # a copy


def test_an_empty_mesh():
    mesh = ts.Mesh()
    assert repr(mesh) == "<Mesh 0 vertices, 0 triangles, unproven>"
    assert mesh.faces.shape == (0, 3) and mesh.vertices.shape == (0, 3) and not mesh.is_closed and mesh.nbytes == 0
    assert mesh.positions().shape == (0, 3) and repr(pickle.loads(pickle.dumps(mesh))) == repr(mesh)
    with pytest.raises(ts.StateError, match="no vertices"):
        mesh.bounds
    with pytest.raises(ts.StateError, match="not made of patches"):
        mesh.update()
    made = ts.bezier(wavy(1, 1)).patches().tessellate(1e-2, out=mesh)
    assert made is mesh and len(mesh.faces) > 0


def test_options():
    patches = ts.bezier(wavy(3, 3)).patches()
    fine, coarse = patches.tessellate(1e-3), patches.tessellate(1e-1)
    assert len(fine.faces) > len(coarse.faces)
    assert len(patches.tessellate(rates=4).faces) == 9 * 32
    assert not patches.tessellate(rates=(3, 5)).is_certified
    quads = patches.tessellate(1e-2, quads=True)
    assert len(quads.quads) > 0 and quads.quads.shape[1] == 4 and len(quads.quad_patches) == len(quads.quads)
    assert len(quads.triangles()) == len(quads.faces) + 2 * len(quads.quads)
    shared = patches.tessellate(1e-2, share_vertices=True)
    assert not shared.has_normals and not shared.has_uv
    assert len(shared.vertices) < len(patches.tessellate(1e-2).vertices)
    assert patches.tessellate(1e-2, share_vertices=True, crease_angle=0.5).has_normals
    relative = patches.tessellate(1e-3, relative=True)
    assert relative.bound <= 1e-3 * np.linalg.norm(np.diff(patches.box, axis=0)) * 1.001
    turned = patches.tessellate(angle=0.2)
    assert 0 < turned.angle <= 0.2 and "rad" in repr(turned)
    budget = patches.tessellate(max_triangles=500)
    assert 100 < len(budget.faces) <= 500 and budget.is_certified
    view = ts.View(eye=(1, 1, 10), target=(1, 1, 0), up=(0, 1, 0))
    assert 0 < patches.tessellate(pixels=0.5, view=view).pixels <= 0.5


def test_a_view_that_moves():
    patches = ts.bezier(wavy(4, 4)).patches()

    def view(distance):
        return ts.View(eye=(2, 2, distance), target=(2, 2, 0), up=(0, 1, 0))

    mesh = patches.tessellate(pixels=0.5, view=view(20))
    far = len(mesh.faces)
    assert mesh.update(view=view(6)) and len(mesh.faces) > 2 * far and 0 < mesh.pixels <= 0.5
    assert not mesh.update() and not mesh.update(view=view(6.01))
    assert mesh.update(view=view(20)) and len(mesh.faces) <= 1.25 * far
    with pytest.raises(ts.ArgumentError, match="same point"):
        mesh.update(view=ts.View(eye=(0, 0, 0), target=(0, 0, 0)))
    with pytest.raises(ts.ArgumentError, match="no tolerance in pixels"):
        patches.tessellate(1e-2).update(view=view(6))


def test_a_tolerance_for_each_surface():
    patches = ts.bezier(wavy(2, 2)).patches()  # each patch is a surface
    mesh = patches.tessellate([1e-4, 1e-2, 1e-2, 1e-2])
    counts = np.bincount(mesh.patches)
    assert mesh.is_certified and mesh.bound <= 1e-2 and counts[0] > 5 * counts[3]
    assert not mesh.update()
    assert (patches.tessellate(np.full(8, 1e-2)[::2]).faces == patches.tessellate(1e-2).faces).all()
    with pytest.raises(ts.ArgumentError, match="surface 1 is 0"):
        patches.tessellate([0.1, 0.0, 0.1, 0.1])
    with pytest.raises(ts.ArgumentError, match="4 surfaces, found 5"):
        patches.tessellate([0.1] * 5)


def test_headroom():
    patches = ts.bezier(wavy(3, 3)).patches()
    assert patches.tessellate(1e-2, headroom=0.5).bound <= 0.51e-2
    with pytest.raises(ts.ArgumentError, match="headroom"):
        patches.tessellate(1e-2, headroom=1)


@pytest.mark.parametrize(
    "options, words",
    [
        ({}, "tolerance"),
        ({"tolerance": -1}, "tolerance"),
        ({"tolerance": float("nan")}, "tolerance"),
        ({"tolerance": 0}, "tolerance is 0, expected a finite number above 0"),
        ({"tolerance": "fine"}, "tolerance: expected a number, found 'fine'"),
        ({"tolerance": float("inf")}, "tolerance is inf, expected a finite number"),
        ({"angle": 0.0}, "angle is 0, expected"),
        ({"angle": 2}, "at most pi / 2"),
        ({"pixels": 0, "view": ts.View((0, 0, 9), (0, 0, 0))}, "pixels is 0, expected"),
        ({"tolerance": 1, "weld": float("nan")}, "weld is nan, expected a finite number"),
        ({"pixels": 1, "view": (0, 0, 9)}, "view: expected a View, found tuple"),
        ({"pixels": 1, "view": ts.View((0, 0, 9), (0, 0, 0), extent="wide")}, "view.extent: expected a number"),
        ({"pixels": 1}, "expected a view"),
        ({"pixels": 1, "view": ts.View((0, 0), (0, 0, 0))}, "view.eye"),
        ({"tolerance": 1e-6, "max_triangles": 100}, "triangles"),
        ({"rates": 0}, ""),
        ({"tolerance": 1, "dtype": int}, "float32 or float64"),
    ],
)
def test_bad_options(options, words):
    with pytest.raises(ts.Error, match=words):
        ts.bezier(wavy(1, 1)[0]).patches().tessellate(**options)


def test_positions_in_double_are_those_of_the_model():
    points = wavy(2, 2) + [1e6, 0, 0]
    patches = ts.bezier(points).patches()
    single = patches.tessellate(1e-3)
    double = patches.tessellate(1e-3, dtype=np.float64)
    assert double.vertices.dtype == np.float64 and (double.origin == 0).all()
    assert double.vertices[:, 0].min() == 1e6
    assert np.allclose(single.positions(), double.positions(), atol=1e-6)
    assert double.check().t_junctions == 0


def test_out_writes_into_the_same_memory():
    patches = ts.bezier(wavy(3, 3)).patches()
    mesh = patches.tessellate(1e-3)
    vertices, faces = mesh.vertices, mesh.faces
    assert patches.tessellate(1e-2, out=mesh) is mesh
    assert np.shares_memory(mesh.vertices, vertices) and np.shares_memory(mesh.faces, faces)
    assert (mesh.faces == patches.tessellate(1e-2).faces).all()
    patches.tessellate(1e-4, out=mesh)  # more than fits
    assert (mesh.vertices == patches.tessellate(1e-4).vertices).all()


def test_edits_and_updates():
    patches = ts.bezier(wavy(3, 3)).patches()
    mesh, scene = patches.tessellate(1e-2), patches.rays(editable=True)
    before = mesh.vertices.copy()
    points = patches[4].points
    with pytest.raises(ValueError, match="read-only"):
        points[1, 1, 2] += 1
    points = points.copy()
    points[1:3, 1:3, 2] += 1e-4
    patches[4].points = points
    assert (patches[4].points == points).all()
    assert mesh.update() is False
    moved = np.abs(mesh.vertices - before).max(axis=1) > 0
    assert moved.any() and set(np.unique(mesh.patches[moved[mesh.faces].any(axis=1)])) == {4}
    points[1:3, 1:3, 2] += 3
    patches[4].points = points
    assert mesh.update() is True
    assert (mesh.vertices == patches.tessellate(1e-2).vertices).all() or mesh.is_certified
    with pytest.raises(ts.StateError):
        scene.closest([1.5, 1.5, 9], [0, 0, -1])
    scene.refit()
    assert scene.closest([1.5, 1.5, 9], [0, 0, -1]).position[2] > 1


def test_bad_edits():
    patches = ts.bezier(wavy(2, 1)).patches()
    points = patches[1].points
    with pytest.raises(IndexError):
        patches[2]
    with pytest.raises(ts.ArgumentError, match="expected shape"):
        patches[1].points = points[:3]
    with pytest.raises(ts.ArgumentError, match="control points"):
        patches.edit([0, 1], points)
    with pytest.raises(ts.ArgumentError, match="numbers from 0"):
        patches.edit([-1], points)
    with pytest.raises(ts.ArgumentError) as caught:
        patches.edit([0, 1], np.stack([points, points * np.nan]))
    assert caught.value.code == "non_finite" and caught.value.index == 1


def test_files(goblet, tmp_path):
    mesh = goblet.patches().tessellate(1e-2)
    for name in ("goblet.obj", "goblet.ply", "goblet.stl", "goblet.glb"):
        mesh.save(tmp_path / name)
        assert (tmp_path / name).stat().st_size > 1000
    with pytest.raises(ts.UnsupportedError, match="extension|format"):
        mesh.save(tmp_path / "goblet.xyz")
    with pytest.raises(OSError):
        mesh.save(tmp_path / "no" / "goblet.ply")


def test_files_far_from_zero(tmp_path):
    ball = {"kind": "sphere", "radius": 1, "axis": {"origin": [12958095.124851028, 4865499.469870342, 0]}}
    model = ts.parse(json.dumps({"format": "tessera", "version": 1, "surfaces": [ball]}))
    mesh = model.patches().tessellate(1e-2)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for name in ("ball.obj", "ball.ply", "ball.glb"):
            assert mesh.rounding(name) < 1e-6
            mesh.save(tmp_path / name)
    lines = (tmp_path / "ball.obj").read_text().splitlines()
    points = np.array([line.split()[1:4] for line in lines if line.startswith("v ")], float)
    radii = np.linalg.norm(points - ball["axis"]["origin"], axis=1)
    assert np.abs(radii - 1).max() <= mesh.bound + 1e-7
    assert mesh.rounding("ball.stl") > 0.1
    with pytest.warns(UserWarning, match="floats of this file move vertices by up to"):
        mesh.save(tmp_path / "ball.stl")
    with pytest.raises(ts.UnsupportedError):
        mesh.rounding("ball.xyz")


def test_another_reader_finds_the_same_mesh(goblet, tmp_path):
    meshio = pytest.importorskip("meshio")
    mesh = goblet.patches().tessellate(1e-2)
    mesh.save(tmp_path / "goblet.obj")  # its reader of .ply knows no numbers of faces, such as the patch
    found = meshio.read(tmp_path / "goblet.obj")
    assert np.allclose(found.points, mesh.positions(), atol=1e-6)
    assert (found.cells_dict["triangle"] == mesh.faces).all()


def test_trimesh(goblet):
    pytest.importorskip("trimesh")
    made = goblet.patches().tessellate(1e-2, share_vertices=True).to_trimesh()
    assert made.is_watertight and made.volume > 0


def test_pyvista(goblet):
    pytest.importorskip("pyvista")
    mesh = goblet.patches().tessellate(1e-2)
    assert mesh.to_pyvista().n_cells == len(mesh.faces)


def test_meshio(goblet, tmp_path):
    meshio = pytest.importorskip("meshio")
    mesh = goblet.patches().tessellate(1e-2, quads=True)
    made = mesh.to_meshio()
    assert (made.points == mesh.positions()).all()
    assert (made.cells_dict["triangle"] == mesh.faces).all() and (made.cells_dict["quad"] == mesh.quads).all()
    assert (made.point_data["normals"] == mesh.normals).all() and (made.point_data["uv"] == mesh.uv).all()
    assert (made.cell_data["patch"][1] == mesh.quad_patches).all()
    made.write(tmp_path / "goblet.vtu")
    found = meshio.read(tmp_path / "goblet.vtu")
    assert (found.points == mesh.positions()).all() and (found.cells_dict["quad"] == mesh.quads).all()
    shared = goblet.patches().tessellate(1e-2, share_vertices=True).to_meshio()
    assert list(shared.point_data) == [] and len(shared.cells) == 1


@pytest.mark.parametrize("name", ["trimesh", "pyvista", "meshio"])
def test_missing_packages_are_named(goblet, name, monkeypatch):
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(ImportError, match=rf"to_{name}\(\) needs the package {name}: pip install {name}"):
        getattr(goblet.patches().tessellate(1e-1), f"to_{name}")()


def test_meshes_and_sets_are_pickled():
    patches = ts.bezier(wavy(2, 2)).patches()
    points = np.array(patches[3].points) + [0, 0, 1e-3]
    patches[3].points = points
    mesh = patches.tessellate(1e-2)
    copy = pickle.loads(pickle.dumps(mesh))
    assert (copy.vertices == mesh.vertices).all() and (copy.faces == mesh.faces).all()
    assert copy.check() == mesh.check() and repr(copy) == repr(mesh)
    again = pickle.loads(pickle.dumps(patches))
    assert (again[3].points == points).all()
    assert (again.tessellate(1e-2).vertices == mesh.vertices).all()
    assert copy.update() is True and (copy.vertices == mesh.vertices).all()


def test_measure(goblet):
    patches = goblet.patches()
    found = ts.measure(lambda: patches.tessellate(1e-3), repeats=2)
    assert found.seconds > 0 and found.share_of_limit > 0 and found.nbytes == found.result.nbytes
