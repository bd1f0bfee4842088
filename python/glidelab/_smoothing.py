"""The smoother and the bandwidth rules on their own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Optional, SupportsFloat

import numpy as np
from numpy.typing import ArrayLike

from . import _glidelab
from ._checks import Vector, optional_real, text, vector, whole
from ._errors import input_error, input_errors
from ._results import NORMAL95, Written, frame_of
from ._shown import Brief, html_plot, html_table, new_axes


@dataclass(frozen=True, eq=False, repr=False)
class Strength(Brief):
    """How strongly a smoother that finds its own strength smooths.

    Attributes
    ----------
    method : str
        One line on how it was chosen.
    time_s : float
        The smoothing time; oscillations with an angular frequency above 1/time_s are treated as noise.
    noise_m : float
        Standard deviation of one position, as estimated or as stated.
    breaks_s : ndarray
        Where a may jump, as estimated.
    jump_sd_m_s2 : float or None
        Standard deviation of the jumps, infinite where any is allowed; None without a break.
    simultaneous_a : float
        a ± this times its standard deviation holds a at all times together with 95 % probability.
    """

    method: str
    time_s: float
    noise_m: float
    breaks_s: Vector
    jump_sd_m_s2: Optional[float]
    simultaneous_a: float


@dataclass(frozen=True, eq=False, repr=False)
class Smoothed(Written):
    """Position, velocity and acceleration; all arrays have one length, NaN where too few points lie within reach.

    Attributes
    ----------
    t_s : ndarray
        Times.
    x_m, v_m_s, a_m_s2 : ndarray
        The smoothed positions and their derivatives; a is NaN for a local polynomial of order 1.
    sd_x_m, sd_v_m_s, sd_a_m_s2 : ndarray or None
        Their standard deviations: of a local polynomial by the noise alone, where the noise of a position is stated;
        of ``kalman`` and ``spline`` with what the smoothing may take off.
    bandwidth_s : float
        Of the kernel; of ``kalman`` and ``spline`` that of the local cubic with as much noise in a.
    strength : Strength or None
        What ``kalman`` or ``spline`` chose.
    """

    t_s: Vector
    x_m: Vector
    v_m_s: Vector
    a_m_s2: Vector
    sd_x_m: Optional[Vector]
    sd_v_m_s: Optional[Vector]
    sd_a_m_s2: Optional[Vector]
    bandwidth_s: float
    strength: Optional[Strength] = None

    def plot(self, ax: Any = None) -> Any:
        """a over t; dark the 95 % band of each point, light (of ``kalman`` and ``spline``) that of all together.

        Returns
        -------
        matplotlib.axes.Axes
            `ax`, or new ones.
        """
        ax = new_axes(1)[0] if ax is None else ax
        if self.sd_a_m_s2 is not None:
            bands = [] if self.strength is None else [(self.strength.simultaneous_a, 0.2)]
            for factor, alpha in [*bands, (NORMAL95, 0.35)]:
                ax.fill_between(self.t_s, self.a_m_s2 - factor * self.sd_a_m_s2, self.a_m_s2 + factor * self.sd_a_m_s2,
                                color="C0", alpha=alpha, linewidth=0)
        ax.plot(self.t_s, self.a_m_s2, color="C0")
        for at in [] if self.strength is None else self.strength.breaks_s.tolist():
            ax.axvline(at, color="0.6", linestyle="--")
        ax.set_xlabel("t (s)")
        ax.set_ylabel("a (m/s²)")
        return ax

    def __str__(self) -> str:
        rows = self._rows()
        width = max(len(row[0]) for row in rows)
        return "\n".join(f"{name.ljust(width)}  {value}" for name, value in rows) + "\n"

    def _rows(self) -> list[list[str]]:
        rows = [["points", str(len(self.t_s))]]
        if self.strength is None:
            rows.append(["bandwidth (s)", f"{self.bandwidth_s:.4g}"])
        else:
            rows += [["chosen by", self.strength.method], ["smoothing time (s)", f"{self.strength.time_s:.4g}"],
                     ["local cubic with as much noise in a (s)", f"{self.bandwidth_s:.4g}"],
                     ["noise of a position (m)", f"{self.strength.noise_m:.3g}"],
                     ["simultaneous 95 % band of a", f"± {self.strength.simultaneous_a:.3g} sd"]]
            if self.strength.breaks_s.size > 0:
                rows.append(["breaks (s)", ", ".join(f"{at:.4g}" for at in self.strength.breaks_s)])
        names = {"x_m": "x (m)", "v_m_s": "v (m/s)", "a_m_s2": "a (m/s²)"}
        for name, words in names.items():
            values, sd = getattr(self, name), getattr(self, f"sd_{name}")
            rows.append([words, _span(values) + ("" if sd is None else f", sd {_span(sd)}")])
        return rows

    def _repr_html_(self) -> str:
        return html_table(["", ""], self._rows()) + html_plot(self.plot)

    def _columns(self) -> Mapping[str, Sequence[Any]]:
        names = ("t_s", "x_m", "sd_x_m", "v_m_s", "sd_v_m_s", "a_m_s2", "sd_a_m_s2")
        columns = {name: getattr(self, name) for name in names}
        return {name: values for name, values in columns.items() if values is not None}

    def to_frame(self) -> Any:
        """A pandas.DataFrame, one row per time, with units in ``attrs["units"]``."""
        return frame_of(self._columns())


def _span(values: Vector) -> str:
    """"-0.31 to 1.2", without the NaNs."""
    finite = values[np.isfinite(values)]
    return "none" if finite.size == 0 else f"{finite.min():.3g} to {finite.max():.3g}"


def smooth(t_s: ArrayLike, x_m: ArrayLike, bandwidth_s: Optional[SupportsFloat] = None, *, order: int = 3,
           kernel: str = "gaussian", noise_m: Optional[float] = None, at_s: Optional[ArrayLike] = None,
           smoother: str = "local-polynomial", breaks_s: Optional[ArrayLike] = None) -> Smoothed:
    """Position, velocity and acceleration by a local polynomial, or by a smoother that finds its own strength.

    Parameters
    ----------
    t_s : array_like, shape (n,)
        Times in seconds, rising; of any spacing.
    x_m : array_like, shape (n,)
        Positions, or any other series over these times.
    bandwidth_s : float, optional
        Of the local polynomial's kernel, in seconds; for the Gaussian its standard deviation. Not of the others.
    order : int
        1 to 5; 3 is the paper's local cubic.
    kernel : {"gaussian", "epanechnikov", "tricube", "uniform", "bimodal"}
        The weights of the neighbouring points.
    noise_m : float, optional
        Standard deviation of one position (`position_noise`): with it, the results' standard deviations are given.
    at_s : array_like, shape (m,), optional
        Other times at which to evaluate, in any order, within the motion; a local polynomial then gives no standard
        deviations.
    smoother : {"local-polynomial", "kalman", "spline"}
        ``kalman``: an integrated Wiener or Ornstein-Uhlenbeck process of order 3 to 5, its order, rate and strength
        by marginal likelihood. ``spline``: the spline of the same process, its strength by generalised
        cross-validation. Both estimate the noise where `noise_m` does not state it, and take neither `bandwidth_s` nor
        `order` and `kernel`.
    breaks_s : array_like, shape (b,), optional
        Of ``kalman`` and ``spline``: about when v = 0 and a may jump (dry friction), rising. They are moved to where
        the smoothed v is 0.

    Returns
    -------
    Smoothed
        At `t_s`, or at `at_s`.

    Raises
    ------
    InputError
        Numbers that are not finite, times that do not rise, an option out of range.
    NumericalError
        ``kalman`` or ``spline``: a gap so long that the uncertainty across it cannot be computed.

    Notes
    -----
    The local polynomial: equations 10 to 12 of the paper; Fan and Gijbels 1996, section 3.2. The weights are exact for any
    times. ``kalman`` and ``spline`` are one posterior: that a spline is the mean of an integrated Wiener process is
    Wahba's (1978, J. R. Stat. Soc. B 40, 364; breaks: Wecker and Ansley 1983, J. Am. Stat. Assoc. 78, 81); its computation
    as a state-space model Hartikainen and Särkkä's (2010, IEEE MLSP, 379), here by a square-root information filter
    (Bierman 1977); splines and cross-validation: Green and Silverman 1994, chapters 2 and 3; Kim and Gu 2004.
    docs/guide/bandwidth.md compares them.
    """
    t, x = vector("t_s", t_s), vector("x_m", x_m)
    text("smoother", smoother, f"one of {', '.join(_glidelab.smoother_names())}")
    whole("order", order, 1, 5)
    text("kernel", kernel)
    noise_m = optional_real("noise_m", noise_m, "a number of metres, or None")
    if isinstance(bandwidth_s, str):
        raise input_error("bandwidth_s", repr(bandwidth_s),
                          "a time in seconds above 0: choose_bandwidth(t_s, x_m, rule) gives that of a rule")
    bandwidth_s = optional_real("bandwidth_s", bandwidth_s, "a time in seconds above 0")
    if smoother != "local-polynomial":
        return _smooth_by(smoother, t, x, bandwidth_s, order, kernel, noise_m, at_s, breaks_s)
    if breaks_s is not None:
        raise input_error("breaks_s", "times", 'none with "local-polynomial", which knows of no breaks')
    if bandwidth_s is None:
        raise input_error("bandwidth_s", "None", "a time in seconds above 0")
    if at_s is None:
        rows = _glidelab.smooth(t, x, bandwidth_s, order, kernel, noise_m)
        _refuse_nothing(rows[0], bandwidth_s)
        if noise_m is None:
            return Smoothed(t, rows[0], rows[1], rows[2], None, None, None, bandwidth_s)
        return Smoothed(t, rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], bandwidth_s)
    if noise_m is not None:
        raise input_error("noise_m", f"{noise_m:g}", "none with at_s: standard deviations are those at t_s")
    at = _within("at_s", vector("at_s", at_s), t)
    rows = _glidelab.smooth_at(t, x, at, bandwidth_s, order, kernel)
    _refuse_nothing(rows[0], bandwidth_s)
    return Smoothed(at, rows[0], rows[1], rows[2], None, None, None, bandwidth_s)


def _refuse_nothing(x: Vector, bandwidth_s: float) -> None:
    if x.size > 0 and np.isnan(x).all():
        raise input_error("bandwidth_s", f"{bandwidth_s:g}", "a longer time: within reach of this one no time has points enough")


def _within(key: str, times: Vector, t: Vector) -> Vector:
    """The times, none of which lies outside the motion."""
    outside = [] if t.size == 0 else np.flatnonzero((times < t[0]) | (times > t[-1])).tolist()
    if outside:
        raise input_errors([("", 0, f"{key}[{i}]", f"{times[i]:g}", "a time between the first and the last of t_s")
                            for i in outside])
    return times


_LARGEST = 1e70  # its fourth power is finite with time steps in it


def _smooth_by(smoother: str, t: Vector, x: Vector, bandwidth_s: Optional[float], order: int, kernel: str,
               noise_m: Optional[float], at_s: Optional[ArrayLike], breaks_s: Optional[ArrayLike]) -> Smoothed:
    if bandwidth_s is not None:
        raise input_error("bandwidth_s", repr(bandwidth_s), f'none with "{smoother}", which finds its own strength')
    if (order, kernel) != (3, "gaussian"):
        raise input_error("order" if order != 3 else "kernel", repr(order if order != 3 else kernel),
                          f'the default with "{smoother}": others are for the local polynomial')
    for i in np.flatnonzero(np.abs(x) > _LARGEST).tolist():
        raise input_error(f"x_m[{i}]", f"{x[i]:g}", f"a number within ±{_LARGEST:g}: variances are computed of its square")
    at = None if at_s is None else _within("at_s", vector("at_s", at_s), t)
    rising, place = (None, None) if at is None else np.unique(at, return_inverse=True)
    rows, like_s, method, time_s, noise, breaks, jump, factor = _glidelab.smooth_by(
        smoother, t, x, rising, vector("breaks_s", [] if breaks_s is None else breaks_s), noise_m)
    if place is not None:
        rows = rows[:, place]
    strength = Strength(method, time_s, noise, breaks, jump, factor)
    return Smoothed(t if at is None else at, rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], like_s, strength)


@dataclass(frozen=True)
class BandwidthRule:
    """A rule that chooses a bandwidth.

    Attributes
    ----------
    name : str
        As `choose_bandwidth` and `analyze` take it.
    words, assumes : str
        What it does, and what it assumes of the noise.
    """

    name: str
    words: str
    assumes: str

    def _repr_html_(self) -> str:
        return _rules_html([self])


def _rules_html(rules: Sequence[BandwidthRule]) -> str:
    return html_table(["rule", "what it does", "what it assumes of the noise"],
                      [[one.name, one.words, one.assumes] for one in rules])


class _Rules(tuple[BandwidthRule, ...]):
    """The rules, which a notebook shows as a table."""

    def _repr_html_(self) -> str:
        return _rules_html(self)


def bandwidth_rules() -> tuple[BandwidthRule, ...]:
    """The rules that `choose_bandwidth` and `analyze` know.

    Returns
    -------
    tuple of BandwidthRule
        The default first. A notebook shows them as a table.

    Notes
    -----
    docs/guide/bandwidth.md names the source of each.
    """
    return _Rules(BandwidthRule(*rule) for rule in _glidelab.bandwidth_rules())


@dataclass(frozen=True, eq=False, repr=False)
class Bandwidth(Written):
    """A bandwidth that a rule chose.

    Attributes
    ----------
    bandwidth_s : float
        One for all points; of a local rule, the median.
    method : str
        One line on how it was chosen.
    at_s, local_s : ndarray
        Of a local rule: times, and the bandwidth at each; else empty.
    """

    bandwidth_s: float
    method: str
    at_s: Vector
    local_s: Vector

    def _columns(self) -> Mapping[str, Sequence[Any]]:
        table: dict[str, Any] = {"t_s": self.at_s, "bandwidth_s": self.local_s}
        return table if self.at_s.size > 0 else {}

    def _repr_html_(self) -> str:
        rows = [["bandwidth (s)", f"{self.bandwidth_s:.4g}"], ["chosen by", self.method]]
        if self.local_s.size > 0:
            rows.append(["from point to point (s)", _span(self.local_s)])
        return html_table(["", ""], rows)

    def __float__(self) -> float:
        return self.bandwidth_s

    def __str__(self) -> str:
        return f"{self.bandwidth_s:.4g} s: {self.method}\n"


def choose_bandwidth(t_s: ArrayLike, x_m: ArrayLike, rule: str = "plug-in", *,
                     noise_m: Optional[float] = None) -> Bandwidth:
    """The bandwidth of the local cubic for a(t), by a rule, for one stretch of motion without a jump in a.

    Parameters
    ----------
    t_s, x_m : array_like, shape (n,)
        Times in seconds, rising, and positions in metres; n is 8 or more.
    rule : str
        A name of `bandwidth_rules`.
    noise_m : float, optional
        Standard deviation of one position, white; `position_noise` of the motion.

    Returns
    -------
    Bandwidth
        For the acceleration; `analyze` cuts a clip at its turns first, and so may choose another one.

    Raises
    ------
    InputError
        Wrong numbers, an unknown rule, a motion that is too short for any bandwidth.

    Notes
    -----
    ``plug-in``: Ruppert, Sheather and Wand 1995; Fan and Gijbels 1996, section 4.2. ``ebbs``: Ruppert 1997. ``ici``:
    Goldenshluger and Nemirovski 1997. ``rsc``: Fan and Gijbels 1995. ``cv``: Stone 1974. ``gcv``: Craven and Wahba 1979.
    ``cv-correlated``: De Brabanter and others 2011. docs/guide/bandwidth.md says what each assumes.
    """
    t, x = vector("t_s", t_s), vector("x_m", x_m)
    text("rule", rule, f"one of {', '.join(one.name for one in bandwidth_rules())}")
    pick = _glidelab.choose_bandwidth(t, x, rule, optional_real("noise_m", noise_m, "a number of metres, or None"))
    if pick is None:
        raise input_error("t_s", f"{len(t)} points", f"a motion that is long enough for the rule {rule}")
    return Bandwidth(*pick)


def position_noise(t_s: ArrayLike, x_m: ArrayLike) -> float:
    """The standard deviation of one position, in metres, from how far each lies off its neighbours.

    Parameters
    ----------
    t_s, x_m : array_like, shape (n,)
        Times in seconds, rising, and positions in metres; n is 8 or more.

    Returns
    -------
    float
        From the residuals of the cubic through each point's four nearest neighbours; of positions rounded to a step,
        not below what the rounding makes. No law of motion is assumed.

    Raises
    ------
    InputError
        Wrong numbers.

    Notes
    -----
    For even times it is the fourth difference over sqrt(70), whose variance for white noise is that of one position.
    Only the smaller half of the squares counts, so that outliers and impacts do not.
    """
    return _glidelab.position_noise(vector("t_s", t_s), vector("x_m", x_m))
