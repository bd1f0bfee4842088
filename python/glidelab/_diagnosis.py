"""diagnose(): which effect the law lacks; plan(): which effects planned motions would show."""

from __future__ import annotations

import html
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional, Union

from numpy.typing import ArrayLike

from . import _glidelab
from ._checks import Vector, frozen, real, shown, text, texts
from ._errors import input_error
from ._inputs import (PathLike, Progress, Runs, Scenario, Track, checked_seed, file_options, given_gravity,
                      given_scenario, given_tracks, job_count, recorder, refuse, refuse_of_arrays, stated_incline, teller)
from ._results import BY_ROW, QUANTITIES, Made, Recovered, Result, frame_of, recovered_of, rounded
from ._shown import Brief, html_plot, html_table, new_axes
from ._sources import Film, source_of


@dataclass(frozen=True)
class Effect:
    """An effect that the verdict names.

    Attributes
    ----------
    id, stage : str
        As docs/reference/effects.md lists it, and where it acts: ``"dynamics"``, ``"timing"``, ``"optics"``, ...
    probability : float
        That it acts, alone or with another.
    equivalent_to : tuple of str
        Effects that these data cannot tell from it.
    joint_probability : float
        That one of the set acts.
    parameters : dict
        ``{"force_n": {"value": ..., "sd": ...}}``; with ``"at_end": True`` where the size stands at an end of the
        range that is searched
    """

    id: str
    stage: str
    probability: float
    equivalent_to: tuple[str, ...]
    joint_probability: float
    parameters: Mapping[str, Any]


@dataclass(frozen=True)
class Cause:
    """One cause in the sequence that explains the gap.

    Attributes
    ----------
    id : str
        As docs/reference/effects.md lists it.
    share : float or None
        The part of the gap that it explains, 0 to 1.
    share_interval95 : (float, float) or None
        Its 95 % interval.
    gap_after : float or None
        The gap of held-out clips with this cause and those before it in the model.
    """

    id: str
    share: Optional[float]
    share_interval95: Optional[tuple[float, float]]
    gap_after: Optional[float]


@dataclass(frozen=True, eq=False, repr=False)
class Residuals(Brief):
    """What the models leave of one motion; all arrays have one length.

    Attributes
    ----------
    clip : str
        Its name.
    t_s, x_m, v_m_s : ndarray
        Times, positions and velocities.
    before_m, after_m : ndarray
        Residuals of the nominal model, and with the causes.
    """

    clip: str
    t_s: Vector
    x_m: Vector
    v_m_s: Vector
    before_m: Vector
    after_m: Vector


