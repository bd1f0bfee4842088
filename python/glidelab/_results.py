"""What every result has in common: its JSON, its text, its files; numbers with their uncertainty; tables."""

from __future__ import annotations

import html
import importlib
import json
import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional

from ._glidelab import Outcome
from ._inputs import PathLike, Progress, teller


class Made:
    """The C++ side's outcome, of which pickling keeps JSON and text."""

    def __init__(self, outcome: Outcome) -> None:
        self.json: str = outcome.json
        self.text: str = outcome.text
        self.outcome: Optional[Outcome] = outcome

    def __getstate__(self) -> dict[str, Any]:
        return {"json": self.json, "text": self.text, "outcome": None}


@dataclass(frozen=True, eq=False, repr=False)
class Result:
    """What every result can do."""

    _made: Made

    def to_dict(self) -> dict[str, Any]:
        """The JSON that the command of this name writes, as a dict (docs/reference/json.md)."""
        document: dict[str, Any] = json.loads(self._made.json)
        return document

    def to_json(self) -> str:
        """The text of that file, byte for byte."""
        return self._made.json

    def __str__(self) -> str:
        """What the command prints."""
        return self._made.text

    def __repr__(self) -> str:
        return f"<glidelab.{type(self).__name__}>"

    def write(self, folder: PathLike, progress: Progress = None) -> None:
        """Writes what the command would: JSON, tables, and the page with its plots.

        Parameters
        ----------
        folder : str or path
            Made if it is missing. Files appear whole or not at all; others that lie there stay.
        progress : callable, True or None
            Called with a stage and the part of it that is done; True: a bar of tqdm.

        Raises
        ------
        SystemFailure
            gnuplot is missing, or the folder cannot be written.
        RuntimeError
            The result was pickled, which keeps its numbers and not what its page needs.
        """
        if self._made.outcome is None:
            raise RuntimeError("a result that was pickled has its numbers and its text, but no page to write")
        self._made.outcome.write(os.fspath(folder), teller(progress))

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(str(self))}</pre>"


@dataclass(frozen=True)
class Quantity:
    """A number with its standard deviation and its 95 % interval, or why the data do not determine it.

    Attributes
    ----------
    value, sd : float or None
        None where the data do not determine it.
    interval95 : (float, float) or None
        From and to.
    why : str
        Why there is no value, or no interval; empty where there are both.
    unit : str
        ``"1/s"``; empty for a pure number.
    uncorrected, smoothing_correction : float or None
        Where the smoothing's bias was taken off: the value without that, and what was added.
    """

    value: Optional[float] = None
    sd: Optional[float] = None
    interval95: Optional[tuple[float, float]] = None
    why: str = ""
    unit: str = ""
    uncorrected: Optional[float] = None
    smoothing_correction: Optional[float] = None

    @property
    def determined(self) -> bool:
        """Whether there is a value."""
        return self.value is not None

    def __float__(self) -> float:
        if self.value is None:
            raise ValueError(f"not determined: {self.why}")
        return self.value

    def __str__(self) -> str:
        if self.value is None:
            return "not determined"
        return rounded(self.value, self.sd) + (f" {self.unit}" if self.unit else "")


def rounded(value: float, sd: Optional[float]) -> str:
    """"2.779 ± 0.006": the standard deviation with two digits if it begins with 1, else one; the value to its place."""
    if sd is None or not sd > 0.0 or not math.isfinite(sd):
        return f"{value:.6g}"
    exponent = math.floor(math.log10(sd))
    if sd / 10.0**exponent < 1.95:
        exponent -= 1
    places = max(0, -exponent)
    return f"{value:.{places}f} ± {sd:.{places}f}"


def quantity_of(holder: Mapping[str, Any], key: str, unit: str) -> Quantity:
    """`holder[key]` as docs/reference/json.md has it: {value, sd, interval95}, or null with the reason in "why"."""
    found = holder.get(key)
    if found is None:
        return Quantity(why=holder.get("why", {}).get(key, "not stated"), unit=unit)
    interval = found.get("interval95")
    return Quantity(
        value=found["value"],
        sd=found.get("sd"),
        interval95=None if interval is None else (interval[0], interval[1]),
        why="" if interval is not None else found.get("why", {}).get("interval95", ""),
        unit=unit,
        uncorrected=found.get("uncorrected"),
        smoothing_correction=found.get("smoothing_correction"))


UNITS = {
    "k_over_m_1_s": "1/s", "mu": "", "alpha_deg": "°", "v_lim_m_s": "m/s", "a0_m_s2": "m/s²",
    "t_s": "s", "x_m": "m", "v_m_s": "m/s", "a_m_s2": "m/s²", "mass_kg": "kg", "incline_deg": "°",
}


def unit_of(column: str) -> str:
    """The unit of a table's column, by the end of its name: "sd_v_m_s" is in m/s; empty for a pure number."""
    for name, unit in UNITS.items():
        if unit and (column == name or column.removesuffix("_sd").endswith(name)):
            return unit
    return ""


def frame_of(columns: Mapping[str, Sequence[Any]]) -> Any:
    """A pandas.DataFrame, with ``attrs["units"]``.

    Raises
    ------
    ModuleNotFoundError
        pandas is not installed.
    """
    pandas = importlib.import_module("pandas")
    frame = pandas.DataFrame(dict(columns))
    frame.attrs["units"] = {name: unit_of(name) for name in columns}
    return frame


def html_table(header: Sequence[str], rows: Sequence[Sequence[str]], caption: str = "") -> str:
    """A table; texts are escaped."""
    cells = "".join(f"<th>{html.escape(one)}</th>" for one in header)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    head = f"<caption>{html.escape(caption)}</caption>" if caption else ""
    return f"<table>{head}<thead><tr>{cells}</tr></thead><tbody>{body}</tbody></table>"


def new_axes(count: int) -> list[Any]:
    """`count` axes of matplotlib, three in a row at most, in a figure of their own.

    Raises
    ------
    ModuleNotFoundError
        matplotlib is not installed.
    """
    pyplot = importlib.import_module("matplotlib.pyplot")
    columns = max(1, min(count, 3))
    rows = -(-count // columns)
    width, height = (6.0, 4.0) if columns == 1 else (4.0, 3.2)
    _, grid = pyplot.subplots(rows, columns, figsize=(width * columns, height * rows), squeeze=False,
                              layout="constrained")
    axes = list(grid.flat)
    for unused in axes[count:]:
        unused.set_axis_off()
    return axes[:count]
