"""Models: where they come from, their names, shapes and points."""

import gzip
import io
import pickle

import numpy as np
import pytest

import tessera as ts
from conftest import model_file, wavy


def test_names_and_kinds(goblet):
    assert goblet.names == ["goblet"] and len(goblet) == 1
    surface = goblet["goblet"]
    assert surface.kind == "NURBS surface" and surface.index == 0 and surface.loops == 0
    assert surface.domain.shape == (2, 2) and surface.domain[0].tolist() == [0, 1]
    assert [each.name for each in goblet] == ["goblet"]
    assert "'goblet'" in repr(goblet) and "NURBS" in repr(surface)


def test_unknown_names_say_which_there_are(goblet):
    with pytest.raises(KeyError, match="'bowl'; there is 'goblet'"):
        goblet["bowl"]
    with pytest.raises(IndexError, match="there is no surface 1, the model has 1"):
        goblet[1]
    assert goblet[-1].name == "goblet"


def test_a_sphere_of_nurbs_is_round():
    model = ts.read(model_file("sphere.json"))
    surface = model[0]
    u = np.linspace(*surface.domain[0], 7)[1:-1, None]
    v = np.linspace(*surface.domain[1], 9)[1:-1]
    jets = surface.evaluate(u, v, derivatives=2)
    assert jets.position.shape == (5, 7, 3)
    centre = model.patches().box.mean(axis=0)
    radius = np.linalg.norm(jets.position - centre, axis=-1)
    assert np.ptp(radius) < 1e-14 * radius.max() * 10
    assert np.allclose(jets.gaussian, 1 / radius**2, rtol=1e-9)
    assert np.allclose(np.abs(jets.mean), 1 / radius, rtol=1e-9)


def test_bezier_is_the_bernstein_sum():
    points = wavy(1, 1)[0]
    model = ts.bezier(points, name="wave")
    u, v = np.random.default_rng(1).random((2, 50))
    jets = model["wave"].evaluate(u, v, derivatives=1)
    binomial = np.array([1, 3, 3, 1])
    powers = np.arange(4)
    bu, bv = (binomial * t[:, None] ** powers * (1 - t[:, None]) ** (3 - powers) for t in (u, v))
    wanted = np.einsum("ni,nj,ijc->nc", bu, bv, points)
    assert np.allclose(jets.position, wanted, rtol=0, atol=1e-14)
    step = 1e-6
    ahead = model[0].evaluate(u + step, v).position
    assert np.allclose((ahead - jets.position) / step, jets.du, atol=1e-5)


def test_nurbs_equals_its_bezier():
    points, weights = wavy(1, 1)[0], np.full((4, 4), 2.0)
    knots = [0, 0, 0, 0, 1, 1, 1, 1]
    spline = ts.nurbs(degree=(3, 3), knots=(knots, knots), points=points, weights=weights)
    patch = ts.bezier(points, weights)
    at = np.linspace(0, 1, 9)
    assert np.allclose(spline[0].evaluate(at, at).position, patch[0].evaluate(at, at).position, atol=1e-14)


def test_many_patches_and_several_splines():
    assert len(ts.bezier(wavy(3, 4))) == 12
    model = ts.model(ts.Spline(wavy(1, 1)[0], name="a"), ts.Spline(wavy(1, 1, 2)[0], name="b"))
    assert model.names == ["a", "b"]
    assert model.patches()[1].degree == (2, 2)
    at_b = model["b"].evaluate(0.5, 0.5).position
    assert np.allclose(at_b, ts.bezier(wavy(1, 1, 2)[0])[0].evaluate(0.5, 0.5).position)


def test_the_caller_may_change_its_arrays_afterwards():
    points = wavy(1, 1)[0]
    model = ts.bezier(points)
    before = pickle.loads(pickle.dumps(model))
    points[:] = 0
    copy = pickle.loads(pickle.dumps(model))
    assert (copy.patches()[0].points == before.patches()[0].points).all()


def test_shapes_and_instances():
    text = (
        '{"format": "tessera", "version": 1, "surfaces": [{"kind": "bezier", "name": "sheet", "points": '
        "[[[0,0,0],[0,1,0]],[[1,0,0],[1,1,1]]]}]}"
    )
    model = ts.parse(text)
    assert model.names == ["sheet"] and model.unit == "" and model.warnings == []
    assert model.shapes == [] and model.instances == []


