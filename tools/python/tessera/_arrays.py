"""Arrays of NumPy as records of the C library: checked, without a copy where the memory suits."""

from __future__ import annotations

import ctypes
import math
import operator
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

import numpy as np

from ._library import In, Out
from .errors import ArgumentError, ArgumentTypeError, MissingError

_NoBytes = ctypes.c_char * 0


class NamedArrays:
    """Arrays by the names of quantities. Those that were not asked for raise MissingError."""

    _known: ClassVar[Mapping[str, Any]]

    def __init__(self, **arrays: np.ndarray) -> None:
        unknown = arrays.keys() - self._known.keys()
        if unknown:
            raise ArgumentError(f"{sorted(unknown)[0]!r} is no quantity; there are {', '.join(self._known)}")
        self.__dict__.update(arrays)

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> np.ndarray:
            if name in self._known:
                found = ", ".join(self.__dict__) or "none"
                raise MissingError(f"{name} was not asked for: name it in quantities=[...]; there are {found}")
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")


_Own = TypeVar("_Own", bound="TypedArrays")


class TypedArrays(NamedArrays):
    """Arrays whose numbers of components and types are known by the names of quantities."""

    _known: ClassVar[Mapping[str, tuple[int, np.dtype]]]
    _usual: ClassVar[Sequence[str]]

    @classmethod
    def empty(cls: type[_Own], shape: int | tuple[int, ...], quantities: Sequence[str] | None = None) -> _Own:
        """Returns arrays to write to."""
        shape = (shape,) if isinstance(shape, int) else tuple(shape)
        arrays = {}
        for name in cls._usual if quantities is None else names_of(quantities):
            if name not in cls._known:
                raise ArgumentError(f"{name!r} is no quantity; there are {', '.join(cls._known)}")
            components, dtype = cls._known[name]
            arrays[name] = np.empty(shape if components == 1 else (*shape, components), dtype)
        return cls(**arrays)

    @property
    def nbytes(self) -> int:
        return sum(array.nbytes for array in self.__dict__.values())

    def _fill(self, out: Any, shape: tuple[int, ...]) -> Any:
        """Fills a struct of outputs of ``shape``, and returns it."""
        for name, array in self.__dict__.items():
            components, dtype = self._known[name]
            setattr(out, name, out_view(name, array, dtype, shape, components))
        return out

    def _needs(self, what: str, *quantities: str) -> None:
        """Raises an error unless the arrays that a property reads are there."""
        if any(name not in self.__dict__ for name in quantities):
            noun = "quantity" if len(quantities) == 1 else "quantities"
            raise ArgumentError(f"{what} needs the {noun} {' and '.join(quantities)}")


def array_of(name: str, value: Any, dtype: Any = np.float64) -> np.ndarray:
    """Returns numbers as an array of ``dtype``; the same memory if it has that type. Takes DLPack, too."""
    if not isinstance(value, np.ndarray) and hasattr(value, "__dlpack__"):
        value = np.from_dlpack(value)
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise ArgumentError(f"{name}: expected an array of numbers, found rows of several lengths") from error
    wanted = np.dtype(dtype)
    if array.dtype == wanted:
        return array if array.flags.aligned else array.copy()
    if array.dtype.kind not in ("fiu" if wanted.kind == "f" else "iu"):
        raise ArgumentTypeError(f"{name}: expected {wanted} numbers, found dtype {array.dtype}")
    if wanted.kind == "u" and array.size and (array.min() < 0 or array.max() > np.iinfo(wanted).max):
        raise ArgumentError(f"{name}: expected numbers from 0 to {np.iinfo(wanted).max}")
    return array.astype(wanted)


def integer_of(name: str, value: Any, least: int, most: int) -> int:
    """Returns an integer from ``least`` to ``most``. C takes the last bits of any other number without a word."""
    try:
        number = operator.index(value)
    except TypeError:
        raise ArgumentTypeError(f"{name}: expected an integer, found {value!r}") from None
    if not least <= number <= most:
        raise ArgumentError(f"{name} is {number}, expected an integer from {least} to {most}")
    return number


