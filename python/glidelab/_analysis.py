"""analyze(): from positions, or from an experiment folder, to K/m, mu, alpha and the terminal velocity."""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional, SupportsFloat, Union

import numpy as np
from numpy.typing import ArrayLike

from . import _glidelab
from ._checks import Vector, frozen, optional_real, switch, text, texts
from ._inputs import (PathLike, Progress, Runs, Track, file_options, given_gravity, given_tracks, job_count, refuse,
                      refuse_of_arrays, stated_incline, teller)
from ._results import QUANTITIES, Made, Quantity, Result, WithEffects, frame_of, quantity_of, with_effects_of
from ._shown import Brief, html_plot, html_table, new_axes
from ._sources import Film, source_of

DEFAULT_ESTIMATOR = _glidelab.estimator_names()[0]


@dataclass(frozen=True)
class Line:
    """The line a = a0 - (K/m) v through the points of one direction of motion.

    Attributes
    ----------
    direction : int
        Sign of v.
    points : int
        Number of points that the line is fitted to.
    k_over_m_1_s, a0_m_s2 : Quantity
        Slope (with the other sign) and intercept.
    covariance_k_over_m_a0 : float or None
        Of the two.
    r2 : float or None
        Coefficient of determination.
    v_range_m_s : (float, float)
        Range of the speeds of these points.
    """

    direction: int
    points: int
    k_over_m_1_s: Quantity
    a0_m_s2: Quantity
    covariance_k_over_m_a0: Optional[float]
    r2: Optional[float]
    v_range_m_s: tuple[float, float]


@dataclass(frozen=True, eq=False, repr=False)
class Motion(Brief):
    """A clip frame by frame. All arrays have one length; NaN where there is no value.

    Attributes
    ----------
    t_s : ndarray
        Middle of the exposure, from the first frame, in seconds.
    measured_x_m : ndarray
        The position as measured, in metres.
    x_m, v_m_s, a_m_s2 : ndarray
        Position, velocity and acceleration by the smoother.
    sd_x_m, sd_v_m_s, sd_a_m_s2 : ndarray
        Their standard deviations.
    reason : ndarray of str
        ``"used"``, or why the frame is not in a line.
    """

    t_s: Vector
    measured_x_m: Vector
    x_m: Vector
    v_m_s: Vector
    a_m_s2: Vector
    sd_x_m: Vector
    sd_v_m_s: Vector
    sd_a_m_s2: Vector
    reason: np.ndarray[Any, np.dtype[np.str_]]

    @property
    def used(self) -> np.ndarray[Any, np.dtype[np.bool_]]:
        """Which frames a line is fitted to."""
        used: np.ndarray[Any, np.dtype[np.bool_]] = self.reason == "used"
        return used

    def to_frame(self) -> Any:
        """A pandas.DataFrame, one row per frame, with units in ``attrs["units"]``."""
        return frame_of({name: getattr(self, name) for name in (
            "t_s", "measured_x_m", "x_m", "sd_x_m", "v_m_s", "sd_v_m_s", "a_m_s2", "sd_a_m_s2", "reason")})


@dataclass(frozen=True, eq=False, repr=False)
class Clip(Brief):
    """One clip, analysed by itself.

    Attributes
    ----------
    name, experiment : str
        Of the clip, and of the folder it comes from.
    frames, detected : int
        Of the whole clip, and those in which the marker was found.
    frame_rate_hz, bandwidth_s, position_noise_m : float or None
        The bandwidth is the standard deviation of the Gaussian kernel; the noise that of one position.
    bandwidth_method : str
        How it was chosen.
    segments : tuple of Line
        At most one for each direction.
    v_lim_m_s : Quantity
        Terminal velocity.
    motion : Motion
        Frame by frame.
    notes : tuple of str
        What a reader should know.
    """

    name: str
    experiment: str
    frames: int
    detected: int
    frame_rate_hz: Optional[float]
    bandwidth_s: Optional[float]
    bandwidth_method: str
    position_noise_m: Optional[float]
    segments: tuple[Line, ...]
    v_lim_m_s: Quantity
    motion: Motion
    notes: tuple[str, ...]

    def plot(self, ax: Any = None) -> Any:
        """The phase diagram: a against v, the points of the lines dark, the others light, and the lines.

        Returns
        -------
        matplotlib.axes.Axes
            `ax`, or new ones.
        """
        ax = new_axes(1)[0] if ax is None else ax
        motion, used = self.motion, self.motion.used
        ax.plot(motion.v_m_s[~used], motion.a_m_s2[~used], ".", color="0.8", markersize=4)
        ax.plot(motion.v_m_s[used], motion.a_m_s2[used], ".", color="C0", markersize=4, label=self.name)
        for line in self.segments:
            v = np.asarray(line.v_range_m_s)
            ax.plot(v, float(line.a0_m_s2) - float(line.k_over_m_1_s) * v, color="C1")
        ax.set_xlabel("v (m/s)")
        ax.set_ylabel("a (m/s²)")
        ax.legend()
        return ax


