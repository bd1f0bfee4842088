"""What every result has in common: its JSON, its text, its files; numbers with their uncertainty, and those with effects
in the model; tables."""

from __future__ import annotations

import csv
import html
import importlib
import io
import json
import math
import os
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import InitVar, dataclass, fields, is_dataclass
from pathlib import Path
from typing import Any, Optional

import numpy as np

from . import _glidelab
from ._checks import file_name
from ._errors import SystemFailure
from ._glidelab import Outcome
from ._inputs import PathLike, Progress, teller
from ._shown import Brief


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

    def __init__(self, outcome: Outcome, files: Any = None) -> None:
        self.files = files  # what it reads to write its page
        self.json: str = outcome.json
        self.text: str = outcome.text
        self.outcome: Optional[Outcome] = outcome

    def __getstate__(self) -> dict[str, Any]:
        return {"json": self.json, "text": self.text, "outcome": None, "files": None}


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
        self._made.outcome.write(file_name("folder", folder, "the name of a folder"), teller(progress))

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(str(self))}</pre>"


def _cell(value: Any) -> str:
    """A value of a CSV table, all digits of a number; empty where there is none."""
    if value is None or (isinstance(value, (float, np.floating)) and not math.isfinite(value)):
        return ""
    return repr(float(value)) if isinstance(value, (float, np.floating)) else str(value)


def put_whole(folder: Path, files: Mapping[str, str]) -> None:
    """Writes texts under their names into a folder that is there: each appears whole or not at all. OSError."""
    with tempfile.TemporaryDirectory(prefix=".glidelab-", dir=folder) as staged:
        for file, text in files.items():
            Path(staged, file).write_text(text, encoding="utf-8")
        for file in files:
            Path(staged, file).replace(folder / file)


def csv_text(columns: Mapping[str, Sequence[Any]]) -> str:
    """Columns as a CSV file, a line for each row."""
    said = io.StringIO()
    lines = csv.writer(said, lineterminator="\n")
    lines.writerow(columns)
    lines.writerows([_cell(value) for value in row] for row in zip(*columns.values()))
    return said.getvalue()


_PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title>
<style>body{{font:16px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em}}table{{border-collapse:collapse}}
th,td{{padding:.2em .8em;text-align:left;border-bottom:1px solid #ddd}}img{{max-width:100%}}</style></head>
<body><h1>{title}</h1>
{body}
</body></html>
"""


class Written(Brief):
    """A result of no command: it writes itself."""

    def to_dict(self) -> dict[str, Any]:
        """Its data as JSON has them: arrays are lists, and what is not finite is None."""
        data: dict[str, Any] = plain(self)
        return data

    def _columns(self) -> Mapping[str, Sequence[Any]]:
        """Its table; without a column where it has none."""
        return {}

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(str(self))}</pre>"

    def write(self, folder: PathLike) -> None:
        """Writes its data, its table if it has one, and a page with its tables and plots: ``NAME.json``, ``NAME.csv``
        and ``report.html``, where NAME is the class's in small letters.

        Parameters
        ----------
        folder : str or path
            Made if it is missing. Files appear whole or not at all; others that lie there stay.

        Raises
        ------
        SystemFailure
            The folder cannot be written.
        """
        name = type(self).__name__
        columns = self._columns()
        files = {f"{name.lower()}.json": json.dumps(self.to_dict(), indent=1, allow_nan=False, ensure_ascii=False) + "\n"}
        if columns:
            files[f"{name.lower()}.csv"] = csv_text(columns)
        files["report.html"] = _PAGE.format(title=name, body=self._repr_html_())
        where = Path(file_name("folder", folder, "the name of a folder"))
        try:
            where.mkdir(parents=True, exist_ok=True)
            put_whole(where, files)
        except OSError as error:
            raise SystemFailure(f"{error.filename or where}: cannot be written: {error.strerror}") from None


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


QUANTITIES = dict(_glidelab.quantities())  # keys and their units


@dataclass(frozen=True)
class Recovered:
    """What one configuration's motion shows, with causes in the model.

    Attributes
    ----------
    group : str
        Clips that share one set-up of the track.
    mass_kg, incline_deg : float
        As stated.
    with_causes : tuple of str
        Ids of the effects in the model.
    k_over_m_1_s, mu, alpha_deg, v_lim_m_s : Quantity
        With them.
    """

    group: str
    mass_kg: float
    incline_deg: float
    with_causes: tuple[str, ...]
    k_over_m_1_s: Quantity
    mu: Quantity
    alpha_deg: Quantity
    v_lim_m_s: Quantity


def recovered_of(found: Mapping[str, Any]) -> Recovered:
    """An entry of "recovered" in a result's JSON."""
    quantities = {key: quantity_of(found, key, unit) for key, unit in QUANTITIES.items()}
    return Recovered(found["group"], found["mass_kg"], found["incline_deg"], tuple(found["with"]), **quantities)


@dataclass(frozen=True, eq=False, repr=False)
class WithEffects(Brief):
    """The quantities with effects in the model that the user named.

    Attributes
    ----------
    effects : dict of str to dict
        Each effect's parameters, ``{"value": ..., "sd": ...}`` by name with the unit in it.
    gap_before, gap_after : float or None
        Root mean square of standardised residuals of held-out clips without and with the effects; 1 is the noise floor.
    recovered : tuple of Recovered
        The quantities, a configuration each.
    notes : tuple of str
        What a reader should know.
    """

    effects: Mapping[str, Mapping[str, Any]]
    gap_before: Optional[float]
    gap_after: Optional[float]
    recovered: tuple[Recovered, ...]
    notes: tuple[str, ...]


def with_effects_of(found: Optional[Mapping[str, Any]]) -> Optional[WithEffects]:
    """The object "with" of results.json; None where no effect was named."""
    if found is None:
        return None
    gap = found.get("gap") or {}
    return WithEffects({one["id"]: one["parameters"] for one in found["effects"]}, gap.get("before"), gap.get("after"),
                       tuple(recovered_of(one) for one in found["recovered"]), tuple(found["notes"]))


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
    table: dict[str, Any] = dict(columns)
    for name, values in columns.items():  # a number that is missing is NaN, in a column of numbers even if all are
        floats = [isinstance(value, float) for value in values]
        if all(one or value is None for one, value in zip(floats, values)) and (any(floats) or name in by_row):
            table[name] = np.array([math.nan if value is None else value for value in values], dtype=np.float64)
    if by_row:
        table["unit"] = [unit_of(name) for name in columns["quantity"]]
        units["unit"] = ""
    frame = pandas.DataFrame(table)
    frame.attrs["units"] = units
    return frame
