"""Estimators of one's own: what a function may answer, and programs, which run in a process of their own
(docs/reference/own-estimator.md), functions served to such a process among them."""

from __future__ import annotations

import json
import math
import os
import socketserver
import sys
import tempfile
import threading
import time
import tomllib
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np

from . import _glidelab
from ._checks import above_0, shown, text
from ._errors import input_error
from ._inputs import Track
from ._results import NORMAL95, QUANTITIES, Quantity

_MOST_MEGABYTES = 1e9  # as of the command's --estimator-megabytes: no computer has as much

@dataclass(frozen=True)
class OutsideFailures:
    """Runs that failed in one way.

    Attributes
    ----------
    count : int
        How many.
    first : str
        What was said of the first.
    """

    count: int
    first: str


@dataclass(frozen=True)
class OutsideRuns:
    """How the runs of an outside estimator went.

    Attributes
    ----------
    name, command : str
        As it is called in results, and what was run; of a function, ``"the function mine"``.
    runs, failed : int
        All, and those that left no answer.
    failures : dict of str to OutsideFailures
        By kind: ``"exit_status"`` of a program, ``"raised"`` of a function (with the exception's type, text and place),
        ``"signal"``, ``"time_out"``, ``"no_output"``, ``"bad_output"``.
    mean_s, longest_s : float or None
        Seconds of a run; in a sweep those of a function's calls in this process. None where they were not measured, as of a
        program in a sweep.
    """

    name: str
    command: str
    runs: int
    failed: int
    failures: Mapping[str, OutsideFailures]
    mean_s: Optional[float]
    longest_s: Optional[float]


def outside_runs(document: Mapping[str, Any], calls_s: Sequence[float] = ()) -> Optional[OutsideRuns]:
    """The object "outside" of a result's JSON; None where no estimator was given. The seconds of a function's calls stand
    where those of the runs were not stored."""
    found = document.get("outside")
    if found is None:
        return None
    failures = {kind: OutsideFailures(one["count"], one["first"]) for kind, one in found["failures"].items()}
    mean_s, longest_s = found.get("mean_s"), found.get("longest_s")
    if mean_s is None and calls_s:
        mean_s, longest_s = sum(calls_s) / len(calls_s), max(calls_s)
    return OutsideRuns(found["name"], found["command"], found["runs"], found["failed"], failures, mean_s, longest_s)


# --- a function's answers

Estimator = Callable[[list[Track]], Mapping[str, object]]  # what it may answer, `estimator` says

registered: dict[str, Estimator] = {}  # by `estimator`, under their names


class WrongAnswer(Exception):
    """An answer that is none, in words."""


def _number(said: Any, key: str) -> float:
    """A finite number, NaN or an infinity; WrongAnswer if it is not a number; a string of digits is not one."""
    if not isinstance(said, (str, bytes, bool)):
        try:
            return float(said)
        except (TypeError, ValueError, OverflowError):
            pass
    raise WrongAnswer(f"{key}: found {said!r:.60}, expected a number, a pair of number and standard deviation, or None")


def _sd(said: Any, key: str) -> float:
    sd = _number(said, key)
    if not (math.isfinite(sd) and sd >= 0.0):
        raise WrongAnswer(f"{key}: found the standard deviation {sd:g}, expected a finite one of 0 or more")
    return sd


def _ends(stated: Any, key: str) -> tuple[float, float]:
    try:
        low, high = stated
    except (TypeError, ValueError):
        raise WrongAnswer(f"{key}: found the interval {stated!r:.60}, expected two numbers") from None
    return _number(low, key), _number(high, key)


def _quantity(found: Any, key: str) -> Quantity:
    """An estimator's answer, checked; WrongAnswer if it is not a valid answer."""
    if found is None or (isinstance(found, Quantity) and found.value is None):
        return Quantity()
    value: Any
    sd: Any
    stated: Any = None
    if isinstance(found, Quantity):
        value, sd, stated = found.value, found.sd, found.interval95
    elif isinstance(found, Mapping):
        if "value" not in found:
            raise WrongAnswer(f"{key}: found {found!r:.60}, expected the key \"value\" in a dict")
        value, sd, stated = found["value"], found.get("sd"), found.get("interval95")
    elif isinstance(found, (tuple, list)) or (isinstance(found, np.ndarray) and found.shape == (2,)):
        if len(found) != 2:
            raise WrongAnswer(f"{key}: found {len(found)} numbers, expected a number, or a number and its standard deviation")
        value, sd = found
    else:
        value, sd = found, None
    value = _number(value, key)
    answer = Quantity(value, None if sd is None else _sd(sd, key))
    if math.isinf(value):
        raise WrongAnswer(f"{key}: found {value:g}, expected a finite number, or None where it is not determined")
    if math.isnan(value):
        return Quantity(why="not a number")
    if stated is not None:
        low, high = _ends(stated, key)
        if not low <= value <= high:
            raise WrongAnswer(f"{key}: found an interval from {low:g} to {high:g}, expected one with the value in it")
        return replace(answer, interval95=(low, high))
    if answer.sd is None:
        return answer
    return replace(answer, interval95=(value - NORMAL95 * answer.sd, value + NORMAL95 * answer.sd))