@dataclass(frozen=True, eq=False, repr=False)
class Diagnosis(Result):
    """What a diagnosis says.

    Attributes
    ----------
    verdict : {"none", "effect", "unknown"}
        Nothing is missing, named effects are, or something that is not on the list.
    points : int
        Positions that took part.
    summary : str
        The answer in words.
    effects : tuple of Effect
        What the verdict names.
    none, unknown : float
        Probabilities that nothing, and that something off the list, acts.
    explained : tuple of Cause
        How much of the gap each cause explains, in order.
    gap_before, gap_after : float or None
        Root mean square of standardised residuals of held-out clips; 1 is the noise floor. None where there is no gap
        to measure.
    recovered : tuple of Recovered
        The quantities with the causes in the model.
    next_experiment : str
        What to record next.
    residuals : tuple of Residuals
        Of each motion.
    twin : str
        The fitted motions as a scenario (TOML), for `simulate`, `render` and `validate`; empty for a table of lines.
    notes : tuple of str
        What a reader should know.
    """

    verdict: str
    points: int
    summary: str
    effects: tuple[Effect, ...]
    none: float
    unknown: float
    explained: tuple[Cause, ...]
    gap_before: Optional[float]
    gap_after: Optional[float]
    recovered: tuple[Recovered, ...]
    next_experiment: str
    residuals: tuple[Residuals, ...]
    twin: str
    notes: tuple[str, ...]

    def to_frame(self) -> Any:
        """A pandas.DataFrame of all explanations that were weighed, the likeliest first: id, probability, gains."""
        ranking = self.to_dict()["ranking"]
        columns = ("id", "probability", "log_evidence_gain", "log_likelihood_gain", "parameters", "gap_after")
        return frame_of({name: [one.get(name) for one in ranking] for name in columns})

    def plot(self) -> list[Any]:
        """Residuals over v, of the nominal model and with the causes.

        Returns
        -------
        list of matplotlib.axes.Axes
            The two, with one scale.
        """
        axes = new_axes(2)
        for axis, member, title in zip(axes, ("before_m", "after_m"), ("nominal model", "with the causes")):
            for one in self.residuals:
                axis.plot(one.v_m_s, 1e6 * getattr(one, member), ".", markersize=3, label=one.clip)
            axis.set_title(title)
            axis.set_xlabel("v (m/s)")
            axis.set_ylabel("residual (µm)")
        axes[1].set_ylim(axes[0].get_ylim())
        if 0 < len(self.residuals) <= _MOST_NAMED:
            axes[1].legend(fontsize=7, markerscale=3)
        return axes

    def _repr_html_(self) -> str:
        tables = [
            (["effect", "where", "probability", "or", "its size"],
             [[one.id, one.stage, f"{one.joint_probability:.3g}", ", ".join(one.equivalent_to), _sizes(one.parameters)]
              for one in self.effects], "effects that the verdict names"),
            (["cause", "share of the gap (%)", "95 % interval", "gap with it and those above"],
             [[one.id, *("" if one.share is None else f"{100.0 * one.share:.0f}",
                         "" if one.share_interval95 is None else "{:.0f} to {:.0f}".format(
                             *(100.0 * end for end in one.share_interval95)),
                         "" if one.gap_after is None else f"{one.gap_after:.3g}")] for one in self.explained],
             "" if self.gap_before is None else f"a gap of {self.gap_before:.3g} noise floors, and what explains it"),
            (["group", "mass (kg)", "stated α (°)", "with", "K/m", "µ", "α", "terminal velocity"],
             [[one.group, f"{one.mass_kg:g}", f"{one.incline_deg:g}", ", ".join(one.with_causes),
               *(str(getattr(one, key)) for key in QUANTITIES)] for one in self.recovered],
             "recovered with the causes in the model"),
            (["explanation", "probability", "gain of log evidence", "gap with it"],
             [[str(one["id"]), *("" if one.get(key) is None else f"{one[key]:.3g}" for key in
                                 ("probability", "log_evidence_gain", "gap_after"))]
              for one in self.to_dict()["ranking"]], "all explanations that were weighed"),
        ]
        said = [f"<p><b>{html.escape(self.summary)}</b></p>", f"<p>{html.escape(self.next_experiment)}</p>"]
        said += [f"<p>{html.escape(note)}</p>" for note in self.notes]
        return "".join(said) + "".join(html_table(*one) for one in tables if one[1]) + html_plot(self.plot)


def _sizes(parameters: Mapping[str, Any]) -> str:
    """"force_n 0.012 ± 0.001": each parameter of an effect."""
    said = []
    for name, found in parameters.items():
        value = found.get("value")
        if value is not None:
            said.append(f"{name} {rounded(value, found.get('sd'))}{' (at the end of its range)' if found.get('at_end') else ''}")
    return ", ".join(said)


_MOST_NAMED = 12  # clips in a legend; more would hide the residuals


def _interval(found: Optional[Sequence[float]]) -> Optional[tuple[float, float]]:
    return None if found is None else (found[0], found[1])


def diagnosis_of(outcome: _glidelab.Outcome, residuals: Sequence[Mapping[str, Any]], twin: str,
                 files: Any = None) -> Diagnosis:
    """The outcome of the C++ side as a result."""
    made = Made(outcome, files)
    found = Result(made).to_dict()
    gap = found.get("gap") or {}
    return Diagnosis(
        made, found["verdict"], found["points"], found["summary"],
        tuple(Effect(one["id"], one["stage"], one["probability"], tuple(one["equivalent_to"]),
                     one["joint_probability"], one["parameters"]) for one in found["effects"]),
        found["probability"]["none"], found["probability"]["unknown"],
        tuple(Cause(one["id"], one["share"], _interval(one.get("share_interval95")), one["gap_after"])
              for one in found["explained"]),
        gap.get("before"), gap.get("after"),
        tuple(recovered_of(one) for one in found["recovered"]), found["next_experiment"],
        tuple(Residuals(**{key: value if key == "clip" else frozen(value) for key, value in one.items()})
              for one in residuals),
        twin, tuple(found["notes"]))


