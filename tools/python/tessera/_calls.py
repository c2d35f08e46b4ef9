"""How calls run: errors become exceptions, long calls can be interrupted, handles release themselves."""

from __future__ import annotations

import contextlib
import contextvars
import ctypes
import os
import queue
import threading
from collections.abc import Callable, Iterator
from typing import Any

from ._arrays import integer_of
from ._library import library, struct
from .errors import Error, error_of

MAX_THREADS = 1024
_threads: contextvars.ContextVar[int] = contextvars.ContextVar("tessera_threads", default=0)
_Progress = ctypes.CFUNCTYPE(None, ctypes.c_double, ctypes.c_void_p)
Progress = Callable[[float], Any]


@contextlib.contextmanager
def threads(count: int) -> Iterator[None]:
    """Runs the calls of a block on ``count`` threads, at most 1024; 0 stands for all of the machine, as outside of such blocks.

    >>> import tessera as ts
    >>> with ts.threads(1):
    ...     mesh = ts.read(goblet).patches().tessellate(1e-2)
    """
    token = _threads.set(integer_of("threads", count, 0, MAX_THREADS))
    try:
        yield
    finally:
        _threads.reset(token)


def _error(status: int) -> Error:
    index = ctypes.c_int64()
    message = library.tsr_last_message(ctypes.byref(index)).decode(errors="replace")
    return error_of(library.tsr_status_name(status).decode(), message, index.value if index.value >= 0 else None)


def call(function: Any, *arguments: Any) -> None:
    """Calls a function of the library that takes little time."""
    status = function(*arguments)
    if status:
        raise _error(status)


def made_bytes(function: Any, *arguments: Any) -> bytes:
    """Calls a function whose first argument is the place of a tsr_bytes. Returns a copy of these."""
    handle, size = ctypes.c_void_p(), ctypes.c_size_t()
    call(function, ctypes.byref(handle), *arguments)
    try:
        return ctypes.string_at(library.tsr_bytes_data(handle, ctypes.byref(size)), size.value)
    finally:
        library.tsr_release(handle)


def run(
    function: Any, *arguments: Any, is_long: bool = True, progress: Progress | None = None, makes: Any = None
) -> None:
    """Calls a function whose last argument is a tsr_run.

    A long call of the main thread runs in another thread, so that an interrupt (Ctrl-C) ends it. ``makes``: the
    handle that the call makes; an interrupt does not wait for it, and it is released once it is made.
    """
    count = _threads.get()
    if not is_long and progress is None:
        options: Any = None
        if count:
            options = struct("tsr_run")
            options.threads = count
            options = ctypes.byref(options)
        call(function, *arguments, options)
        return
    _Run(function, arguments, count, progress, makes).finish()


class _Worker:
    """A thread for the long calls of the main thread. It is kept, since oneTBB takes a millisecond to admit another."""

    def __init__(self) -> None:
        self._calls: queue.SimpleQueue[Callable[[], Any] | None] = queue.SimpleQueue()
        self.put = self._calls.put
        threading.Thread(target=self._loop, name="tessera", daemon=True).start()

    def _loop(self) -> None:
        while (work := self._calls.get()) is not None:
            work()
            del work  # and with it the caller's progress


_worker: _Worker | None = None


def _kept_worker() -> _Worker:
    global _worker
    if _worker is None:
        _worker = _Worker()
    return _worker


def _leave_worker() -> None:
    """Makes the next call start a worker: this one is busy, or the thread of a parent process."""
    global _worker
    worker, _worker = _worker, None
    if worker is not None:
        worker.put(None)


os.register_at_fork(after_in_child=_leave_worker)


class _Run:
    """A long call. It keeps what the call uses until the call ends."""

    def __init__(
        self, function: Any, arguments: tuple[Any, ...], count: int, progress: Progress | None, makes: Any
    ) -> None:
        self._cancel = ctypes.c_uint8()
        options = struct("tsr_run")
        options.threads = count
        options.cancel = ctypes.addressof(self._cancel)
        self._progress = progress
        if progress is not None:
            self._callback = _Progress(self._report)
            options.progress = ctypes.cast(self._callback, ctypes.c_void_p)
        self._options = options
        self._function, self._arguments, self._makes = function, arguments, makes
        self._error: BaseException | None = None
        self._left = False
        self._lock = threading.Lock()
        self._done = threading.Semaphore(0)

    def finish(self) -> None:
        if threading.get_ident() == threading.main_thread().ident:
            self._wait()
        else:
            self._work()
        if self._error is not None:
            raise self._error

    def _work(self) -> None:
        try:
            status = self._function(*self._arguments, ctypes.byref(self._options))
            if status and self._error is None:
                self._error = _error(status)
        except BaseException as error:
            self._error = error
        finally:
            with self._lock:
                is_left = self._left
                self._done.release()
            if is_left and self._makes is not None:
                library.tsr_release(self._makes)

    def _wait(self) -> None:
        is_started = False
        try:
            _kept_worker().put(self._work)
            is_started = True
            self._done.acquire()
        except BaseException:
            self._cancel.value = 1
            with self._lock:
                self._left = True
            _leave_worker()
            # Arrays must not be written once their caller goes on. Handles are no concern of the caller's.
            while is_started and self._makes is None:
                with contextlib.suppress(KeyboardInterrupt):
                    self._done.acquire()
                    break
            raise

    def _report(self, share: float, _: Any) -> None:
        try:
            if self._error is None and self._progress is not None:
                self._progress(share)
        except BaseException as error:
            self._error = error
            self._cancel.value = 1


class Handle:
    """An object of the library. close() gives it up early; otherwise it ends with the last reference to it."""

    _kind: str  # as in tsr_KIND_describe
    _handle: ctypes.c_void_p | None = None

    def _make(self, function: Any, *arguments: Any, **options: Any) -> None:
        """Makes the object by a function whose first argument is the new handle; the options are those of run()."""
        handle = ctypes.c_void_p()
        run(function, ctypes.byref(handle), *arguments, makes=handle, **options)
        self._handle = handle

    def _info(self) -> Any:
        """Returns the tsr_KIND_info of the object."""
        info = struct(f"tsr_{self._kind}_info")
        call(getattr(library, f"tsr_{self._kind}_describe"), self._handle, ctypes.byref(info))
        return info

    def close(self) -> None:
        """Frees the object. Later calls raise StateError."""
        handle, self._handle = self._handle, None
        if handle:
            library.tsr_release(handle)

    def __del__(self, _release: Any = library.tsr_release) -> None:
        if self._handle:
            _release(self._handle)

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
