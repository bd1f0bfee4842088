"""Glidelab from Python: simulate, film, analyse, validate and diagnose video experiments on friction.

>>> import glidelab
>>> glidelab.analyze(t, x, mass_kg=0.335)          # positions, as arrays # doctest: +SKIP
>>> glidelab.diagnose("my-recording")              # an experiment folder # doctest: +SKIP

Arguments and results are in SI units, with the unit in the name; angles are in degrees. Every `Result` has ``to_dict()``
(the JSON that the command of its name writes) and ``write(folder)`` (its files and its page). `Judgement`, `Gate`, `Smoothed`
and `Bandwidth` are of no command: they write their data as JSON, their table as CSV, and a page. All show themselves in a
notebook and on one line at a prompt, and `explain` puts them in words. docs/guide/python.md is the tutorial.
"""

from typing import Any as _Any, Union as _Union

import numpy as _numpy

from . import _glidelab
from ._analysis import Analysis, Clip, Configuration, Line, Motion, analyze
from ._checks import refuse_numpy as _refuse_numpy
from ._blind import Blind, BlindAnswers, BlindCase, BlindTarget, blind
from ._camera import Camera, Marker, calibrate, fit_marker
from ._certificate import Certificate, CertifiedExplanation, CertifiedQuantity, ChangedTwin, certify
from ._diagnosis import Cause, Diagnosis, Effect, Plan, PlannedEffect, Residuals, diagnose, plan
from ._estimator import estimator, judge
from ._errors import Error, InputError, Issue, NotMet, NumericalError, SystemFailure
from ._film import FilmedClip, Frame, Rendered, render, render_folder
from ._gate import Gate, GateRow, Worse, gate
from ._inputs import Track, load_scenario, scenarios_folder
from ._outside import OutsideFailures, OutsideRuns
from ._recording import Finding, RecordingCheck, check
from ._results import Quantity, Recovered, Result, WithEffects
from ._simulation import ModeChange, SimulatedClip, Simulation, simulate
from ._sources import Film
from ._smoothing import (Bandwidth, BandwidthRule, Smoothed, Strength, bandwidth_rules, choose_bandwidth,
                         position_noise, smooth)
from ._studies import Coverage, CoverageRow, Judged, Judgement, Recovery, Validation, coverage, validate
from ._sweeps import Candidate, Requirement, Sweep, require, sweep

_refuse_numpy(_glidelab.pybind11_version, _numpy.__version__)
__version__: str = _glidelab.version


class Explanation(str):
    """A text that a prompt and a notebook show as it reads, line by line."""

    def __repr__(self) -> str:
        return str(self)

    def _repr_pretty_(self, printer: _Any, _cycle: bool) -> None:
        printer.text(str(self))


def explain(result: _Union[Result, Judgement, Gate, Smoothed, Bandwidth]) -> Explanation:
    """A result in words: of a command what it prints, the answer in sentences and its tables.

    Parameters
    ----------
    result : Result, Judgement, Gate, Smoothed or Bandwidth
        Of any function that returns one: `analyze`, `diagnose`, `validate`, `judge`, `smooth`, ...

    Returns
    -------
    Explanation
        A str. As the last line of a cell, or at the prompt, it shows itself as it reads; a script prints it.
    """
    return Explanation(str(result))


__all__ = [
    "Analysis", "Bandwidth", "BandwidthRule", "Blind", "BlindAnswers", "BlindCase", "BlindTarget", "Camera", "Candidate",
    "Cause", "Certificate", "CertifiedExplanation", "CertifiedQuantity", "ChangedTwin", "Clip", "Configuration", "Coverage",
    "CoverageRow", "Diagnosis", "Effect", "Error", "Explanation", "Film", "FilmedClip", "Finding", "Frame", "Gate", "GateRow",
    "InputError", "Issue", "Judged", "Judgement", "Line", "Marker", "ModeChange", "Motion", "NotMet", "NumericalError",
    "OutsideFailures", "OutsideRuns", "Plan", "PlannedEffect", "Quantity", "RecordingCheck", "Recovered",
    "Recovery", "Rendered", "Requirement", "Residuals", "Result", "SimulatedClip", "Simulation", "Smoothed",
    "Strength", "Sweep", "SystemFailure", "Track", "Validation", "WithEffects", "Worse", "analyze", "bandwidth_rules",
    "blind", "calibrate", "certify", "check", "choose_bandwidth", "coverage", "diagnose", "estimator", "explain",
    "fit_marker", "gate", "judge", "load_scenario", "plan", "position_noise", "render", "render_folder", "require",
    "scenarios_folder", "simulate", "smooth", "sweep", "validate",
]
