"""The view of notebooks: what it holds, and its size."""

import base64
import gzip
import html
import html.parser
import json
import os
import pathlib
import re
import struct
import time
import zlib

import numpy as np
import pytest

import browser
import tessera as ts
from conftest import wavy
from tessera import live


def data_of(text):
    page = html.unescape(re.search(r'srcdoc="([^"]*)"', text)[1])
    return page, json.loads(re.search(r"const data = (\{.*\});", page)[1])


def test_a_view_holds_the_mesh(goblet):
    mesh = goblet.patches().tessellate(1e-2)
    page, data = data_of(mesh._repr_html_())
    faces = np.frombuffer(base64.b64decode(data["faces"]), np.uint16).reshape(-1, 3)
    assert (faces == mesh.faces).all() and data["count"] == faces.size and not data["wide"]
    positions = np.frombuffer(base64.b64decode(data["positions"]), np.uint16).reshape(-1, 3)
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    assert np.abs(low + positions / 65535.0 * (high - low) - mesh.vertices).max() < 1e-4
    x, y = np.frombuffer(base64.b64decode(data["normals"]), np.int8).reshape(-1, 2).T / 127
    z = 1 - np.abs(x) - np.abs(y)
    below = z < 0
    x, y = (
        np.where(below, (1 - np.abs(y)) * np.where(x < 0, -1, 1), x),
        np.where(below, (1 - np.abs(x)) * np.where(y < 0, -1, 1), y),
    )
    normals = np.stack([x, y, z], axis=1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    assert np.abs(normals - mesh.normals).max() < 3e-2
    assert "Mesh " in page and "http" not in page and "@" not in page.split("<script>")[0]


def faces_in(shown):
    """The triangles of a view and its picture, which is no blank."""
    _, data = data_of(shown._repr_html_())
    assert len(shown._repr_png_()) > 1200
    return data["count"] // 3


def test_surfaces_scenes_and_assemblies_are_shown(goblet):
    wide = ts.model(ts.Spline(wavy(1, 1)[0]), ts.Spline(wavy(1, 1)[0] + [5, 0, 0]))
    both = faces_in(wide)
    assert 0 < faces_in(wide[0]) < both and faces_in(wide[0]) + faces_in(wide[1]) == both
    assert faces_in(goblet.patches().rays()) == faces_in(goblet)
    assembly = goblet.tessellate(tolerance=1e-2)
    assert faces_in(assembly) == len(assembly.meshes[0].faces)


def test_fifty_thousand_triangles_take_two_megabytes_at_most(goblet):
    patches = goblet.patches()
    mesh = patches.tessellate(max_triangles=50_000)
    assert 40_000 < len(mesh.faces) <= 50_000
    assert len(mesh._repr_html_()) <= 2_000_000
    # The most vertices that a mesh can have, with indices of four bytes.
    cells = ts.bezier(wavy(158, 158, 1)).patches().tessellate(rates=1)
    assert len(cells.faces) > 49_000 and len(cells.vertices) == 2 * len(cells.faces)
    assert 1_000_000 < len(cells._repr_html_()) <= 2_000_000


def test_larger_meshes_are_shown_with_fewer_triangles(goblet):
    mesh = goblet.patches().tessellate(1e-4)
    assert len(mesh.faces) > 100_000
    page, data = data_of(mesh._repr_html_())
    assert data["count"] <= 150_000 and f"{len(mesh.faces):,} triangles" in page and "shown with" in page


def test_sets_of_more_patches_than_triangles_are_simplified():
    for patches in (ts.bezier(wavy(170, 170, 1)).patches(), ts.bezier(1e6 + wavy(170, 170, 1)).patches()):
        for shown in (patches, patches.tessellate(rates=2)):
            text = shown._repr_html_()
            page, data = data_of(text)
            assert 30_000 < data["count"] / 3 <= 50_000 and "shown simplified" in page and len(text) <= 2_000_000
            assert max(data["half_size"]) < 0.71  # the box of the field, and its slightly smaller simplification


def test_views_of_small_things():
    triangle = ts.bezier([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 0, 0]]]).patches().tessellate(rates=1)
    page, data = data_of(triangle._repr_html_())
    assert data["count"] == 3 and " 1 triangle, " in page
    data_of(ts.bezier(np.zeros((2, 2, 3)))._repr_html_())


