"""Motions of a glider with effects that the nominal model lacks, written from the contract of the effects alone.

The law, along x (positive downhill):

    (m + m_w) dv/dt = m g sin(alpha) + sum of forces - K k(x, v, s) v - s (mu q(x, v, t, s) m g cos(alpha) + F_0)

s is the sign of the velocity; k and q are the products of what the effects do to drag and friction. A glider at rest stays
there until the other forces exceed its friction. scipy's solve_ivp integrates from one change of sign to the next. Nothing
here is shared with the program: no formula, no integrator, no constant but g. SI units; angles in radians.
"""

import dataclasses

import numpy as np
from scipy.integrate import solve_ivp

G = 9.80665  # m/s²
REST = 1e-9  # m/s: below this a glider counts as at rest


@dataclasses.dataclass
class Clip:
    number: int
    configuration: int
    mass: float  # true
    alpha: float  # true
    x0: float
    v0: float
    times: np.ndarray  # of the frames, from 0 on
    launched: str
    stated_mass: float
    stated_incline_deg: float
    group: str
    force: object = None  # recorded force in N as a function of the time, or None


@dataclasses.dataclass
class Glider:
    drag: float  # K, kg/s
    mu: float


class Effect:
    """What does nothing. An effect overrides what it changes; `size` scales it, and 0 is its absence."""

    id = ""
    largest = 1.0  # plausible size
    max_step = 0.1  # s, of the integrator: less for what acts within millimetres

    def __init__(self, size, **fixed):
        self.size = size
        self.__dict__.update(fixed)

    def added_mass(self):
        return 0.0

    def constant_friction(self):
        return 0.0

    def friction(self, clip, t, x, v, s):
        return 1.0

    def drag(self, clip, x, v, s):
        return 1.0

    def force(self, clip, t, x, v):
        return 0.0

    def true_force_time(self, t):
        """When the recorded force of time t acts, and by which factor."""
        return t, 1.0

    def seen(self, clip, t, x, v):
        return x

    def frame_times(self, clip, t):
        return t


def overriding(effects, name):
    return [e for e in effects if getattr(type(e), name) is not getattr(Effect, name)]


class Law:
    """The right-hand side for one clip, in which each effect is asked only for what it changes."""

    def __init__(self, glider, effects, clip):
        self.glider, self.clip = glider, clip
        self.frictions = overriding(effects, "friction")
        self.drags = overriding(effects, "drag")
        self.forces = overriding(effects, "force")
        self.clocks = overriding(effects, "true_force_time")
        self.inertia = clip.mass + sum(e.added_mass() for e in effects)
        self.constant = sum(e.constant_friction() for e in effects)
        self.weight = clip.mass * G * np.sin(clip.alpha)
        self.normal = clip.mass * G * np.cos(clip.alpha)

    def drive(self, t, x, v):
        total = self.weight
        for e in self.forces:
            total += e.force(self.clip, t, x, v)
        if self.clip.force is not None:
            at, gain = t, 1.0
            for e in self.clocks:
                at, factor = e.true_force_time(at)
                gain *= factor
            total += gain * self.clip.force(at)
        return total

    def grip(self, t, x, v, s):
        mu = self.glider.mu
        for e in self.frictions:
            mu *= e.friction(self.clip, t, x, v, s)
        return mu * self.normal + self.constant

    def acceleration(self, t, x, v, s):
        k = self.glider.drag
        for e in self.drags:
            k *= e.drag(self.clip, x, v, s)
        return (self.drive(t, x, v) - k * v - s * self.grip(t, x, v, s)) / self.inertia


def leaves_rest(law, t, x, end):
    """The time from t on at which the forces exceed friction, and the sign in which it moves; (end, 0) if never."""
    step = 1e-3
    while t < end:
        drive = law.drive(t, x, 0.0)
        s = 1.0 if drive > 0 else -1.0
        if abs(drive) > law.grip(t, x, 0.0, s):
            return t, s
        t += step
    return end, 0.0


