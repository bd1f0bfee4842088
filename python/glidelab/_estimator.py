"""An estimator of your own, judged next to the built-in ones on the same motions."""

from __future__ import annotations

import importlib
import math
import signal
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from typing import Any, Optional, TypeVar, Union

import numpy as np

from . import _glidelab
from ._analysis import DEFAULT_ESTIMATOR, analyze
from ._checks import real, whole
from ._errors import input_error
from ._inputs import Progress, Scenario, Track, checked_seed, given_scenario, job_count, teller
from ._outside import Estimator, WrongAnswer, checked_answer, registered, said_by
from ._results import QUANTITIES, Quantity
from ._studies import Judged, Judgement

_Function = TypeVar("_Function", bound=Estimator)


def estimator(function: _Function) -> _Function:
    """Registers a function as an estimator, under its name: `judge` takes it by default, and `judge`, `validate`,
    `coverage` and `sweep` take its name.

    Parameters
    ----------
    function : callable
        Called with the tracks of one configuration (one mass on one slope), a list of `Track`; returns a dict with any
        of ``k_over_m_1_s``, ``mu``, ``alpha_deg``, ``v_lim_m_s``, each a number, a pair of number and standard deviation
        (tuple, list or array), a dict ``{"value": ..., "sd": ..., "interval95": [..., ...]}`` as in results.json (the
        last two may be left out), or a `Quantity`. What it cannot determine it leaves out, or gives as None or NaN. An
        interval that does not contain its value is refused. Further keys may stand beside all four quantities.

    Returns
    -------
    callable
        The function.

    Raises
    ------
    InputError
        It is not a function, or has the name of a built-in estimator.
    """
    if not callable(function):
        raise input_error("estimator", repr(function), "a function")
    name = function.__name__
    if name in _glidelab.estimator_names():
        raise input_error("estimator", f"the name \"{name}\"", "one that is not a built-in estimator's")
    registered[name] = function
    return function


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


class _TooLong(BaseException):
    """The time of a call is over. No Exception: an estimator that catches all of these does not catch this one."""


_MOST_SECONDS = 1e9  # thirty years; more than a timer of the system may take


def _checked_seconds(seconds: Optional[float]) -> None:
    if seconds is None:
        return
    if isinstance(seconds, bool) or not isinstance(seconds, (int, float)) or not 0.0 < seconds <= _MOST_SECONDS:
        raise input_error("seconds", repr(seconds), f"a number of seconds above 0, at most {_MOST_SECONDS:g}, or None")
    if not hasattr(signal, "setitimer") or threading.current_thread() is not threading.main_thread():
        raise input_error("seconds", repr(seconds), "None where judge() does not run in Python's main thread on a Unix "
                          "system: nowhere else can a call be interrupted")


@contextmanager
def _at_most(seconds: Optional[float]) -> Iterator[None]:
    """Raises _TooLong in what it surrounds once the time is over; a timer that ran before runs on afterwards."""
    if seconds is None:
        yield
        return

    def ring(_number: int, _frame: object) -> None:
        raise _TooLong

    begin = time.monotonic()
    left, interval = signal.setitimer(signal.ITIMER_REAL, 0.0)
    before = signal.signal(signal.SIGALRM, ring)
    try:
        signal.setitimer(signal.ITIMER_REAL, seconds)
        yield
    finally:
        try:
            signal.setitimer(signal.ITIMER_REAL, 0.0)
        finally:  # it may ring just before
            signal.signal(signal.SIGALRM, signal.SIG_DFL if before is None else before)
        if left > 0.0:
            signal.setitimer(signal.ITIMER_REAL, max(left - (time.monotonic() - begin), 1e-6), interval)


def _answered(one: Union[Estimator, str], tracks: Mapping[str, Sequence[Track]], gravity_m_s2: float, jobs: int,
              seconds: Optional[float]) -> Union[dict[str, dict[str, Quantity]], str]:
    """What an estimator says of each configuration of an experiment, or how it failed. Its positions are its own."""
    try:
        if isinstance(one, str):
            with _at_most(seconds):
                return _built_in(one, tracks, gravity_m_s2, jobs)
        results = {}
        for configuration, of in tracks.items():
            with _at_most(seconds):
                found = one([replace(track, t_s=np.array(track.t_s), x_m=np.array(track.x_m)) for track in of])
            results[configuration] = checked_answer(found)
        return results
    except WrongAnswer as wrong:
        return str(wrong)
    except _TooLong:
        return f"not done after {seconds:g} s"
    except (KeyboardInterrupt, SystemExit):
        raise
    except BaseException as error:  # pylint: disable=broad-exception-caught  # whatever else it raises is its failure
        return said_by(error)


def _import_first() -> None:
    """Imports what results need later: a call that is ended in the middle of its own first import of the same package
    leaves this half done."""
    for name in ("pandas", "matplotlib.pyplot"):
        with suppress(ImportError):
            importlib.import_module(name)


