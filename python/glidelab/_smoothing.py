"""The smoother and the bandwidth rules on their own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

from numpy.typing import ArrayLike

from . import _glidelab
from ._arrays import Vector, vector
from ._errors import input_error
from ._results import frame_of


@dataclass(frozen=True, eq=False)
class Smoothed:
    """Position, velocity and acceleration; all arrays have one length, NaN where too few points lie within reach.

    Attributes
    ----------
    t_s : ndarray
        Times.
    x_m, v_m_s, a_m_s2 : ndarray
        The local polynomial and its derivatives; a is NaN for order 1.
    sd_x_m, sd_v_m_s, sd_a_m_s2 : ndarray or None
        Their standard deviations, where the noise of a position is stated.
    bandwidth_s : float
        Of the kernel.
    """

    t_s: Vector
    x_m: Vector
    v_m_s: Vector
    a_m_s2: Vector
    sd_x_m: Optional[Vector]
    sd_v_m_s: Optional[Vector]
    sd_a_m_s2: Optional[Vector]
    bandwidth_s: float

    def to_frame(self) -> Any:
        """A pandas.DataFrame, a row a time, with units in ``attrs["units"]``."""
        names = ("t_s", "x_m", "sd_x_m", "v_m_s", "sd_v_m_s", "a_m_s2", "sd_a_m_s2")
        columns = {name: getattr(self, name) for name in names}
        return frame_of({name: values for name, values in columns.items() if values is not None})


def smooth(t_s: ArrayLike, x_m: ArrayLike, bandwidth_s: float, *, order: int = 3, kernel: str = "gaussian",
           noise_m: Optional[float] = None, at_s: Optional[ArrayLike] = None) -> Smoothed:
    """Position, velocity and acceleration by a local polynomial.

    Parameters
    ----------
    t_s : array_like, shape (n,)
        Times in seconds, rising; of any spacing.
    x_m : array_like, shape (n,)
        Positions, or any other series over these times.
    bandwidth_s : float
        Of the kernel, in seconds; for the Gaussian its standard deviation.
    order : int
        1 to 5; 3 is the paper's local cubic.
    kernel : {"gaussian", "epanechnikov", "tricube", "uniform", "bimodal"}
        The weights of the points around.
    noise_m : float, optional
        Standard deviation of one position (`position_noise`): with it, the results' standard deviations are given.
    at_s : array_like, shape (m,), optional
        Other times at which to evaluate; then no standard deviations are given.

    Returns
    -------
    Smoothed
        At `t_s`, or at `at_s`.

    Raises
    ------
    InputError
        Numbers that are not finite, times that do not rise, an option out of range.

    Notes
    -----
    Equations 10 to 12 of the paper; Fan and Gijbels 1996, section 3.2. The weights are exact for any times.
    """
    t, x = vector("t_s", t_s), vector("x_m", x_m)
    if at_s is None:
        rows = _glidelab.smooth(t, x, bandwidth_s, order, kernel, noise_m)
        if noise_m is None:
            return Smoothed(t, rows[0], rows[1], rows[2], None, None, None, bandwidth_s)
        return Smoothed(t, rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], bandwidth_s)
    if noise_m is not None:
        raise input_error("noise_m", repr(noise_m), "nothing beside at_s: standard deviations are those at t_s")
    at = vector("at_s", at_s)
    rows = _glidelab.smooth_at(t, x, at, bandwidth_s, order, kernel)
    return Smoothed(at, rows[0], rows[1], rows[2], None, None, None, bandwidth_s)


@dataclass(frozen=True)
class BandwidthRule:
    """A rule that chooses a bandwidth: its name, what it does, and what it assumes of the noise."""

    name: str
    words: str
    assumes: str


def bandwidth_rules() -> tuple[BandwidthRule, ...]:
    """The rules that `choose_bandwidth` and `analyze` know (docs/guide/bandwidth.md)."""
    return tuple(BandwidthRule(*rule) for rule in _glidelab.bandwidth_rules())


@dataclass(frozen=True, eq=False)
class Bandwidth:
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

    def __float__(self) -> float:
        return self.bandwidth_s


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
    """
    t, x = vector("t_s", t_s), vector("x_m", x_m)
    pick = _glidelab.choose_bandwidth(t, x, rule, noise_m)
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
    """
    return _glidelab.position_noise(vector("t_s", t_s), vector("x_m", x_m))