def number_of(name: str, value: Any) -> float:
    """Returns a finite number."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise ArgumentTypeError(f"{name}: expected a number, found {value!r}") from None
    if not math.isfinite(number):
        raise ArgumentError(f"{name} is {number}, expected a finite number", "non_finite")
    return number


def positive_of(name: str, value: Any, zero: bool = False) -> float:
    """Returns a finite number above 0, or 0 with ``zero``."""
    number = number_of(name, value)
    if number < 0 or (number == 0 and not zero):
        raise ArgumentError(f"{name} is {number:g}, expected a finite number {'of 0 or more' if zero else 'above 0'}")
    return number


def index_of(noun: str, value: Any, count: int) -> int:
    """Returns the place of an element among ``count``, also of one that is counted from the end, by -1 and less."""
    try:
        index = operator.index(value)
    except TypeError:
        raise ArgumentTypeError(f"{noun}: expected an integer, found {value!r}") from None
    if not -count <= index < count:
        raise IndexError(f"there is no {noun} {index}, the {'model' if noun == 'surface' else 'set'} has {count}")
    return index % count


def pair_of(name: str, value: Any, least: int, most: int) -> tuple[int, int]:
    """Returns two integers from ``least`` to ``most``, one per direction, of one or two."""
    try:
        first, second = value if np.ndim(value) else (value, value)
        first, second = operator.index(first), operator.index(second)
    except (TypeError, ValueError):
        raise ArgumentTypeError(f"{name}: expected an integer or one per direction, found {value!r}") from None
    return integer_of(name, first, least, most), integer_of(name, second, least, most)


def names_of(quantities: Any) -> list[str]:
    """Returns the names of quantities, of one name or several."""
    return [quantities] if isinstance(quantities, str) else list(quantities)


def check_out(out: Any, kind: type) -> None:
    """Raises an error if ``out`` is something else."""
    if not isinstance(out, kind):
        raise ArgumentTypeError(f"out: expected {kind.__name__}, found {type(out).__name__}")


def vectors_of(name: str, value: Any, dtype: Any = np.float64, components: int = 3) -> np.ndarray:
    """Returns an array of shape (..., components)."""
    array = array_of(name, value, dtype)
    if array.ndim == 0 or array.shape[-1] != components:
        raise ArgumentError(f"{name}: expected shape (..., {components}), found {array.shape}")
    return array


def records_of(array: np.ndarray, components: int) -> np.ndarray:
    """Returns the records of an array, (n,) or (n, components); a copy if their strides do not suit."""
    flat = array.reshape(-1) if components == 1 else array.reshape(-1, components)
    # A stride of 0 stands for packed records.
    return flat if all(stride > 0 for stride in flat.strides) else np.ascontiguousarray(flat)


def _view(kind: Any, flat: np.ndarray) -> Any:
    return kind(flat.__array_interface__["data"][0], len(flat), *flat.strides)


def in_view(flat: np.ndarray) -> Any:
    """Returns the tsr_in of records_of(); the array must be kept during the call."""
    return _view(In, flat)


def out_view(name: str, array: np.ndarray, dtype: np.dtype, shape: tuple[int, ...], components: int) -> Any:
    """Returns the tsr_out of an array that is checked: its type, its shape, and whether it can be written in place."""
    check_output(name, array, dtype, shape if components == 1 else (*shape, components))
    if array.flags.c_contiguous:
        # Without strides the records are packed. The address comes from the buffer, since __array_interface__ takes 0.6 us.
        buffer: Any = array  # which ctypes' stubs do not know
        return Out(ctypes.addressof(_NoBytes.from_buffer(buffer)), array.size // components)
    flat = array.view()
    try:
        flat.shape = (-1,) if components == 1 else (-1, components)
    except AttributeError:
        raise ArgumentError(f"{name}: the array is not contiguous: its records need one stride") from None
    if flat.size and min(flat.strides) <= 0:
        raise ArgumentError(f"{name}: the array has strides {array.strides}, expected positive ones")
    return _view(Out, flat)


def check_output(name: str, array: Any, dtype: np.dtype, shape: tuple[int, ...]) -> None:
    """Raises an error unless the array can be written with values of this type and shape."""
    if not isinstance(array, np.ndarray):
        raise ArgumentTypeError(f"{name}: expected an array of NumPy, found {type(array).__name__}")
    if array.dtype != dtype:
        raise ArgumentTypeError(f"{name}: expected dtype {np.dtype(dtype)}, found {array.dtype}")
    if array.shape != shape:
        raise ArgumentError(f"{name}: expected shape {shape}, found {array.shape}")
    flags = array.flags
    if not flags.writeable:
        raise ArgumentError(f"{name}: the array is read-only")
    if not flags.aligned:
        raise ArgumentError(f"{name}: the array is not aligned")


def address_of(array: np.ndarray | None) -> int | None:
    """Returns where the memory of a packed array begins; None for None."""
    return None if array is None else array.__array_interface__["data"][0]