def diagnose(source: Union[ArrayLike, Track, Film, PathLike, Sequence[Track], Sequence[Film], Sequence[PathLike]],
             x_m: Optional[ArrayLike] = None, *, mass_kg: Optional[float] = None, incline_deg: Optional[float] = None,
             force_n: Optional[ArrayLike] = None, name: str = "", without: Sequence[str] = (),
             gravity_m_s2: Optional[float] = None, allow_outside: bool = False,
             most_megapixels: Optional[float] = None, jobs: Optional[int] = None, progress: Progress = None,
             column: str = "", runs: Runs = None, masses_kg: Optional[Sequence[float]] = None,
             incline_sd_deg: Optional[float] = None, gravity_sd_m_s2: Optional[float] = None,
             recorded_by: str = "", frame_rate_hz: Optional[float] = None,
             px_per_m: Optional[float] = None) -> Diagnosis:
    """Which effect, if any, the law of viscous drag and Coulomb friction lacks.

    Parameters
    ----------
    source : array_like, Track, Film, str, path, or a sequence of tracks, of films or of names
        ``diagnose(t_s, x_m)``, a `Track` or several, which share the glider and the track; a `Film` or several; or names
        of experiment folders, of files with a track, or of one ``.csv`` with a table of lines.
    x_m : array_like, shape (n,), optional
        With times as `source`: positions in metres, positive downhill.
    mass_kg, incline_deg, force_n : optional
        With (t, x), the first two also with a file: as in `analyze`.
    name : str
        With arrays: what the experiment is called in results.
    without : sequence of str
        Effects to leave out, by the ids of docs/reference/effects.md.
    gravity_m_s2, allow_outside, most_megapixels, jobs, progress, column, runs, masses_kg
        As in `analyze`.
    incline_sd_deg, gravity_sd_m_s2, frame_rate_hz, px_per_m
        As in `analyze`.
    recorded_by : {"", "sensor", "camera"}
        What measured the positions of arrays or files: a motion sensor has none of the effects of a camera. Left out,
        the header of a file's column may tell. A folder's experiment.toml states it.

    Returns
    -------
    Diagnosis
        The same, to the last bit, as ``glidelab diagnose`` says of a folder with the same positions.

    Raises
    ------
    InputError
        Wrong input; too few positions for a verdict; an unknown effect in `without`.

    Notes
    -----
    docs/guide/diagnosis.md says how far to trust the verdict, docs/reference/weighing.md how explanations are weighed.
    """
    stated: dict[str, Any] = {"mass_kg": mass_kg, "incline_deg": stated_incline(incline_deg, incline_sd_deg),
                              "incline_sd_deg": incline_sd_deg, "force_n": force_n}
    given = source_of(source, x_m, **stated)
    left_out = texts("without", without, "a list of effects, such as [\"quadratic_drag\"]")
    if given.paths:
        refuse({"force_n": force_n}, "a file's force is one of its columns")
        refuse({"name": name or None}, "a file's name is that of its results")
        files = file_options(given.paths, allow_outside, most_megapixels, column=column, mass_kg=mass_kg,
                             incline_deg=incline_deg, incline_sd_deg=incline_sd_deg, gravity_m_s2=gravity_m_s2,
                             gravity_sd_m_s2=gravity_sd_m_s2, runs=runs, masses_kg=masses_kg,
                             recorded_by=recorder(recorded_by), frame_rate_hz=frame_rate_hz, px_per_m=px_per_m)
        with given.told():
            return diagnosis_of(*_glidelab.diagnose_files(list(given.paths), left_out, job_count(jobs), files,
                                                          teller(progress)), given.written)
    refuse_of_arrays(x_m is not None, {"column": column or None, "runs": runs, "masses_kg": masses_kg,
                                       "most_megapixels": most_megapixels, "frame_rate_hz": frame_rate_hz,
                                       "px_per_m": px_per_m}, allow_outside,
                     {"mass_kg": mass_kg, "incline_deg": incline_deg, "incline_sd_deg": incline_sd_deg,
                      "force_n": force_n})
    gravity = given_gravity(gravity_m_s2, gravity_sd_m_s2)
    return diagnosis_of(*_glidelab.diagnose_arrays(given_tracks(given.tracks), gravity, text("name", name), left_out,
                                                   recorder(recorded_by), job_count(jobs), teller(progress)))


@dataclass(frozen=True)
class PlannedEffect:
    """An effect that planned motions would show, or not.

    Attributes
    ----------
    id, parameter : str
        As docs/reference/effects.md lists it, and the key of its size, with the unit.
    seen : bool
        Whether the largest size that is considered would show.
    seen_from : float or None
        The size that amounts to four standard deviations.
    alike : tuple of str
        Effects that the motions could not distinguish from it.
    """

    id: str
    parameter: str
    seen: bool
    seen_from: Optional[float]
    alike: tuple[str, ...]


