"""scipy.signal.savgol_filter, cubic, with a window of 0.16 s; then a straight line a(v) through the points of each direction."""

from experiment_folder import lines_through, main, public_package

signal = public_package("scipy.signal", "python3-scipy")
WINDOW_S = 0.16


def derivatives(clip):
    n = len(clip.x_m)
    step = (clip.t_s[-1] - clip.t_s[0]) / (n - 1)
    window = max(5, 2 * round(WINDOW_S / step / 2.0) + 1)
    if window >= n:
        return [], []
    v, a = (signal.savgol_filter(clip.x_m, window, 3, deriv=d, delta=step) for d in (1, 2))
    inner = slice(window // 2, n - window // 2)  # at the ends the filter extrapolates
    return list(v[inner]), list(a[inner])


if __name__ == "__main__":
    main(lines_through(derivatives))
