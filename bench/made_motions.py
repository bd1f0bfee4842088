"""Motions whose x, v and a are known: gliders for bench/bands, and the test signals of PyNumDiff for bench/peers.

Each is a function of times (s, an array) that returns an array of three columns: x (m), v (m/s), a (m/s²). All but two are closed
forms; the controlled car and the Lorenz system are integrated to 1e-10 by scipy.
"""

import numpy as np

GRAVITY_M_S2 = 9.80665


def viscous(a0, k, v0, x0=0.0):
    """dv/dt = a0 - k v; k < 0: friction that falls with v."""
    def at(t):
        limit = a0 / k
        decay = np.exp(-k * t)
        return np.column_stack([x0 + limit * t + (v0 - limit) * (1.0 - decay) / k, limit + (v0 - limit) * decay, (a0 - k * v0) * decay])

    return at


def turning(up, down, k, turn):
    """dv/dt = up - k v until v = 0 at the time `turn`, then down - k v: dry friction turns with the motion."""
    v0 = -up / k * np.expm1(k * turn)
    top = viscous(up, k, v0)(np.array([turn]))[0, 0]

    def at(t):
        return np.where((t < turn)[:, None], viscous(up, k, v0)(t), viscous(down, k, 0.0, top)(t - turn))

    return at


def constant(a0, v0):
    return lambda t: np.column_stack([v0 * t + 0.5 * a0 * t**2, v0 + a0 * t, np.full(len(t), a0)])


def quadratic(c, friction, v0):
    """dv/dt = -friction - c v² while v > 0."""
    def at(t):
        unit, from_angle = np.sqrt(friction / c), np.arctan(v0 * np.sqrt(c / friction))
        angle = from_angle - np.sqrt(friction * c) * t
        v = unit * np.tan(angle)
        return np.column_stack([np.log(np.cos(angle) / np.cos(from_angle)) / c, v, -friction - c * v**2])

    return at


def quadratic_fall(c, drive):
    """dv/dt = drive - c v² from rest."""
    def at(t):
        limit, rate = np.sqrt(drive / c), np.sqrt(drive * c)
        v = limit * np.tanh(rate * t)
        return np.column_stack([np.log(np.cosh(rate * t)) / c, v, drive - c * v**2])

    return at


def power_three_halves(c, v0):
    """dv/dt = -c v^1.5."""
    def at(t):
        root = 1.0 / np.sqrt(v0) + 0.5 * c * t  # 1 / sqrt(v)
        return np.column_stack([2.0 / c * (np.sqrt(v0) - 1.0 / root), root**-2, -c * root**-3])

    return at


def damped_spring(omega_1_s, gamma_1_s, x0, v0):
    """x'' = -omega² x - 2 gamma x', gamma < omega."""
    def at(t):
        w = np.sqrt(omega_1_s**2 - gamma_1_s**2)
        decay, c, s = np.exp(-gamma_1_s * t), np.cos(w * t), np.sin(w * t)
        b = (v0 + gamma_1_s * x0) / w
        x = decay * (x0 * c + b * s)
        v = decay * ((b * w - gamma_1_s * x0) * c - (x0 * w + gamma_1_s * b) * s)
        return np.column_stack([x, v, -omega_1_s**2 * x - 2.0 * gamma_1_s * v])

    return at


def sines(frequencies_hz, amplitudes, phases=None):
    def at(t):
        total = np.zeros((len(t), 3))
        for f, amplitude, phase in zip(frequencies_hz, amplitudes, phases or [0.0] * len(amplitudes)):
            w = 2.0 * np.pi * f
            s, c = np.sin(w * t + phase), np.cos(w * t + phase)
            total += amplitude * np.column_stack([s, w * c, -w * w * s])
        return total

    return at


def logistic(rate_1_s, capacity, x0):
    """dx/dt = r x (1 - x / K)."""
    def at(t):
        x = capacity / (1.0 + (capacity / x0 - 1.0) * np.exp(-rate_1_s * t))
        v = rate_1_s * x * (1.0 - x / capacity)
        return np.column_stack([x, v, rate_1_s * v * (1.0 - 2.0 * x / capacity)])

    return at


def rising_triangle(t):
    """Straight lines between the extrema of sin(t²); a is 0 but at the corners."""
    corners = np.concatenate([[0.0], np.sqrt(np.pi * (0.5 + np.arange(40)))])
    heights = np.concatenate([[0.0], (-1.0) ** np.arange(40)])
    side = np.clip(np.searchsorted(corners, t, side="right") - 1, 0, len(corners) - 2)
    v = np.diff(heights)[side] / np.diff(corners)[side]
    return np.column_stack([heights[side] + v * (t - corners[side]), v, np.zeros(len(t))])


