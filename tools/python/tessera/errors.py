"""Exceptions. All are :class:`Error`, and also the built-in exception that a caller of Python expects."""

from __future__ import annotations


class Error(Exception):
    """An error of Tessera.

    ``code`` names the reason, such as ``"non_finite"``; ``message`` says what was found and what was expected;
    ``index`` is the element that the message names (a surface, a patch, a ray), or None.

    >>> import tessera as ts
    >>> try:
    ...     ts.bezier([[[0, 0, 0], [0, 1, 0]], [[1, 0, float("nan")], [1, 1, 0]]])
    ... except ts.Error as error:
    ...     print(error.code, error.index, isinstance(error, ValueError))
    non_finite 0 True
    """

    def __init__(self, message: str, code: str = "invalid_argument", index: int | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.code = code
        self.index = index

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (self.message, self.code, self.index)


class ArgumentError(Error, ValueError):
    """A value, a shape or a length that a call cannot use, and the content of a file that does not follow its
    format."""


class ArgumentTypeError(Error, TypeError):
    """An argument of another type than expected, such as an array of strings."""


class MissingError(Error, AttributeError):
    """An array that was not computed: a quantity that was not asked for, or normals of a mesh that has none."""


class FileError(Error, OSError):
    """A file that cannot be opened, read or written."""


class UnsupportedError(Error, NotImplementedError):
    """A valid request that is not available here."""


class OutOfMemoryError(Error, MemoryError):
    """An allocation failed."""


class StateError(Error, RuntimeError):
    """An object that is released, in use by another thread, or made for an earlier state of its patch set."""


class CancelledError(Error, RuntimeError):
    """A call that was ended before it was finished; its outputs are partly written."""


_CLASSES: dict[str, type[Error]] = {
    "unsupported": UnsupportedError,
    "isa_unavailable": UnsupportedError,
    "stale": StateError,
    "invalid_handle": StateError,
    "in_use": StateError,
    "internal": StateError,
    "io_error": FileError,
    "out_of_memory": OutOfMemoryError,
    "cancelled": CancelledError,
}


def error_of(code: str, message: str, index: int | None) -> Error:
    """Returns the exception for a status of the C library."""
    return _CLASSES.get(code, ArgumentError)(message, code, index)
