"""scipy.interpolate.UnivariateSpline of degree 5 with s = n, weights one over the noise; then a straight line a(v) through the points
of each direction."""

from experiment_folder import lines_through, main, public_package

numpy = public_package("numpy", "python3-numpy")
interpolate = public_package("scipy.interpolate", "python3-scipy")
ENDS = 4  # points at either end that are left out: a spline bends freely there


def noise(x):
    """Of a position, from third differences, whose sum of squared weights is 20; a median stands outliers."""
    third = numpy.diff(x, 3) / numpy.sqrt(20.0)
    return numpy.median(numpy.abs(third)) / 0.6745 or numpy.sqrt(numpy.mean(third**2))


def derivatives(clip):
    t, x = numpy.array(clip.t_s), numpy.array(clip.x_m)
    if len(x) < 4 * ENDS:
        return [], []
    spline = interpolate.UnivariateSpline(t, x, w=numpy.full(len(x), 1.0 / noise(x)), k=5, s=len(x))
    return list(spline(t, nu=1)[ENDS:-ENDS]), list(spline(t, nu=2)[ENDS:-ENDS])


if __name__ == "__main__":
    main(lines_through(derivatives))
