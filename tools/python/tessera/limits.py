"""The limits of this machine, and the share of them that a call reaches."""

from __future__ import annotations

import ctypes
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ._arrays import integer_of
from ._calls import call
from ._library import library, struct


@dataclass(frozen=True)
class Limits:
    """Rates of one thread: fused multiply-adds per second in float and in double, and bytes stored per second."""

    float_operations_per_second: float
    double_operations_per_second: float
    store_bytes_per_second: float


def limits(store_bytes: int = 0) -> Limits:
    """Measures this machine on the calling thread, in a fraction of a second. ``store_bytes``: the size of the output
    in question; 0: 160 MiB."""
    info = struct("tsr_limits_info")
    call(library.tsr_limits, integer_of("store_bytes", store_bytes, 0, 2**63 - 1), ctypes.byref(info))
    return Limits(**{name: getattr(info, name) for name in Limits.__dataclass_fields__})


@dataclass(frozen=True)
class Measurement:
    """The best time of a call, its result, the bytes of the result's arrays, and the time that one thread takes to
    store as many bytes as a share of it."""

    seconds: float
    result: Any
    nbytes: int
    share_of_limit: float


def measure(work: Callable[[], Any], repeats: int = 5) -> Measurement:
    """Times a call that returns a mesh, jets, hits or an array, and relates it to what stores cost on this machine.

    >>> import tessera as ts
    >>> patches = ts.read(goblet).patches()
    >>> ts.measure(lambda: patches.tessellate(1e-3)).share_of_limit > 0
    True
    """
    seconds, result = float("inf"), None
    for _ in range(integer_of("repeats", repeats, 1, 2**31 - 1)):
        start = time.perf_counter()
        result = work()
        seconds = min(seconds, time.perf_counter() - start)
    nbytes = int(result.nbytes) if result is not None else 0
    share = nbytes / limits(nbytes).store_bytes_per_second / seconds
    return Measurement(seconds, result, nbytes, share)
