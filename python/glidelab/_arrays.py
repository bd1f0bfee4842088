"""Arrays as the C++ side takes them: one dimension, contiguous, double precision; without a copy where they are so."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._checks import refuse_masked
from ._errors import input_error

Vector = NDArray[np.float64]


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
