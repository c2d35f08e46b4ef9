"""Nearest points, solids, measures and sections against spheres and boxes, whose answers are known."""

import gc
import pickle

import numpy as np
import pytest

import tessera as ts
from conftest import model_file, wavy


def box(low=(0, 0, 0), high=(1, 1, 1), count=6):
    """The first faces of a box, which share no edges, with normals outwards; without the last one it has no lid."""
    low, high = np.array(low, float), np.array(high, float)
    faces = []
    for axis in range(3):
        for side in range(2):
            first, second = (axis + 1) % 3, (axis + 2) % 3
            if side == 0:
                first, second = second, first
            points = np.empty((2, 2, 3))
            points[..., axis] = (low, high)[side][axis]
            points[0, :, first], points[1, :, first] = low[first], high[first]
            points[:, 0, second], points[:, 1, second] = low[second], high[second]
            faces.append(points)
    return ts.bezier(np.array(faces[:count]))


@pytest.fixture
def ball():
    return ts.sphere(2.0)


def points_about(count, seed=3):
    points = np.random.default_rng(seed).normal(size=(count, 3))
    return points * np.random.default_rng(seed + 1).uniform(0.2, 4, (count, 1)) / np.linalg.norm(points, axis=1)[:, None]


def test_nearest_points_of_a_sphere(ball):
    points = points_about(3000)
    near = ts.PointScene(ball).nearest(points)
    radius = np.linalg.norm(points, axis=1)
    assert near.distance == pytest.approx(np.abs(radius - 2), abs=1e-13)
    assert np.allclose(near.position, 2 * points / radius[:, None], atol=1e-7)
    assert np.allclose(np.abs((near.normal * near.position).sum(axis=1)), 2, atol=1e-9)
    assert near.found.all() and near.certified.mean() > 0.99 and (near.surface == 0).all()
    jets = ball[0].evaluate(near.u, near.v)
    assert np.allclose(jets.position, near.position, atol=1e-13)
    assert repr(near) == "<NearestPoints of 3,000 points: 3,000 found>"


def test_shapes_and_types_of_points(ball):
    scene = ts.PointScene(ball.patches())
    points = points_about(12).astype(np.float32).reshape(3, 4, 3)
    near = scene.nearest(points)
    assert near.distance.shape == (3, 4) and near.uv.shape == (3, 4, 2) and near.position.shape == (3, 4, 3)
    assert (near.distance == scene.nearest(points.astype(np.float64)).distance).all()
    assert scene.nearest([3, 0, 0]).distance == pytest.approx(1)
    several = scene.nearest(points, patches=3)
    assert several.distance.shape == (*near.distance.shape, 3) and several.position.shape == (*near.distance.shape, 3, 3)
    assert np.allclose(several.distance[..., 0], near.distance, rtol=0, atol=1e-14) and (np.diff(several.distance, axis=-1) >= 0).all()
    assert all(len(set(patches)) == 3 for patches in several.patch.reshape(-1, 3))
    with pytest.raises(ts.ArgumentError, match="patches is 0"):
        scene.nearest(points, patches=0)
    assert scene.nearest(np.zeros((0, 3))).position.shape == (0, 3)
    records = np.zeros((12, 5))
    records[:, 1:4] = points.reshape(-1, 3)
    assert (scene.nearest(records[:, 1:4]).distance.reshape(3, 4) == near.distance).all()
    backwards = scene.nearest(points[::-1, ::-1])
    assert (backwards.distance == near.distance[::-1, ::-1]).all()
    only = scene.nearest(points, quantities="distance")
    assert not hasattr(only, "normal") and (only.distance == near.distance).all()
    distances = np.empty((3, 4))
    assert scene.nearest(points, out=ts.NearestPoints(distance=distances)).distance is distances
    assert (distances == near.distance).all()


def test_largest_distances(ball):
    scene = ts.PointScene(ball)
    points = np.array([[3.0, 0, 0], [2.25, 0, 0], [np.nan, 0, 0]])
    near = scene.nearest(points, max_distance=0.5)
    assert near.kind.tolist() == [0, 1, 2] and near.found.tolist() == [False, True, False]
    assert near.distance.tolist() == [np.inf, 0.25, np.inf] and near.patch[0] == 0xFFFFFFFF
    assert near.certified[:2].all()
    each = scene.nearest(points[0], max_distance=[0.5, 1.5, -1, np.nan])
    assert each.kind.tolist() == [0, 1, 2, 2]
    # A distance that float cannot hold is not rounded.
    assert scene.nearest(np.float32([3, 0, 0]), max_distance=1 - 1e-12).kind == 0
    assert scene.nearest(np.float32([3, 0, 0]), max_distance=1 + 1e-12).kind == 1


