"""What people take to get velocity and acceleration out of tracked positions, each as one function.

Every method takes the runs of one experiment (evenly spaced times, metres) and returns for each run an array of three columns,
x (m), v (m/s), a (m/s^2), NaN where the method gives nothing, and the seconds of processor time that it took. It raises Missing where its program is
not installed.
"""

import importlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
import types

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
EXAMPLES = os.path.join(os.path.dirname(HERE), "examples", "estimators")


class Missing(Exception):
    """A peer that is not installed here."""


def timed(one_run, runs):
    started = time.process_time()
    values = [one_run(run) for run in runs]
    return values, time.process_time() - started


def step(run):
    return (run["t"][-1] - run["t"][0]) / (len(run["t"]) - 1)


def noise(x):
    """Standard deviation of a position from third differences, whose sum of squared weights is 20. Of a normal distribution the
    median of the moduli is 0.6745 standard deviations; where rounding makes it 0 the root mean square stands in its place."""
    third = np.diff(x, 3) / np.sqrt(20.0)
    return np.median(np.abs(third)) / 0.6745 or np.sqrt(np.mean(third**2))


def tracker(runs):
    """Tracker's help, "Algorithms": v by the step before and after, a as the parabola through five steps."""

    def one(run):
        x, dt = run["x"], step(run)
        out = np.full((len(x), 3), np.nan)
        out[:, 0] = x
        out[1:-1, 1] = (x[2:] - x[:-2]) / (2.0 * dt)
        out[2:-2, 2] = (2.0 * x[4:] - x[3:-1] - 2.0 * x[2:-2] - x[1:-3] + 2.0 * x[:-4]) / (7.0 * dt**2)
        return out

    return timed(one, runs)


def savitzky_golay(runs, window_s):
    """scipy.signal.savgol_filter, cubic; the window has no default, so that one must be given."""
    try:
        from scipy.signal import savgol_filter
    except ImportError as missing:
        raise Missing("scipy (python3-scipy)") from missing

    def one(run):
        dt = step(run)
        window = max(5, 2 * int(round(window_s / dt / 2.0)) + 1)
        if window > len(run["x"]):
            return np.full((len(run["x"]), 3), np.nan)
        return np.column_stack([savgol_filter(run["x"], window, 3, deriv=d, delta=dt) for d in range(3)])

    return timed(one, runs)


def along_splines(runs, spline_of):
    """One spline a run and its derivatives; runs of fewer than 8 positions have none."""

    def one(run):
        t, x = run["t"], run["x"]
        if len(x) < 8:
            return np.full((len(x), 3), np.nan)
        spline = spline_of(t, x)
        return np.column_stack([spline(t, nu=d) for d in range(3)])

    return timed(one, runs)


def univariate_spline(runs, factor=1.0):
    """scipy.interpolate.UnivariateSpline of degree 5 with w = 1/sd and s = len(w), as its documentation advises, times a factor."""
    try:
        from scipy.interpolate import UnivariateSpline
    except ImportError as missing:
        raise Missing("scipy (python3-scipy)") from missing

    return along_splines(runs, lambda t, x: UnivariateSpline(t, x, w=np.full(len(x), 1.0 / noise(x)), k=5, s=factor * len(x)))


def smoothing_spline(runs, penalty=None):
    """scipy.interpolate.make_smoothing_spline: the cubic smoothing spline; no penalty: its own, by generalised cross-validation."""
    try:
        from scipy.interpolate import make_smoothing_spline
    except ImportError as missing:
        raise Missing("scipy 1.10 (python3-scipy)") from missing

    return along_splines(runs, lambda t, x: make_smoothing_spline(t, x, lam=penalty))


def kernsmooth(runs, bandwidths_s, degree=None):
    """R's KernSmooth::locpoly; a bandwidth a run, None for the package's own dpill(); degree None: its default, derivative + 1."""
    if not shutil.which("Rscript") or subprocess.run(
        ["Rscript", "-e", "library(KernSmooth)"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    ).returncode:
        raise Missing("R with KernSmooth (r-cran-kernsmooth)")
    with tempfile.TemporaryDirectory(prefix="peers") as folder:
        names = [os.path.join(folder, name) for name in ("in.csv", "out.csv", "time.txt")]
        with open(names[0], "w", encoding="utf-8") as table:
            table.write("run,bandwidth_s,degree,t_s,x_m\n")
            for i, (run, h) in enumerate(zip(runs, bandwidths_s)):
                width = "NA" if h is None else repr(float(h))
                table.writelines(f"{i},{width},{degree or 'NA'},{float(t)!r},{float(x)!r}\n" for t, x in zip(run["t"], run["x"]))
        subprocess.run(["Rscript", os.path.join(HERE, "peers_kernsmooth.R"), *names], check=True)
        rows = np.genfromtxt(names[1], delimiter=",", skip_header=1)
        with open(names[2], encoding="utf-8") as text:
            took = float(text.read())
    return [rows[rows[:, 0] == i, 1:] for i in range(len(runs))], took


def example(module):
    """A module of examples/estimators, which ends the program where its package is not installed."""
    if EXAMPLES not in sys.path:
        sys.path.append(EXAMPLES)
    try:
        return importlib.import_module(module)
    except SystemExit as missing:
        raise Missing(str(missing.code).removeprefix("skipped: no ")) from missing


def inner_points(derivatives, run):
    """Of an example's v and a, which leave out as many points at either end, in the middle of the run."""
    out = np.full((len(run["x"]), 3), np.nan)
    v, a = derivatives(types.SimpleNamespace(t_s=list(run["t"]), x_m=list(run["x"])))
    ends = (len(out) - len(v)) // 2
    if len(v):
        out[ends : ends + len(v), 1], out[ends : ends + len(v), 2] = v, a
    return out


def kalman_of_order_three(runs):
    """The Kalman filter and RTS smoother of examples/estimators, a Wiener process in a, its size by likelihood."""
    module = example("kalman_smoother")
    return timed(lambda run: inner_points(module.derivatives, run), runs)


def pynumdiff(runs):
    """PyNumDiff's Savitzky-Golay filter by its own optimiser, as in examples/estimators."""
    module = example("chosen_by_pynumdiff")
    return timed(lambda run: inner_points(module.derivatives, run), runs)


def module_of(program):
    """Glidelab's Python module, of the build that the program is from."""
    folder = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(program))), "python")
    if os.path.isdir(folder) and folder not in sys.path:
        sys.path.insert(0, folder)
    try:
        return importlib.import_module("glidelab")
    except ImportError as missing:
        raise Missing(f"module glidelab ({missing})") from missing


def glidelab_smoother(program, name):
    """Glidelab's smoother that finds its own strength."""

    def smoothed(runs):
        module = module_of(program)

        def one(run):
            found = module.smooth(run["t"], run["x"], smoother=name)
            return np.column_stack([found.x_m, found.v_m_s, found.a_m_s2])

        return timed(one, runs)

    return smoothed


def glidelab_cubic(program):
    """Glidelab's local cubic, its bandwidth by the plug-in rule or given."""

    def smoothed(runs, bandwidth_s=None):
        module = module_of(program)

        def one(run):
            chosen = bandwidth_s or module.choose_bandwidth(run["t"], run["x"]).bandwidth_s
            found = module.smooth(run["t"], run["x"], chosen)
            return np.column_stack([found.x_m, found.v_m_s, found.a_m_s2])

        return timed(one, runs)

    return smoothed
