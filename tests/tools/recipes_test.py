#!/usr/bin/env python3
"""Runs the recipes of a guide for many files: recipes_test.py GUIDE TOOL MODELS FOLDER

Each recipe is a block whose fence names a file, ```sh parallel.sh. It must make a mesh of every file of the list; when
it runs again, all files are passed over; and after a broken file it ends with status 1 and has made the others. A
script of Slurm is run as Slurm runs it: a process per task of its array, with the variables of the task. (No daemon of
Slurm is needed, and its scheduling is not tested.) A recipe whose program is missing is skipped, and named.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys

FILES = 20
ENDS = {".sh", ".sbatch", ".py"}


def recipes_of(guide):
    """Yields the name and the text of each named block of the section about many files."""
    section = re.search(r"^## Many files\n(.*?)(?=^## |\Z)", guide.read_text(encoding="utf-8"), re.M | re.S)[1]
    for name, text in re.findall(r"^```\w+ (\S+)\n(.*?)^```$", section, re.M | re.S):
        if pathlib.Path(name).suffix not in ENDS:
            sys.exit(f"{guide}: how is {name} run?")
        yield name, text


def python_with_dask():
    for python in ("/usr/bin/python3", sys.executable):
        if subprocess.run([python, "-c", "import dask.distributed"], stderr=subprocess.DEVNULL).returncode == 0:
            return python
    return None


def tasks_of(name, text):
    """Returns the processes of a recipe, as commands with variables; None if a program is missing."""
    if name.endswith(".py"):
        python = python_with_dask()
        return python and [([python, name], {})]
    if name == "parallel.sh" and not shutil.which("parallel"):
        return None
    if not name.endswith(".sbatch"):
        return [(["bash", "-e", name], {})]
    first, last = map(int, re.search(r"^#SBATCH --array=(\d+)-(\d+)$", text, re.M).groups())
    processors = re.search(r"^#SBATCH --cpus-per-task=(\d+)$", text, re.M)[1]
    count = str(last - first + 1)
    common = {"SLURM_CPUS_PER_TASK": processors, "SLURM_ARRAY_TASK_COUNT": count}
    return [(["bash", name], {**common, "SLURM_ARRAY_TASK_ID": str(task)}) for task in range(first, last + 1)]


def run(tasks, folder, environment):
    """Runs the tasks, some at a time. Returns their statuses and what they have written to standard error."""
    statuses, errors, running = set(), "", []
    for command, variables in [*tasks, *[(None, None)] * 4]:
        if len(running) == 4 or command is None and running:
            process = running.pop(0)
            errors += process.communicate()[1]
            statuses.add(process.returncode)
        if command is not None:
            running.append(subprocess.Popen(command, cwd=folder, env={**environment, **variables}, text=True,
                                            stdout=subprocess.PIPE, stderr=subprocess.PIPE))
    return statuses, errors


def check(holds, what, errors):
    if not holds:
        sys.exit(f"recipes_test: {what}\n{errors}")


def try_recipe(name, text, model, folder, environment):
    """Returns whether the recipe was run, and not skipped."""
    tasks = tasks_of(name, text)
    if not tasks:
        print(f"{name}: skipped, its program is missing")
        return False
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "parts").mkdir(parents=True)
    (folder / name).write_text(text, encoding="utf-8")
    names = [f"part {k}" for k in range(FILES)]
    for file in names:
        shutil.copy(model, folder / "parts" / f"{file}.json")
    (folder / "list.txt").write_text("".join(f"parts/{file}.json\n" for file in names), encoding="utf-8")
    meshes = [folder / "meshes" / f"{file}.ply" for file in names]

    statuses, errors = run(tasks, folder, environment)
    check(statuses == {0} and errors == "", f"{name} ends with {statuses}", errors)
    check(sorted((folder / "meshes").iterdir()) == sorted(meshes), f"{name} makes other files", errors)
    made = [mesh.stat().st_mtime_ns for mesh in meshes]
    statuses, errors = run(tasks, folder, environment)
    check(statuses == {0}, f"{name} ends with {statuses} when it runs again", errors)
    check(made == [mesh.stat().st_mtime_ns for mesh in meshes], f"{name} makes files again", errors)

    (folder / "parts" / f"{names[3]}.json").write_text("{", encoding="utf-8")
    meshes[7].unlink()
    statuses, errors = run(tasks, folder, environment)
    check(1 in statuses and statuses <= {0, 1}, f"{name} ends with {statuses} after a broken file", errors)
    check(f"{names[3]}.json:1: " in errors and meshes[7].exists(), f"{name} loses a file", errors)
    print(f"{name}: {FILES} files in {len(tasks)} process{'es' * (len(tasks) > 1)}")
    return True


def main():
    guide, tool, models, folder = (pathlib.Path(word).resolve() for word in sys.argv[1:5])
    environment = {**os.environ, "PATH": f"{tool.parent}{os.pathsep}{os.environ['PATH']}", "LC_ALL": "C.UTF-8"}
    recipes = dict(recipes_of(guide))
    listing = recipes.pop("list.sh")
    check("> list.txt" in listing and len(recipes) >= 4, f"{guide} has the recipes {list(recipes)}", "")
    ran = [try_recipe(name, text, models / "bezier_bicubic.json", folder / name, environment)
           for name, text in recipes.items()]
    return 0 if all(ran) else 77


if __name__ == "__main__":
    sys.exit(main())
