"""validate() and coverage(), and what judge() finds: estimates compared with the truth of a scenario."""

from __future__ import annotations

import html
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional, SupportsFloat, Union

from . import _glidelab
from ._checks import above_0, optional_real, reals, whole
from ._inputs import Progress, Scenario, checked_seed, given_scenario, job_count, teller
from ._outside import Estimator, OutsideRuns, given_command, outside_runs
from ._results import NORMAL95, Made, Result, Written, frame_of, rounded, unit_of, words_of
from ._shown import html_plot, html_table, new_axes


@dataclass(frozen=True)
class Recovery:
    """One recovered value and its truth; None where there is none.

    Attributes
    ----------
    configuration, estimator, quantity : str
        Of what, by what; ``k_over_m_1_s``, ``mu``, ``alpha_deg`` or ``v_lim_m_s``.
    truth, value, sd, error : float or None
        What the scenario put in, what was found, its standard deviation, value less truth.
    cramer_rao_sd : float or None
        The least standard deviation that any unbiased estimator can have with these frames and this noise.
    """

    configuration: str
    estimator: str
    quantity: str
    truth: Optional[float]
    value: Optional[float]
    sd: Optional[float]
    error: Optional[float]
    cramer_rao_sd: Optional[float]


@dataclass(frozen=True)
class _Error:
    quantity: str
    estimator: str
    configuration: str
    error: Optional[float]
    bar: float


def _error_axes(rows: Sequence[_Error]) -> list[Any]:
    """An axis a quantity with an error, the configurations along it, a colour an estimator."""
    erring = [row for row in rows if row.error is not None]
    names = list(dict.fromkeys(row.quantity for row in erring))
    estimators = list(dict.fromkeys(row.estimator for row in rows))
    places = list(dict.fromkeys(row.configuration for row in rows))
    axes = new_axes(len(names))
    for axis, name in zip(axes, names):
        for number, estimator in enumerate(estimators):
            of = [row for row in erring if (row.quantity, row.estimator) == (name, estimator)]
            if of:
                axis.errorbar([places.index(row.configuration) + 0.15 * number for row in of],
                              [row.error for row in of], [row.bar for row in of], fmt="o", color=f"C{number}",
                              label=estimator)
        axis.axhline(0.0, color="0.8", zorder=0)
        axis.set_xticks(range(len(places)), places)
        axis.set_ylabel(words_of(name, "error of "))
        axis.legend()
    return axes


@dataclass(frozen=True, eq=False, repr=False)
class Validation(Result):
    """A scenario filmed, analysed, and compared with its truth.

    Attributes
    ----------
    quantities : tuple of Recovery
        Every quantity of every configuration by every estimator.
    frames, detected : int
        Of all clips, and those in which the marker was found.
    analysis_json : str
        results.json of the analysis.
    outside : OutsideRuns or None
        How the runs of the estimator went that was given as a command.
    """

    quantities: tuple[Recovery, ...]
    frames: int
    detected: int
    analysis_json: str
    outside: Optional[OutsideRuns] = None

    def analysis_dict(self) -> dict[str, Any]:
        """results.json of the analysis as a dict."""
        document: dict[str, Any] = json.loads(self.analysis_json)
        return document

    def to_frame(self) -> Any:
        """A pandas.DataFrame, one row per value."""
        return frame_of({name: [getattr(one, name) for one in self.quantities] for name in (
            "configuration", "estimator", "quantity", "truth", "value", "sd", "error", "cramer_rao_sd")},
                        ("truth", "value", "sd", "error", "cramer_rao_sd"))

    def plot(self) -> list[Any]:
        """Errors with 95 % bars, in the quantity's unit, an axis a quantity and a colour an estimator.

        Returns
        -------
        list of matplotlib.axes.Axes
            One for each quantity with an error.
        """
        return _error_axes([_Error(one.quantity, one.estimator, one.configuration, one.error,
                                   NORMAL95 * (one.sd or 0.0)) for one in self.quantities])

    def _repr_html_(self) -> str:
        document = self.to_dict()
        answer = " ".join(str(self).partition("\n\n")[0].split())
        head = f"<p><b>{html.escape(answer)}</b></p><p>The marker was found in {self.detected} of {self.frames} frames.</p>"
        rows = [[one.configuration, one.estimator, words_of(one.quantity),
                 *("" if number is None else f"{number:.5g}" for number in (one.truth, one.value, one.sd, one.error)),
                 "" if one.error is None or not one.sd else f"{one.error / one.sd:+.2f}",
                 "" if one.cramer_rao_sd is None else f"{one.cramer_rao_sd:.3g}"] for one in self.quantities]
        lines = [[one["clip"], "v < 0" if one["direction"] < 0 else "v > 0", f"{one['r2']:.6f}"]
                 for one in document.get("lines", ())]
        return (head + html_table(["configuration", "estimator", "quantity", "truth", "found", "sd", "error", "error/sd",
                                   "least sd"], rows)
                + (html_table(["clip", "line", "R²"], lines) if lines else "") + html_plot(self.plot))


