"""Test signals that are no glider's (made_motions.py), differentiated by all methods: those that find their own strength, and those that
somebody must set, at the setting that is best in hindsight. No method knows where a signal has corners."""

import sys

import made_motions
import numpy as np
import peers_methods as methods

STEP_S, DURATION_S = 0.01, 4.0
NOISES_M = (0.01, 0.1)
END = 0.05  # part of a signal at either end that counts as its ends


def self_choosing(program):
    """Name and method."""
    return {
        "Glidelab, kalman": methods.glidelab_smoother(program, "kalman"),
        "Glidelab, spline": methods.glidelab_smoother(program, "spline"),
        "Glidelab, local cubic, its rule": methods.glidelab_cubic(program),
        "UnivariateSpline, s = len(w)": methods.univariate_spline,
        "make_smoothing_spline": methods.smoothing_spline,
        "KernSmooth, dpill": lambda runs: methods.kernsmooth(runs, [None] * len(runs)),
        "RTS smoother, order 3": methods.kalman_of_order_three,
        "PyNumDiff, its optimiser": methods.pynumdiff,
    }


def in_hindsight(program):
    """Name, method and the settings among which the best is sought, for v and for a apart."""
    return {
        "Glidelab, local cubic": (methods.glidelab_cubic(program), np.geomspace(0.015, 0.5, 15)),
        "Savitzky-Golay, cubic": (methods.savitzky_golay, np.geomspace(0.05, 1.5, 15)),
        "UnivariateSpline": (methods.univariate_spline, np.geomspace(0.6, 3.0, 9)),
        "make_smoothing_spline": (methods.smoothing_spline, np.geomspace(1e-9, 1e-2, 13)),
        "KernSmooth, cubic": (lambda runs, h: methods.kernsmooth(runs, [h] * len(runs), 3), np.geomspace(0.015, 0.5, 15)),
    }


def made_runs(signal, noise_m, repeats):
    """Runs with the noise of as many seeds, and the truth that they share."""
    t = np.arange(0.0, DURATION_S, STEP_S)
    truth = made_motions.SIGNALS[signal](t)
    return [{"t": t, "x": truth[:, 0] + noise_m * np.random.default_rng(seed).standard_normal(len(t))} for seed in range(repeats)], truth


def errors(signal, values, truth):
    """Root mean square errors of v and a inside, and of both over all frames; None where a method gives none, and for a of a signal with corners."""
    off = np.stack(values)[:, :, 1:] - truth[None, :, 1:]
    ends = round(END * len(truth))

    def rms(part):
        return float(np.sqrt(np.mean(part**2))) if np.isfinite(part).all() else None

    found = [rms(off[:, ends:-ends, d]) for d in (0, 1)] + [rms(off[:, :, d]) for d in (0, 1)]
    return [found[0], None, found[2], None] if signal == "triangle" else found


def compare(program, repeats=4, signals=tuple(made_motions.SIGNALS)):
    """Rows: signal, noise, method, whether it chose by itself, and its four errors."""
    rows, skipped = [], set()
    for signal in signals:
        for noise in NOISES_M:
            try:
                runs, truth = made_runs(signal, noise, repeats)
            except ImportError:
                print(f"skipped: {signal}: no scipy (python3-scipy)", file=sys.stderr)
                continue
            for name, method in self_choosing(program).items():
                try:
                    found = errors(signal, method(runs)[0], truth)
                except methods.Missing as missing:
                    skipped.add(f"skipped: {name}: no {missing}")
                    continue
                rows.append({"signal": signal, "noise_m": noise, "method": name, "self_choosing": True, "errors": found})
            for name, (method, settings) in in_hindsight(program).items():
                try:
                    tried = [errors(signal, method(runs, setting)[0], truth) for setting in settings]
                except methods.Missing as missing:
                    skipped.add(f"skipped: {name}, best in hindsight: no {missing}")
                    continue
                best = [min((one[i] for one in tried if one[i] is not None), default=None) for i in range(4)]
                rows.append({"signal": signal, "noise_m": noise, "method": name, "self_choosing": False, "errors": best})
    for line in sorted(skipped):
        print(line, file=sys.stderr)
    return rows
