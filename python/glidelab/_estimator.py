"""An estimator of your own, judged beside the built-in ones on the same motions."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional, TypeVar, Union

from . import _glidelab
from ._analysis import DEFAULT_ESTIMATOR, QUANTITIES, analyze
from ._errors import input_error
from ._inputs import Progress, Scenario, Track, checked_seed, given_scenario, job_count, teller
from ._results import Quantity, frame_of, html_table, rounded

Found = Union[float, tuple[float, float], Quantity, None]
Estimator = Callable[[Sequence[Track]], Mapping[str, Found]]
_Function = TypeVar("_Function", bound=Estimator)

_registered: dict[str, Estimator] = {}
_NORMAL95 = 1.959964  # the normal distribution's 97.5 % quantile


def estimator(function: _Function) -> _Function:
    """Registers a function as an estimator, under its name, so that `judge` takes it by default.

    Parameters
    ----------
    function : callable
        Called with the tracks of one configuration (one mass on one slope), a list of `Track`; returns a dict with any
        of ``k_over_m_1_s``, ``mu``, ``alpha_deg``, ``v_lim_m_s``, each a number, a pair of number and standard deviation,
        or a `Quantity`. What it cannot determine it leaves out, or gives as None.

    Returns
    -------
    callable
        The function.
    """
    name = function.__name__
    if name in _glidelab.estimator_names():
        raise input_error("estimator", f"the name \"{name}\"", "one that is not a built-in estimator's")
    _registered[name] = function
    return function


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
        Replicates with a value, and those in which the estimator raised something.
    bias, sd, rms : float or None
        Mean error, standard deviation and root mean square of the errors; None without an answer.
    stated : int
        Answers with a standard deviation.
    covered : float or None
        The part of these whose 95 % interval holds the truth.
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


@dataclass(frozen=True, eq=False)
class Judgement:
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
        What an estimator raised first.
    """

    replicates: int
    rows: tuple[Judged, ...]
    seconds: Mapping[str, float]
    failures: Mapping[str, str]

    def of(self, estimator_name: str, quantity: str) -> tuple[Judged, ...]:
        """The rows of one estimator and one quantity, a row a configuration."""
        return tuple(row for row in self.rows if row.estimator == estimator_name and row.quantity == quantity)

    def to_frame(self) -> Any:
        """A pandas.DataFrame, a row a quantity."""
        return frame_of({name: [getattr(row, name) for row in self.rows] for name in (
            "configuration", "quantity", "estimator", "truth", "answered", "failed", "bias", "sd", "rms", "covered")})

    def _table(self) -> list[list[str]]:
        def text(value: Optional[float]) -> str:
            return "" if value is None else f"{value:.3g}"
        return [[row.configuration, row.quantity, row.estimator, rounded(row.truth, None),
                 f"{row.answered} of {self.replicates}", text(row.bias), text(row.rms),
                 "" if row.covered is None else f"{100.0 * row.covered:.0f} %"] for row in self.rows]

    def __str__(self) -> str:
        rows = [list(_HEADER), *self._table()]
        widths = [max(len(row[i]) for row in rows) for i in range(len(_HEADER))]
        lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows]
        lines += [f"{name}: {1e3 * seconds:.2f} ms an experiment" for name, seconds in self.seconds.items()]
        lines += [f"{name} failed first with: {what}" for name, what in self.failures.items()]
        return "\n".join(lines) + "\n"

    def _repr_html_(self) -> str:
        return html_table(list(_HEADER), self._table())


_HEADER = ("configuration", "quantity", "estimator", "truth", "answers", "mean error", "rms error", "95 % hold")


class _Tally:
    """Errors of one estimator in one quantity of one configuration."""

    def __init__(self) -> None:
        self.errors: list[float] = []
        self.failed = 0
        self.stated = 0
        self.held = 0

    def add(self, quantity: Quantity, truth: float) -> None:
        """One replicate's."""
        if quantity.value is None:
            return
        self.errors.append(quantity.value - truth)
        if quantity.interval95 is not None:
            self.stated += 1
            self.held += quantity.interval95[0] <= truth <= quantity.interval95[1]


def _quantity(found: Found, of: str, key: str) -> Quantity:
    """What an estimator said; InputError for what is no number."""
    if found is None:
        return Quantity()
    if isinstance(found, Quantity):
        return found
    numbers = found if isinstance(found, tuple) else (found,)
    if len(numbers) > 2:
        raise input_error(f"{of}: {key}", f"{len(numbers)} numbers", "a number, or a number and its standard deviation")
    value = float(numbers[0])
    if not math.isfinite(value):
        return Quantity(why="not finite")
    if len(numbers) == 1 or not math.isfinite(float(numbers[1])):
        return Quantity(value)
    half = _NORMAL95 * float(numbers[1])
    return Quantity(value, float(numbers[1]), (value - half, value + half))


def _checked(answers: Mapping[str, Mapping[str, Found]], name: str) -> dict[str, dict[str, Quantity]]:
    """What an estimator of the user's said of each configuration; InputError for what is no answer."""
    results = {}
    for configuration, found in answers.items():
        for key in found:
            if key not in QUANTITIES:
                raise input_error(name, f"the quantity \"{key}\"", f"one of {', '.join(QUANTITIES)}")
        results[configuration] = {key: _quantity(found.get(key), name, key) for key in QUANTITIES}
    return results


