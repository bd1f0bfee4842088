"""PyNumDiff's Savitzky-Golay filter with the settings that its own optimiser finds without a truth, once for v and once more for
a; then a straight line a(v) through the points of each direction."""

import math

from experiment_folder import lines_through, main, public_package

numpy = public_package("numpy", "python3-numpy")
pynumdiff = public_package("pynumdiff", "PyNumDiff, from PyPI")
optimize = public_package("pynumdiff.optimize", "PyNumDiff, from PyPI").optimize

CUTOFF_HZ = 3.0  # a glider's acceleration changes no faster
EDGE = 0.1       # part of a clip at either end that is left out


def derivative(values, step):
    """By the settings that balance a faithful integral against a smooth derivative; how much smoothness is wanted follows from the
    cutoff by the formula that PyNumDiff's authors recommend (van Breugel, Kutz and Brunton, IEEE Access 8, 196865, 2020)."""
    smoothness = math.exp(-1.6 * math.log(CUTOFF_HZ) - 0.71 * math.log(step) - 5.1)
    settings, _ = optimize(pynumdiff.savgoldiff, values, step, tvgamma=smoothness)
    return pynumdiff.savgoldiff(values, step, **settings)[1]


def derivatives(clip):
    n = len(clip.x_m)
    if n < 20:
        return [], []
    step = (clip.t_s[-1] - clip.t_s[0]) / (n - 1)
    v = derivative(numpy.array(clip.x_m), step)
    a = derivative(v, step)
    inner = slice(round(EDGE * n), n - round(EDGE * n))
    return list(v[inner]), list(a[inner])


if __name__ == "__main__":
    main(lines_through(derivatives))