@dataclass(frozen=True, repr=False)
class Configuration(Brief):
    """All clips of one mass, one stated inclination and one group.

    Attributes
    ----------
    mass_kg, incline_deg : float
        As stated.
    group : str
        Clips that share one set-up of the track.
    clips : tuple of str
        Their names.
    k_over_m_1_s, mu, alpha_deg, v_lim_m_s : Quantity
        What the motion shows.
    lines : tuple of Line
        Through the points of all clips.
    notes : tuple of str
        What a reader should know.
    """

    mass_kg: float
    incline_deg: float
    group: str
    clips: tuple[str, ...]
    k_over_m_1_s: Quantity
    mu: Quantity
    alpha_deg: Quantity
    v_lim_m_s: Quantity
    lines: tuple[Line, ...]
    notes: tuple[str, ...]


@dataclass(frozen=True, eq=False, repr=False)
class Analysis(Result):
    """What an analysis finds.

    Attributes
    ----------
    estimator : str
        The one that found the quantities.
    clips : tuple of Clip
        In the order in which they were given.
    configurations : tuple of Configuration
        K/m, mu, alpha and the terminal velocity of each.
    doubts : tuple of str
        What the law (drag proportional to the speed, dry friction, gravity) cannot explain, one sentence each; empty
        where it fits. Where it does not, the standard deviations would hold only if it did.
    with_effects : WithEffects or None
        The quantities with the effects that were given to `analyze` in the model.
    """

    estimator: str
    clips: tuple[Clip, ...]
    configurations: tuple[Configuration, ...]
    doubts: tuple[str, ...]
    with_effects: Optional[WithEffects] = None

    @property
    def configuration(self) -> Configuration:
        """The only configuration.

        Raises
        ------
        ValueError
            There are several.
        """
        if len(self.configurations) != 1:
            raise ValueError(f"there are {len(self.configurations)} configurations")
        return self.configurations[0]

    def to_frame(self) -> Any:
        """A pandas.DataFrame, one row per configuration: each quantity and its standard deviation (``mu``, ``mu_sd``),
        NaN where it is not determined, with units in ``attrs["units"]``."""
        columns: dict[str, list[Any]] = {
            "mass_kg": [one.mass_kg for one in self.configurations],
            "incline_deg": [one.incline_deg for one in self.configurations],
            "group": [one.group for one in self.configurations],
            "clips": [len(one.clips) for one in self.configurations],
        }
        for key in QUANTITIES:
            found = [getattr(one, key) for one in self.configurations]
            columns[key] = [np.nan if one.value is None else one.value for one in found]
            columns[key + "_sd"] = [np.nan if one.sd is None else one.sd for one in found]
        return frame_of(columns)

    def plot(self) -> list[Any]:
        """The phase diagram of every clip, side by side.

        Returns
        -------
        list of matplotlib.axes.Axes
            One for each clip.
        """
        return _phase_diagrams(self.clips)

    def _repr_html_(self) -> str:
        rows = [[one.group, f"{one.mass_kg:g}", f"{one.incline_deg:g}", *(str(getattr(one, key)) for key in QUANTITIES)]
                for one in self.configurations]
        table = html_table(["group", "mass (kg)", "stated α (°)", "K/m", "µ", "α", "terminal velocity"], rows)
        doubts = "".join(f"<p>{html.escape(doubt)}</p>" for doubt in self.doubts)
        return table + doubts + self._html_with() + html_plot(lambda: _phase_diagrams(self.clips[:_MOST_SHOWN]))

    def _html_with(self) -> str:
        if self.with_effects is None:
            return ""
        rows = [[one.group, f"{one.mass_kg:g}", f"{one.incline_deg:g}", *(str(getattr(one, key)) for key in QUANTITIES)]
                for one in self.with_effects.recovered]
        return html_table(["group", "mass (kg)", "stated α (°)", "K/m", "µ", "α", "terminal velocity"], rows,
                          "with " + ", ".join(self.with_effects.effects))


_MOST_SHOWN = 12  # phase diagrams of an analysis in a notebook; plot() draws all


def _phase_diagrams(clips: Sequence[Clip]) -> list[Any]:
    return [clip.plot(ax) for clip, ax in zip(clips, new_axes(len(clips)))]


