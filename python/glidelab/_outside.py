"""An estimator that is a program of its own, judged next to the built-in ones (docs/reference/own-estimator.md)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Optional

from . import _glidelab
from ._checks import above_0, text
from ._errors import input_error

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
        As it is called in results, and what was run.
    runs, failed : int
        All, and those that left no answer.
    failures : dict of str to OutsideFailures
        By kind: ``"exit_status"``, ``"signal"``, ``"time_out"``, ``"no_output"``, ``"bad_output"``.
    mean_s, longest_s : float or None
        Seconds of a run; None where they were not measured.
    """

    name: str
    command: str
    runs: int
    failed: int
    failures: Mapping[str, OutsideFailures]
    mean_s: Optional[float]
    longest_s: Optional[float]


def outside_runs(document: Mapping[str, Any]) -> Optional[OutsideRuns]:
    """The object "outside" of a result's JSON; None where no estimator was given."""
    found = document.get("outside")
    if found is None:
        return None
    failures = {kind: OutsideFailures(one["count"], one["first"]) for kind, one in found["failures"].items()}
    return OutsideRuns(found["name"], found["command"], found["runs"], found["failed"], failures, found.get("mean_s"),
                       found.get("longest_s"))


def given_command(command: Optional[str], name: str, seconds: float,
                  megabytes: float) -> Optional[_glidelab.EstimatorCommand]:
    """As the C++ side takes it; None without a command."""
    for key, value in (("estimator_seconds", seconds), ("estimator_megabytes", megabytes)):
        above_0(key, value, "a number above 0")
    text("estimator_name", name)
    if megabytes > _MOST_MEGABYTES:
        raise input_error("estimator_megabytes", repr(megabytes), f"at most {_MOST_MEGABYTES:g}")
    if command is None:
        if name:
            raise input_error("estimator_name", repr(name), "estimator_command= as well")
        return None
    if callable(command):
        raise input_error("estimator_command", "a function", "a command, which runs in a process of its own, such as "
                          "\"python3 mine.py {folder} {out}\"; glidelab.judge() takes a function")
    text("estimator_command", command, "a string such as \"python3 mine.py {folder} {out}\"")
    return _glidelab.EstimatorCommand(command, name, float(seconds), float(megabytes))