def test_a_part_is_shown_soon(sources):
    """At a distance that suits the view, and not at the smallest one of so many triangles, which must be searched."""
    patches = ts.read(str(sources / "tools/models/trimmed_torus.json")).patches()
    _, data = data_of(patches._repr_html_())
    assert 1_000 < data["count"] / 3 < 20_000


def test_views_of_models_sets_and_meshes_without_normals(goblet):
    assert "PatchSet 44 patches" in data_of(goblet._repr_html_())[0]
    shared = goblet.patches().tessellate(1e-2, share_vertices=True, quads=True)
    assert data_of(shared._repr_html_())[1]["count"] == 3 * len(shared.triangles())


def test_names_cannot_leave_the_frame():
    model = ts.bezier([[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 1]]], name='"><script>alert(1)</script>')
    text = model._repr_html_()
    assert text.count("<script>") == 0 and text.count("<") == 5  # div, img, iframe and two ends
    assert text.startswith("<div ") and text.endswith("</iframe></div>")


def test_two_views_on_one_page_stay_apart(goblet, trimmed):
    class Page(html.parser.HTMLParser):
        def __init__(self):
            super().__init__()
            self.tags = []

        def handle_starttag(self, tag, attributes):
            self.tags.append((tag, dict(attributes)))

    page = Page()
    page.feed(goblet._repr_html_() + trimmed._repr_html_() + goblet._repr_html_())
    # Each view is a frame without an origin: the page has no ids, names or scripts of it, and no access to it.
    assert [tag for tag, _ in page.tags] == ["div", "img", "iframe"] * 3
    frames = [attributes for tag, attributes in page.tags if tag == "iframe"]
    for attributes in frames:
        assert attributes.keys() == {"srcdoc", "sandbox", "title", "style"} and attributes["sandbox"] == "allow-scripts"
    first, second, third = (attributes["srcdoc"] for attributes in frames)
    assert first == third != second


def pixels_of(png):
    """The pixels of a PNG of the picture, [row][column][3]."""
    assert png.startswith(b"\x89PNG\r\n\x1a\n")
    at, body = 8, b""
    while at < len(png):
        length, kind = struct.unpack(">I4s", png[at : at + 8])
        data = png[at + 8 : at + 8 + length]
        assert struct.unpack(">I", png[at + 8 + length : at + 12 + length])[0] == zlib.crc32(kind + data)
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", data[:10])
        body += data if kind == b"IDAT" else b""
        at += 12 + length
    assert (depth, colour) == (8, 2)
    return unfiltered(np.frombuffer(zlib.decompress(body), np.uint8).reshape(height, 1 + 3 * width))