def test_bad_points(ball):
    scene = ts.PointScene(ball)
    with pytest.raises(ts.ArgumentError, match=r"points: expected shape \(..., 3\), found \(4, 2\)"):
        scene.nearest(np.zeros((4, 2)))
    with pytest.raises(ts.ArgumentTypeError, match="points"):
        scene.nearest([["x", "y", "z"]])
    with pytest.raises(ts.ArgumentError, match=r"max_distance: its shape \(2,\) does not fit points of \(4,\)"):
        scene.nearest(np.zeros((4, 3)), max_distance=[1, 2])
    with pytest.raises(ts.ArgumentError, match="'depth' is no quantity"):
        scene.nearest([0, 0, 1], quantities=["depth"])
    with pytest.raises(ts.ArgumentTypeError, match="out: expected NearestPoints, found Hits"):
        scene.nearest([0, 0, 1], out=ts.Hits(t=np.empty(1)))
    with pytest.raises(ts.ArgumentError, match=r"distance: expected shape \(4,\), found \(3,\)"):
        scene.nearest(np.zeros((4, 3)), out=ts.NearestPoints(distance=np.empty(3)))
    with pytest.raises(ts.ArgumentError, match="certified needs the quantity flags"):
        scene.nearest([0, 0, 1], quantities=["distance"]).certified
    with pytest.raises(ts.ArgumentTypeError, match="expected a PatchSet or a Model, found str"):
        ts.PointScene("sphere")


def test_edits_and_lifetimes():
    patches = ts.bezier(wavy(2, 2)).patches()
    scene, solid = ts.PointScene(patches), ts.Solid(patches.rays(editable=True))
    assert not solid.is_closed and solid.open_borders == 8
    moved = patches[0].points + [0, 0, 5]
    before = scene.nearest([0.5, 0.5, 9]).distance
    patches[0].points = moved
    for call in (scene.nearest, solid.contains, solid.winding_numbers, solid.signed_distance):
        with pytest.raises(ts.StateError):
            call([0.5, 0.5, 9])
    scene.refit()
    assert scene.nearest([0.5, 0.5, 9]).distance < before - 3
    copy = pickle.loads(pickle.dumps(scene))
    assert copy.nearest([0.5, 0.5, 9]).distance == scene.nearest([0.5, 0.5, 9]).distance
    solid.close()
    with pytest.raises(ts.StateError):
        solid.contains([0, 0, 0])
    kept = ts.Solid(box())
    gc.collect()
    assert kept.contains([0.5, 0.5, 0.5]) and pickle.loads(pickle.dumps(kept)).contains([0.5, 0.5, 0.5])


def test_a_solid_tells_inside_from_outside():
    solid = ts.Solid(box(high=(1, 2, 3)))
    assert solid.is_closed and solid.open_borders == 0 and repr(solid).endswith("closed>")
    points = np.random.default_rng(5).uniform(-1, 4, (2000, 3))
    inside = ((points > 0) & (points < [1, 2, 3])).all(axis=1)
    assert (solid.contains(points) == inside).all() and inside.any()
    sides = solid.sides(points.reshape(20, 100, 3))
    assert sides.certified.shape == (20, 100) and sides.certified.all()
    assert (sides.outside.reshape(-1) == ~inside).all() and not sides.unknown.any()
    beside = points - np.clip(points, 0, [1, 2, 3])
    wanted = np.where(inside, -np.minimum(points, [1, 2, 3] - points).min(axis=1), np.linalg.norm(beside, axis=1))
    assert np.allclose(solid.signed_distance(points), wanted, atol=1e-13)
    single = solid.signed_distance(points.astype(np.float32))
    assert np.allclose(single, wanted, atol=1e-6)
    assert solid.contains(np.zeros((0, 3))).shape == (0,) and solid.signed_distance([2, 1, 1]).shape == ()
    bad = solid.sides([[np.nan, 0, 0], [0.5, 0.5, 0.5]])
    assert bad.side.tolist() == [3, 1] and bad.inside.tolist() == [False, True]
    assert np.isnan(solid.signed_distance([np.inf, 0, 0]))
    with pytest.raises(ts.ArgumentError, match=r"expected shape \(..., 3\)"):
        solid.contains([1, 2])