def _line(found: Mapping[str, Any]) -> Line:
    return Line(found["direction"], found["points"], quantity_of(found, "k_over_m_1_s", "1/s"),
                quantity_of(found, "a0_m_s2", "m/s²"), found["covariance_k_over_m_a0"], found["r2"],
                (found["v_range_m_s"][0], found["v_range_m_s"][1]))


def _clip(found: Mapping[str, Any], arrays: Mapping[str, Any]) -> Clip:
    series = {name: frozen(np.asarray(values)) for name, values in arrays.items()}
    return Clip(found["name"], found["experiment"], found["frames"], found["detected"], found["frame_rate_hz"],
                found["bandwidth_s"], found["bandwidth_method"], found["position_noise_m"],
                tuple(_line(line) for line in found["segments"]), quantity_of(found, "v_lim_m_s", "m/s"),
                Motion(**series), tuple(found["notes"]))


def _configuration(found: Mapping[str, Any]) -> Configuration:
    quantities = {key: quantity_of(found, key, unit) for key, unit in QUANTITIES.items()}
    return Configuration(found["mass_kg"], found["incline_deg"], found["group"], tuple(found["clips"]),
                         lines=tuple(_line(line) for line in found["lines"]), notes=tuple(found["notes"]), **quantities)


def analysis_of(outcome: _glidelab.Outcome, motions: Sequence[Mapping[str, Any]], files: Any = None) -> Analysis:
    """The outcome of the C++ side as a result."""
    made = Made(outcome, files)
    document = Result(made).to_dict()
    return Analysis(made, document["estimator"],
                    tuple(_clip(clip, arrays) for clip, arrays in zip(document["clips"], motions)),
                    tuple(_configuration(one) for one in document["configurations"]), tuple(document["doubts"]),
                    with_effects_of(document.get("with")))


def _choices(bandwidth: Union[SupportsFloat, str, None], estimator: str, robust: bool, jobs: Optional[int],
             smoother: str, with_effects: Sequence[str]) -> _glidelab.AnalysisChoices:
    effects = texts("with_effects", with_effects, "a list of effects, such as [\"quadratic_drag\"]")
    text("estimator", estimator, f"one of {', '.join(_glidelab.estimator_names())}")
    text("smoother", smoother, f"one of {', '.join(_glidelab.smoother_names())}")
    switch("robust", robust)
    rule, seconds = "", None
    if isinstance(bandwidth, str):
        rule = bandwidth
    else:
        seconds = optional_real("bandwidth", bandwidth, "a number of seconds, or the name of a rule")
    return _glidelab.AnalysisChoices(seconds, rule, estimator, bool(robust), job_count(jobs), smoother, effects)


