"""What a prompt shows of results, one line, and what a notebook shows: tables and plots."""

from __future__ import annotations

import base64
import html
import importlib
import importlib.util
import io
import math
from collections.abc import Callable, Mapping, Sequence
from contextvars import ContextVar
from dataclasses import fields, is_dataclass
from typing import Any, Optional

import numpy as np

_LONGEST = 60  # characters of a text


def _shown(name: str, value: Any) -> Optional[str]:
    """"mass_kg=0.335", "len(clips)=6"; None for what has no value, is empty, or is too long."""
    if is_dataclass(value) and "__str__" in vars(type(value)):  # a Quantity
        return f"{name}={value}"
    if isinstance(value, (tuple, list, Mapping)):
        return f"len({name})={len(value)}" if value else None
    if isinstance(value, np.ndarray):
        return f"{name} of shape {value.shape}" if value.ndim != 1 else None
    if isinstance(value, float):
        return f"{name}={value:.6g}" if math.isfinite(value) else None
    if isinstance(value, str):
        return f"{name}={value!r}" if 0 < len(value) <= _LONGEST and "\n" not in value else None
    if isinstance(value, (bool, int, np.generic)):
        return f"{name}={value}"
    return None


class Brief:
    """A dataclass that a prompt shows on one line: its single values, and of the rest how much there is.

    ``<glidelab.Clip: name='m1-up', frames=320, len(segments)=2>``; all arrays of one dimension have one length, which is shown
    once.
    """

    def __repr__(self) -> str:
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        shown = [one for one in (_shown(name, value) for name, value in values.items()) if one is not None]
        lengths = [len(value) for value in values.values() if isinstance(value, np.ndarray) and value.ndim == 1]
        if any(lengths):
            shown.insert(0, f"{max(lengths)} values")
        return f"<glidelab.{type(self).__name__}{': ' if shown else ''}{', '.join(shown)}>"


def html_table(header: Sequence[str], rows: Sequence[Sequence[str]], caption: str = "") -> str:
    """A table; texts are escaped."""
    cells = "".join(f"<th>{html.escape(one)}</th>" for one in header)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    head = f"<caption>{html.escape(caption)}</caption>" if caption else ""
    return f"<table>{head}<thead><tr>{cells}</tr></thead><tbody>{body}</tbody></table>"


_by_pyplot = ContextVar("_by_pyplot", default=True)  # whether figures are pyplot's, which shows them


def new_axes(count: int) -> list[Any]:
    """`count` axes of matplotlib, three in a row at most, in a figure of their own.

    Raises
    ------
    ModuleNotFoundError
        matplotlib is not installed.
    """
    if count == 0:
        return []
    columns = max(1, min(count, 3))
    rows = -(-count // columns)
    width, height = (6.0, 4.0) if columns == 1 else (4.0, 3.2)
    size = (width * columns, height * rows)
    make = importlib.import_module("matplotlib.pyplot").figure if _by_pyplot.get() else importlib.import_module(
        "matplotlib.figure").Figure
    axes = list(make(figsize=size, layout="constrained").subplots(rows, columns, squeeze=False).flat)
    for unused in axes[count:]:
        unused.set_axis_off()
    return axes[:count]


def html_plot(plot: Callable[[], Any]) -> str:
    """What `plot` draws, as an image for a notebook; empty without matplotlib. No window opens."""
    if importlib.util.find_spec("matplotlib") is None:
        return ""
    before = _by_pyplot.set(False)
    try:
        drawn = plot()
    finally:
        _by_pyplot.reset(before)
    axes = drawn if isinstance(drawn, list) else [drawn]
    if not axes:
        return ""
    picture = io.BytesIO()
    axes[0].figure.savefig(picture, format="png", dpi=90)
    return f'<img alt="plot" src="data:image/png;base64,{base64.b64encode(picture.getvalue()).decode()}">'