def test_a_cad_file_has_shapes_at_places(tmp_path):
    model = ts.read(model_file("bearing_block.step"))
    assert model.unit == "mm" and len(model.shapes) >= 1 and len(model.instances) >= 1
    instance = model.instances[0]
    assert instance.placement.shape == (4, 4) and instance.placement[3].tolist() == [0, 0, 0, 1]
    assert len(model.patches(shape=0)) <= len(model.patches())
    assembly = model.tessellate(tolerance=0.1)
    assert len(assembly.meshes) == len(model.shapes)
    assert all(mesh.check().open_edges == 0 for mesh in assembly.meshes)
    assembly.save(tmp_path / "block.glb")
    model.save(tmp_path / "other.glb", tolerance=0.1)
    assert (tmp_path / "other.glb").read_bytes() == (tmp_path / "block.glb").read_bytes()


def test_models_of_bytes_and_of_open_files(tmp_path):
    path = model_file("goblet.json")
    with open(path, "rb") as file:
        content = file.read()
    packed = gzip.compress(content)
    wanted = ts.read(path).patches()[3].points
    sources = [(kind(content), "json") for kind in (bytes, bytearray, memoryview, io.BytesIO)]
    for source, format in [*sources, (packed, "json.gz"), (io.BytesIO(packed), ".json.gz")]:
        model = ts.read(source, format=format)
        assert (model.patches()[3].points == wanted).all()
        assert (pickle.loads(pickle.dumps(model)).patches()[3].points == wanted).all()
    with open(path, "rb") as file:  # its name states the format
        assert ts.read(file).names == ["goblet"]
    unnamed = tmp_path / "upload"
    unnamed.write_bytes(content)
    assert ts.read(unnamed, format=".json").names == ["goblet"]
    with pytest.raises(ts.UnsupportedError, match='bytes: unsupported format ""'):
        ts.read(content)
    with pytest.raises(ts.ArgumentError, match="bytes: .*ends within"):
        ts.read(packed[:-9], format="json.gz")
    with pytest.raises(ts.ArgumentError, match="bytes: the file is empty"):
        ts.read(b"", format="json")
    with open(path, encoding="utf-8") as file, pytest.raises(TypeError, match='mode "rb".*returned str'):
        ts.read(file)
    with pytest.raises(TypeError, match="source: expected a path, bytes or a file, found int"):
        ts.read(3)


def test_the_reader_of_step_is_chosen():
    with pytest.raises(ts.ArgumentError, match="step_reader: expected one of tessera, opencascade, either, found 'occt'"):
        ts.read(b"ISO-10303-21;", format="step", step_reader="occt")
    for reader in ("tessera", "opencascade", "either"):
        with pytest.raises(ts.Error, match="bytes: "):
            ts.read(b"ISO-10303-21;", format="step", step_reader=reader)
    with open(model_file("bearing_block.step"), "rb") as file:
        content = file.read()
    try:
        model = ts.read(gzip.compress(content), format="stpz", step_reader="opencascade")
    except ts.UnsupportedError:
        pytest.skip("there is no tessera-cad-reader")
    assert model.unit == "mm" and len(model.shapes) >= 1
    assert len(ts.read(content, format="step", step_reader="either")) == len(model)


def test_join_and_save(tmp_path):
    model = ts.bezier(wavy(2, 2))
    joined = model.join()
    assert len(joined) == 4
    model.save(tmp_path / "field.json")
    again = ts.read(tmp_path / "field.json")
    assert (again.patches()[3].points == model.patches()[3].points).all()


def test_errors_keep_code_index_and_message(tmp_path):
    points = wavy(2, 1)
    points[1, 2, 3, 0] = np.nan
    with pytest.raises(ts.ArgumentError) as caught:
        ts.bezier(points)
    error = caught.value
    assert error.code == "non_finite" and error.index == 1 and "[2][3]" in error.message
    assert isinstance(error, ValueError) and str(error) == error.message
    copy = pickle.loads(pickle.dumps(error))
    assert (copy.code, copy.index, copy.message) == (error.code, error.index, error.message)
    with pytest.raises(OSError) as caught:
        ts.read(tmp_path / "none.json")
    assert caught.value.code == "io_error"
    (tmp_path / "bad.json").write_text('{"surfaces": [')
    with pytest.raises(ValueError, match="bad.json"):
        ts.read(tmp_path / "bad.json")


