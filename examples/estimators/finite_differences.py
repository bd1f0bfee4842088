"""Tracker's finite differences ("Algorithms" in its help): v from the step before and after, a from the parabola through five
steps; then a straight line a(v) through the points of each direction. Pure Python."""

from experiment_folder import lines_through, main


def derivatives(clip):
    v, a = [], []
    t, x = clip.t_s, clip.x_m
    for i in range(2, len(x) - 2):
        step = (t[i + 2] - t[i - 2]) / 4.0
        v.append((x[i + 1] - x[i - 1]) / (2.0 * step))
        a.append((2.0 * x[i + 2] - x[i + 1] - 2.0 * x[i] - x[i - 1] + 2.0 * x[i - 2]) / (7.0 * step**2))
    return v, a


if __name__ == "__main__":
    main(lines_through(derivatives))
