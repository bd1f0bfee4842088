"""gate(): is an estimator, or the analysis, worse than it was when its baseline was written?"""

from __future__ import annotations

import html
import json
from collections.abc import Mapping, Sequence
from dataclasses import InitVar, dataclass
from pathlib import Path
from typing import Any, Optional, Union

from . import _glidelab
from ._checks import above_0, file_name, whole
from ._errors import SystemFailure
from ._inputs import PathLike, Progress, Scenario, checked_seed, given_scenario, job_count, teller
from ._outside import Estimator, OutsideRuns, given_command, outside_runs
from ._results import Written, frame_of, put_whole, unit_of, words_of
from ._shown import html_table

_FEWEST, _MOST = 10, 1000000  # runs, as of the command's --runs


@dataclass(frozen=True)
class GateRow:
    """The errors of one quantity, and what a comparison with the baseline detects of it.

    Attributes
    ----------
    configuration, estimator, quantity : str
        Of what, by what.
    answered, covered : int
        Runs with a value, and those whose 95 % interval contains the true value.
    bias, sd : float or None
        Mean error and standard deviation of the errors; None where too few runs have a value.
    efficiency : float or None
        The Cramér-Rao bound of the variance over the mean square error; None where there is no bound.
    factor : float or None
        Errors this many times as large are detected with probability 0.95; None where no factor is, or nothing is compared.
    runs_for_1_1 : int or None
        How many runs, in the baseline and now, detect errors 1.1 times as large with that probability.
    """

    configuration: str
    estimator: str
    quantity: str
    answered: int
    covered: int
    bias: Optional[float]
    sd: Optional[float]
    efficiency: Optional[float]
    factor: Optional[float] = None
    runs_for_1_1: Optional[int] = None


@dataclass(frozen=True)
class Worse:
    """One thing that has become worse.

    Attributes
    ----------
    configuration, estimator, quantity : str
        Of what, by what; of the smoothing the clip, the estimator, and ``"a"`` or ``"bandwidth"``.
    what : str
        ``"spread"``, ``"bias"``, ``"coverage"`` or ``"answers"``; of the smoothing ``"rms error"`` or ``"mean"``.
    then, now : float
        In the baseline, and now.
    p_value : float
        Of this test alone.
    """

    configuration: str
    estimator: str
    quantity: str
    what: str
    then: float
    now: float
    p_value: float


class _Told:  # pylint: disable=too-few-public-methods
    """Where a gate keeps what it says: in no field, so that its data are its fields alone."""

    _text: str


@dataclass(frozen=True, eq=False, repr=False)
class Gate(_Told, Written):
    """Errors of replicated tracks, compared with those of a baseline where there is one.

    Attributes
    ----------
    passed : bool or None
        Whether nothing has become significantly worse; None without a baseline.
    worse : tuple of Worse
        What has.
    rows : tuple of GateRow
        Every quantity with a true value, of every configuration, by every estimator.
    runs, seed : int
        Of the replicates, and of their noise.
    noise_m : float
        Standard deviation of a position in metres.
    tests : int or None
        How many tests the comparison makes, at a significance of 1 % over all; None without a baseline.
    outside : OutsideRuns or None
        How the runs of the estimator went that was given as a command or a function.
    baseline_json : str
        These errors as the file that a later gate compares with: see `write_baseline`.
    """

    passed: Optional[bool]
    worse: tuple[Worse, ...]
    rows: tuple[GateRow, ...]
    runs: int
    seed: int
    noise_m: float
    tests: Optional[int]
    outside: Optional[OutsideRuns]
    baseline_json: str
    text: InitVar[str]

    def __post_init__(self, text: str) -> None:
        object.__setattr__(self, "_text", text)

    def write_baseline(self, file: PathLike) -> None:
        """Writes these errors as a baseline, byte for byte what ``validate --write-baseline`` writes.

        Parameters
        ----------
        file : str or path
            It appears whole or not at all, in the place of one that lies there.

        Raises
        ------
        SystemFailure
            It cannot be written.
        """
        where = Path(file_name("file", file))
        try:
            put_whole(where.parent, {where.name: self.baseline_json})
        except OSError as error:
            raise SystemFailure(f"{where}: cannot be written: {error.strerror}") from None

    def to_dict(self) -> dict[str, Any]:
        """Its data as JSON has them; the baseline, which is a document of its own, is left out."""
        data = super().to_dict()
        return {key: value for key, value in data.items() if key != "baseline_json"}

    def to_frame(self) -> Any:
        """A pandas.DataFrame, one row per quantity."""
        return frame_of({name: [getattr(row, name) for row in self.rows] for name in _COLUMNS}, ("bias", "sd"))

    def _columns(self) -> Mapping[str, Sequence[Any]]:
        table = {name: [getattr(row, name) for row in self.rows] for name in _COLUMNS}
        return {**table, "unit": [unit_of(row.quantity) for row in self.rows]}

    def __str__(self) -> str:
        return self._text

    def _repr_html_(self) -> str:
        def number(value: Optional[float]) -> str:
            return "" if value is None else f"{value:.3g}"

        answer = "" if self.passed is None else (
            "Nothing is worse than the baseline." if self.passed else "Worse than the baseline:")
        worse = [[one.configuration, one.estimator, words_of(one.quantity), one.what, number(one.then), number(one.now),
                  f"{one.p_value:.1g}"] for one in self.worse]
        rows = [[row.configuration, row.estimator, words_of(row.quantity), f"{row.answered} of {self.runs}", number(row.bias),
                 number(row.sd), str(row.covered), number(row.factor),
                 "" if row.runs_for_1_1 is None else str(row.runs_for_1_1)] for row in self.rows]
        return ((f"<p><b>{html.escape(answer)}</b></p>" if answer else "")
                + (html_table(["configuration", "estimator", "quantity", "what", "then", "now", "p"], worse) if worse else "")
                + html_table(["configuration", "estimator", "quantity", "answers", "mean error", "sd of errors",
                              "95 % intervals that hold", "errors larger by this factor are found", "runs for a factor of 1.1"],
                             rows))