def checked_answer(found: Any) -> dict[str, Quantity]:
    """The answer of a user's estimator for one configuration, checked; WrongAnswer if it is not a valid answer."""
    if not isinstance(found, Mapping):
        raise WrongAnswer(f"the answer: found {found!r:.60}, expected a dict of quantities")
    if not all(key in found for key in QUANTITIES):  # then a key that is none may be a misspelt one
        for key in found:
            if key not in QUANTITIES:
                raise WrongAnswer(f"found the quantity {key!r:.60}, expected one of {', '.join(QUANTITIES)}; further keys only "
                             "beside all four" + _glidelab.did_you_mean(str(key), list(QUANTITIES)))
    return {key: _quantity(found.get(key), key) for key in QUANTITIES}


def said_by(error: BaseException) -> str:
    """Kind, text and place of an exception; no text where it cannot be had."""
    try:
        text = f"{type(error).__name__}: {error}"
    except Exception:  # pylint: disable=broad-exception-caught  # __str__ is the estimator's own, too
        text = type(error).__name__
    last = traceback.extract_tb(error.__traceback__)[-1]
    return f"{text} ({Path(last.filename).name}, line {last.lineno})"


# --- a function that a process calls

def _tracks_in(folder: Path) -> list[tuple[list[str], list[Track]]]:
    """The configurations of an experiment folder that an outside estimator is given: names of clips, and their tracks."""
    document = tomllib.loads((folder / "experiment.toml").read_text(encoding="utf-8"))
    found: dict[tuple[float, float, str], tuple[list[str], list[Track]]] = {}
    for clip in document["clip"]:
        t_s, x_m = np.loadtxt(folder / "tracks" / (clip["name"] + ".csv"), delimiter=",", skiprows=1, unpack=True, ndmin=2)
        names, tracks = found.setdefault((clip["mass_kg"], clip["incline_deg"], clip.get("group", "")), ([], []))
        names.append(clip["name"])
        tracks.append(Track(t_s, x_m, **{key: clip[key] for key in _OF_TRACK if key in clip}))
    return list(found.values())


_OF_TRACK = ("mass_kg", "incline_deg", "name", "mass_sd_kg", "incline_sd_deg", "launched", "group")


def _stated(key: str, quantity: Quantity) -> Optional[dict[str, Any]]:
    """As results.json has it."""
    if quantity.value is None or not math.isfinite(quantity.value):
        return None
    if quantity.sd is None:
        raise WrongAnswer(f"{key}: found no standard deviation, expected one beside the value")
    return {"value": quantity.value, "sd": quantity.sd, "interval95": quantity.interval95}


def _called(function: Estimator, folder: Path) -> str:
    """results.json of a function's answers."""
    configurations: list[dict[str, Any]] = []
    for names, tracks in _tracks_in(folder):
        answer = checked_answer(function(tracks))
        configurations.append({"clips": names, **{key: _stated(key, one) for key, one in answer.items()}})
    return json.dumps({"format": 1, "configurations": configurations})


_PLACE = "GLIDELAB_FUNCTION_"  # and the name, of the environment: where the process finds the function

_RAISED, _WRONG_ANSWER = "1", "2"  # exit statuses, as fit/outside/outside_estimator.h has them

# What the process does: it hands on the two folders, says what is said of them, and ends with the status before it, or 0.
_CLIENT = """import os, socket, sys
with socket.socket(socket.AF_UNIX) as caller:
    caller.connect(os.environ[sys.argv[1]])
    caller.sendall(os.fsencode(chr(0).join(sys.argv[2:])))
    caller.shutdown(socket.SHUT_WR)
    said = b"".join(iter(lambda: caller.recv(4096), b"")).decode(errors="replace")
print(said[1:], file=sys.stderr)
sys.exit(int(said[:1] or 0))"""