@dataclass(frozen=True, eq=False, repr=False)
class Plan(Result):
    """Which effects motions will show and tell apart.

    Attributes
    ----------
    clips, points : int
        How many motions and positions.
    noise_m : float
        Standard deviation of one position, the mean over the motions.
    effects : tuple of PlannedEffect
        All effects of the list.
    notes : tuple of str
        What a reader should know.
    """

    clips: int
    points: int
    noise_m: float
    effects: tuple[PlannedEffect, ...]
    notes: tuple[str, ...]

    def to_frame(self) -> Any:
        """A pandas.DataFrame, one row per effect; the column ``unit`` has that of ``seen_from``."""
        columns = {name: [getattr(one, name) for one in self.effects]
                   for name in ("id", "parameter", "seen", "seen_from", "alike")}
        columns["unit"] = [_glidelab.unit_of_key(one.parameter) for one in self.effects]
        frame = frame_of(columns)
        frame.attrs["units"]["seen_from"] = BY_ROW
        return frame

    def _repr_html_(self) -> str:
        rows = [[one.id, one.parameter, "" if one.seen_from is None else f"{one.seen_from:.3g}", ", ".join(one.alike)]
                for one in self.effects if one.seen]
        return html_table(["effect", "parameter", "smallest size that shows", "looks like"], rows) + html_plot(self.plot)

    def plot(self, ax: Any = None) -> Any:
        """How alike the effects that would show are: the cosine between what they do to the motions, 1 where no size
        tells them apart.

        Returns
        -------
        matplotlib.axes.Axes
            `ax`, or new ones; an effect a row and a column.
        """
        ax = new_axes(1)[0] if ax is None else ax
        alike = self.to_dict()["isolability"]
        names = [name.replace("_", " ") for name in alike["effects"]]
        ax.set_title("cosine between effects", fontsize=8)
        if names:
            shown_as = ax.imshow(alike["cosine"], vmin=0.0, vmax=1.0, cmap="Blues")
            ax.figure.colorbar(shown_as, ax=ax)
        ax.set_xticks(range(len(names)), names, rotation=90, fontsize=6)
        ax.set_yticks(range(len(names)), names, fontsize=6)
        return ax


def plan(source: Union[Scenario, Track, Sequence[Track]], *, noise_m: Optional[float] = None,
         seed: Optional[int] = None, gravity_m_s2: Optional[float] = None, name: str = "", jobs: Optional[int] = None,
         progress: Progress = None) -> Plan:
    """Which effects motions will show and tell apart, before they are recorded.

    Parameters
    ----------
    source : str, path, dict, Track or sequence of Track
        A scenario, or motions that were recorded.
    noise_m : float
        With a scenario: standard deviation of the position noise in metres, which a scenario does not state.
    seed : int, optional
        With a scenario: of the noise; the scenario's own.
    gravity_m_s2, name
        With tracks, as in `diagnose`.
    jobs, progress
        As in `analyze`.

    Returns
    -------
    Plan
        The same as ``glidelab diagnose --plan`` writes.

    Raises
    ------
    InputError
        Wrong input; nothing moves freely.

    Notes
    -----
    The size that shows is four standard deviations, with the other parameters free; docs/guide/diagnosis.md.
    """
    tracks = [source] if isinstance(source, Track) else source
    if isinstance(tracks, Sequence) and not isinstance(tracks, str):
        _only("noise_m", noise_m, "a scenario: recorded positions show their own noise")
        _only("seed", seed, "a scenario")
        given = source_of(tracks, None)
        gravity = given_gravity(gravity_m_s2, None)
        outcome = _glidelab.plan_arrays(given_tracks(given.tracks), gravity, text("name", name), job_count(jobs),
                                        teller(progress))
    else:
        _only("gravity_m_s2", gravity_m_s2, "recorded positions: a scenario states its own")
        _only("name", name or None, "recorded positions: a scenario states its own")
        if noise_m is None:
            raise input_error("noise_m", "nothing", "the position noise in metres, which a scenario does not state")
        noise_m = real("noise_m", noise_m, "a number of metres from 1e-9 to 1")
        if not 1e-9 <= noise_m <= 1.0:
            raise input_error("noise_m", f"{noise_m:g}", "a number of metres from 1e-9 to 1")
        outcome = _glidelab.plan_scenario(given_scenario(source), noise_m, checked_seed(seed), job_count(jobs),  # type: ignore[arg-type]
                                          teller(progress))
    made = Made(outcome)
    found = Result(made).to_dict()
    return Plan(made, found["clips"], found["points"], found["noise_m"],
                tuple(PlannedEffect(one["id"], one["parameter"], one["seen"], one.get("seen_from"), tuple(one["alike"]))
                      for one in found["effects"]), tuple(found["notes"]))


def _only(key: str, value: object, where: str) -> None:
    if value is not None:
        raise input_error(key, shown(value), f"nothing: it is for {where}")
