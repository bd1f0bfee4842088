"""pysindy: v and a by its smoothed finite differences, then its sequentially thresholded least squares over the terms 1, v, sign v
and v |v|. What it keeps is the law; the first three give g sin(alpha), K/m and mu g cos(alpha)."""

import math

from experiment_folder import main, public_package

numpy = public_package("numpy", "python3-numpy")
pysindy = public_package("pysindy", "pysindy, from PyPI")

THRESHOLD = 0.005  # m/s², 1/s, 1/m: a smaller coefficient is taken for 0
EDGE = 0.1         # part of a clip at either end that is left out


def points_of(clip):
    n = len(clip.x_m)
    t = numpy.array(clip.t_s)
    differences = pysindy.SmoothedFiniteDifference(smoother_kws={"window_length": max(5, 2 * (n // 40) + 1)})
    v = differences(numpy.array(clip.x_m).reshape(-1, 1), t)
    a = differences(v, t)
    inner = slice(round(EDGE * n), n - round(EDGE * n))
    return v[inner, 0], a[inner, 0]


def estimator(folder):
    answers = []
    for configuration in folder.configurations:
        points = [points_of(clip) for clip in configuration.clips if len(clip.x_m) >= 20]
        v, a = (numpy.concatenate([pair[i] for pair in points]) if points else numpy.array([]) for i in (0, 1))
        terms = numpy.column_stack([numpy.ones_like(v), -v, -numpy.sign(v), -v * numpy.abs(v)])
        if len(v) < 10 or numpy.all(v > 0.0) or numpy.all(v < 0.0):
            answers.append({})  # one direction does not tell mu from alpha
            continue
        found = pysindy.STLSQ(threshold=THRESHOLD, alpha=0.0).fit(terms, a.reshape(-1, 1)).coef_.ravel()
        kept = found != 0.0
        variance = numpy.sum((a - terms @ found) ** 2) / (len(a) - numpy.sum(kept))
        sd = numpy.zeros(len(found))
        sd[kept] = numpy.sqrt(variance * numpy.diag(numpy.linalg.inv(terms[:, kept].T @ terms[:, kept])))
        drive, drag, friction, _ = zip(found, sd)
        g = folder.gravity_m_s2
        answer = {"k_over_m_1_s": drag}
        if abs(drive[0]) < g:
            cosine = math.sqrt(1.0 - (drive[0] / g) ** 2)
            answer["alpha_deg"] = (math.degrees(math.asin(drive[0] / g)), math.degrees(drive[1] / g / cosine))
            answer["mu"] = (friction[0] / g / cosine, friction[1] / g / cosine)
        answers.append(answer)
    return answers


if __name__ == "__main__":
    main(estimator)
