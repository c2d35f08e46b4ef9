"""The view of notebooks: what it holds, and its size."""

import base64
import html
import html.parser
import json
import re
import struct
import zlib

import numpy as np
import pytest

import tessera as ts
from conftest import wavy


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
    lines = np.frombuffer(zlib.decompress(body), np.uint8).reshape(height, 1 + 3 * width)
    assert (lines[:, 0] == 1).all()  # each row by differences from the left
    return np.cumsum(lines[:, 1:].reshape(height, width, 3), axis=1, dtype=np.uint8)


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
