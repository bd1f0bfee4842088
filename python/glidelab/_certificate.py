"""certify(): can the stated intervals be trusted on this recording?"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional, SupportsFloat, Union

from numpy.typing import ArrayLike

from . import _glidelab
from ._analysis import DEFAULT_ESTIMATOR
from ._checks import above_0, text, whole
from ._inputs import (PathLike, Progress, Runs, Track, checked_seed, file_options, job_count,
                      teller)
from ._results import Made, Result, frame_of
from ._shown import html_table
from ._sources import Film, readable_source


@dataclass(frozen=True)
class CertifiedQuantity:
    """One quantity over all twins and configurations.

    Attributes
    ----------
    quantity : str
        ``"k_over_m_1_s"``, ``"mu"``, ``"alpha_deg"`` or ``"v_lim_m_s"``.
    asked, failed, answered : int
        Values whose truth is known, how many of these got no estimate, and how many got one.
    coverage : float or None
        Share of the stated 95 % intervals that contain the true value; None where none was stated.
    coverage_interval95 : (float, float) or None
        What as many twins leave open of it.
    bias_sds : float or None
        Mean of error over stated standard deviation.
    rms_error, stated_sd : float or None
        Root mean square error (also called `rms`), and stated standard deviation, in the quantity's unit.
    too_narrow : bool
        Fewer intervals hold than 95 %, by more than chance makes.
    """

    quantity: str
    asked: int
    failed: int
    coverage: Optional[float]
    coverage_interval95: Optional[tuple[float, float]]
    bias_sds: Optional[float]
    rms: Optional[float]
    stated_sd: Optional[float]
    too_narrow: bool

    @property
    def answered(self) -> int:
        """Values whose truth is known and that got an estimate."""
        return self.asked - self.failed

    @property
    def rms_error(self) -> Optional[float]:
        """Root mean square error."""
        return self.rms


@dataclass(frozen=True)
class ChangedTwin:
    """How much one improvement would reduce the errors.

    Attributes
    ----------
    limit, change, advice : str
        What limits ("noise"), what was changed in the twins, and what a person can do.
    twins : int
        How many were recorded with it.
    fall : float or None
        How much smaller the root mean square error becomes, 1 - after/before.
    fall_interval95 : (float, float) or None
        Its 95 % interval.
    stands_out : bool
        Whether that is more than chance over all changes.
    """

    limit: str
    change: str
    advice: str
    twins: int
    fall: Optional[float]
    fall_interval95: Optional[tuple[float, float]]
    stands_out: bool


@dataclass(frozen=True)
class CertifiedExplanation:
    """The twins that follow one of the explanations that the diagnosis weighed.

    Attributes
    ----------
    causes : tuple of str
        Ids of its effects; none: the nominal law.
    probability : float
        Among those that twins follow.
    twins : int
        How many follow it.
    coverage : float
        Share of the stated 95 % intervals of K/m, mu and alpha that contain the true value in them.
    coverage_interval95 : (float, float)
        What as many twins leave open of it.
    """

    causes: tuple[str, ...]
    probability: float
    twins: int
    coverage: float
    coverage_interval95: tuple[float, float]


@dataclass(frozen=True, eq=False, repr=False)
class Certificate(Result):
    """Whether the intervals of an analysis hold in recordings like this one.

    Attributes
    ----------
    answer : str
        In a sentence.
    holds : bool or None
        None where there was nothing to count.
    twins : int
        How many were recorded.
    estimator, by : str
        The method that was judged; ``"film"`` or ``"tracks"``: how the twins were recorded.
    quantities : tuple of CertifiedQuantity
    changes : tuple of ChangedTwin
        The most helpful first.
    causes : tuple of str
        Ids of the effects that were diagnosed, and act in the twins.
    explanations : tuple of CertifiedExplanation
        Those that twins follow, the reported one first.
    """

    answer: str
    holds: Optional[bool]
    twins: int
    estimator: str
    by: str
    quantities: tuple[CertifiedQuantity, ...]
    changes: tuple[ChangedTwin, ...]
    causes: tuple[str, ...]
    explanations: tuple[CertifiedExplanation, ...]

    def to_frame(self) -> Any:
        """A pandas.DataFrame, one row per quantity."""
        return frame_of({name: [getattr(one, name) for one in self.quantities] for name in (
            "quantity", "asked", "failed", "coverage", "bias_sds", "rms", "stated_sd", "too_narrow", "answered", "rms_error")},
                        ("rms", "stated_sd", "rms_error"))

    def _repr_html_(self) -> str:
        rows = [[one.quantity, "" if one.coverage is None else f"{100.0 * one.coverage:.0f} %",
                 "" if one.bias_sds is None else f"{one.bias_sds:.2f}"] for one in self.quantities]
        return html_table(["quantity", "intervals that hold", "bias (stated sd)"], rows, self.answer)


def _pair(found: Optional[Sequence[float]]) -> Optional[tuple[float, float]]:
    return None if found is None else (found[0], found[1])


def _quantity(found: Mapping[str, Any]) -> CertifiedQuantity:
    coverage: Mapping[str, Any] = found.get("coverage") or {}
    return CertifiedQuantity(found["quantity"], found["asked"], found["failed"], coverage.get("share"),
                             _pair(coverage.get("interval95")), found.get("bias_sds"), found.get("rms"),
                             found.get("stated_sd"), bool(found.get("too_narrow")))


def _explanation(found: Mapping[str, Any]) -> CertifiedExplanation:
    coverage: Mapping[str, Any] = found["coverage"]
    low, high = coverage["interval95"]
    return CertifiedExplanation(tuple(found["causes"]), found["probability"], found["twins"], coverage["share"],
                                (low, high))


def _change(found: Mapping[str, Any]) -> ChangedTwin:
    fall: Mapping[str, Any] = found.get("fall") or {}
    return ChangedTwin(found["limit"], found["change"], found["advice"], found["twins"], fall.get("value"),
                       _pair(fall.get("interval95")), found["stands_out"])


def certify(source: Union[ArrayLike, Track, Film, PathLike, Sequence[Track], Sequence[Film], Sequence[PathLike]],
            x_m: Optional[ArrayLike] = None, *, twins: int = 40, estimator: str = DEFAULT_ESTIMATOR,
            bandwidth_s: Optional[SupportsFloat] = None, seed: Optional[int] = None, allow_outside: bool = False,
            most_megapixels: Optional[float] = None, jobs: Optional[int] = None, progress: Progress = None,
            column: str = "", mass_kg: Optional[float] = None, incline_deg: Optional[float] = None, runs: Runs = None,
            masses_kg: Optional[Sequence[float]] = None, incline_sd_deg: Optional[float] = None,
            gravity_m_s2: Optional[float] = None, gravity_sd_m_s2: Optional[float] = None, frame_rate_hz: Optional[float] = None,
            px_per_m: Optional[float] = None) -> Certificate:
    """Records and analyses twins of a recording: do its intervals hold, what limits it, what would help?

    Parameters
    ----------
    source : array_like, Track, Film, str or path, or a sequence of tracks, of films or of names
        ``certify(t_s, x_m)``, as in `analyze`; a `Track` or several, each with its mass and how it was launched; a
        `Film` or several; experiment folders that share the glider and the track, or files with a track.
    x_m : array_like, shape (n,), optional
        With times as `source`: positions in metres, positive downhill.
    twins : int
        20 to 200: how many are recorded.
    estimator : str
        The method whose intervals are judged, as in `analyze`.
    bandwidth_s : float, optional
        Of the phase diagram; chosen clip by clip.
    seed : int, optional
        Of the twins' noise, clock and calibration; 1.
    allow_outside, most_megapixels, jobs, progress, column, mass_kg, incline_deg, runs, masses_kg
        As in `analyze`.
    incline_sd_deg, gravity_m_s2, gravity_sd_m_s2, frame_rate_hz, px_per_m
        As in `analyze`.

    Returns
    -------
    Certificate
        As ``glidelab certify`` writes it (docs/guide/trust.md). Intervals that do not hold raise no exception.

    Raises
    ------
    InputError
        Wrong input, or motions that no scenario can record again.

    Notes
    -----
    docs/guide/trust.md describes the twins: a parametric bootstrap (Efron and Tibshirani 1993) of the whole analysis.
    Arrays are written to a temporary folder, with all their digits, and read as a file or a folder is.
    """
    given = readable_source(source, x_m, {"column": column or None, "runs": runs, "masses_kg": masses_kg,
                                          "most_megapixels": most_megapixels, "frame_rate_hz": frame_rate_hz,
                                          "px_per_m": px_per_m}, allow_outside,
                            {"mass_kg": mass_kg, "incline_deg": incline_deg, "incline_sd_deg": incline_sd_deg},
                            {"gravity_m_s2": gravity_m_s2, "gravity_sd_m_s2": gravity_sd_m_s2})
    files = file_options(given.paths, allow_outside, most_megapixels, column=column, runs=runs, masses_kg=masses_kg,
                         frame_rate_hz=frame_rate_hz, px_per_m=px_per_m, **given.stated)
    bandwidth = None if bandwidth_s is None else above_0("bandwidth_s", bandwidth_s, "seconds, above 0")
    text("estimator", estimator, f"one of {', '.join(_glidelab.estimator_names())}")
    with given.told():
        made = Made(_glidelab.certify(list(given.paths), whole("twins", twins, 20, 200), estimator, bandwidth,
                                      checked_seed(seed), job_count(jobs), files, teller(progress)), given.written)
    found = Result(made).to_dict()
    return Certificate(made, found["answer"], found["holds"], found["twins"], found["estimator"], found["by"],
                       tuple(_quantity(one) for one in found["quantities"]),
                       tuple(_change(one) for one in found["changes"]), tuple(found["causes"]),
                       tuple(_explanation(one) for one in found["explanations"]))