def validate(scenario: Scenario, *, estimator_command: Union[str, Estimator, None] = None, estimator_name: str = "",
             estimator_seconds: float = 60.0, estimator_megabytes: float = 4096.0,
             seed: Optional[int] = None, jobs: Optional[int] = None, progress: Progress = None) -> Validation:
    """Films a scenario, analyses the images, and compares the results with the truth.

    Parameters
    ----------
    scenario : str, path or dict
        A scenario file (docs/reference/scenario.md), or what `load_scenario` makes of one.
    estimator_command : str or callable, optional
        Also judge an estimator of your own: a program that reads the experiment folder ``{folder}`` and writes
        ``{out}/results.json``, such as ``"python3 mine.py {folder} {out}"`` (docs/reference/own-estimator.md); or a
        function as `estimator` describes it, or its name if it is registered, which states a standard deviation with
        each value. A function is called in this process, for one run at a time.
    estimator_name : str
        Its name in results; the name of its file, or the function's.
    estimator_seconds, estimator_megabytes : float
        The longest time that a run of it may take, and the memory of each of its processes. A function's call that takes
        longer counts as a failure and is not ended, and its memory is not bounded.
    seed : int, optional
        Of the camera's noise; the scenario's.
    jobs, progress
        As in `analyze`.

    Returns
    -------
    Validation
        As ``glidelab validate`` writes it. The films lie in a temporary folder for as long as the result lives;
        ``write(folder)`` copies them out.

    Raises
    ------
    InputError, NumericalError, SystemFailure
        What rendering and analysis raise. An estimator_command that fails raises nothing: see `Validation.outside`.

    Notes
    -----
    docs/guide/trust.md; the least standard deviation is the Cramér-Rao bound (Rao 1945) of these frames and this noise.
    """
    with given_command(estimator_command, estimator_name, estimator_seconds, estimator_megabytes) as given:
        outcome, analysis = _glidelab.validate(given_scenario(scenario), given.command, checked_seed(seed), job_count(jobs),
                                               teller(progress))
    made = Made(outcome)
    found = Result(made).to_dict()
    names = ("truth", "value", "sd", "error", "cramer_rao_sd")
    return Validation(made, tuple(
        Recovery(one["configuration"], one["estimator"], one["quantity"], *(one.get(name) for name in names))
        for one in found["quantities"]), found["frames"], found["detected"], analysis, outside_runs(found, given.calls_s))


@dataclass(frozen=True)
class CoverageRow:
    """How often the 95 % intervals of one quantity contain the true value.

    Attributes
    ----------
    configuration, estimator, quantity : str
        Of what, by what.
    truth, bias, sd, rms_error, stated_sd : float or None
        The truth; mean error, standard deviation and root mean square of the errors; the root mean square of what was
        stated.
    answered, covered : int
        Replicates with a value (also called `determined`), and intervals that contain the true value.
    coverage : float or None
        Their ratio.
    interval95 : (float, float) or None
        Exact binomial interval of the coverage (Clopper and Pearson 1934).
    p_value : float or None
        Of a count as far from 95 %.
    """

    configuration: str
    estimator: str
    quantity: str
    truth: Optional[float]
    determined: int
    covered: int
    bias: Optional[float]
    sd: Optional[float]
    stated_sd: Optional[float]
    coverage: Optional[float]
    interval95: Optional[tuple[float, float]]
    p_value: Optional[float]

    @property
    def answered(self) -> int:
        """Replicates with a value."""
        return self.determined

    @property
    def rms_error(self) -> Optional[float]:
        """Root mean square of the errors: their mean and their standard deviation together."""
        if self.bias is None or self.sd is None:
            return None
        return math.sqrt(self.bias**2 + self.sd**2 * (self.determined - 1) / self.determined)


