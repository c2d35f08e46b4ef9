"""A view of a model for notebooks that makes its own meshes: Tessera as WebAssembly, within the notebook."""

from __future__ import annotations

import base64
import contextlib
import functools
import gzip
import json
import os
import pathlib
import re
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, replace

from .errors import UnsupportedError
from .view import Shown, frame_of, page_of


@dataclass(frozen=True)
class ModelFile:
    """The file that the view reads: its name without folders, its bytes, the extension that decides where that of the
    name does not, and the distances within which edges are joined then, one join after the other."""

    name: str
    content: bytes
    format: str | None = None
    join: tuple[float, ...] = ()

    def joined(self, distance: float) -> ModelFile:
        return replace(self, join=(*self.join, distance))


# Files that no browser can read: only OpenCASCADE does.
_BY_OPENCASCADE = re.compile(r"\.(iges|igs|brep|brp)(\.gz)?$", re.IGNORECASE)


class LiveView(Shown):
    """A view whose meshes are made anew for each camera, within half a pixel of the surfaces, proven.

    It needs no network: the output holds the library as WebAssembly, 2 MB, and the model's file.
    """

    def __init__(self, name: str, file: Callable[[], ModelFile], picture: Callable[[], bytes]) -> None:
        """``name``: what is shown, within brackets; ``file`` and ``picture`` are called when the view is shown."""
        self._name, self._file, self._picture = name, file, picture
        packed_module()  # which may be missing

    def _page(self) -> str:
        scripts, module = packed_module()
        file = self._file()
        data = {
            "scripts": scripts,
            "module": module,
            "name": file.name,
            "format": file.format,
            "file": _packed(file.content),
            "join": file.join,
            "title": self._name[1:-1],
        }
        script = pathlib.Path(__file__).with_name("live.js").read_text(encoding="utf-8")
        return page_of(self._name[1:-1], data, script)

    def _view(self) -> tuple[str, bytes]:
        png = self._picture()
        return frame_of(self._page(), self._name, png), png

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the view as a page of its own (.html), for everyone who has a browser."""
        pathlib.Path(path).write_text(self._page(), encoding="utf-8")

    def __repr__(self) -> str:
        return f"<LiveView of {self._name[1:-1]}>"


class WithLiveView(Shown):
    """A model, which can be shown by a live view."""

    _file: Callable[[], ModelFile] | None = None  # the file that it was read from, if there is one

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the surfaces (.json)."""
        raise NotImplementedError

    def _cad_bytes(self) -> bytes:
        """Returns a model that OpenCASCADE has read as bytes that can be read in place of its file."""
        raise NotImplementedError

    def view(self, live: bool = False) -> Shown:
        """Returns what a notebook shows: the model itself, which a notebook shows with a mesh that is stored.

        ``live``: a view that makes its meshes itself, so that one can go as near as one likes. The output holds the
        library, 2 MB, and the model's file, or the model where browsers cannot read that (IGES, BREP); models of arrays
        as their surfaces, without colours. LiveView.save() writes it as a page. Errors: UnsupportedError (this installation has no
        tessera.wasm).

        >>> import tessera as ts
        >>> ts.read(goblet).view()
        <Model 1 surface: 'goblet'>
        """
        return LiveView(repr(self), self._readable_file, lambda: self._view()[1]) if live else self

    def _readable_file(self) -> ModelFile:
        """Returns a file that browsers can read: the model's own, or the model in its place, or one of its surfaces."""
        if self._file:
            with contextlib.suppress(OSError):  # it has changed since, or is there no longer
                file = self._file()
                if not _BY_OPENCASCADE.search(f".{file.format}" if file.format else file.name):
                    return file
                return ModelFile(file.name, self._cad_bytes(), file.format)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "model.json")
            self.save(path)
            return ModelFile(path.name, path.read_bytes())


def _packed(content: bytes) -> str:
    return base64.b64encode(gzip.compress(content, 9, mtime=0)).decode()


def _package() -> pathlib.Path:
    """Returns the folder of the package for JavaScript, which has the module: the named one, or that of the wheel, or
    in the source tree the one that is built."""
    named = os.environ.get("TESSERA_NPM")
    here = pathlib.Path(__file__).resolve().parent
    places = [pathlib.Path(named)] if named else [here / "npm"]
    if not named and (here.parents[2] / "engine" / "include").is_dir():
        places.append(here.parents[2] / "build" / "wasm" / "npm")
    for place in places:
        if (place / "tessera.wasm").is_file() and (place / "index.js").is_file():
            return place
    raise UnsupportedError(
        "view(live=True) needs tessera.wasm with its scripts, which this installation has not; expected it in "
        + " or ".join(map(str, places))
        + ". Make it in Tessera's sources by cmake --preset wasm && cmake --build build/wasm --target tessera_npm, and "
        "name the folder build/wasm/npm by TESSERA_NPM. view() needs none of it",
        "unsupported",
    )


_IMPORT = re.compile(r"""(\b(?:from|import)\s*)(['"])(\.{1,2}/[^'"]+)\2""")


@functools.lru_cache(maxsize=1)
def packed_module() -> tuple[str, str]:
    """Returns the scripts, a JSON object of texts by paths, and tessera.wasm, both packed by gzip, in base64.

    Scripts name each other as tessera/PATH. Errors: UnsupportedError (they are not there).
    """
    package = _package()
    texts: dict[str, str] = {}
    wanted = ["index.js"]
    while wanted:
        path = wanted.pop()
        if path in texts:
            continue

        def named(match: re.Match[str], folder: str = os.path.dirname(path)) -> str:
            other = os.path.normpath(os.path.join(folder, match[3])).replace(os.sep, "/")
            wanted.append(other)
            return f"{match[1]}{match[2]}tessera/{other}{match[2]}"

        texts[path] = _IMPORT.sub(named, (package / path).read_text(encoding="utf-8"))
    return _packed(json.dumps(texts).encode()), _packed((package / "tessera.wasm").read_bytes())
