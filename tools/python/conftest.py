"""Shared by the tests and by the examples in docstrings."""

import pathlib

import numpy as np
import pytest

import tessera as ts

SOURCES = pathlib.Path(__file__).resolve().parents[2]


def model_file(name):
    return str(SOURCES / "tools" / "models" / name)


@pytest.fixture(autouse=True)
def _names_of_examples(doctest_namespace):
    doctest_namespace["goblet"] = model_file("goblet.json")


@pytest.fixture
def sources():
    return SOURCES


@pytest.fixture
def goblet():
    return ts.read(model_file("goblet.json"))


@pytest.fixture
def trimmed():
    return ts.read(model_file("trimmed_torus.json"))


def wavy(rows, columns, degree=3):
    """Bezier patches [patch, i, j, 3] of z = sin(x) cos(y), side by side."""
    steps = np.arange(degree + 1) / degree
    u, v = np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij")
    x = u.reshape(-1, 1, 1) + steps[None, :, None] + 0 * steps
    y = v.reshape(-1, 1, 1) + 0 * steps[None, :, None] + steps
    return np.stack([x, y, np.sin(x) * np.cos(y)], axis=-1)
