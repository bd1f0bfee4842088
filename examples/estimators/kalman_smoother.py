"""A Kalman filter and Rauch-Tung-Striebel smoother in numpy: state (x, v, a), a a Wiener process whose size is the most likely of a
grid; then a straight line a(v) through the smoothed points of each direction."""

import math

from experiment_folder import lines_through, main, public_package

numpy = public_package("numpy", "python3-numpy")
ENDS = 4  # points at either end, where the smoother knows a badly


def noise(x):
    third = numpy.diff(x, 3) / numpy.sqrt(20.0)
    return numpy.median(numpy.abs(third)) / 0.6745 or numpy.sqrt(numpy.mean(third**2))


def step_matrices(h, q):
    transition = numpy.array([[1.0, h, h * h / 2.0], [0.0, 1.0, h], [0.0, 0.0, 1.0]])
    driven = q * numpy.array([[h**5 / 20, h**4 / 8, h**3 / 6], [h**4 / 8, h**3 / 3, h * h / 2], [h**3 / 6, h * h / 2, h]])
    return transition, driven


def filtered(t, x, r, q):
    """Means and covariances before and after each position, and the log likelihood."""
    mean, cov = numpy.array([x[0], 0.0, 0.0]), numpy.diag([r, 25.0, 100.0])
    history, log_likelihood = [], 0.0
    for i, position in enumerate(x):
        transition = numpy.eye(3)
        if i > 0:
            transition, driven = step_matrices(t[i] - t[i - 1], q)
            mean, cov = transition @ mean, transition @ cov @ transition.T + driven
        before = (mean, cov)
        s = cov[0, 0] + r
        rest = position - mean[0]
        log_likelihood -= 0.5 * (math.log(s) + rest * rest / s)
        gain = cov[:, 0] / s
        mean, cov = mean + gain * rest, cov - numpy.outer(gain, cov[0])
        history.append((transition, before, (mean, cov)))
    return history, log_likelihood


def derivatives(clip):
    t, x = numpy.array(clip.t_s), numpy.array(clip.x_m)
    if len(x) < 4 * ENDS:
        return [], []
    r = noise(x) ** 2
    history, _ = max((filtered(t, x, r, 10.0**e) for e in range(-3, 5)), key=lambda run: run[1])
    means = [history[-1][2][0]]
    for i in range(len(x) - 2, -1, -1):
        transition, before, _ = history[i + 1]
        mean, cov = history[i][2]
        back = numpy.linalg.solve(before[1], transition @ cov).T
        means.append(mean + back @ (means[-1] - before[0]))
    means = numpy.array(means[::-1])[ENDS:-ENDS]
    return list(means[:, 1]), list(means[:, 2])


if __name__ == "__main__":
    main(lines_through(derivatives))
