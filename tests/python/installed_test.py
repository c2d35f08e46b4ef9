"""The package that `cmake --install` lays down in a prefix: what pip and importlib.metadata know of it."""

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys

import pytest

import tessera as ts

LIBRARY = pathlib.Path(os.environ["TESSERA_C_LIBRARY"])
BUILD = LIBRARY.parents[1]


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The folder of the installed package."""
    if shutil.which("cmake") is None or not (BUILD / "cmake_install.cmake").exists():
        pytest.skip("there is no build to install")
    prefix = tmp_path_factory.mktemp("prefix")
    install = ["cmake", "--install", str(BUILD), "--component", "python3-tessera", "--prefix", str(prefix)]
    subprocess.run(install, check=True, stdout=subprocess.DEVNULL)
    found = list(prefix.glob("lib/python3*/dist-packages"))
    if not found:
        pytest.skip("the build installs no package for Python")
    return found[0]


def output_of(site, *arguments):
    environment = {**os.environ, "PYTHONPATH": str(site)}
    command = [sys.executable, *arguments]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=environment, cwd=site).stdout


def test_metadata(site):
    code = (
        "import importlib.metadata as m, tessera; d = m.distribution('tessera'); "
        "print(d.version, d.metadata['Requires-Python'], d.requires, tessera.__version__, tessera.__file__)"
    )
    wanted = [ts.__version__, ">=3.9", "['numpy>=1.22']", ts.__version__, str(site / "tessera" / "__init__.py")]
    assert output_of(site, "-c", code).split() == wanted


def test_pip_lists_it(site):
    if importlib.util.find_spec("pip") is None:
        pytest.skip("there is no pip")
    listed = output_of(site, "-m", "pip", "--disable-pip-version-check", "list", "--format=freeze").split()
    assert f"tessera=={ts.__version__}" in listed
    shown = output_of(site, "-m", "pip", "--disable-pip-version-check", "show", "tessera").splitlines()
    assert f"Location: {site}" in shown and "Requires: numpy" in shown
