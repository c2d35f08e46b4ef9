"""How calls run: interrupts, progress, threads, forks, handles that are released."""

import gc
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
import weakref

import numpy as np
import pytest

import tessera as ts
from conftest import wavy


@pytest.fixture(scope="module")
def field():
    return ts.bezier(wavy(60, 60)).patches()


def interrupted(work):
    """Runs work, again and again, and sends SIGINT meanwhile."""
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            while True:
                work()
    finally:
        timer.join()


def test_a_long_call_ends_by_an_interrupt(field):
    scene = field.rays()
    origins = np.full((4_000_000, 3), [30.2, 30.1, 9.0])
    hits = ts.Hits(t=np.empty(len(origins)))

    def work():
        hits.t[:] = -1
        scene.closest(origins, [0.3, 0.2, -1], out=hits)

    interrupted(work)
    assert (hits.t == -1).any()  # it ended before it was finished
    assert scene.closest([1.5, 1.5, 9], [0, 0, -1]).is_hit  # goes on


def test_a_plan_ends_by_an_interrupt(field):
    interrupted(lambda: field.tessellate(1e-5, fewest=True))
    assert len(field) == 3600


def test_few_large_patches_end_by_an_interrupt(goblet):
    patches = goblet.patches()
    shares = []
    patches.tessellate(1e-5, progress=shares.append)
    assert len(shares) > 20  # where progress is reported, an interrupt is seen
    interrupted(lambda: patches.tessellate(1e-6))


def test_progress(field):
    shares = []
    field.tessellate(1e-3, progress=shares.append)
    assert shares == sorted(shares) and 0 <= shares[0] < shares[-1] == 1

    def stop(share):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        field.tessellate(1e-3, progress=stop)


def test_an_edit_during_a_call_is_an_error(field):
    points = field[0].points
    errors = []

    def edit(share):
        try:
            field.edit([0], points)
        except ts.StateError as error:
            errors.append(error.code)

    field.tessellate(1e-3, progress=edit)
    assert errors and set(errors) == {"in_use"}


def test_threads_share_objects(field):
    wanted = field.tessellate(1e-3)
    made = []
    workers = [threading.Thread(target=lambda: made.append(field.tessellate(1e-3))) for _ in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert len(made) == 4 and all((mesh.vertices == wanted.vertices).all() for mesh in made)


def test_the_count_of_threads_does_not_change_bytes(field):
    wanted = field.tessellate(1e-3)
    with ts.threads(1):
        assert (field.tessellate(1e-3).vertices == wanted.vertices).all()
    with pytest.raises(ts.ArgumentError):
        with ts.threads(-1):
            pass


def test_other_threads_go_on_meanwhile(field):
    counted = [0]
    is_over = threading.Event()

    def count():
        while not is_over.is_set():
            counted[0] += 1
            time.sleep(0.0001)

    counter = threading.Thread(target=count)
    counter.start()
    try:
        # If a call kept the lock, the other thread could hardly count once around it.
        with ts.threads(1):
            for _ in range(10_000):
                before = counted[0]
                field.tessellate(1e-4)
                if counted[0] - before > 3:
                    return
        raise AssertionError("another thread stood still during each call")
    finally:
        is_over.set()
        counter.join()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
def test_a_forked_child_gets_an_error(field):
    field.tessellate(1e-2)
    child = os.fork()
    if child == 0:
        status = 1
        try:
            field.tessellate(1e-2)
        except ts.UnsupportedError as error:
            status = 0 if "forked" in error.message else 2
        os._exit(status)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def count_of(patches):
    return len(patches.tessellate(1e-2).faces)


def test_spawned_processes_work():
    patches = ts.bezier(wavy(2, 2)).patches()
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.map(count_of, [patches]) == [count_of(patches)]


def test_released_objects_raise_errors():
    model = ts.bezier(wavy(1, 1))
    patches = model.patches()
    scene = patches.rays()
    with patches:
        pass
    for use in (lambda: patches.tessellate(1), lambda: patches.box, lambda: patches.grid([0], [0]), patches.rays):
        with pytest.raises(ts.StateError) as caught:
            use()
        assert caught.value.code == "invalid_handle"
    assert scene.closest([0.5, 0.5, 9], [0, 0, -1]).is_hit  # keeps what it needs
    model.close()
    with pytest.raises(ts.StateError):
        model.patches()
    model.close()


def test_import_takes_nothing_else():
    names = "trimesh", "pyvista", "open3d", "meshio", "matplotlib", "IPython", "multiprocessing", "json", "html"
    code = "import sys, numpy; before = set(sys.modules); import tessera; "
    code += f"print(*{set(names)} & set(sys.modules) - before)"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    found = subprocess.run([sys.executable, "-c", code], env=environment, check=True, capture_output=True, text=True)
    assert found.stdout.strip() == ""


def test_a_long_call_lets_go_of_its_progress(goblet):
    class Progress:
        def __call__(self, share):
            pass

    progress = Progress()
    goblet.patches().tessellate(1e-3, progress=progress)
    found = weakref.ref(progress)
    del progress
    for _ in range(1000):
        if found() is None:
            return
        gc.collect()
        time.sleep(0.01)
    raise AssertionError("the progress of a call that has ended is kept")
