"""What every result has in common: its JSON, its text, its files; numbers with their uncertainty; tables."""

from __future__ import annotations

import base64
import html
import importlib
import importlib.util
import io
import json
import math
import os
from collections.abc import Callable, Mapping, Sequence
from contextvars import ContextVar
from dataclasses import InitVar, dataclass, fields, is_dataclass
from typing import Any, Optional

import numpy as np

from ._brief import Brief
from ._glidelab import Outcome
from ._inputs import PathLike, Progress, teller


NORMAL95 = 1.959964  # the normal distribution's 97.5 % quantile


def plain(value: Any) -> Any:
    """What JSON has for a value and its parts: a dataclass is a dict, an array a list; what is not finite is None."""
    if is_dataclass(value) and not isinstance(value, type):
        return {field.name: plain(getattr(value, field.name)) for field in fields(value)}
    if isinstance(value, Mapping):
        return {key: plain(one) for key, one in value.items()}
    if isinstance(value, (tuple, list, np.ndarray)):
        return [plain(one) for one in (value.tolist() if isinstance(value, np.ndarray) else value)]
    return None if isinstance(value, float) and not math.isfinite(value) else value


class Made:
    """The result on the C++ side. Pickling keeps its JSON and text."""

    def __init__(self, outcome: Outcome) -> None:
        self.json: str = outcome.json
        self.text: str = outcome.text
        self.outcome: Optional[Outcome] = outcome

    def __getstate__(self) -> dict[str, Any]:
        return {"json": self.json, "text": self.text, "outcome": None}


class _Holder:  # pylint: disable=too-few-public-methods
    """Where a result keeps what it was made of: in no field, so that `dataclasses.asdict` gives its data alone."""

    _made: Made


@dataclass(frozen=True, eq=False, repr=False)
class Result(_Holder, Brief):
    """What every result can do."""

    made: InitVar[Made]

    def __post_init__(self, made: Made) -> None:
        object.__setattr__(self, "_made", made)

    def to_dict(self) -> dict[str, Any]:
        """The JSON that the command of this name writes, as a dict (docs/reference/result-files.md)."""
        document: dict[str, Any] = json.loads(self._made.json)
        return document

    def to_json(self) -> str:
        """The text of that file, byte for byte."""
        return self._made.json

    def __str__(self) -> str:
        """What the command prints."""
        return self._made.text

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
        return rounded(self.value, self.sd) + ("°" if self.unit == "°" else f" {self.unit}" if self.unit else "")


def rounded(value: float, sd: Optional[float]) -> str:
    """"2.7791 ± 0.0061": the standard deviation with two digits, the value to its place, as on the program's pages."""
    if sd is None or not sd > 0.0 or not math.isfinite(sd):
        return f"{value:.6g}"
    half_a_unit = 1.0 + 0.5e-2  # 0.0996 becomes 0.10
    places = max(0, 1 - math.floor(math.log10(sd * half_a_unit)))
    return f"{value:.{places}f} ± {sd:.{places}f}"


def quantity_of(holder: Mapping[str, Any], key: str, unit: str) -> Quantity:
    """`holder[key]` as docs/reference/result-files.md has it: {value, sd, interval95}, or null with the reason in "why"."""
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


_UNITS = {  # by the end of a column's name, the longer first
    "_m_s2": "m/s²", "_m_s": "m/s", "_1_s": "1/s", "_deg": "°", "_kg": "kg", "_eur": "EUR", "_hz": "Hz", "_px": "px",
    "_n": "N", "_s": "s", "_m": "m",
}
BY_ROW = "as the column unit says"


def unit_of(column: str) -> str:
    """The unit of a table's column, by the end of its name: "sd_v_m_s" and "v_m_s_sd" are in m/s; empty for a pure
    number."""
    name = column.removesuffix("_sd")
    return next((unit for end, unit in _UNITS.items() if name.endswith(end)), "")


_SYMBOLS = {"k_over_m_1_s": "K/m", "mu": "µ", "alpha_deg": "α", "v_lim_m_s": "terminal velocity"}


def words_of(quantity: str, before: str = "") -> str:
    """"error of K/m (1/s)" for "k_over_m_1_s" after "error of": what a table or an axis calls a quantity."""
    unit = unit_of(quantity)
    return before + _SYMBOLS.get(quantity, quantity) + (f" ({unit})" if unit else "")


def frame_of(columns: Mapping[str, Sequence[Any]], by_row: Sequence[str] = ()) -> Any:
    """A pandas.DataFrame, with ``attrs["units"]``.

    With `by_row`, columns in the unit of their row's quantity: there is a column ``unit`` then, made of the column
    ``quantity``.

    Raises
    ------
    ModuleNotFoundError
        pandas is not installed.
    """
    pandas = importlib.import_module("pandas")
    units = {name: BY_ROW if name in by_row else unit_of(name) for name in columns}
    table = dict(columns)
    if by_row:
        table["unit"] = [unit_of(name) for name in columns["quantity"]]
        units["unit"] = ""
    frame = pandas.DataFrame(table)
    frame.attrs["units"] = units
    return frame


def html_table(header: Sequence[str], rows: Sequence[Sequence[str]], caption: str = "") -> str:
    """A table; texts are escaped."""
    cells = "".join(f"<th>{html.escape(one)}</th>" for one in header)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    head = f"<caption>{html.escape(caption)}</caption>" if caption else ""
    return f"<table>{head}<thead><tr>{cells}</tr></thead><tbody>{body}</tbody></table>"


_shown = ContextVar("_shown", default=True)  # whether figures are pyplot's, which shows them


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
    make = importlib.import_module("matplotlib.pyplot").figure if _shown.get() else importlib.import_module(
        "matplotlib.figure").Figure
    axes = list(make(figsize=size, layout="constrained").subplots(rows, columns, squeeze=False).flat)
    for unused in axes[count:]:
        unused.set_axis_off()
    return axes[:count]


def html_plot(plot: Callable[[], Any]) -> str:
    """What `plot` draws, as an image for a notebook; empty without matplotlib. No window opens."""
    if importlib.util.find_spec("matplotlib") is None:
        return ""
    before = _shown.set(False)
    try:
        drawn = plot()
    finally:
        _shown.reset(before)
    axes = drawn if isinstance(drawn, list) else [drawn]
    if not axes:
        return ""
    picture = io.BytesIO()
    axes[0].figure.savefig(picture, format="png", dpi=90)
    return f'<img alt="plot" src="data:image/png;base64,{base64.b64encode(picture.getvalue()).decode()}">'
