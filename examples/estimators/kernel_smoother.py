"""R's KernSmooth: locpoly with a Gaussian kernel of 0.03 s, degree 3 for v and a; then a straight line a(v) through the points
of each direction."""

import shutil
import subprocess
import sys

from experiment_folder import lines_through, main

BANDWIDTH_S = 0.03
AT_ENDS = 3.0  # bandwidths from either end within which the kernel is cut off

# Standard input: a line with the bandwidth, then "t x" rows. Standard output: "t v a" rows on as many even times.
IN_R = """
if (!requireNamespace("KernSmooth", quietly = TRUE)) quit(status = 3)
lines <- readLines(file("stdin"))
h <- as.numeric(lines[1])
points <- read.table(text = lines[-1])
of <- function(order) KernSmooth::locpoly(points[[1]], points[[2]], drv = order, degree = 3, bandwidth = h, gridsize = nrow(points))
write.table(format(data.frame(of(1)$x, of(1)$y, of(2)$y), digits = 17), row.names = FALSE, col.names = FALSE, quote = FALSE)
"""


def derivatives(clip):
    rows = "".join(f"{t!r} {x!r}\n" for t, x in zip(clip.t_s, clip.x_m))
    done = subprocess.run(["Rscript", "-e", IN_R], input=f"{BANDWIDTH_S}\n{rows}", capture_output=True, text=True)
    if done.returncode == 3:
        sys.exit("skipped: no KernSmooth (r-cran-kernsmooth)")
    if done.returncode != 0:
        sys.exit(f"Rscript: {done.stderr.strip()}")
    end = AT_ENDS * BANDWIDTH_S
    points = [[float(number) for number in row.split()] for row in done.stdout.splitlines()]
    inner = [(v, a) for t, v, a in points if clip.t_s[0] + end <= t <= clip.t_s[-1] - end]
    return [v for v, _ in inner], [a for _, a in inner]


if __name__ == "__main__":
    if shutil.which("Rscript") is None:
        sys.exit("skipped: no Rscript (r-base-core)")
    main(lines_through(derivatives))
