"""The tables of ctypes against the headers that they stand for."""

import ctypes
import re
import shutil
import subprocess

import pytest

from tessera import _calls, _library


@pytest.fixture
def header(sources):
    names = ("tessera_c.h", "tessera_c_files.h", "tessera_c_shapes.h", "tessera_c_queries.h")
    text = "".join((sources / "engine/include/tessera" / name).read_text() for name in names)
    return re.sub(r"/\*.*?\*/", "", text, flags=re.S)


def kind_of(argument):
    if "*" in argument:
        return "z" if re.match(r"const char\s*\*", argument) else "p"
    return {"size_t": "s", "double": "d", "int32_t": "i", "int64_t": "l", "tsr_status": "i", "uint32_t": "u", "void": "-"}[
        argument.split()[0]
    ]


def test_functions_are_those_of_the_header(header):
    found = {}
    for result, name, arguments in re.findall(r"^([\w ]+\*?) (tsr_\w+)\(([^)]*)\);", header, re.M):
        kinds = "".join(kind_of(each.strip()) for each in arguments.split(",") if each.strip() != "void")
        found[name] = kind_of(result) + kinds
    assert len(found) > 30
    assert found == _library._FUNCTIONS


def test_structs_are_those_of_the_header(header, sources, tmp_path):
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("there is no C compiler")
    assert set(re.findall(r"^} (tsr_\w+);", header, re.M)) == set(_library._STRUCTS)
    lines = [f'#include "tessera/tessera_c_{name}.h"' for name in ("files", "shapes", "queries")]
    for name in _library._STRUCTS:
        made = _library._TYPES[name]
        lines.append(f"_Static_assert(sizeof({name}) == {ctypes.sizeof(made)}, \"{name}\");")
        for field, _ in made._fields_:
            offset = getattr(made, field).offset
            lines.append(f"_Static_assert(offsetof({name}, {field}) == {offset}, \"{name}.{field}\");")
            size = getattr(made, field).size
            lines.append(f"_Static_assert(sizeof(((({name}*)0)->{field})) == {size}, \"{name}.{field}\");")
    file = tmp_path / "layout.c"
    file.write_text("\n".join(lines) + "\n")
    subprocess.run([compiler, "-std=c11", "-fsyntax-only", f"-I{sources}/engine/include", str(file)], check=True)


def test_values_are_those_of_the_header(header):
    from tessera import measures, patches, plans, points, rays, sources

    assert "TSR_MISS = 0, TSR_HIT, TSR_INVALID_RAY" in header
    assert (rays.MISS, rays.HIT, rays.INVALID_RAY) == (0, 1, 2)
    assert "TSR_NEAREST_NONE = 0, TSR_NEAREST_FOUND, TSR_NEAREST_INVALID_POINT" in header
    assert "TSR_SIDE_OUTSIDE = 0, TSR_SIDE_INSIDE, TSR_SIDE_UNKNOWN, TSR_SIDE_INVALID_POINT" in header
    assert "TSR_STEP_READER_TESSERA = 0, TSR_STEP_READER_OPENCASCADE, TSR_STEP_READER_EITHER" in header
    assert sources.STEP_READERS == ("tessera", "opencascade", "either")
    assert "TSR_LIMIT_AUTOMATIC = 0, TSR_LIMIT_BELOW, TSR_LIMIT_ABOVE" in " ".join(header.split())
    values = {name: int(value) for name, value in re.findall(r"(TSR_\w+) = (\d+)", header)}
    assert values["TSR_HIT_UNCERTIFIED"] == rays._UNCERTIFIED
    assert values["TSR_MAX_THREADS"] == _calls.MAX_THREADS
    for name in ("RELATIVE", "SHARE", "QUADS", "FEWEST", "SMALLEST", "DOUBLE", "APART"):
        assert values[f"TSR_PLAN_{name}"] == getattr(plans, f"_{name}")
    for name in ("CERTIFIED", "AMBIGUOUS", "BORDER"):
        assert values[f"TSR_NEAREST_{name}"] == getattr(points, f"_{name}")
    for name in ("AREAS", "BODIES", "BOX", "ENCLOSED"):
        assert values[f"TSR_MEASURE_{name}"] == getattr(measures, f"_{name}")
    for name in ("WHOLE", "POINTS", "DOUBLE"):
        assert values[f"TSR_SET_{name}"] == getattr(patches, f"_{name}")
