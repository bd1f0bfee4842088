"""Glidelab from Python: simulate, film, analyse, validate and diagnose video experiments on friction.

>>> import glidelab
>>> glidelab.analyze(t, x, mass_kg=0.335)          # positions, as arrays # doctest: +SKIP
>>> glidelab.diagnose("my-recording")              # an experiment folder # doctest: +SKIP

Arguments and results are in SI units, with the unit in the name; angles are in degrees. Every result has ``to_dict()``
(the JSON that the command of its name writes), ``write(folder)`` (its files and its page) and shows itself in a
notebook. docs/guide/python.md is the tutorial.
"""

from __future__ import annotations

import numpy as _numpy

from . import _glidelab
from ._analysis import Analysis, Clip, Configuration, Line, Motion, analyze
from ._arrays import refuse_numpy as _refuse_numpy
from ._camera import Camera, Marker, calibrate, fit_marker
from ._certificate import Certificate, CertifiedExplanation, CertifiedQuantity, ChangedTwin, certify
from ._diagnosis import Cause, Diagnosis, Effect, Plan, PlannedEffect, Recovered, Residuals, diagnose, plan
from ._estimator import Judged, Judgement, estimator, judge
from ._errors import Error, InputError, Issue, NotMet, NumericalError, SystemFailure
from ._film import FilmedClip, Frame, Rendered, render, render_folder
from ._inputs import Track, load_scenario
from ._recording import Finding, RecordingCheck, check
from ._results import Quantity, Result
from ._simulation import ModeChange, SimulatedClip, Simulation, simulate
from ._smoothing import (Bandwidth, BandwidthRule, Smoothed, Strength, bandwidth_rules, choose_bandwidth,
                         position_noise, smooth)
from ._studies import (Candidate, Coverage, CoverageRow, Recovery, Requirement, Sweep, Validation, coverage, require,
                       sweep, validate)

_refuse_numpy(_glidelab.pybind11_version, _numpy.__version__)
__version__: str = _glidelab.version


def explain(result: Result) -> str:
    """What the command prints of a result: the answer in sentences, and its tables."""
    return str(result)


__all__ = [
    "Analysis", "Bandwidth", "BandwidthRule", "Camera", "Candidate", "Cause", "Certificate",
    "CertifiedExplanation", "CertifiedQuantity", "ChangedTwin", "Clip", "Configuration", "Coverage", "CoverageRow",
    "Diagnosis", "Effect",
    "Error", "FilmedClip", "Finding", "Frame", "InputError", "Issue", "Judged", "Judgement", "Line",
    "Marker", "ModeChange", "Motion", "NotMet", "NumericalError", "Plan", "PlannedEffect", "Quantity",
    "RecordingCheck", "Recovered", "Recovery", "Rendered", "Requirement", "Residuals", "Result", "SimulatedClip",
    "Simulation", "Smoothed", "Strength", "Sweep", "SystemFailure", "Track", "Validation", "analyze", "bandwidth_rules",
    "calibrate", "certify", "check", "choose_bandwidth", "coverage", "diagnose", "estimator", "explain", "fit_marker",
    "judge", "load_scenario", "plan", "position_noise", "render", "render_folder", "require", "simulate", "smooth", "sweep", "validate",
]
