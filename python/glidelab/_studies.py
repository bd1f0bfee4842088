"""validate(), coverage(), require() and sweep(): estimates beside the truth of a scenario."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Optional

from . import _glidelab
from ._errors import input_error
from ._inputs import PathLike, Progress, Scenario, checked_seed, given_scenario, job_count, teller
from ._results import Made, Result, frame_of, html_table


def whole(name: str, value: int, least: int, most: int) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise input_error(name, repr(value), f"a whole number from {least} to {most}")
    return value


@dataclass(frozen=True)
class Recovery:
    """One recovered value beside its truth; None where there is none.

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
    """

    quantities: tuple[Recovery, ...]
    frames: int
    detected: int
    analysis_json: str

    def analysis_dict(self) -> dict[str, Any]:
        """results.json of the analysis as a dict."""
        document: dict[str, Any] = json.loads(self.analysis_json)
        return document

    def to_frame(self) -> Any:
        """A pandas.DataFrame, a row a value."""
        return frame_of({name: [getattr(one, name) for one in self.quantities] for name in (
            "configuration", "estimator", "quantity", "truth", "value", "sd", "error", "cramer_rao_sd")})

    def _repr_html_(self) -> str:
        rows = [[one.configuration, one.estimator, one.quantity,
                 *("" if number is None else f"{number:.5g}" for number in (one.truth, one.value, one.sd, one.error))]
                for one in self.quantities]
        return html_table(["configuration", "estimator", "quantity", "truth", "found", "sd", "error"], rows)


def validate(scenario: Scenario, *, seed: Optional[int] = None, jobs: Optional[int] = None,
             progress: Progress = None) -> Validation:
    """Films a scenario, analyses the images, and compares the results with the truth.

    Parameters
    ----------
    scenario : str, path or dict
        A scenario file (docs/reference/scenario.md), or what `load_scenario` makes of one.
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
        What rendering and analysis raise.
    """
    outcome, analysis = _glidelab.validate(given_scenario(scenario), checked_seed(seed), job_count(jobs),
                                           teller(progress))
    made = Made(outcome)
    found = Result(made).to_dict()
    names = ("truth", "value", "sd", "error", "cramer_rao_sd")
    return Validation(made, tuple(
        Recovery(one["configuration"], one["estimator"], one["quantity"], *(one.get(name) for name in names))
        for one in found["quantities"]), found["frames"], found["detected"], analysis)


@dataclass(frozen=True)
class CoverageRow:
    """How often the 95 % intervals of one quantity hold the truth.

    Attributes
    ----------
    configuration, estimator, quantity : str
        Of what, by what.
    truth, bias, sd, stated_sd : float or None
        The truth; mean error and standard deviation of the values; the root mean square of what was stated.
    determined, covered : int
        Replicates with a value, and intervals that hold the truth.
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


@dataclass(frozen=True, eq=False, repr=False)
class Coverage(Result):
    """How often stated intervals hold the truth.

    Attributes
    ----------
    replicates : int
        How many experiments were made.
    rows : tuple of CoverageRow
        Every quantity of every configuration by every estimator.
    """

    replicates: int
    rows: tuple[CoverageRow, ...]

    def to_frame(self) -> Any:
        """A pandas.DataFrame, a row a quantity."""
        return frame_of({name: [getattr(one, name) for one in self.rows] for name in (
            "configuration", "estimator", "quantity", "truth", "determined", "covered", "bias", "sd", "stated_sd",
            "coverage", "p_value")})


def coverage(scenario: Scenario, *, noise_m: Optional[float] = None, replicates: int = 1000,
             levels: Sequence[float] = (), bandwidth_s: Optional[float] = None, seed: Optional[int] = None,
             jobs: Optional[int] = None, progress: Progress = None) -> Coverage:
    """Analyses many replicates of a scenario's motions, and counts how often the intervals hold the truth.

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
    seed, jobs, progress
        As in `validate`.

    Returns
    -------
    Coverage
        As ``glidelab coverage`` writes it. Intervals that are too narrow are no exception.

    Raises
    ------
    InputError
        Wrong input, or a camera that cannot see the marker.
    """
    made = Made(_glidelab.coverage(given_scenario(scenario), noise_m, whole("replicates", replicates, 1, 1000000),
                                   [float(level) for level in levels], bandwidth_s, checked_seed(seed),
                                   job_count(jobs), teller(progress)))
    found = Result(made).to_dict()
    rows = []
    for one in found["quantities"]:
        interval = one.get("coverage_interval95")
        rows.append(CoverageRow(
            one["configuration"], one["estimator"], one["quantity"], one.get("truth"), one["determined"],
            one["covered"], one.get("bias"), one.get("sd"), one.get("stated_sd"), one.get("coverage"),
            None if interval is None else (interval[0], interval[1]), one.get("p_value")))
    return Coverage(made, found["replicates"], tuple(rows))