def integrated(law, start, t):
    """States of dy/dt = law(t, y) at the times t, which begin at 0."""
    from scipy.integrate import solve_ivp

    return solve_ivp(law, (0.0, t[-1] + 1e-9), start, "DOP853", t, rtol=1e-10, atol=1e-12).y


def controlled_car(t):
    """A car that a proportional-integral controller (2 1/s, 2 1/s²) brings from rest to 2 m/s, on a slope that grows by 0.012 a second."""
    def law(t_s, y):
        x, v, missing = y
        return [v, 2.0 * (2.0 - v) + 2.0 * missing - GRAVITY_M_S2 * np.sin(0.012 * t_s), 2.0 - v]

    y = integrated(law, [0.0, 0.0, 0.0], t)
    return np.column_stack([y[0], y[1], law(t, y)[1]])


def lorenz_x(t):
    """x / 20 of the Lorenz system (10, 45, 8/3) from (5, 1, 3)."""
    sigma, rho, beta = 10.0, 45.0, 8.0 / 3.0

    def law(_, y):
        return [sigma * (y[1] - y[0]), y[0] * (rho - y[2]) - y[1], y[0] * y[1] - beta * y[2]]

    y = integrated(law, [5.0, 1.0, 3.0], t)
    first = law(t, y)
    return np.column_stack([y[0], first[0], sigma * (first[1] - first[0])]) / 20.0


# The test signals of PyNumDiff (van Breugel, Kutz and Brunton, IEEE Access 8, 196865, 2020), 4 s long; of its controlled car
# the law alone, with other forces.
SIGNALS = {
    "two sines": lambda t: sines((1.0, 1.7), (0.5, 0.5))(t) + [1.0, 0.0, 0.0],
    "triangle": rising_triangle,
    "logistic growth": logistic(4.0, 2.0, 0.1),
    "damped spring": damped_spring(10.0, 1.5, 0.0, 4.0),
    "controlled car": controlled_car,
    "Lorenz x": lorenz_x,
}


def glider(kind, random, length_s):
    """A motion of one of GLIDERS with drawn numbers, and when it turns (None where it does not)."""
    k, friction = random.uniform(0.5, 4.0), random.uniform(0.002, 0.015) * GRAVITY_M_S2
    slope, fast = random.uniform(0.03, 0.07) * GRAVITY_M_S2, random.uniform(1.0, 2.0)
    c = random.uniform(0.3, 2.0)
    turn = random.uniform(0.35, 0.65) * length_s
    made = {
        "viscous and one constant force": lambda: viscous(-friction, k, fast),
        "viscous, from rest down": lambda: viscous(slope, k, 0.0),
        "viscous, with a reversal": lambda: turning(slope + friction, slope - friction, k, turn),
        "viscous, near the terminal velocity": lambda: viscous(slope, k, slope / k * random.uniform(0.8, 1.2)),
        "constant friction": lambda: constant(-friction, fast),
        "friction that falls with v": lambda: viscous(-4.0 * friction, -random.uniform(0.05, 0.3), fast),
        "drag by v², level": lambda: quadratic(c, friction, fast),
        "drag by v², from rest down": lambda: quadratic_fall(c, slope),
        "drag by v^1.5": lambda: power_three_halves(c, fast),
        "damped spring": lambda: damped_spring(random.uniform(2.0, 6.0), random.uniform(0.1, 0.6), random.uniform(0.2, 0.5), 0.0),
    }[kind]()
    return made, turn if kind == "viscous, with a reversal" else None


GLIDERS = (
    "viscous and one constant force", "viscous, from rest down", "viscous, with a reversal", "viscous, near the terminal velocity", "constant friction",
    "friction that falls with v", "drag by v², level", "drag by v², from rest down", "drag by v^1.5", "damped spring",
)


def other_motion(kind, random, length_s):
    """Motions that are none of a glider, of OTHERS, with drawn numbers."""
    cycles = random.uniform(1.0, 4.0) / length_s
    return {
        "three sines": lambda: sines(cycles * np.array([1.0, 1.7, 2.3]), random.uniform(0.05, 0.3, 3), list(random.uniform(0.0, 6.28, 3))),
        "logistic growth": lambda: logistic(random.uniform(6.0, 12.0) / length_s, random.uniform(0.5, 2.0), 0.05),
        "damped spring, several periods": lambda: damped_spring(2.0 * np.pi * cycles, random.uniform(0.1, 1.0), 0.3, 0.0),
    }[kind]()


OTHERS = ("three sines", "logistic growth", "damped spring, several periods")
