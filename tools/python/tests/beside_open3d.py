"""Uses Tessera and Open3D in one process, in turn and at once: beside_open3d.py FIRST MODEL

FIRST is the module that is imported first. Prints the copies of oneTBB and Embree in the process.
"""

import importlib
import pathlib
import re
import sys
import threading

import numpy as np

TOLERANCE = 1e-4


def main(first, model):
    importlib.import_module(first)
    import open3d

    import tessera as ts

    patches = ts.read(model).patches()
    mesh = patches.tessellate(TOLERANCE)
    triangles = open3d.t.geometry.RaycastingScene()
    triangles.add_triangles(
        open3d.core.Tensor(mesh.positions().astype(np.float32)), open3d.core.Tensor(mesh.faces)
    )
    scene = patches.rays()
    low, high = scene.box
    x, z = np.meshgrid(np.linspace(low[0], high[0], 200), np.linspace(low[2], high[2], 200))
    origins = np.stack([x, np.full_like(x, low[1] - 1), z], axis=-1)
    found = scene.closest(origins, [0, 1, 0])
    points = open3d.core.Tensor(found.position[found.is_hit].astype(np.float32))
    works = {
        "rays": lambda: scene.closest(origins, [0, 1, 0]).position,
        "mesh": lambda: patches.tessellate(TOLERANCE).vertices,
        "distances": lambda: triangles.compute_distance(points).numpy(),
    }
    wanted = {name: work() for name, work in works.items()}
    # Tessera's rays hit the surface, and Open3D's distances are to triangles near it.
    assert found.is_hit.mean() > 0.1 and wanted["distances"].max() < TOLERANCE + 1e-6

    differing = []

    def repeat(name):
        for _ in range(5):
            if not np.array_equal(works[name](), wanted[name]):
                differing.append(name)

    workers = [threading.Thread(target=repeat, args=[name]) for name in 2 * list(works)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert not differing, differing
    libraries = re.findall(r"/(lib(?:tbb|embree\d*)\b[-.\w]*)$", pathlib.Path("/proc/self/maps").read_text(), re.M)
    print(*sorted(set(libraries)))


if __name__ == "__main__":
    main(*sys.argv[1:])