@dataclass(frozen=True)
class Candidate:
    """One camera or setting of a sweep, as a requirement judges it.

    Attributes
    ----------
    name, verdict : str
        Of the sweep's point, and what is said of it.
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

    def to_frame(self) -> Any:
        """A pandas.DataFrame, a row a candidate; of several targets the first target's error and bound."""
        columns: dict[str, list[Any]] = {name: [getattr(one, name) for one in self.candidates] for name in (
            "name", "reached", "verdict", "price_eur", "frame_rate_hz", "noise_m")}
        columns["error"] = [one.errors[0] if one.errors else None for one in self.candidates]
        columns["bound"] = [one.bounds[0] if one.bounds else None for one in self.candidates]
        return frame_of(columns)

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
        return html_table(header, rows)


def rounded_error(error: float, sd: Optional[float]) -> str:
    """"3.6e-06 ± 1.0e-06": errors are small numbers, of which two digits count."""
    return f"{error:.2g}" if sd is None else f"{error:.2g} ± {sd:.1g}"


def require(sweep: PathLike, targets: Sequence[str], *, confirm: str = "tracks", runs: int = 12, track_runs: int = 200,
            seed: Optional[int] = None, jobs: Optional[int] = None, progress: Progress = None) -> Requirement:
    """Which cameras and settings of a sweep reach a target, the cheapest first, and what limits the others.

    Parameters
    ----------
    sweep : str or path
        A sweep file over cameras or settings (docs/reference/sweep.md).
    targets : sequence of str
        ``"mu=0.0005"``, ``"k_over_m_1_s:error95=0.01"``, ``"mu:bias=0.0001"``.
    confirm : {"tracks", "clips", "none"}
        How what the Cramer-Rao bound allows is confirmed.
    runs, track_runs : int
        Rendered runs, with ``confirm="clips"``, and runs as tracks of each candidate.
    seed, jobs, progress
        As in `validate`.

    Returns
    -------
    Requirement
        As ``glidelab require`` writes it. A target that nothing reaches is no exception.

    Raises
    ------
    InputError
        A wrong sweep or target.
    """
    if isinstance(targets, str):
        targets = [targets]
    if not targets:
        raise input_error("targets", "none", "one or more, such as \"mu=0.0005\"")
    made = Made(_glidelab.require(os.fspath(sweep), list(targets), confirm, whole("runs", runs, 2, 100000),
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
    """

    name: str
    runs: int
    failed: int
    database: str

    def to_frame(self) -> Any:
        """A pandas.DataFrame, a row a quantity and an estimator, over all runs."""
        rows = self.to_dict()["overall"]
        return frame_of({name: [row.get(name) for row in rows] for name in (rows[0] if rows else ())})


def sweep(file: PathLike, folder: PathLike, *, seed: Optional[int] = None, jobs: Optional[int] = None,
          progress: Progress = None) -> Sweep:
    """Runs a scenario many times with varied values. Called again with the same folder, it goes on where it stopped.

    Parameters
    ----------
    file : str or path
        A sweep file (docs/reference/sweep.md).
    folder : str or path
        Where its database ``sweep.sqlite`` lies or is made. After Ctrl-C the runs that are finished stay there.
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
    """
    made = Made(_glidelab.sweep(os.fspath(file), os.fspath(folder), checked_seed(seed), job_count(jobs),
                                teller(progress)))
    found = Result(made).to_dict()
    return Sweep(made, found["name"], found["runs"], found["failed"], os.path.join(os.fspath(folder), "sweep.sqlite"))
