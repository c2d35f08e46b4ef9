"""Builds the wheel: the C library, the reader of CAD files, and the libraries that they need.

TESSERA_PYTHON_BUILD names the folder of the build [build/python]; TESSERA_PYTHON_PREBUILT one that is built already.
TESSERA_NPM names the folder of the package for JavaScript [build/wasm/npm], which live views need: the wheel has them
if the folder is there, and is then 1.6 MB larger.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py
from wheel.bdist_wheel import bdist_wheel

sys.dont_write_bytecode = True  # nothing is written among the sources
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from libraries import SOURCES, copy_libraries, write_licences  # noqa: E402

PREBUILT = os.environ.get("TESSERA_PYTHON_PREBUILT")
BUILD = pathlib.Path(PREBUILT or os.environ.get("TESSERA_PYTHON_BUILD", SOURCES / "build" / "python"))


NPM = pathlib.Path(os.environ.get("TESSERA_NPM") or SOURCES / "build" / "wasm" / "npm")


def version():
    text = (SOURCES / "engine/include/tessera/version.h").read_text()
    return re.search(r'#define TESSERA_VERSION "([^"]+)"', text)[1]


def built():
    """Builds the library and, where OpenCASCADE is found, the reader of CAD files. Returns their files."""
    files = [BUILD / "engine" / "libtessera_c.so", BUILD / "tools" / "tessera-cad-reader"]
    if not PREBUILT:
        build()
    return [file for file in files if file.exists()]


def build():
    options = {"CMAKE_BUILD_TYPE": "Release", "TESSERA_BUILD_CAD_READER": "AUTO"}
    options.update((f"TESSERA_BUILD_{part}", "OFF") for part in ("TESTS", "BENCH", "TOOLS"))
    configure = ["cmake", "-S", str(SOURCES), "-B", str(BUILD)]
    configure += [f"-D{name}={value}" for name, value in options.items()]
    if shutil.which("ninja") and not (BUILD / "CMakeCache.txt").exists():
        configure += ["-G", "Ninja"]
    subprocess.run(configure, check=True)
    jobs = str(os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", os.cpu_count()))
    for target in ("tessera_c_library", "tessera_cad_reader"):
        if target == "tessera_c_library" or has_target(target):
            subprocess.run(["cmake", "--build", str(BUILD), "--parallel", jobs, "--target", target], check=True)


def has_target(name):
    helped = subprocess.run(["cmake", "--build", str(BUILD), "--target", "help"], stdout=subprocess.PIPE, text=True)
    return re.search(rf"\b{name}\b", helped.stdout) is not None


def bundle(folder):
    """Fills tessera/lib, and returns the files of the libraries that it copied.

    Copies have names of their own, so that they and other libraries of a process stay apart.
    """
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    files = [pathlib.Path(shutil.copy(file, folder)) for file in built()]
    return copy_libraries(files, folder, lambda name: name.replace(".so", "-tessera.so", 1))


def bundle_npm(folder):
    """Fills tessera/npm with tessera.wasm and its scripts, where they are built."""
    shutil.rmtree(folder, ignore_errors=True)
    if not (NPM / "tessera.wasm").exists():
        print(f"setup.py: {NPM} has no tessera.wasm: the wheel has no live views", file=sys.stderr)
        return
    shutil.copytree(NPM / "src", folder / "src")
    for name in ("index.js", "package.json", "LICENSE", "tessera.wasm"):
        shutil.copyfile(NPM / name, folder / name)


class BuildWithLibrary(build_py):
    def run(self):
        super().run()
        for tool in ("cmake", "patchelf", "strip"):
            if shutil.which(tool) is None:
                raise SystemExit(f"found no program {tool}: run tools/setup.sh --for python")
        self.distribution.bundled = bundle(pathlib.Path(self.build_lib) / "tessera" / "lib")
        bundle_npm(pathlib.Path(self.build_lib) / "tessera" / "npm")


class WheelOfAnyPython(bdist_wheel):
    def get_tag(self):
        return "py3", "none", super().get_tag()[2]

    def egg2dist(self, egginfo_path, distinfo_path):
        super().egg2dist(egginfo_path, distinfo_path)
        if self.distribution.bundled is not None:  # pip asks for the metadata before it builds
            write_licences(pathlib.Path(distinfo_path, "licenses"), self.distribution.bundled)


class DistributionOfOnePlatform(Distribution):
    bundled = None  # the files of the libraries that the wheel holds

    def has_ext_modules(self):
        return True


WRITTEN = BUILD / "wheel"
WRITTEN.mkdir(parents=True, exist_ok=True)
setup(
    name="tessera",
    version=version(),
    description="Parametric surfaces to points, meshes and ray hits",
    python_requires=">=3.9",
    install_requires=["numpy>=1.22"],
    packages=["tessera"],
    package_data={"tessera": ["py.typed", "view.html", "live.js"]},
    options={"build": {"build_base": str(WRITTEN)}, "egg_info": {"egg_base": str(WRITTEN)}},
    distclass=DistributionOfOnePlatform,
    cmdclass={"build_py": BuildWithLibrary, "bdist_wheel": WheelOfAnyPython},
)