@dataclass(frozen=True, eq=False, repr=False)
class Coverage(Result):
    """How often stated intervals contain the true value.

    Attributes
    ----------
    replicates : int
        How many experiments were made.
    rows : tuple of CoverageRow
        Every quantity of every configuration by every estimator.
    outside : OutsideRuns or None
        How the runs of the estimator went that was given as a command.
    """

    replicates: int
    rows: tuple[CoverageRow, ...]
    outside: Optional[OutsideRuns] = None

    def to_frame(self) -> Any:
        """A pandas.DataFrame, one row per quantity."""
        return frame_of({name: [getattr(one, name) for one in self.rows] for name in (
            "configuration", "estimator", "quantity", "truth", "determined", "covered", "bias", "sd", "stated_sd",
            "coverage", "p_value", "answered", "rms_error")}, ("truth", "bias", "sd", "stated_sd", "rms_error"))

    def plot(self) -> Any:
        """How often the 95 % intervals hold, with the interval of that count, a bar a quantity.

        Returns
        -------
        matplotlib.axes.Axes
            Rows as in `rows`, those without an interval left out.
        """
        counted = [one for one in self.rows if one.coverage is not None and one.interval95 is not None]
        ax = new_axes(1)[0]
        for number, one in enumerate(counted):
            low, high = one.interval95 or (0.0, 0.0)
            ax.barh(number, 100.0 * (one.coverage or 0.0), color="0.85")
            ax.plot([100.0 * low, 100.0 * high], [number, number], color="C0" if low <= 0.95 <= high else "C3", linewidth=3)
        ax.axvline(95.0, color="0.4", linestyle="--")
        ax.set_yticks(range(len(counted)), [f"{one.configuration}, {words_of(one.quantity)}, {one.estimator}" for one in counted],
                      fontsize=7)
        ax.invert_yaxis()
        ax.set_xlim(min([70.0, *(100.0 * (one.interval95 or (1.0,))[0] for one in counted)]), 100.0)
        ax.set_xlabel("95 % intervals that contain the true value (%)")
        return ax

    def _repr_html_(self) -> str:
        def text(number: Optional[float]) -> str:
            return "" if number is None else f"{number:.3g}"

        rows = [[one.configuration, one.estimator, words_of(one.quantity), f"{one.determined} of {self.replicates}",
                 text(one.bias), text(one.sd), text(one.stated_sd),
                 "" if one.coverage is None else f"{100.0 * one.coverage:.1f} %",
                 "" if one.interval95 is None else
                 f"{100.0 * one.interval95[0]:.1f} to {100.0 * one.interval95[1]:.1f} %"] for one in self.rows]
        return html_table(["configuration", "estimator", "quantity", "answers", "mean error", "sd", "stated sd",
                           "95 % intervals that hold", "95 % interval of this share"], rows) + html_plot(self.plot)


def coverage(scenario: Scenario, *, noise_m: Optional[float] = None, replicates: int = 1000,
             levels: Sequence[float] = (), bandwidth_s: Optional[SupportsFloat] = None,
             estimator_command: Union[str, Estimator, None] = None, estimator_name: str = "",
             estimator_seconds: float = 60.0, estimator_megabytes: float = 4096.0,
             seed: Optional[int] = None, jobs: Optional[int] = None, progress: Progress = None) -> Coverage:
    """Analyses many replicates of a scenario's motions, and counts how often the intervals contain the true value.

    Parameters
    ----------
    scenario : str, path or dict
        As in `validate`. Nothing is rendered.
    noise_m : float, optional
        Standard deviation of a position in metres; the least that the scenario's camera allows, clip by clip.
    replicates : int
        Number of experiments.
    levels : sequence of float
        Of the intervals that are counted, above 0 and below 1; 0.5, 0.68, 0.9, 0.95, 0.99.
    bandwidth_s : float, optional
        Of the phase diagram; chosen clip by clip.
    estimator_command, estimator_name, estimator_seconds, estimator_megabytes
        As in `validate`.
    seed, jobs, progress
        As in `validate`.

    Returns
    -------
    Coverage
        As ``glidelab coverage`` writes it. Intervals that are too narrow raise no exception.

    Raises
    ------
    InputError
        Wrong input, or a camera that cannot see the marker.

    Notes
    -----
    docs/evidence/coverage.md. Intervals of a count are those of Clopper and Pearson (1934).
    """
    bandwidth = None if bandwidth_s is None else above_0("bandwidth_s", bandwidth_s, "seconds, above 0")
    noise = optional_real("noise_m", noise_m, "a number of metres, or None")
    with given_command(estimator_command, estimator_name, estimator_seconds, estimator_megabytes) as given:
        made = Made(_glidelab.coverage(given_scenario(scenario), noise, whole("replicates", replicates, 1, 1000000),
                                       reals("levels", levels, "a list of levels above 0 and below 1"), bandwidth,
                                       given.command, checked_seed(seed), job_count(jobs), teller(progress)))
    found = Result(made).to_dict()
    rows = []
    for one in found["quantities"]:
        interval = one.get("coverage_interval95")
        rows.append(CoverageRow(
            one["configuration"], one["estimator"], one["quantity"], one.get("truth"), one["determined"],
            one["covered"], one.get("bias"), one.get("sd"), one.get("stated_sd"), one.get("coverage"),
            None if interval is None else (interval[0], interval[1]), one.get("p_value")))
    return Coverage(made, found["replicates"], tuple(rows), outside_runs(found, given.calls_s))