@pytest.mark.parametrize(
    "change, words",
    [
        ({"degree": 0}, "degree"),
        ({"knots": ([0, 0, 1, 1], [0, 0, 1])}, "knot"),
        ({"knots": ([0, 0, 1, 1], [1, 1, 0, 0])}, "knot"),
        ({"points": [[[0, 0], [0, 1]], [[1, 0], [1, 1]]]}, r"expected shape \(nu, nv, 3\), found \(2, 2, 2\)"),
        ({"weights": [1, 1, 1, 1]}, r"weights: expected shape \(2, 2\), found \(4,\)"),
        ({"weights": [[1, 1], [1, -1]]}, "weight"),
        ({"points": [[[0, 0, 0]], [[1, 0, 0], [1, 1, 1]]]}, "several lengths"),
    ],
)
def test_bad_splines(change, words):
    knots, points = [0, 0, 1, 1], [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 1]]]
    good = {"degree": 1, "knots": (knots, knots), "points": points}
    ts.nurbs(**good)
    with pytest.raises(ts.Error, match=words):
        ts.nurbs(**{**good, **change})


def test_one_list_of_knots_holds_for_both_directions():
    points = wavy(1, 1)[0]
    knots = [0, 0, 0, 1, 2, 2, 2]
    one, two = ts.nurbs(2, knots, points), ts.nurbs(2, (knots, knots), points)
    assert (one[0].evaluate(0.3, 1.7).position == two[0].evaluate(0.3, 1.7).position).all()
    assert ts.nurbs(2, np.array(knots), points)[0].knots[1].tolist() == knots
    with pytest.raises(ts.ArgumentError, match="one per direction, found 3 lists"):
        ts.nurbs(2, [knots] * 3, points)
    with pytest.raises(TypeError, match="knots: expected one list of numbers, or one per direction, found 3"):
        ts.nurbs(2, 3, points)
    with pytest.raises(ts.ArgumentError, match=r"points: expected shape \(nu, nv, 3\), found \(\)"):
        ts.bezier(3)


def test_zero_is_no_tolerance(goblet):
    for call in (lambda: goblet.patches().rays(tolerance=0), lambda: goblet.patches(fit_tolerance=0)):
        with pytest.raises(ts.ArgumentError, match="tolerance is 0, expected a finite number above 0"):
            call()
    with pytest.raises(ts.ArgumentError, match="distance is -1, expected a finite number of 0 or more"):
        goblet.join(-1)


def test_bad_types_of_arrays():
    for bad in (np.array([[["a"] * 3] * 2] * 2), np.ones((2, 2, 3), complex), np.ones((2, 2, 3), bool)):
        with pytest.raises(TypeError, match="expected float64 numbers, found dtype"):
            ts.bezier(bad)


def test_arrays_of_other_layouts_and_types():
    points = wavy(1, 1)[0]
    wanted = ts.bezier(points)[0].evaluate(0.3, 0.6).position
    unaligned = np.frombuffer(b"x" + points.tobytes(), np.uint8)[1:].view(np.float64).reshape(points.shape)
    wide = np.zeros((4, 4, 6))
    wide[..., ::2] = points
    for other in (np.asfortranarray(points), points.astype(">f8"), unaligned, wide[..., ::2], points.tolist()):
        assert (ts.bezier(other)[0].evaluate(0.3, 0.6).position == wanted).all()


def test_models_are_pickled(goblet, tmp_path):
    copy = pickle.loads(pickle.dumps(goblet))
    assert copy.names == goblet.names
    assert (copy.patches()[7].points == goblet.patches()[7].points).all()
    text = ts.bezier(wavy(1, 1)[0])
    file = tmp_path / "moving.json"
    text.save(file)
    model = ts.read(file)
    file.write_text(file.read_text() + "\n")
    with pytest.raises(OSError, match="changed since it was read"):
        pickle.dumps(model)
    joined = pickle.loads(pickle.dumps(ts.bezier(wavy(2, 1)).join()))
    assert len(joined) == 2