def test_winding_numbers_of_closed_and_open_boxes():
    points = np.random.default_rng(7).uniform(-1, 2, (500, 3))
    inside = ((points > 0) & (points < 1)).all(axis=1)
    closed = ts.Solid(box()).winding_numbers(points.reshape(5, 100, 3))
    assert closed.shape == (5, 100) and np.allclose(closed.reshape(-1), inside, atol=1e-9) and inside.any()
    open_box = ts.Solid(box(count=5))
    assert not open_box.is_closed
    assert open_box.winding_numbers([0.5, 0.5, 0.5]) == pytest.approx(5 / 6, abs=1e-8)
    assert open_box.winding_numbers(np.float32([0.5, 0.5, 0.5])) == pytest.approx(5 / 6, abs=1e-8)
    sides = open_box.sides([[0.5, 0.5, 0.5], [0.5, 0.5, 3], [0.5, 0.5, 1]])
    assert sides.side.tolist() == [1, 0, 2] and not sides.certified.any()
    assert np.isnan(open_box.winding_numbers([[np.nan, 0, 0]])).all()
    assert open_box.winding_numbers(np.zeros((0, 3))).shape == (0,)


def test_measures_of_a_box():
    model = box(low=(-1, 0, 2), high=(1, 4, 5)).join()
    found = model.measure()
    assert found.volume == pytest.approx(24, abs=found.volume_error) and found.volume_error < 1e-6
    assert found.area == pytest.approx(52, abs=found.area_error) and found.area_error < 1e-6
    assert np.allclose(found.centroid, [0, 2, 3.5], atol=found.body.centroid_error)
    wanted = 24 / 12 * np.diag([16 + 9, 4 + 9, 4 + 16])
    assert np.allclose(found.inertia, wanted, atol=found.body.inertia_error)
    assert np.allclose(found.body.moments, [26, 40, 50], atol=found.body.moments_error)
    assert np.allclose(np.abs(found.body.axes[0]), [0, 1, 0], atol=1e-6)
    assert np.allclose(found.box.low, [-1, 0, 2], atol=1e-8) and np.allclose(found.box.high, [1, 4, 5], atol=1e-8)
    assert (found.box.low <= [-1, 0, 2]).all() and (found.box.high_error >= 0).all()
    assert sorted(round(face.area, 6) for face in found.surfaces) == [6, 6, 8, 8, 12, 12]
    assert [body.instance for body in found.bodies] == [0] and found.faults == {}
    assert found.body.is_proven and found.surface.is_proven and found.box.is_proven
    assert pickle.loads(pickle.dumps(found)).volume == found.volume


def test_measures_of_surfaces_that_share_no_edges(ball):
    loose = box()
    with pytest.raises(ts.ArgumentError, match=r"no solid and no closed shell: join\(\)"):
        loose.measure().volume
    assert loose.measure().bodies == [] and loose.measure().area == pytest.approx(6)
    assert loose.measure(enclosed=True).volume == pytest.approx(1)
    found = ball.measure(enclosed=True)
    moment = 2 / 5 * found.volume * 4
    assert found.volume == pytest.approx(32 / 3 * np.pi, abs=found.volume_error)
    assert np.allclose(found.body.moments, moment, atol=found.body.moments_error) and found.body.moments_error < 1e-5
    assert np.allclose(found.box.low, -2, atol=1e-8)
    rough = ball.measure(accuracy=1e-3, enclosed=True)
    assert found.volume_error < rough.volume_error and abs(rough.volume - found.volume) <= rough.volume_error * 1.01
    for options in ({"accuracy": 1}, {"accuracy": float("nan")}, {"max_cells": 0}):
        with pytest.raises(ts.ArgumentError):
            _ = ball.measure(**options).area


def test_measures_of_trimmed_surfaces(trimmed):
    found = trimmed.measure()
    mesh = trimmed.patches().tessellate(tolerance=1e-3)
    corners = mesh.vertices.astype(float)[mesh.faces]
    of_mesh = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2
    assert found.area == pytest.approx(of_mesh, rel=1e-2)