def analyze(source: Union[ArrayLike, Track, Film, PathLike, Sequence[Track], Sequence[Film], Sequence[PathLike]],
            x_m: Optional[ArrayLike] = None, *, mass_kg: Optional[float] = None, incline_deg: Optional[float] = None,
            force_n: Optional[ArrayLike] = None, column: str = "", name: str = "",
            bandwidth: Union[SupportsFloat, str, None] = None, estimator: str = DEFAULT_ESTIMATOR, robust: bool = False,
            gravity_m_s2: Optional[float] = None, allow_outside: bool = False,
            most_megapixels: Optional[float] = None, jobs: Optional[int] = None, progress: Progress = None,
            smoother: str = "local-polynomial", runs: Runs = None, masses_kg: Optional[Sequence[float]] = None,
            with_effects: Sequence[str] = (), incline_sd_deg: Optional[float] = None,
            gravity_sd_m_s2: Optional[float] = None, frame_rate_hz: Optional[float] = None,
            px_per_m: Optional[float] = None) -> Analysis:
    """K/m, mu, alpha and the terminal velocity from positions, or from an experiment folder.

    Parameters
    ----------
    source : array_like, Track, Film, str, path, or a sequence of tracks, of films or of names
        ``analyze(t_s, x_m)``: times in seconds, shape (n,), n >= 8, rising. A `Track` or several, which share the
        glider and the track. A `Film` or several: frames in memory, which are written without loss to a temporary
        folder, and read as those of a clip are. Or names of experiment folders or of files
        with a track (docs/reference/commands.md).
    x_m : array_like, shape (n,), optional
        With times as `source`: positions in metres, positive downhill.
    mass_kg, incline_deg : float, optional
        With (t, x), or a file: mass of the glider, and the inclination as stated.
    force_n : array_like, shape (n,), optional
        With (t, x): a known force along x in newtons.
    column : str
        With a file: the column that is x, by its header or its number.
    name : str
        With arrays: what the experiment is called in results.
    bandwidth : float or str, optional
        Standard deviation of the smoothing kernel in seconds, or the rule that chooses it: ``"lines"`` (the default), or
        one of `bandwidth_rules`.
    estimator : {"phase-diagram", "phase-diagram-gls", "trajectory"}
        Lines in the phase diagram as in the paper, generalised lines, or the fit of the whole motion.
    robust : bool
        With ``"trajectory"``: leave out positions that lie off the motion.
    gravity_m_s2 : float, optional
        With arrays or a file: that of the place; not stated: 9.80665, and alpha and mu contain 0.015 m/s². Of a
        stated value they contain half a unit of its last digit over sqrt(3).
    allow_outside : bool
        With a folder: whether it may name files outside itself.
    most_megapixels : float, optional
        With a folder: the largest image or frame that is read, in millions of pixels; 100.
    jobs : int, optional
        Threads; as many as there are cores.
    progress : callable, True or None
        Called as ``progress(stage, fraction)``; True: a bar of tqdm.
    smoother : {"local-polynomial", "kalman", "spline"}
        How v(t) and a(t) are computed from the positions (`smooth`); the last two find their own strength and take no
        `bandwidth`.
    runs : "all" or sequence of int, optional
        With a file of several runs (or masses): which of them become clips, by their numbers from 1 on. Without it the
        file is one clip.
    masses_kg : sequence of float, optional
        The mass of each of the `runs`, or of each of several files, in place of `mass_kg`.
    with_effects : sequence of str
        Also give K/m, mu, alpha and the terminal velocity with these effects in the model (ids of
        docs/reference/effects.md): `Analysis.with_effects`.
    incline_sd_deg : float, optional
        With `incline_deg`: its standard deviation, with which motion in one direction gives mu.
    gravity_sd_m_s2 : float, optional
        With `gravity_m_s2`: its standard deviation, in place of the one said there; 0 if it is exact.
    frame_rate_hz, px_per_m : float, optional
        With a file that counts frames, or that is in pixels: frames per second, and pixels per metre.

    Returns
    -------
    Analysis
        The same numbers, to the last bit, as ``glidelab analyze`` finds in a folder with the same positions.

    Raises
    ------
    InputError
        Wrong input, with what was found where, and what is expected there.
    NumericalError
        A fit broke down.

    Notes
    -----
    The local cubic and the lines are those of the paper (equations 10 to 13); docs/guide/measurement.md explains them.

    Examples
    --------
    >>> import numpy as np, glidelab
    >>> t = np.arange(0.0, 1.5, 0.005)
    >>> x = -0.25 * t + 0.45 * (1.0 - np.exp(-t)) # doctest: +SKIP
    >>> glidelab.analyze(t, x, mass_kg=0.335) # doctest: +SKIP
    """
    stated: dict[str, Any] = {"mass_kg": mass_kg, "incline_deg": stated_incline(incline_deg, incline_sd_deg),
                              "incline_sd_deg": incline_sd_deg, "force_n": force_n}
    given = source_of(source, x_m, **stated)
    choices = _choices(bandwidth, estimator, robust, jobs, smoother, with_effects)
    if given.paths:
        refuse({"force_n": force_n}, "a file's force is one of its columns")
        refuse({"name": name or None}, "a file's name is that of its results")
        files = file_options(given.paths, allow_outside, most_megapixels, column=column, mass_kg=mass_kg,
                             incline_deg=incline_deg, incline_sd_deg=incline_sd_deg, gravity_m_s2=gravity_m_s2,
                             gravity_sd_m_s2=gravity_sd_m_s2, runs=runs, masses_kg=masses_kg,
                             frame_rate_hz=frame_rate_hz, px_per_m=px_per_m)
        with given.told():
            return analysis_of(*_glidelab.analyze_files(list(given.paths), choices, files, teller(progress)), given.written)
    refuse_of_arrays(x_m is not None, {"column": column or None, "runs": runs, "masses_kg": masses_kg,
                                       "most_megapixels": most_megapixels, "frame_rate_hz": frame_rate_hz,
                                       "px_per_m": px_per_m}, allow_outside,
                     {"mass_kg": mass_kg, "incline_deg": incline_deg, "incline_sd_deg": incline_sd_deg,
                      "force_n": force_n})
    gravity = given_gravity(gravity_m_s2, gravity_sd_m_s2)
    return analysis_of(*_glidelab.analyze_arrays(given_tracks(given.tracks), gravity, text("name", name), choices,
                                                 teller(progress)))
