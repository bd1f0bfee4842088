"""require() and sweep(): errors over what a sweep varies, and which of its cameras reach a target."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional, Union

from . import _glidelab
from ._checks import file_name, text, texts, whole
from ._errors import input_error
from ._inputs import PathLike, Progress, checked_seed, job_count, teller
from ._outside import Estimator, OutsideRuns, given_command, outside_runs
from ._results import Made, Result, frame_of, unit_of, words_of
from ._shown import html_plot, html_table, new_axes


@dataclass(frozen=True)
class Candidate:
    """One camera or setting of a sweep, as a requirement judges it.

    Attributes
    ----------
    name, verdict : str
        The point of the sweep and its verdict.
    reached : bool
        Whether it reaches every target.
    price_eur, frame_rate_hz, noise_m : float or None
        What it costs, how it is set, and the noise of its positions.
    errors, error_sds, bounds : tuple of (float or None)
        Of each target, in the target's unit and measure: the error by runs with its standard deviation (None: not run),
        and the least that noise and frame rate allow.
    """

    name: str
    reached: bool
    verdict: str
    price_eur: Optional[float]
    frame_rate_hz: Optional[float]
    noise_m: Optional[float]
    errors: tuple[Optional[float], ...] = ()
    error_sds: tuple[Optional[float], ...] = ()
    bounds: tuple[Optional[float], ...] = ()


_OF_CANDIDATES = ("name", "reached", "verdict", "price_eur", "frame_rate_hz", "noise_m")


@dataclass(frozen=True, eq=False, repr=False)
class Requirement(Result):
    """Which cameras and settings reach a target.

    Attributes
    ----------
    name : str
        Of the sweep.
    candidates : tuple of Candidate
        The cheapest first.
    targets : tuple of str
        What was asked for, in words: "mu 95 % error 0.0001".
    """

    name: str
    candidates: tuple[Candidate, ...]
    targets: tuple[str, ...] = ()

    @property
    def cheapest(self) -> Optional[Candidate]:
        """The first that reaches the target; None where nothing does."""
        return next((one for one in self.candidates if one.reached), None)

    def to_frame(self, by_target: bool = False) -> Any:
        """A pandas.DataFrame, one row per candidate, with units in ``attrs["units"]``.

        Parameters
        ----------
        by_target : bool
            False: ``error`` and ``bound`` are those of the first target, ``error_2`` and ``bound_2`` of the second, ...;
            ``attrs["targets"]`` names the targets. True: one row per candidate and target, with the columns ``target``,
            ``quantity``, ``error``, ``error_sd`` and ``bound``, in the unit that ``unit`` says.
        """
        if by_target:
            return self._frame_by_target()
        columns: dict[str, list[Any]] = {name: [getattr(one, name) for one in self.candidates] for name in _OF_CANDIDATES}
        units = {}
        for number, target in enumerate(self.targets):
            of = "" if number == 0 else f"_{number + 1}"
            columns[f"error{of}"] = [one.errors[number] if number < len(one.errors) else None for one in self.candidates]
            columns[f"bound{of}"] = [one.bounds[number] if number < len(one.bounds) else None for one in self.candidates]
            units[f"error{of}"] = units[f"bound{of}"] = unit_of(target.split()[0])
        frame = frame_of(columns)
        frame.attrs["units"].update(units)
        frame.attrs["targets"] = list(self.targets)
        return frame

    def _frame_by_target(self) -> Any:
        rows = [(one, number, target) for one in self.candidates for number, target in enumerate(self.targets)]
        columns: dict[str, list[Any]] = {name: [getattr(one, name) for one, _, _ in rows] for name in _OF_CANDIDATES}
        columns["target"] = [target for _, _, target in rows]
        columns["quantity"] = [target.split()[0] for _, _, target in rows]
        numbers = {"error": "errors", "error_sd": "error_sds", "bound": "bounds"}
        for name, member in numbers.items():
            columns[name] = [of[number] if number < len(of) else None
                             for of, number in ((getattr(one, member), number) for one, number, _ in rows)]
        return frame_of(columns, tuple(numbers))

    def _repr_html_(self) -> str:
        header = ["camera", "price (EUR)", "verdict"]
        for target in self.targets:
            header += [f"error ({target})", "at best"]
        rows = []
        for one in self.candidates:
            row = [one.name, "" if one.price_eur is None else f"{one.price_eur:g}", one.verdict]
            for error, sd, bound in zip(one.errors, one.error_sds, one.bounds):
                row += ["" if error is None else rounded_error(error, sd), "" if bound is None else f"{bound:.2g}"]
            rows.append(row)
        return html_table(header, rows) + html_plot(self.plot)

    def plot(self) -> list[Any]:
        """The error of each candidate, with its standard deviation, next to the least one and the target's name.

        Returns
        -------
        list of matplotlib.axes.Axes
            One for each target.
        """
        axes = new_axes(len(self.targets))
        for number, (axis, target) in enumerate(zip(axes, self.targets)):
            for place, one in enumerate(self.candidates):
                bound = one.bounds[number] if number < len(one.bounds) else None
                error = one.errors[number] if number < len(one.errors) else None
                if bound is not None:
                    axis.plot(bound, place, "|", color="0.5", markersize=12)
                if error is not None:
                    axis.errorbar(error, place, xerr=one.error_sds[number] or 0.0, fmt="o",
                                  color="C0" if one.reached else "C3")
            axis.set_yticks(range(len(self.candidates)), [one.name for one in self.candidates], fontsize=7)
            axis.invert_yaxis()
            axis.set_xscale("log")
            axis.set_xlabel(f"error (| at best): {target}")
        return axes


def rounded_error(error: float, sd: Optional[float]) -> str:
    """"3.6e-06 ± 1.0e-06": errors are small numbers, given to two significant digits."""
    return f"{error:.2g}" if sd is None else f"{error:.2g} ± {sd:.1g}"


def require(sweep: PathLike, targets: Sequence[str], *, confirm: Optional[str] = None, runs: int = 20,
            track_runs: int = 200, seed: Optional[int] = None, jobs: Optional[int] = None, progress: Progress = None) -> Requirement:
    """Which cameras and settings of a sweep reach a target, the cheapest first, and what limits the others.

    Parameters
    ----------
    sweep : str or path
        A sweep file over cameras or settings (docs/reference/sweep.md).
    targets : sequence of str
        ``"mu=0.0005"``, ``"k_over_m_1_s:error95=0.01"``, ``"mu:bias=0.0001"``.
    confirm : {"tracks", "clips", "none"}, optional
        How candidates that the Cramér-Rao bound allows are judged: by rendered clips, which takes minutes, by tracks
        with the predicted noise (no lens, shutter, codec and calibration), or not at all. As the command: by clips if
        the sweep says ``level = "clips"``, else by tracks.
    runs, track_runs : int
        The most rendered runs of a candidate, with clips, and runs as tracks of each.
    seed, jobs, progress
        As in `validate`.

    Returns
    -------
    Requirement
        As ``glidelab require`` writes it. A target that nothing reaches raises no exception.

    Raises
    ------
    InputError
        A wrong sweep or target.

    Notes
    -----
    docs/evidence/requirements.md. What no camera can undercut is the Cramér-Rao bound (Rao 1945).
    """
    wanted = [targets] if isinstance(targets, str) else texts("targets", targets, "texts such as \"mu=0.0005\"")
    if not wanted:
        raise input_error("targets", "none", "one or more, such as \"mu=0.0005\"")
    how = "" if confirm is None else text("confirm", confirm, "none, tracks or clips")
    if confirm is not None and not how:
        raise input_error("confirm", "\"\"", "none, tracks or clips")
    made = Made(_glidelab.require(file_name("sweep", sweep), wanted, how, whole("runs", runs, 2, 100000),
                                  whole("track_runs", track_runs, 2, 1000000), checked_seed(seed), job_count(jobs),
                                  teller(progress)))
    found = Result(made).to_dict()
    of_targets = [{name: tuple(target.get(name) for target in one["targets"])
                   for name in ("found", "found_sd", "bound")} for one in found["candidates"]]
    return Requirement(made, found["name"], tuple(
        Candidate(one["name"], one["reached"], one["verdict"], one.get("price_eur"), one.get("frame_rate_hz"),
                  one.get("noise_m"), of["found"], of["found_sd"], of["bound"])
        for one, of in zip(found["candidates"], of_targets)), tuple(found["targets"]))


@dataclass(frozen=True, eq=False, repr=False)
class Sweep(Result):
    """Errors over all runs of a sweep, and over each key that varies.

    Attributes
    ----------
    name : str
        Of the sweep.
    runs, failed : int
        In the database, and of these without a result.
    database : str
        The SQLite file with every run.
    outside : OutsideRuns or None
        How the runs of the estimator went that was given as a command.
    """

    name: str
    runs: int
    failed: int
    database: str
    outside: Optional[OutsideRuns] = None

    def to_frame(self) -> Any:
        """A pandas.DataFrame, one row per quantity and estimator, over all runs."""
        rows = self.to_dict()["overall"]
        columns = {name: [row.get(name) for row in rows] for name in (rows[0] if rows else ())}
        if rows:
            columns["bias"] = columns["mean_error"]  # as other studies call it
        return frame_of(columns, [name for name in _IN_ITS_UNIT if name in columns])

    def plot(self) -> list[Any]:
        """The root mean square error over each key that varies, with the least that any estimator can have dashed.

        Returns
        -------
        list of matplotlib.axes.Axes
            A row of axes a key, one for each quantity with an error; a colour an estimator.
        """
        curves = [(key["name"], quantity, rows) for key in self.to_dict()["axes"]
                  for quantity, rows in _by_quantity(key["groups"]).items()]
        axes = new_axes(len(curves)) if curves else []
        for axis, (key, quantity, rows) in zip(axes, curves):
            places = list(dict.fromkeys(row["at"] for row in rows))
            values = _numbers(places)
            for number, estimator in enumerate(dict.fromkeys(row["estimator"] for row in rows)):
                of = [row for row in rows if row["estimator"] == estimator]
                x = [values[places.index(row["at"])] for row in of]
                axis.plot(x, [row["rms_error"] for row in of], "o-", color=f"C{number}", label=estimator)
                least = [(at, row["least_sd"]) for at, row in zip(x, of) if row.get("least_sd") is not None]
                axis.plot([at for at, _ in least], [sd for _, sd in least], "--", color="0.6")
            axis.set_xticks(values, places, fontsize=7)
            axis.set_yscale("log")
            axis.set_xlabel(key)
            axis.set_ylabel(words_of(quantity, "rms error of "))
            axis.legend(fontsize=7)
        return axes

    def _repr_html_(self) -> str:
        document = self.to_dict()
        tables = [html_table(["quantity", "estimator", *_HEADER], [
            [words_of(row["quantity"]), row["estimator"], *_cells(row)] for row in document["overall"]],
            f"{self.name}: {self.runs} runs, {self.failed} failed")]
        for key in document["axes"]:
            tables.append(html_table([key["name"], "quantity", "estimator", *_HEADER], [
                [row["at"], words_of(row["quantity"]), row["estimator"], *_cells(row)] for row in key["groups"]]))
        return "".join(tables) + html_plot(self.plot)


_IN_ITS_UNIT = ("mean_error", "bias", "mean_error_sd", "rms_error", "stated_sd", "least_sd")
_HEADER = ("answers", "mean error", "rms error", "stated sd", "least sd", "95 % hold")


def _cells(row: Mapping[str, Any]) -> list[str]:
    numbers = [row.get(name) for name in ("mean_error", "rms_error", "stated_sd", "least_sd")]
    held = row.get("coverage")
    return [f"{row['answered']} of {row['runs']}", *("" if one is None else f"{one:.3g}" for one in numbers),
            "" if held is None else f"{100.0 * held:.0f} %"]


def _numbers(places: Sequence[str]) -> list[float]:
    """Where values of a key stand on an axis: at themselves, or one after the other where they are no numbers."""
    try:
        return [float(place) for place in places]
    except ValueError:
        return [float(number) for number in range(len(places))]


def _by_quantity(rows: Sequence[Mapping[str, Any]]) -> dict[str, list[Mapping[str, Any]]]:
    found: dict[str, list[Mapping[str, Any]]] = {}
    for row in rows:
        if row.get("rms_error") is not None:
            found.setdefault(row["quantity"], []).append(row)
    return found


def sweep(file: PathLike, folder: PathLike, *, estimator_command: Union[str, Estimator, None] = None, estimator_name: str = "",
          estimator_seconds: float = 60.0, estimator_megabytes: float = 4096.0,
          seed: Optional[int] = None, jobs: Optional[int] = None, progress: Progress = None) -> Sweep:
    """Runs a scenario many times with varied values. Called again with the same folder, it resumes where it stopped.

    Parameters
    ----------
    file : str or path
        A sweep file (docs/reference/sweep.md).
    folder : str or path
        Where its database ``sweep.sqlite`` lies or is made. After Ctrl-C the runs that are finished stay there.
    estimator_command, estimator_name, estimator_seconds, estimator_megabytes
        As in `validate`.
    seed, jobs, progress
        As in `validate`.

    Returns
    -------
    Sweep
        As ``glidelab sweep --json`` prints it.

    Raises
    ------
    InputError
        A wrong sweep, or a database of another one.

    Notes
    -----
    docs/reference/sweep.md. The least standard deviation is the Cramér-Rao bound (Rao 1945).
    """
    with given_command(estimator_command, estimator_name, estimator_seconds, estimator_megabytes) as given:
        made = Made(_glidelab.sweep(file_name("file", file), file_name("folder", folder, "the name of a folder"),
                                    given.command, checked_seed(seed), job_count(jobs), teller(progress)))
    found = Result(made).to_dict()
    return Sweep(made, found["name"], found["runs"], found["failed"], os.path.join(os.fspath(folder), "sweep.sqlite"),
                 outside_runs(found, given.calls_s))
