"""simulate(): the true motions of a scenario."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from . import _glidelab
from ._checks import Vector, frozen, optional_real
from ._inputs import Progress, Scenario, Track, given_scenario, teller
from ._results import Made, Result, frame_of
from ._shown import Brief, html_plot, html_table, new_axes


@dataclass(frozen=True)
class ModeChange:
    """When and where the glider changed between ``slide_up``, ``stick`` and ``slide_down``.

    Attributes
    ----------
    t_s, x_m : float
        Time and place of the change.
    before, after : {"slide_up", "stick", "slide_down"}
        How it moved until then, and from then on.
    """

    t_s: float
    x_m: float
    before: str
    after: str


@dataclass(frozen=True, eq=False, repr=False)
class SimulatedClip(Brief):
    """The true motion of one clip, at the middle of each exposure.

    Attributes
    ----------
    name, configuration : str
        Of the clip, and of its configuration in the scenario.
    t_s, x_m, v_m_s, a_m_s2 : ndarray
        SI units; x is positive downhill, t = 0 at the first frame.
    mode : ndarray of str
        ``slide_up``, ``stick`` or ``slide_down``.
    changes : tuple of ModeChange
        All changes of mode.
    dissipated_j : float
        Work done against all forces but gravity.
    """

    name: str
    configuration: str
    t_s: Vector
    x_m: Vector
    v_m_s: Vector
    a_m_s2: Vector
    mode: np.ndarray[Any, np.dtype[np.str_]]
    changes: tuple[ModeChange, ...]
    dissipated_j: float

    def track(self, noise_m: float = 0.0, seed: int = 1, **stated: Any) -> Track:
        """The positions as a Track to be analysed.

        Parameters
        ----------
        noise_m : float
            Standard deviation of independent normal noise that is added.
        seed : int
            Of ``numpy.random.default_rng``.
        **stated
            Fields of Track: mass_kg, incline_deg, ... Without one, `launched` is as the motion begins, and `name` the
            clip's.
        """
        noise = np.random.default_rng(seed).normal(0.0, 1.0, len(self.x_m)) * noise_m
        v_m_s = self.v_m_s[0] if len(self.v_m_s) > 0 else 0.0
        launched = "up" if v_m_s < 0.0 else "down" if v_m_s > 0.0 else "released"
        fields: dict[str, Any] = {"name": self.name, "launched": launched, **stated}
        return Track(self.t_s, self.x_m + noise, **fields)

    def to_frame(self) -> Any:
        """A pandas.DataFrame, one row per frame, with units in ``attrs["units"]``."""
        return frame_of({name: getattr(self, name) for name in ("t_s", "x_m", "v_m_s", "a_m_s2", "mode")})


@dataclass(frozen=True, eq=False, repr=False)
class Simulation(Result):
    """The true motions of a scenario.

    Attributes
    ----------
    clips : tuple of SimulatedClip
        In the scenario's order.
    """

    clips: tuple[SimulatedClip, ...]

    def to_frame(self) -> Any:
        """A pandas.DataFrame, one row per frame of each clip, with units in ``attrs["units"]``."""
        names = ("t_s", "x_m", "v_m_s", "a_m_s2", "mode")
        columns: dict[str, Any] = {"clip": [clip.name for clip in self.clips for _ in clip.t_s],
                                   "configuration": [clip.configuration for clip in self.clips for _ in clip.t_s]}
        for name in names:
            columns[name] = np.concatenate([getattr(clip, name) for clip in self.clips])
        return frame_of(columns)

    def plot(self) -> list[Any]:
        """x(t), and the phase diagram a against v.

        Returns
        -------
        list of matplotlib.axes.Axes
            The two.
        """
        position, phase = new_axes(2)
        for clip in self.clips:
            position.plot(clip.t_s, clip.x_m, label=clip.name)
            phase.plot(clip.v_m_s, clip.a_m_s2, ".", markersize=3, label=clip.name)
        position.set_xlabel("t (s)")
        position.set_ylabel("x (m)")
        phase.set_xlabel("v (m/s)")
        phase.set_ylabel("a (m/s²)")
        phase.legend()
        return [position, phase]

    def _repr_html_(self) -> str:
        rows = [[one.name, one.configuration, str(len(one.t_s)), f"{one.x_m[0]:.4f}", f"{one.x_m[-1]:.4f}",
                 f"{one.v_m_s[-1]:+.4f}"] for one in self.clips]
        return html_table(["clip", "configuration", "states", "from x (m)", "to x (m)", "last v (m/s)"],
                          rows) + html_plot(self.plot)


def simulate(scenario: Scenario, *, rate_hz: Optional[float] = None, progress: Progress = None) -> Simulation:
    """The true motions of a scenario.

    Parameters
    ----------
    scenario : str, path or dict
        A scenario file (docs/reference/scenario.md), or what `load_scenario` makes of one.
    rate_hz : float, optional
        States per second; the scenario's frame rate.
    progress : callable, True or None
        Called as ``progress(stage, fraction)``; True: a bar of tqdm.

    Returns
    -------
    Simulation
        Positions within 1e-9 m over 10 s, the time of a reversal within 1e-9 s.

    Raises
    ------
    InputError
        Everything that is wrong with the scenario.
    NumericalError
        The integrator failed; with time, step and tolerance.

    Notes
    -----
    CVODES (Hindmarsh and others 2005), from event to event. docs/reference/scenario.md has the force laws.
    """
    rate = optional_real("rate_hz", rate_hz, "states per second, or None")
    outcome, states = _glidelab.simulate(given_scenario(scenario), rate, teller(progress))
    made = Made(outcome)
    clips = []
    for found, arrays in zip(Result(made).to_dict()["clips"], states):
        series = {name: frozen(np.asarray(values)) for name, values in arrays.items()}
        changes = tuple(ModeChange(one["t_s"], one["x_m"], one["from"], one["to"]) for one in found["mode_changes"])
        clips.append(SimulatedClip(name=found["name"], configuration=found["configuration"], changes=changes,
                                   dissipated_j=found["dissipated_j"], **series))
    return Simulation(made, tuple(clips))