def _built_in(name: str, tracks: Mapping[str, Sequence[Track]], gravity_m_s2: float,
              jobs: int) -> dict[str, dict[str, Quantity]]:
    """The same by one of Glidelab's, which sees all configurations together."""
    analysis = analyze([track for of in tracks.values() for track in of], estimator=name, gravity_m_s2=gravity_m_s2,
                       jobs=jobs)
    results: dict[str, dict[str, Quantity]] = {}
    for configuration, of in tracks.items():
        names = {track.name for track in of}
        for found in analysis.configurations:
            if names == set(found.clips):
                results[configuration] = {key: getattr(found, key) for key in QUANTITIES}
    return results


def judge(scenario: Scenario, *estimators: Union[Estimator, str], noise_m: float, replicates: int = 100,
          seed: Optional[int] = None, jobs: Optional[int] = None, progress: Progress = None) -> Judgement:
    """Runs estimators over replicates of a scenario's motions with noise, and compares what they say with the truth.

    Parameters
    ----------
    scenario : str, path or dict
        A scenario file (docs/reference/scenario.md), or what `load_scenario` makes of one. Nothing is rendered.
    *estimators : callable or str
        As `estimator` describes them, or names of built-in ones; without any, ``"phase-diagram"`` and all that are
        registered. They are given positions, masses and stated inclinations, and never the truth.
    noise_m : float
        Standard deviation of a position in metres, white and normal.
    replicates : int
        How many experiments; each with noise of its own, the same for all estimators.
    seed : int, optional
        Of the first replicate; the scenario's. The others follow it.
    jobs, progress
        As in `analyze`; jobs are of the built-in ones.

    Returns
    -------
    Judgement
        Errors, coverage of the intervals, time. What an estimator raises is counted as a failure, and told.

    Raises
    ------
    InputError
        A wrong scenario or option; an estimator's answer that is no number.

    Examples
    --------
    >>> @glidelab.estimator # doctest: +SKIP
    ... def parabola(tracks):
    ...     return {"mu": 0.0}
    >>> print(glidelab.judge("scenarios/paper/inclined.toml", noise_m=2e-5)) # doctest: +SKIP
    """
    chosen: list[Union[Estimator, str]] = list(estimators) or [DEFAULT_ESTIMATOR, *_registered.values()]
    named: dict[str, Union[Estimator, str]] = {}
    for one in chosen:
        name = one if isinstance(one, str) else getattr(one, "__name__", type(one).__name__)
        if isinstance(one, str) and one not in _glidelab.estimator_names():
            raise input_error("estimators", f"\"{one}\"", f"a function, or one of {', '.join(_glidelab.estimator_names())}")
        if name in named:
            raise input_error("estimators", f"\"{name}\" a second time", "each once, with a name of its own")
        named[name] = one
    if isinstance(replicates, bool) or not isinstance(replicates, int) or replicates < 2:
        raise input_error("replicates", repr(replicates), "a whole number of 2 or more")
    maker = _glidelab.TrackMaker(given_scenario(scenario), noise_m)
    first = checked_seed(seed)
    first = maker.seed if first is None else first
    threads, told = job_count(jobs), teller(progress)

    tallies: dict[tuple[str, str, str], _Tally] = {}
    truth_of: dict[tuple[str, str], float] = {}
    seconds = dict.fromkeys(named, 0.0)
    failures: dict[str, str] = {}
    for replicate in range(replicates):
        fields, truths, gravity_m_s2 = maker.make((first + replicate) % 2**64)
        tracks = {track["name"]: Track(**track) for track in fields}
        configurations = {name: [tracks[clip] for clip in clips] for name, clips, _ in truths}
        for name, one in named.items():
            begin = time.perf_counter()
            found: Optional[dict[str, dict[str, Quantity]]] = None
            answers: Optional[dict[str, Mapping[str, Found]]] = None
            try:
                if isinstance(one, str):
                    found = _built_in(one, configurations, gravity_m_s2, threads)
                else:
                    answers = {configuration: one(list(of)) for configuration, of in configurations.items()}
            except (ArithmeticError, ValueError, RuntimeError, LookupError, TypeError) as error:
                failures.setdefault(name, f"{type(error).__name__}: {error}")
            if answers is not None:
                found = _checked(answers, name)
            seconds[name] += (time.perf_counter() - begin) / replicates
            for configuration, _, quantities in truths:
                for key, truth in quantities.items():
                    if truth is None:
                        continue
                    truth_of[configuration, key] = truth
                    tally = tallies.setdefault((configuration, key, name), _Tally())
                    if found is None:
                        tally.failed += 1
                    else:
                        tally.add(found.get(configuration, {}).get(key, Quantity()), truth)
        if told is not None:
            told("judging", (replicate + 1) / replicates)
    rows = tuple(_judged(key, tally, truth_of[key[0], key[1]]) for key, tally in tallies.items())
    return Judgement(replicates, rows, seconds, failures)


def _judged(key: tuple[str, str, str], tally: _Tally, truth: float) -> Judged:
    configuration, quantity, name = key
    count = len(tally.errors)
    bias = sd = rms = None
    if count > 0:
        bias = sum(tally.errors) / count
        rms = math.sqrt(sum(error**2 for error in tally.errors) / count)
        sd = math.sqrt(sum((error - bias) ** 2 for error in tally.errors) / (count - 1)) if count > 1 else None
    return Judged(configuration, name, quantity, truth, count, tally.failed, bias, sd, rms, tally.stated,
                  tally.held / tally.stated if tally.stated else None)