def motion(glider, effects, clip, times, rtol=1e-6):
    """x and v at the times (rising, the first is 0)."""
    law = Law(glider, effects, clip)
    max_step = min([Effect.max_step] + [e.max_step for e in effects])
    x_out, v_out = np.empty(len(times)), np.empty(len(times))
    t, x, v, end = 0.0, clip.x0, clip.v0, times[-1]
    x_out[0], v_out[0] = x, v
    filled = 1
    for _ in range(10000):
        if filled == len(times):
            return x_out, v_out
        if abs(v) <= REST:
            start, s = leaves_rest(law, t, x, end)
            while filled < len(times) and times[filled] <= start:
                x_out[filled], v_out[filled] = x, 0.0
                filled += 1
            if filled == len(times):
                return x_out, v_out
            t, v = start, s * 2 * REST
        s = 1.0 if v > 0 else -1.0

        def turns(_, y):
            return y[1]

        turns.terminal, turns.direction = True, -s
        run = solve_ivp(lambda t, y: (y[1], law.acceleration(t, y[0], y[1], s)), (t, end), (x, v), method="DOP853",
                        t_eval=times[filled:], events=turns, max_step=max_step, rtol=rtol, atol=1e-2 * rtol)
        n = len(run.t)
        if n > 0:
            x_out[filled:filled + n], v_out[filled:filled + n] = run.y
        filled += n
        if run.status != 1:
            if filled != len(times):
                raise ArithmeticError(f"the motion of clip {clip.number} ends early")
            return x_out, v_out
        t, x, v = run.t_events[0][0], run.y_events[0][0][0], 0.0
    raise ArithmeticError("a glider that turns without end")


def nominal(glider, clip, times):
    """Positions of the nominal motion."""
    return closed_form(glider, clip, times) if clip.force is None else motion(glider, [], clip, times, rtol=1e-10)[0]


def seen(glider, effects, clip):
    """The positions that a camera without noise records."""
    times = clip.times
    for e in overriding(effects, "frame_times"):
        times = e.frame_times(clip, times)
    x, v = motion(glider, effects, clip, times)
    for e in overriding(effects, "seen"):
        x = e.seen(clip, times, x, v)
    return x


def closed_form(glider, clip, times):
    """The nominal motion without a recorded force: exponentials from one turn to the next."""
    b = glider.drag / clip.mass
    x_out = np.empty(len(times))
    t0, x, v = 0.0, clip.x0, clip.v0
    pull, grip = G * np.sin(clip.alpha), glider.mu * G * np.cos(clip.alpha)
    done = 0
    while done < len(times):
        if v == 0.0 and abs(pull) <= grip:
            x_out[done:] = x
            break
        s = np.sign(v) if v != 0.0 else np.sign(pull)
        limit = (pull - s * grip) / b  # terminal velocity
        turn = np.inf
        if v != 0.0 and limit * s < 0:
            turn = t0 + np.log(1.0 - v / limit) / b
        ends = np.searchsorted(times, turn, side="right") if np.isfinite(turn) else len(times)
        tau = times[done:ends] - t0
        x_out[done:ends] = x + limit * tau + (v - limit) * -np.expm1(-b * tau) / b
        done = ends
        if np.isfinite(turn):
            tau = turn - t0
            x += limit * tau + (v - limit) * -np.expm1(-b * tau) / b
            t0, v = turn, 0.0
    return x_out


class NominalFit:
    """What a fit of K, mu, the inclinations and each clip's start cannot take up, to first order in the deviations."""

    def __init__(self, glider, clips, noise, incline_sd):
        self.clips, self.noise = clips, noise
        self.base = [nominal(glider, c, c.times) for c in clips]
        groups = sorted({c.group for c in clips})
        shared, n = 2 + len(groups), sum(len(x) for x in self.base)
        jacobian = np.zeros((n + len(groups), shared + 2 * len(clips)))
        row = 0
        for i, clip in enumerate(clips):
            rows = slice(row, row + len(self.base[i]))
            g = 2 + groups.index(clip.group)
            for column, moved, h in ((0, (dataclasses.replace(glider, drag=glider.drag * 1.001), clip), glider.drag * 1e-3),
                                     (1, (dataclasses.replace(glider, mu=glider.mu * 1.001), clip), glider.mu * 1e-3),
                                     (g, (glider, dataclasses.replace(clip, alpha=clip.alpha + 1e-5)), 1e-5),
                                     (shared + 2 * i, (glider, dataclasses.replace(clip, x0=clip.x0 + 1e-5)), 1e-5),
                                     (shared + 2 * i + 1, (glider, dataclasses.replace(clip, v0=clip.v0 + 1e-5)), 1e-5)):
                jacobian[rows, column] = (nominal(*moved, clip.times) - self.base[i]) / (h * noise)
            row += len(self.base[i])
        for g in range(len(groups)):
            jacobian[n + g, 2 + g] = 1.0 / incline_sd
        self.basis = np.linalg.qr(jacobian)[0]
        self.positions = n

    def excess(self, positions):
        """The mean square of what is left, in units of the noise."""
        r = np.concatenate([(x - b) / self.noise for x, b in zip(positions, self.base)])
        r = np.concatenate([r, np.zeros(self.basis.shape[0] - r.size)])
        r -= self.basis @ (self.basis.T @ r)
        return float(np.mean(r[:self.positions] ** 2))
