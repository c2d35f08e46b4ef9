"""The guide for Python, line by line."""

import doctest
import shutil

from conftest import model_file


def test_guide(sources, tmp_path, monkeypatch):
    shutil.copy(model_file("goblet.json"), tmp_path)
    monkeypatch.chdir(tmp_path)
    found = doctest.testfile(str(sources / "engine/docs/python.md"), module_relative=False, encoding="utf-8")
    assert found.failed == 0 and found.attempted > 40
    assert (tmp_path / "goblet.glb").stat().st_size > 100_000
