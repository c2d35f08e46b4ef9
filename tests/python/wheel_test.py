"""The wheel as pip installs it in a fresh environment: its tag, what it holds, and that it needs nothing else.

It is made of the library of the build that is tested.
"""

import importlib.util
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest

SOURCES = pathlib.Path(__file__).resolve().parents[2]
MODELS = SOURCES / "tools" / "models"
BUILD = pathlib.Path(os.environ["TESSERA_C_LIBRARY"]).parents[1]
HAS_CAD = (BUILD / "tools" / "tessera-cad-reader").exists()
# A user's environment, who has set nothing for this package or for the loader.
CLEAN = {
    name: value
    for name, value in os.environ.items()
    if not name.startswith(("TESSERA_", "PYTHON")) and name != "LD_LIBRARY_PATH"
}


def output_of(*command, **options):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=CLEAN, **options).stdout


@pytest.fixture(scope="module")
def python(tmp_path_factory):
    """The interpreter of an environment in which the package is installed."""
    for tool in ("patchelf", "strip", "ldd", "nm"):
        if shutil.which(tool) is None:
            pytest.skip(f"there is no {tool}")
    for module in ("ensurepip", "pip", "setuptools", "wheel"):
        if importlib.util.find_spec(module) is None:
            pytest.skip(f"there is no Python module {module}")
    folder = tmp_path_factory.mktemp("environment")
    output_of(sys.executable, "-m", "venv", "--system-site-packages", str(folder))
    install = [str(folder / "bin/pip"), "install", "--no-build-isolation", "--no-index", "-q"]
    environment = {**CLEAN, "TESSERA_PYTHON_PREBUILT": str(BUILD)}
    subprocess.run([*install, str(SOURCES / "tools/python")], env=environment, check=True)
    yield folder / "bin/python"
    shutil.rmtree(folder)


@pytest.fixture(scope="module")
def site(python):
    (found,) = python.parents[1].glob("lib/python3*/site-packages/tessera")
    return found.parent


def test_one_wheel_for_every_python(site):
    (metadata,) = site.glob("tessera-*.dist-info")
    assert re.search(r"^Tag: py3-none-linux_\w+$", (metadata / "WHEEL").read_text(), re.M)
    package = {file.name for file in (site / "tessera").iterdir()}
    assert {"__init__.py", "py.typed", "view.html", "live.js", "lib"} <= package
    assert not list((SOURCES / "tools/python").glob("*.egg-info")) and not (SOURCES / "tools/python/build").exists()


def test_every_library_has_its_licence(site):
    (folder,) = site.glob("tessera-*.dist-info/licenses")
    texts = {file.name: file.read_text(encoding="utf-8") for file in folder.iterdir()}
    assert "Apache License" in texts["tessera.txt"] and "Version 2.0" in texts["Apache-2.0"]
    for source, package in (("onetbb", "libtbb"), ("embree", "libembree"), ("xsimd", "libxsimd")):
        assert re.search(rf"^{source} \S+ \({package}", texts["SOURCES.txt"], re.M)
        assert any(name.startswith(package) for name in texts)
    if HAS_CAD:
        (occt,) = (text for name, text in texts.items() if name.startswith("libocct-foundation"))
        assert "Open CASCADE exception" in occt and "Version 2.1" in texts["LGPL-2.1"]


def test_libraries_are_inside_under_their_own_names(site):
    lib = site / "tessera/lib"
    for name in ["libtessera_c.so"] + ["tessera-cad-reader"] * HAS_CAD:
        found = output_of("ldd", str(lib / name))
        assert "not found" not in found and re.search(r"libtbb-tessera\.so", found)
        others = [line.split()[0] for line in found.splitlines() if str(lib) not in line]
        of_the_system = r"linux-vdso|/lib\S*/ld-linux|lib(c|m|z|dl|rt|pthread|stdc\+\+|gcc_s)\.so"
        assert all(re.match(of_the_system, other) for other in others), others
    assert re.search(r"libembree\d*-tessera\.so", output_of("ldd", str(lib / "libtessera_c.so")))
    symbols = output_of("nm", "-D", "--defined-only", str(lib / "libtessera_c.so"))
    names = [line.split()[-1] for line in symbols.splitlines()]
    assert len(names) > 30 and all(name.startswith(("tsr_", "TSR_0")) for name in names)


USE = """
import json, pathlib, sys
import tessera as ts
import numpy as np
models = pathlib.Path(sys.argv[1])
patches = ts.read(models / "goblet.json").patches()
hits = patches.rays().closest([0, -10, 2], [0, 1, 0])
mesh = patches.tessellate(1e-3)
found = {"file": ts.__file__, "patches": len(patches), "is_hit": bool(hits.is_hit), "proven": mesh.is_certified}
if sys.argv[2:] == ["cad"]:
    found["unit"] = ts.read(models / "bearing_block.step", step_reader="opencascade").unit
maps = pathlib.Path("/proc/self/maps").read_text().splitlines()
found["libraries"] = sorted({line.split()[-1] for line in maps if ".so" in line})
print(json.dumps(found))
"""


def test_it_works_in_another_folder(python, site, tmp_path):
    found = json.loads(output_of(str(python), "-c", USE, str(MODELS), *["cad"] * HAS_CAD, cwd=tmp_path))
    assert pathlib.Path(found["file"]) == site / "tessera/__init__.py"
    assert (found["patches"], found["is_hit"], found["proven"]) == (44, True, True)
    assert found.get("unit") == ("mm" if HAS_CAD else None)
    for name in ("libtessera_c", "libtbb", "libembree"):
        of_name = [file for file in found["libraries"] if pathlib.Path(file).name.startswith(name)]
        assert of_name and all(pathlib.Path(file).parent == site / "tessera/lib" for file in of_name)


@pytest.mark.parametrize("first", ["tessera", "open3d"])
def test_beside_the_libraries_of_open3d(python, tmp_path, first):
    program = SOURCES / "tools/python/tests/beside_open3d.py"
    if subprocess.run([str(python), "-c", "import open3d"], env=CLEAN, stderr=subprocess.DEVNULL).returncode != 0:
        pytest.skip("there is no Open3D")
    libraries = output_of(str(python), str(program), first, str(MODELS / "goblet.json"), cwd=tmp_path).split()
    assert sum(name.startswith("libtbb") for name in libraries) >= 2, libraries
    assert sum(name.endswith("-tessera.so") or "-tessera.so." in name for name in libraries) == 2, libraries