class _Calls(socketserver.StreamRequestHandler):
    """One run: the folders of a process, the function's call, and what went wrong."""

    server: _Server

    def handle(self) -> None:
        folder, out = (Path(os.fsdecode(name)) for name in self.rfile.read().split(b"\0"))
        try:
            with self.server.one_at_a_time:
                begin = time.perf_counter()
                try:
                    results = _called(self.server.function, folder)
                finally:
                    self.server.calls_s.append(time.perf_counter() - begin)
            (out / "results.json").write_text(results, encoding="utf-8")
        except WrongAnswer as wrong:
            self._say(_WRONG_ANSWER, str(wrong))
        except BaseException as error:  # pylint: disable=broad-exception-caught  # whatever it raises is its failure
            self._say(_RAISED, said_by(error))

    def _say(self, status: str, what: str) -> None:
        with suppress(OSError):  # the process was ended
            self.wfile.write((status + (" ".join(what.split()) or "failed")).encode(errors="replace"))


class _Server(socketserver.ThreadingUnixStreamServer):
    """Calls a function for processes; one call at a time, for it need not know of threads."""

    daemon_threads = True
    block_on_close = False
    request_queue_size = 128

    def __init__(self, place: str, function: Estimator, calls_s: list[float]) -> None:
        super().__init__(place, _Calls)
        self.function = function
        self.calls_s = calls_s
        self.one_at_a_time = threading.Lock()


@contextmanager
def _served(function: Estimator, name: str, calls_s: list[float]) -> Iterator[str]:
    """The command that calls a function of this process, for as long as it is served; `calls_s` gains the seconds of each
    call."""
    key = _PLACE + "".join(one if one.isascii() and one.isalnum() else "_" for one in name)
    if key in os.environ or not sys.executable:
        raise input_error("estimator_command", f"the function {name}", "one that is not being judged already under this "
                          "name" if sys.executable else "a command: no Python interpreter is known that could call it")
    with tempfile.TemporaryDirectory(prefix="glidelab-") as folder, _Server(
            f"{folder}/calls", function, calls_s) as server:
        os.environ[key] = f"{folder}/calls"
        serving = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05}, daemon=True)
        serving.start()
        try:
            words = [sys.executable, "-S", "-E", "-c", _CLIENT, key]
            yield " ".join("'" + word.replace("'", "'\"'\"'") + "'" for word in words) + " {folder} {out}"
        finally:
            del os.environ[key]
            server.shutdown()
            serving.join()


@dataclass(frozen=True)
class Given:
    """An estimator as the C++ side takes it, None without one; and the seconds of each call of a function."""

    command: Optional[_glidelab.EstimatorCommand]
    calls_s: list[float]


def _named_function(command: str) -> Union[str, Estimator]:
    """The registered function of this name; else the command itself, which has to be one."""
    if command in registered:
        return registered[command]
    if "{" not in command and len(command.split()) == 1:
        names = list(registered)
        raise input_error("estimator_command", shown(command), "a command such as \"python3 mine.py {folder} {out}\", a "
                          "function, or the name of one that is registered by @glidelab.estimator"
                          + (f": {', '.join(names)}" if names else "") + _glidelab.did_you_mean(command, names))
    return command


@contextmanager
def given_command(command: Union[str, Estimator, None], name: str, seconds: float, megabytes: float) -> Iterator[Given]:
    """As studies take it. A function is served as long as this lasts."""
    for key, value in (("estimator_seconds", seconds), ("estimator_megabytes", megabytes)):
        above_0(key, value, "a number above 0")
    text("estimator_name", name)
    if megabytes > _MOST_MEGABYTES:
        raise input_error("estimator_megabytes", repr(megabytes), f"at most {_MOST_MEGABYTES:g}")
    if command is None:
        if name:
            raise input_error("estimator_name", repr(name), "estimator_command= as well")
        yield Given(None, [])
        return
    if isinstance(command, str):
        command = _named_function(command)
    if callable(command):
        name = name or getattr(command, "__name__", type(command).__name__).strip("<>")
        function = getattr(command, "__name__", type(command).__name__)
        calls_s: list[float] = []
        with _served(command, name, calls_s) as words:
            yield Given(_glidelab.EstimatorCommand(words, name, function, float(seconds), float(megabytes)), calls_s)
    else:
        text("estimator_command", command, "a string such as \"python3 mine.py {folder} {out}\", or a function")
        yield Given(_glidelab.EstimatorCommand(command, name, "", float(seconds), float(megabytes)), [])
