"""What values and arrays are checked for before the C++ side sees them: one place, and one exception for all functions."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Sequence
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import input_error

Vector = NDArray[np.float64]  # one dimension, contiguous: as the C++ side takes it, without a copy where it is so
_LONGEST = 60  # characters of a value in a message


def kind_of(value: object) -> str:
    """"an int", "a list": what a value is."""
    name = type(value).__name__
    return f"{'an' if name[:1].lower() in tuple('aeiou') else 'a'} {name}"


def shown(value: object) -> str:
    """A value in a message: itself where it is short, else what it is."""
    if isinstance(value, np.ma.MaskedArray) and value.ndim == 0:
        return "a masked value"
    if isinstance(value, np.ndarray) and value.ndim > 0:
        return f"an array of shape {value.shape}"
    if value is None or isinstance(value, (str, bytes, bool, int, float, complex, np.generic, list, tuple)):
        text = repr(value.item() if isinstance(value, np.generic) else value)
        if len(text) <= _LONGEST:
            return text
    return kind_of(value)


def real(key: str, value: Any, expected: str = "a number", file: str = "") -> float:
    """A real number: no text, no switch, no array. NaN and infinity pass: what is allowed depends on the quantity."""
    is_number = (hasattr(type(value), "__float__") and getattr(value, "ndim", 0) == 0
                 and not isinstance(value, (bool, np.bool_, complex, np.complexfloating, str, bytes, np.ma.MaskedArray)))
    try:
        if is_number:
            return float(value)
    except (TypeError, ValueError, OverflowError):
        pass
    raise input_error(key, shown(value), expected, file)


def optional_real(key: str, value: Any, expected: str = "a number, or None", file: str = "") -> Optional[float]:
    """The same, or None."""
    return None if value is None else real(key, value, expected, file)


def above_0(key: str, value: Any, expected: str) -> float:
    """A finite number above 0."""
    number = real(key, value, expected)
    if not 0.0 < number < math.inf:
        raise input_error(key, f"{number:g}", expected)
    return number


def is_whole(value: Any) -> bool:
    """An int, Python's or numpy's; neither a switch nor a number that merely has no decimals."""
    return isinstance(value, (int, np.integer)) and not isinstance(value, bool)


def whole(key: str, value: Any, least: int, most: Optional[int] = None) -> int:
    """A whole number within limits."""
    if is_whole(value) and least <= value and (most is None or value <= most):
        return int(value)
    raise input_error(key, shown(value), f"a whole number from {least} to {most}" if most is not None else
                      f"a whole number of {least} or more")


def reals(key: str, values: Any, expected: str = "a list of numbers") -> list[float]:
    """Real numbers, one after the other."""
    if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
        raise input_error(key, shown(values), expected)
    return [real(f"{key}[{i}]", value) for i, value in enumerate(values)]


def pair(key: str, values: Any, expected: str = "two numbers") -> tuple[float, float]:
    """Two real numbers."""
    numbers = reals(key, values, expected)
    if len(numbers) != 2:
        raise input_error(key, shown(values), expected)
    return numbers[0], numbers[1]


def _in_utf8(key: str, value: str, file: str = "") -> str:
    try:
        value.encode()
    except UnicodeEncodeError as error:  # half of a surrogate pair; also a byte of a file's name that is no UTF-8
        near = value[max(error.start - _LONGEST // 4, 0):error.start + 1]
        raise input_error(key, ascii(value if len(value) <= _LONGEST else near), "characters of Unicode, which UTF-8 has",
                          file) from None
    return value


def text(key: str, value: Any, expected: str = "text", file: str = "") -> str:
    """A str that C++ can be given."""
    if not isinstance(value, str):
        raise input_error(key, shown(value), expected, file)
    return _in_utf8(key, value, file)


def texts(key: str, values: Any, expected: str) -> list[str]:
    """A list of texts; one text alone is none."""
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise input_error(key, shown(values), expected)
    return [text(key, value, expected) for value in values]


def switch(key: str, value: Any) -> bool:
    """True or False."""
    if not isinstance(value, (bool, np.bool_)):
        raise input_error(key, shown(value), "True or False")
    return bool(value)


def file_name(key: str, value: Any, expected: str = "the name of a file") -> str:
    """The name of a file or a folder, as text."""
    if not isinstance(value, (str, os.PathLike)):
        raise input_error(key, shown(value), expected)
    return _in_utf8(key, str(os.fspath(value)))


def refuse_masked(name: str, values: Any, of: str = "") -> None:
    """A masked value was not measured; its place still has a number, which would enter as data.

    Raises
    ------
    InputError
        With the index of the first, and how many more there are.
    """
    masks: Any = np.ma
    if not masks.is_masked(values):
        return
    places: Sequence[Any] = np.argwhere(masks.getmaskarray(masks.asarray(values))).tolist()
    first, more = ", ".join(map(str, places[0])), len(places) - 1
    raise input_error(f"{name}[{first}]", f"a masked value{f', and {more} more' if more else ''}",
                      "a number: leave out what was not measured", of)


def vector(name: str, values: ArrayLike, of: str = "") -> Vector:
    """`values` as a vector; `name` and `of` (its track) stand in messages.

    Raises
    ------
    InputError
        Not real numbers, masked ones among them, or not one dimension.
    """
    refuse_masked(name, values, of)
    try:
        array = np.asarray(values)
    except ValueError:
        raise input_error(name, "rows of different lengths", "one dimension", of) from None
    if array.dtype.kind not in "fiu":
        raise input_error(name, f"values of type {array.dtype}", "real numbers", of)
    if array.ndim != 1:
        raise input_error(name, f"an array of shape {array.shape}", "one dimension", of)
    return np.ascontiguousarray(array, dtype=np.float64)


def stored(values: Any) -> Any:
    """An array of real numbers of double precision, without a copy where it is one, masks included. What is none stays
    as it is: `vector` refuses it, with all else that is wrong, where it is used."""
    try:
        array = np.asanyarray(values)
    except ValueError:  # rows of different lengths
        return values
    return np.asanyarray(array, dtype=np.float64) if array.dtype.kind in "fiu" else array


def frozen(array: Any) -> Any:
    """The array, which can no longer be written to: results do not change."""
    array.flags.writeable = False
    return array


def refuse_numpy(pybind11: tuple[int, int], numpy_version: str) -> None:
    """ImportError where the module was made with a pybind11 that does not know this numpy: it would read arrays wrongly."""
    if pybind11 < (2, 12) and int(numpy_version.split(".")[0]) >= 2:
        raise ImportError(f"glidelab was built with pybind11 {pybind11[0]}.{pybind11[1]}, which knows numpy below 2, and "
                          f"this is numpy {numpy_version}: install numpy<2, or build with pybind11 2.12 or later")
