"""Copies the libraries that programs are linked with beside them, with their licences: for the wheel and the archive.

python3 libraries.py PREFIX does so for an installation, which then runs wherever it lies.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys

SOURCES = pathlib.Path(__file__).resolve().parents[2]
# Every machine has these; a second C++ library in one process does harm.
OF_THE_SYSTEM = re.compile(r"ld-linux|linux-vdso|lib(c|m|dl|rt|pthread|stdc\+\+|gcc_s|z)\.so")
HEADERS = {"libxsimd-dev", "nlohmann-json3-dev"}  # the packages whose headers are compiled into the library


def needed_by(file):
    """Returns the libraries that a file is linked with, by name, without those of every system."""
    found = subprocess.run(["ldd", str(file)], check=True, stdout=subprocess.PIPE, text=True).stdout
    libraries = dict(re.findall(r"^\s*(\S+) => (/\S+)", found, re.M))
    return {name: path for name, path in libraries.items() if not OF_THE_SYSTEM.match(name)}


def copy_libraries(files, folder, new_name=str):
    """Copies what the files need into a folder, where they then find it. Returns where the libraries lay."""
    needed = {name: path for file in files for name, path in needed_by(file).items()}
    libraries = {name: path for name, path in needed.items() if pathlib.Path(path).parent != folder}
    names = {name: new_name(name) for name in libraries}
    files = [*files, *(pathlib.Path(shutil.copy(path, folder / names[name])) for name, path in libraries.items())]
    for file in files:
        file.chmod(0o755)
        subprocess.run(["strip", "--strip-unneeded", str(file)], check=True)
        print_needed = ["patchelf", "--print-needed", str(file)]
        needed = subprocess.run(print_needed, check=True, stdout=subprocess.PIPE, text=True).stdout.split()
        # patchelf 0.14 mixes up the names of several kinds of changes in one call.
        changes = [part for name in needed if name in names for part in ("--replace-needed", name, names[name])]
        soname = ["--set-soname", file.name] if file.name in names.values() else []
        place = ("$ORIGIN/" + os.path.relpath(folder, file.parent)).removesuffix("/.")
        for change in filter(None, (changes, soname, ["--set-rpath", place])):
            subprocess.run(["patchelf", *change, str(file)], check=True)
    return sorted(os.path.realpath(path) for path in libraries.values())


def write_licences(folder, libraries, headers=HEADERS):
    """Writes what Debian's packages say about the licences of libraries, and the texts that they refer to."""
    folder.mkdir(exist_ok=True)
    shutil.copy(SOURCES / "LICENSE", folder / "tessera.txt")
    if shutil.which("dpkg-query") is None:
        message = "libraries.py: this is not Debian: of the licences only Tessera's is copied; do not pass the result on"
        print(message, file=sys.stderr)
        return
    owned = subprocess.run(["dpkg-query", "-S", *libraries], check=True, stdout=subprocess.PIPE, text=True).stdout
    packages = sorted({line.split(":")[0] for line in owned.splitlines()} | headers)
    for package in packages:
        text = pathlib.Path("/usr/share/doc", package, "copyright").read_text(encoding="utf-8")
        (folder / f"{package}.txt").write_text(text, encoding="utf-8")
        for name in re.findall(r"/usr/share/common-licenses/([\w.-]*\w)", text):
            shutil.copy(pathlib.Path("/usr/share/common-licenses", name), folder)
    query = ["dpkg-query", "-W", "-f", "${source:Package} ${source:Version} (${Package})\n", *packages]
    sources = subprocess.run(query, check=True, stdout=subprocess.PIPE, text=True).stdout
    (folder / "SOURCES.txt").write_text(f"Sources of the libraries, at https://snapshot.debian.org:\n\n{sources}")


def main():
    prefix = pathlib.Path(sys.argv[1]).resolve()
    (library,) = prefix.glob("lib/**/libtessera_c.so.0")
    files = [file for file in library.parent.glob("*.so*") if not file.is_symlink()]
    files += [*prefix.glob("bin/*"), *prefix.glob("libexec/tessera/*")]
    libraries = copy_libraries(files, library.parent)
    write_licences(prefix / "share" / "licenses" / "tessera", libraries, HEADERS | {"libcli11-dev"})


if __name__ == "__main__":
    main()
