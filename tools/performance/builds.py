"""tessera_bench of a commit, of this tree, or as the user built it."""

import os
import shutil
import subprocess

from .console import Failure, say
from .repository import ROOT, WORK, commit_of, git

TARGET = "tessera_bench"


class Build:
    """A built program: `program`, its source (`commit`, None for a user's own program), and its name."""

    def __init__(self, program, label, commit=None, dirty=False):
        self.program, self.label, self.commit, self.dirty = program, label, commit, dirty


def is_program(name):
    return os.path.isfile(name) and os.access(name, os.X_OK)


def default_program(preset="dev"):
    """The program that `cmake --build --preset ...` made of this tree."""
    program = ROOT / "build" / preset / "bench" / TARGET
    if not is_program(program):
        raise Failure(f"there is no {program}: build it by 'cmake --preset {preset} && cmake --build --preset {preset} "
                      f"--target {TARGET}', or name a program by --program")
    return program


def build(name, preset="release", options=(), jobs=None, rebuild=False):
    """The build for a commit's name, this tree ('.'), or a program's path, with CMake's `options` NAME=VALUE. Builds of
    commits are kept under build/perf and used again.
    """
    if is_program(name):
        if options:
            raise Failure(f"{name} is built already: it takes no options")
        return Build(os.path.abspath(name), name)
    options = sorted(options)
    tree = name == "."
    commit = commit_of("HEAD" if tree else name)
    suffix = "".join("-" + option.replace("/", "_") for option in options)
    label = ("this tree" if tree else name) + (" with " + ", ".join(options) if options else "")
    source = ROOT if tree else WORK / "commits" / commit[:12]
    folder = source / "build" / (("perf-" if tree else "") + preset + suffix)  # at the depth of others, for ccache
    program = folder / "bench" / TARGET
    if tree or rebuild or not is_program(program):
        if not tree:
            check_out(commit, source)
        compile_in(source, folder, preset, options, jobs, label)
        if not is_program(program):
            raise Failure(f"{label}: the build made no {TARGET}")
    else:
        say(f"{label}: built before, in {folder.relative_to(ROOT)}")
    return Build(program, label, commit, tree)


def check_out(commit, source):
    if (source / "CMakeLists.txt").is_file():
        return
    git("worktree", "prune")
    source.parent.mkdir(parents=True, exist_ok=True)
    git("worktree", "add", "--force", "--detach", str(source), commit)


def compile_in(source, folder, preset, options, jobs, label):
    environment = dict(os.environ)
    if "CMAKE_CXX_COMPILER_LAUNCHER" not in environment and shutil.which("ccache"):
        environment["CMAKE_CXX_COMPILER_LAUNCHER"] = "ccache"
    environment["CCACHE_BASEDIR"], environment["CCACHE_NOHASHDIR"] = str(source), "1"
    if any(option.startswith("TESSERA_PLANT_SLOWDOWN=") for option in options):
        options = [*options, "TESSERA_INSTALL=OFF"]  # a slowed-down build must not be installed
    folder.parent.mkdir(parents=True, exist_ok=True)
    log = folder.parent / (folder.name + ".log")
    commands = (["cmake", "--preset", preset, "-S", str(source), "-B", str(folder), *("-D" + o for o in options)],
                ["cmake", "--build", str(folder), "--target", TARGET, *(["-j", str(jobs)] if jobs else [])])
    say(f"{label}: builds in {folder}")
    with open(log, "w", encoding="utf-8") as output:
        for command in commands:
            try:
                done = subprocess.run(command, cwd=source, env=environment, stdout=output, stderr=subprocess.STDOUT,
                                      check=False)
            except FileNotFoundError:
                raise Failure(f"{command[0]} is not installed (tools/setup.sh)") from None
            if done.returncode != 0:
                output.flush()
                last = log.read_text(encoding="utf-8", errors="replace").splitlines()[-15:]
                raise Failure(f"{label} can't be built: {' '.join(command)} failed; {log} ends in\n  " + "\n  ".join(last))