@dataclass(frozen=True)
class Judged:
    """The errors of one estimator in one quantity of one configuration.

    Attributes
    ----------
    configuration, estimator, quantity : str
        Of what, by what.
    truth : float
        What the scenario put in.
    answered, failed : int
        Replicates with a value, and those in which the estimator failed: it raised something, gave no answer as
        `estimator` describes it, or took too long.
    bias, sd, rms_error : float or None
        Mean error, standard deviation and root mean square of the errors; None without an answer. Also called `rms`.
    stated : int
        Answers with an interval.
    coverage : float or None
        The share of these whose 95 % interval contains the true value. Also called `covered`.
    """

    configuration: str
    estimator: str
    quantity: str
    truth: float
    answered: int
    failed: int
    bias: Optional[float]
    sd: Optional[float]
    rms: Optional[float]
    stated: int
    covered: Optional[float]

    @property
    def rms_error(self) -> Optional[float]:
        """Root mean square of the errors."""
        return self.rms

    @property
    def coverage(self) -> Optional[float]:
        """The share of stated 95 % intervals that contain the true value."""
        return self.covered


@dataclass(frozen=True, eq=False, repr=False)
class Judgement(Written):
    """How estimators did on the same motions.

    Attributes
    ----------
    replicates : int
        How many experiments were made.
    rows : tuple of Judged
        Every quantity with a truth, of every configuration, by every estimator.
    seconds : dict of str to float
        Mean time that an estimator took for an experiment.
    failures : dict of str to str
        How an estimator failed first.
    """

    replicates: int
    rows: tuple[Judged, ...]
    seconds: Mapping[str, float]
    failures: Mapping[str, str]

    def failed(self, estimator_name: str) -> int:
        """Replicates in which an estimator failed."""
        return max((row.failed for row in self.rows if row.estimator == estimator_name), default=0)

    def of(self, estimator_name: str, quantity: str) -> tuple[Judged, ...]:
        """The rows of one estimator and one quantity, one per configuration."""
        return tuple(row for row in self.rows if row.estimator == estimator_name and row.quantity == quantity)

    def to_frame(self) -> Any:
        """A pandas.DataFrame, one row per quantity."""
        return frame_of({name: [getattr(row, name) for row in self.rows] for name in (
            "configuration", "quantity", "estimator", "truth", "answered", "failed", "bias", "sd", "rms", "covered",
            "rms_error", "coverage")}, ("truth", "bias", "sd", "rms", "rms_error"))

    def _columns(self) -> Mapping[str, Sequence[Any]]:
        table = {name: [getattr(row, name) for row in self.rows] for name in (
            "configuration", "quantity", "estimator", "truth", "answered", "failed", "bias", "sd", "rms_error", "stated",
            "coverage")}
        return {**table, "unit": [unit_of(row.quantity) for row in self.rows]}

    def plot(self) -> list[Any]:
        """Mean errors with the standard deviation of the errors as bars, in the quantity's unit, an axis a quantity and
        a colour an estimator.

        Returns
        -------
        list of matplotlib.axes.Axes
            One for each quantity with an answer.
        """
        return _error_axes([_Error(row.quantity, row.estimator, row.configuration, row.bias, row.sd or 0.0)
                            for row in self.rows])

    def _table(self) -> list[list[str]]:
        def text(value: Optional[float]) -> str:
            return "" if value is None else f"{value:.3g}"
        return [[row.configuration, words_of(row.quantity), row.estimator, rounded(row.truth, None),
                 f"{row.answered} of {self.replicates}" + (f", {row.failed} failed" if row.failed else ""),
                 text(row.bias), text(row.rms),
                 "" if row.covered is None else f"{100.0 * row.covered:.0f} %"] for row in self.rows]

    def __str__(self) -> str:
        rows = [list(_HEADER), *self._table()]
        widths = [max(len(row[i]) for row in rows) for i in range(len(_HEADER))]
        lines = self._failures()
        lines += ["  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows]
        lines += [f"{name}: {1e3 * seconds:.2f} ms an experiment" for name, seconds in self.seconds.items()]
        return "\n".join(lines) + "\n"

    def _failures(self) -> list[str]:
        """A line for each estimator that failed: what is below is not about these replicates."""
        return [f"{name} failed in {self.failed(name)} of {self.replicates} replicates, first with: {what}"
                for name, what in self.failures.items()]

    def _repr_html_(self) -> str:
        failed = "".join(f"<p><b>{html.escape(line)}</b></p>" for line in self._failures())
        return failed + html_table(list(_HEADER), self._table()) + html_plot(self.plot)


_HEADER = ("configuration", "quantity", "estimator", "truth", "answers", "mean error", "rms error", "95 % hold")