def _built_in(name: str, tracks: Mapping[str, Sequence[Track]], gravity_m_s2: float,
              jobs: int) -> dict[str, dict[str, Quantity]]:
    """The same by one of Glidelab's, which sees all configurations together."""
    analysis = analyze([track for of in tracks.values() for track in of], estimator=name, gravity_m_s2=gravity_m_s2,
                       gravity_sd_m_s2=0.0, jobs=jobs)
    results: dict[str, dict[str, Quantity]] = {}
    for configuration, of in tracks.items():
        names = {track.name for track in of}
        for found in analysis.configurations:
            if names == set(found.clips):
                results[configuration] = {key: getattr(found, key) for key in QUANTITIES}
    return results


def judge(scenario: Scenario, *estimators: Union[Estimator, str], noise_m: float, replicates: int = 100,
          seconds: Optional[float] = None, seed: Optional[int] = None, jobs: Optional[int] = None,
          progress: Progress = None) -> Judgement:
    """Runs estimators over replicates of a scenario's motions with noise, and compares what they say with the truth.

    Parameters
    ----------
    scenario : str, path or dict
        A scenario file (docs/reference/scenario.md), or what `load_scenario` makes of one. Nothing is rendered.
    *estimators : callable or str
        As `estimator` describes them, or names of registered or built-in ones; without any, ``"phase-diagram"`` and all that are
        registered. They are given positions, masses and stated inclinations, and never the truth.
    noise_m : float
        Standard deviation of a position in metres, white and normal.
    replicates : int
        How many experiments; each with noise of its own, the same for all estimators.
    seconds : float, optional
        How long one call of an estimator may take, on the clock; a longer one is ended and counts as a failure. A
        signal ends it, so judge() has to run in Python's main thread, a call of C code ends only when it returns to
        Python, and one that catches BaseException may not end at all. What bounds any code, and its memory, is a
        process of its own: ``estimator_command=`` of `validate`, `coverage` and `sweep`.
    seed : int, optional
        Of the first replicate; the scenario's. The others follow it.
    jobs, progress
        As in `analyze`; jobs are of the built-in ones.

    Returns
    -------
    Judgement
        Errors, coverage of the intervals, time. A failing estimator does not stop the run: what it raises (KeyboardInterrupt
        and SystemExit excepted), an invalid answer, and a call that takes too long are counted as failures of
        that experiment, and the first is reported.

    Raises
    ------
    InputError
        A wrong scenario or option.

    Notes
    -----
    The interval of a value with a standard deviation and no interval of its own is value ± 1.96 sd.

    Examples
    --------
    >>> @glidelab.estimator # doctest: +SKIP
    ... def parabola(tracks):
    ...     return {"mu": 0.0}
    >>> print(glidelab.judge("scenarios/paper/inclined.toml", noise_m=2e-5)) # doctest: +SKIP
    """
    chosen: list[Union[Estimator, str]] = list(estimators) or [DEFAULT_ESTIMATOR, *registered.values()]
    named: dict[str, Union[Estimator, str]] = {}
    for one in chosen:
        one = registered.get(one, one) if isinstance(one, str) else one
        name = one if isinstance(one, str) else getattr(one, "__name__", type(one).__name__)
        if isinstance(one, str) and one not in _glidelab.estimator_names():
            names = [*registered, *_glidelab.estimator_names()]
            raise input_error("estimators", f"\"{one}\"", f"a function, or one of {', '.join(names)}"
                              + _glidelab.did_you_mean(one, names))
        if not callable(one) and not isinstance(one, str):
            raise input_error("estimators", repr(one), "a function, or the name of a built-in estimator")
        if name in named:
            raise input_error("estimators", f"\"{name}\" a second time", "each once, with a name of its own")
        named[name] = one
    replicates = whole("replicates", replicates, 2)
    _checked_seconds(seconds)
    if seconds is not None:
        _import_first()
    maker = _glidelab.TrackMaker(given_scenario(scenario), real("noise_m", noise_m, "a number of metres above 0"))
    first = checked_seed(seed)
    first = maker.seed if first is None else first
    threads, told = job_count(jobs), teller(progress)

    tallies: dict[tuple[str, str, str], _Tally] = {}
    truth_of: dict[tuple[str, str], float] = {}
    mean_s = dict.fromkeys(named, 0.0)
    failures: dict[str, str] = {}
    for replicate in range(replicates):
        fields, truths, gravity_m_s2 = maker.make((first + replicate) % 2**64)
        tracks = {track["name"]: Track(**track) for track in fields}
        configurations = {name: [tracks[clip] for clip in clips] for name, clips, _ in truths}
        for name, one in named.items():
            begin = time.perf_counter()
            found = _answered(one, configurations, gravity_m_s2, threads, seconds)
            mean_s[name] += (time.perf_counter() - begin) / replicates
            if isinstance(found, str):
                failures.setdefault(name, found)
            for configuration, _, quantities in truths:
                for key, truth in quantities.items():
                    if truth is None:
                        continue
                    truth_of[configuration, key] = truth
                    tally = tallies.setdefault((configuration, key, name), _Tally())
                    if isinstance(found, str):
                        tally.failed += 1
                    else:
                        tally.add(found.get(configuration, {}).get(key, Quantity()), truth)
        if told is not None:
            told("judging", (replicate + 1) / replicates)
    rows = tuple(_judged(key, tally, truth_of[key[0], key[1]]) for key, tally in tallies.items())
    return Judgement(replicates, rows, mean_s, failures)


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