def unfiltered(lines):
    """The pixels [row][column][3] of the lines of a PNG, by its five filters (RFC 2083, 6)."""
    above = np.zeros((lines.shape[1] // 3, 3), np.int64)
    rows = []
    for line in lines:
        row = line[1:].reshape(-1, 3).astype(np.int64)
        if line[0] == 1:
            row = np.cumsum(row, axis=0)
        elif line[0] == 2:
            row += above
        elif line[0] > 2:
            left, corner = np.zeros(3, np.int64), np.zeros(3, np.int64)
            for column, up in enumerate(above):
                guess = (left + up) // 2
                if line[0] == 4:
                    to_left, to_up, to_corner = (np.abs(left + up - corner - each) for each in (left, up, corner))
                    guess = np.where((to_left <= to_up) & (to_left <= to_corner), left, corner)
                    guess = np.where((to_up < to_left) & (to_up <= to_corner), up, guess)
                row[column] = left = (row[column] + guess) & 255
                corner = up
        above = row & 255
        rows.append(above)
    return np.array(rows, np.uint8)


def test_a_picture_shows_a_sphere():
    pixels = pixels_of(ts.sphere(3, (1e5, 0, 7))._repr_png_())
    rows, columns = np.nonzero((pixels < 250).any(axis=2))
    height, width, _ = pixels.shape
    radius = 0.45 * height
    assert len(rows) == pytest.approx(np.pi * radius**2, rel=0.02)
    assert np.hypot(rows - height / 2, columns - width / 2).max() < radius + 2
    blue, red = pixels[height // 2, width // 2, 2], pixels[height // 2, width // 2, 0]
    assert blue > red  # the front
    # Light comes from above.
    assert pixels[height // 4, width // 2].sum() > pixels[3 * height // 4, width // 2].sum()


def test_a_picture_hides_what_lies_behind():
    above, below = ts.plane((0, 0, 0.3), name="above"), ts.plane((0, 0, 0), (0, 1, 0), (1, 0, 0), name="below")
    for order in ((above, below), (below, above)):
        pixels = pixels_of(ts.model(*order)._repr_png_()).astype(int)
        is_blue = pixels[..., 2] > pixels[..., 0] + 20
        is_orange = pixels[..., 0] > pixels[..., 2] + 20
        # The upper square is whole; of the lower one, a part is seen beneath it.
        assert is_blue.sum() > 1.5 * is_orange.sum() > 3000
        assert np.nonzero(is_blue)[0].mean() < np.nonzero(is_orange)[0].mean()


def test_z_is_up():
    pixels = pixels_of(ts.cone(1, 3)._repr_png_())
    is_cone = (pixels < 250).any(axis=2)
    assert is_cone[: len(pixels) // 3].sum() < is_cone[-len(pixels) // 3 :].sum() / 2


def test_pictures_of_nothing_and_of_too_much():
    assert (pixels_of(ts.Mesh()._repr_png_()) == 255).all()
    assert (pixels_of(ts.bezier(np.zeros((2, 2, 3)))._repr_png_()) == 255).all()
    flat = ts.bezier([[[0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 1, 0]]])  # without area
    assert pixels_of(flat._repr_png_()).mean() > 250
    # 3,000 large sheets, one behind the other, each of which covers a third of the picture.
    points = np.zeros((3000, 2, 2, 3))
    points[:, 1, :, 0] = points[:, :, 1, 1] = 1
    points[..., 2] = np.linspace(0, 0.1, 3000)[:, None, None]
    pixels = pixels_of(ts.bezier(points)._repr_png_())
    assert 0.2 < (pixels < 250).any(axis=2).mean() < 0.6


def test_notebooks_get_both(goblet):
    for shown in (goblet, goblet.patches(), goblet.patches().tessellate(1e-2)):
        bundle = shown._repr_mimebundle_()
        assert bundle["text/plain"] == repr(shown) and bundle["text/html"] == shown._repr_html_()
        png = base64.b64decode(bundle["image/png"])
        assert png == shown._repr_png_() and 2_000 < len(png) < 60_000
        assert bundle["image/png"] in bundle["text/html"]


def live_data_of(text):
    page = html.unescape(re.search(r'srcdoc="([^"]*)"', text)[1])
    return json.loads(re.search(r"const data = (\{.*\});", page)[1])


def unpacked(text):
    return gzip.decompress(base64.b64decode(text))


@pytest.fixture
def module(tmp_path, monkeypatch):
    """A package for JavaScript that is no more than its names."""
    (tmp_path / "src").mkdir()
    (tmp_path / "tessera.wasm").write_bytes(b"\0asm")
    (tmp_path / "index.js").write_text("import { a } from './src/a.js';\nexport { a };\n")
    (tmp_path / "src/a.js").write_text("import '../index.js';\nexport { b as a } from \"./b.js\";\n")
    (tmp_path / "src/b.js").write_text("export const b = 'from ./c.js';\n")
    (tmp_path / "src/unused.js").write_text("let c;\n")
    monkeypatch.setenv("TESSERA_NPM", str(tmp_path))
    live.packed_module.cache_clear()
    yield tmp_path
    live.packed_module.cache_clear()


def test_a_live_view_holds_the_library_and_the_file(module, sources, tmp_path):
    path = sources / "tools/models/bearing_block.step"
    view = ts.read(path).view(live=True)
    text, png = view._repr_html_(), view._repr_png_()
    data = live_data_of(text)
    assert unpacked(data["module"]) == b"\0asm" and data["name"] == "bearing_block.step" and data["join"] == []
    assert unpacked(data["file"]) == path.read_bytes()
    scripts = json.loads(unpacked(data["scripts"]))
    assert scripts.keys() == {"index.js", "src/a.js", "src/b.js"}
    assert scripts["index.js"].startswith("import { a } from 'tessera/src/a.js';")
    assert scripts["src/a.js"] == "import 'tessera/index.js';\nexport { b as a } from \"tessera/src/b.js\";\n"
    assert pixels_of(png).min() < 200 and base64.b64encode(png).decode() in text
    bundle = view._repr_mimebundle_()
    assert bundle["text/html"] == text and bundle["image/png"] == base64.b64encode(png).decode()
    assert bundle["text/plain"].startswith("<LiveView of Model 78 surfaces")
    view.save(tmp_path / "block.html")
    page = (tmp_path / "block.html").read_text(encoding="utf-8")
    assert page.startswith("<!doctype html>") and html.escape(page) in text and "@" not in page.split("<script>")[0]


def test_live_views_of_other_models(module, tmp_path):
    joined = ts.sphere(name="</script><b>").join(0.25).join(0.5)
    text = joined.view(live=True)._repr_html_()
    data = live_data_of(text)
    page = html.unescape(re.search(r'srcdoc="([^"]*)"', text)[1])
    assert data["join"] == [0.25, 0.5] and page.count("</script>") == 1 and page.count("<b>") == 0
    shown = ts.read(unpacked(data["file"]), format="json")
    assert shown.names == ["</script><b>"] and np.allclose(shown.bounds, joined.bounds)
    text = '{"format": "tessera", "version": 1, "surfaces": [{"kind": "sphere", "radius": 2}]}'
    data = live_data_of(ts.parse(text, name="text").view(live=True)._repr_html_())
    assert (data["name"], data["format"], unpacked(data["file"])) == ("text", "json", text.encode())
    # A file that has changed is no longer the model's.
    path = tmp_path / "ball.json"
    path.write_text(text)
    for change in (lambda: path.write_text(text + "\n"), path.unlink):
        model = ts.read(path)
        change()
        data = live_data_of(model.view(live=True)._repr_html_())
        assert data["name"] == "model.json" and len(ts.read(unpacked(data["file"]), format="json")) == 1


def test_live_views_of_files_that_browsers_cannot_read(module, tmp_path, monkeypatch):
    """The view holds the model that OpenCASCADE has read, with its parts, unit and edges."""
    part = ts.read(pathlib.Path(__file__).parents[2] / "models/bearing_block.step")
    path = tmp_path / "block.igs"
    path.write_bytes(part._cad_bytes())
    data = live_data_of(ts.read(path).view(live=True)._repr_html_())
    monkeypatch.setenv("TESSERA_CAD_READER", "/nowhere/reader")
    shown = ts.read(unpacked(data["file"]), format="igs")
    assert (data["name"], data["join"], shown.unit) == ("block.igs", [], part.unit)
    assert repr(shown).split(":")[0] == repr(part).split(":")[0] and len(shown.instances) == len(part.instances) > 1


def test_live_views_without_the_module_say_so(tmp_path, monkeypatch, goblet):
    monkeypatch.setenv("TESSERA_NPM", str(tmp_path))
    live.packed_module.cache_clear()
    with pytest.raises(ts.UnsupportedError, match=r"needs tessera\.wasm.*cmake --preset wasm.*TESSERA_NPM"):
        goblet.view(live=True)
    assert goblet.view() is goblet


PACKAGE = pathlib.Path(os.environ.get("TESSERA_NPM") or pathlib.Path(__file__).parents[3] / "build/wasm/npm")


def shares_of(png):
    """The shares of coloured pixels and of brass ones in a picture of a page."""
    red, green, blue = pixels_of(png)[5:400].astype(int).transpose(2, 0, 1)
    return (np.maximum(red, blue) - green > 15).mean(), (red > blue + 40).mean()


@pytest.mark.skipif(browser.PROGRAM is None, reason="chromium is not installed")
@pytest.mark.parametrize("is_live", [False, True])
def test_a_browser_shows_the_view(sources, tmp_path, is_live):
    if is_live and not (PACKAGE / "tessera.wasm").exists():
        pytest.skip("tessera.wasm is not built")
    live.packed_module.cache_clear()
    view = ts.read(sources / "tools/models/bearing_block.step").view(live=is_live)
    text = view._repr_html_().replace("<img ", "<img hidden ", 1)  # the frame alone
    path = tmp_path / "view.html"
    path.write_text("<!doctype html><body style='margin: 0'>" + text, encoding="utf-8")
    with browser.Browser(tmp_path / "profile") as chromium:
        chromium.open(path.as_uri())
        end = time.monotonic() + 30
        coloured = brass = 0
        while coloured < 0.05 and time.monotonic() < end:
            time.sleep(0.2)
            png = chromium.picture()
            coloured, brass = shares_of(png)
    (tmp_path / "view.png").write_bytes(png)
    assert coloured > 0.05
    assert (brass > 0.01) == is_live  # the live view alone has the colours of parts
