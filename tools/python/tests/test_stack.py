"""The modules as a stack: each imports only those before it in the table, also in functions and for annotations."""

import ast
import pathlib

import pytest

import tessera

STACK = {
    "errors": "exceptions",
    "_picture": "triangles as PNG",
    "view": "triangles as HTML",
    "live": "a view that makes its own triangles, as HTML with tessera.wasm",
    "_library": "the C library, its structs and functions",
    "_arrays": "arrays of NumPy as the library takes them",
    "_nets": "control nets of splines: knots, degrees, interpolation",
    "splines": "Spline, a surface as arrays, and its operations",
    "curves": "Curve, and lines and arcs",
    "_calls": "how calls run; Handle, the base of all objects of the library",
    "limits": "what a machine can do",
    "jets": "the output of evaluations",
    "plans": "how a set is divided: options, View",
    "meshes": "Mesh, which knows its patch set as a Handle",
    "rays": "Hits, and all of Scene but its patch set",
    "patches": "Patch, and all of PatchSet but its model and its scenes",
    "surfaces": "all of Surface but its model",
    "measures": "all of Model.measure() but its model",
    "models": "Model, PatchSet, Scene, Assembly: each returns another one, and has an attribute that leads back",
    "points": "PointScene and Solid, which are made of models, patch sets and scenes",
    "sections": "planes through models and patch sets",
    "sources": "functions that make models of files, text and arrays",
    "shapes": "functions that make models of simple surfaces",
    "__init__": "the public names",
}
FOLDER = pathlib.Path(tessera.__file__).parent


def imported_by(name):
    """The modules of the package that a module imports anywhere; "tessera" for the package itself."""
    for node in ast.walk(ast.parse((FOLDER / f"{name}.py").read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.level:
            yield from [node.module] if node.module else [alias.name for alias in node.names]
        elif isinstance(node, (ast.Import, ast.ImportFrom)):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else [node.module]
            yield from (each for each in names if each.split(".")[0] == "tessera")


def test_every_module_has_its_place():
    assert {file.stem for file in FOLDER.glob("*.py")} == STACK.keys()


@pytest.mark.parametrize("name", STACK)
def test_a_module_imports_only_those_before_it(name):
    before = list(STACK)[: list(STACK).index(name)]
    assert set(imported_by(name)) <= set(before)