_COLUMNS = ("configuration", "estimator", "quantity", "answered", "covered", "bias", "sd", "efficiency", "factor",
            "runs_for_1_1")


def gate(scenario: Scenario, baseline: Optional[PathLike] = None, *, noise_m: Optional[float] = None, runs: int = 100,
         estimator_command: Union[str, Estimator, None] = None, estimator_name: str = "", estimator_seconds: float = 60.0,
         estimator_megabytes: float = 4096.0, seed: Optional[int] = None, jobs: Optional[int] = None,
         progress: Progress = None) -> Gate:
    """Measures the errors of an estimator over replicates of a scenario's motions, and compares them with a baseline.

    Parameters
    ----------
    scenario : str, path or dict
        As in `validate`. Nothing is rendered.
    baseline : str or path, optional
        The file of an earlier `Gate.write_baseline`, or of ``glidelab validate --write-baseline``, for the same scenario;
        without it nothing is compared.
    noise_m : float, optional
        Standard deviation of a position in metres; that of the baseline, which takes no other; without one 2e-5.
    runs : int
        How many replicates, 10 to 1000000. `GateRow.runs_for_1_1` says how many detect errors a tenth larger.
    estimator_command, estimator_name, estimator_seconds, estimator_megabytes
        As in `validate`; an estimator of your own is judged alone. Without one, all of Glidelab's are judged.
    seed : int, optional
        Of the noise; another one than the baseline's; without a baseline 1.
    jobs, progress
        As in `analyze`.

    Returns
    -------
    Gate
        What the command ``glidelab validate --baseline`` finds. What is worse raises no exception: see `Gate.passed`.

    Raises
    ------
    InputError
        A wrong scenario or option, or a baseline of another scenario, noise or estimator, or with the same seed.

    Notes
    -----
    Levene's test of the spread, Welch's t of the mean, and tests of two proportions of coverage and answers, at 1 % over
    all tests (Bonferroni). docs/evidence/gate.md has how often it finds an estimator that was worsened on purpose.

    Examples
    --------
    >>> before = glidelab.gate("scenarios/paper/inclined.toml", runs=1000, estimator_command=mine) # doctest: +SKIP
    >>> before.write_baseline("mine.json") # doctest: +SKIP
    >>> now = glidelab.gate("scenarios/paper/inclined.toml", "mine.json", runs=1000, # doctest: +SKIP
    ...                     estimator_command=mine)
    >>> assert now.passed, now # doctest: +SKIP
    """
    where = "" if baseline is None else file_name("baseline", baseline)
    noise = None if noise_m is None else above_0("noise_m", noise_m, "a number of metres above 0, or None")
    with given_command(estimator_command, estimator_name, estimator_seconds, estimator_megabytes) as given:
        stored, found_json, text = _glidelab.gate(
            given_scenario(scenario), where, noise, whole("runs", runs, _FEWEST, _MOST), given.command, checked_seed(seed),
            job_count(jobs), teller(progress))
    found: dict[str, Any] = json.loads(found_json)
    detectable = {_place(one): one for one in found.get("detectable", ())}
    rows = []
    for one in found["errors"]:
        least = detectable.get(_place(one), {})
        rows.append(GateRow(*_place(one), one["answered"], one["covered"], one["bias"], one["sd"], one["efficiency"],
                            least.get("factor"), least.get("runs_for_1_1")))
    worse = tuple(Worse(*_place(one), one["what"], one["then"], one["now"], one["p_value"])
                  for one in found.get("worse", ()))
    return Gate(found.get("passed"), worse, tuple(rows), found["runs"], found["seed"], found["noise_m"], found.get("tests"),
                outside_runs(found, given.calls_s), stored, text)


def _place(one: Mapping[str, Any]) -> tuple[str, str, str]:
    return one["configuration"], one["estimator"], one["quantity"]
