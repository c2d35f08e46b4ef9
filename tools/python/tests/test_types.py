"""Arrays that were not asked for, and what a type checker sees of the package."""

import importlib.util
import os
import pathlib
import pickle
import shutil
import subprocess
import sys

import pytest

import tessera as ts


def test_missing_arrays_say_so(goblet):
    jets = goblet[0].evaluate(0.5, 1, quantities=["mean"])
    with pytest.raises(ts.MissingError, match=r"gaussian was not asked for: .*there are mean"):
        jets.gaussian
    with pytest.raises(AttributeError, match="no attribute 'gauss'"):
        jets.gauss
    assert not hasattr(jets, "position") and hasattr(jets, "mean")
    assert pickle.loads(pickle.dumps(jets)).mean == jets.mean
    hits = goblet.patches().rays().closest([0, -9, 2], [0, 1, 0], quantities=["t"])
    with pytest.raises(ts.MissingError, match="normal was not asked for"):
        hits.normal
    with pytest.raises(ts.ArgumentError, match="is_hit needs the quantity kind"):
        hits.is_hit
    mesh = goblet.patches().tessellate(1e-2, share_vertices=True)
    for name in ("normals", "uv"):
        with pytest.raises(ts.MissingError, match=f"the mesh has no {name}: its vertices are shared"):
            getattr(mesh, name)
    copy = pickle.loads(pickle.dumps(mesh))
    assert not copy.has_normals and not copy.has_uv


USE = """
import numpy as np
import tessera as ts

model = ts.model(ts.sphere(2.0), ts.coons(*[ts.line((0, 0, 0), (1, 0, 0))] * 4))
mesh = model.patches().tessellate(tolerance=1e-3)
size: float = float(np.ptp(mesh.normals[:, 0]) + mesh.uv.max() + mesh.bounds[1, 0])
jets = model[0].evaluate(0.5, 0.5, derivatives=2)
size += float(jets.gaussian + jets.normal[0] + jets.du.sum())
hits = model.patches().rays().closest([0, 0, 9], [0, 0, -1])
size += float(hits.t + hits.position[0])
part: ts.Spline = model[0].elevate(u=1).split(v=0.5)[0]
u, v = model[0].degree
names: list[str] = [surface.name for surface in model.surfaces]
points: np.ndarray = model[0].points[u:, v:] + model[0].weights[u:, v:, None]
near = ts.PointScene(model).nearest([0, 0, 9])
size += float(near.distance + near.u.sum() + ts.Solid(model).signed_distance([0, 0, 1]) + near.certified.mean())
size += model.measure().volume + model.measure(enclosed=True).box.low[0]
length: float = ts.sections(model, [0, 0, 1], [0.0, 0.5], tolerance=1e-3)[0].polylines[0].length
wrong: str = mesh.bound
"""


def test_a_type_checker_needs_no_asserts(tmp_path):
    if importlib.util.find_spec("mypy") is None:
        pytest.skip("there is no mypy")
    (tmp_path / "use.py").write_text(USE)
    shutil.copytree(pathlib.Path(ts.__file__).parent, tmp_path / "tessera", ignore=shutil.ignore_patterns("lib"))
    command = [sys.executable, "-m", "mypy", "--strict-optional", "--ignore-missing-imports", "--no-incremental"]
    environment = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "MYPYPATH")}
    ran = subprocess.run(
        [*command, "use.py", "tessera"], cwd=tmp_path, env=environment, stdout=subprocess.PIPE, text=True
    )
    first, *rest = ran.stdout.splitlines()
    assert first.startswith("use.py:20: error: Incompatible types in assignment") and len(rest) == 1, ran.stdout