def test_sections_of_a_sphere(ball):
    offsets = np.array([0.5, -1.5, 3.0])
    found = ts.sections(ball, [0, 0.6, 0.8], offsets, tolerance=1e-4)
    assert len(found) == 3 and found.tolerance == 1e-4 and found.unproven.size == 0
    for plane, offset in zip(found, offsets):
        assert plane.offset == offset and plane.bound <= 1e-4 and plane.open_count == 0
        circle = 2 * np.pi * np.sqrt(max(4 - offset**2, 0))
        assert plane.length == pytest.approx(circle, rel=1e-3) and len(plane.polylines) == (circle > 0)
        for line in plane.polylines:
            assert line.is_closed and line.points.shape == (len(line.patch), 3) and line.uv.shape == (len(line.patch), 2)
            assert np.allclose(line.points @ [0, 0.6, 0.8], offset, atol=1e-13)
            assert np.allclose(np.linalg.norm(line.points, axis=1), 2, atol=1e-13)
            assert np.allclose(ball[0].evaluate(line.uv[:, 0], line.uv[:, 1]).position, line.points, atol=1e-12)
            steps = np.diff(line.points, axis=0, append=line.points[:1])
            assert np.linalg.norm(steps, axis=1).sum() == pytest.approx(line.length)
            assert not line.bridges_gap.any()
    assert repr(found) == "<Sections of 3 planes: 2 polylines, within 0.0001>"


def test_sections_along_faces_and_where_planes_touch(ball):
    found = ts.sections(box(), [0, 0, 1], [0, 0.5, 1], limit="automatic")
    assert [plane.length for plane in found] == pytest.approx([4, 4, 4])
    assert [plane.limit for plane in found] == ["above", "below", "below"]
    assert [len(plane.coplanar) for plane in found] == [1, 0, 1]
    assert ts.sections(box(), [0, 0, 1], 0, limit="below")[0].polylines == []
    touched = ts.sections(ball, [1, 0, 0], 2.0)[0]
    assert touched.polylines == [] and np.allclose(touched.contacts, [[2, 0, 0]], atol=1e-3)
    assert len(ts.sections(ball, [1, 0, 0], [])) == 0


def test_bad_sections(ball):
    for normal in ([0, 0, 0], [0, np.nan, 1]):
        with pytest.raises(ts.ArgumentError, match="normal"):
            ts.sections(ball, normal, 0.0)
    with pytest.raises(ts.ArgumentError, match=r"normal: expected shape \(3,\), found \(2, 3\)"):
        ts.sections(ball, np.ones((2, 3)), 0.0)
    with pytest.raises(ts.ArgumentError, match=r"offsets: expected a number or shape \(n,\)"):
        ts.sections(ball, [0, 0, 1], [[0.0]])
    with pytest.raises(ts.ArgumentError) as raised:
        ts.sections(ball, [0, 0, 1], [0.0, np.inf])
    assert raised.value.index == 1
    with pytest.raises(ts.ArgumentError, match="tolerance is 0"):
        ts.sections(ball, [0, 0, 1], 0.0, tolerance=0)
    with pytest.raises(ts.ArgumentError, match="limit: expected one of 'automatic', 'below', 'above', found 'left'"):
        ts.sections(ball, [0, 0, 1], 0.0, limit="left")
    with pytest.raises(ts.ArgumentTypeError, match="expected a PatchSet or a Model"):
        ts.sections([1, 2], [0, 0, 1], 0.0)


def test_the_volume_of_a_part():
    part = ts.read(model_file("bearing_block.step"))
    found = part.measure()
    corners = found.box.high - found.box.low
    assert 0 < found.volume < corners.prod() and found.volume_error < 1e-6 * found.volume
    solid = ts.Solid(part)
    assert solid.is_closed
    random = np.random.default_rng(2).uniform(found.box.low, found.box.high, (20_000, 3))
    assert solid.contains(random).mean() * corners.prod() == pytest.approx(found.volume, rel=0.03)
    slices = np.linspace(found.box.low[2], found.box.high[2], 7)[1:-1]
    assert all(plane.open_count == 0 for plane in ts.sections(part, [0, 0, 1], slices))
