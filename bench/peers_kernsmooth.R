# Position, velocity and acceleration of many runs by KernSmooth's local polynomials with a Gaussian kernel.
#   Rscript peers_kernsmooth.R IN OUT TIME
# IN: run,bandwidth_s,degree,t_s,x_m with evenly spaced times within a run; a bandwidth of NA asks for dpill(), the package's own
# choice, a degree of NA for the package's default, one more than the derivative. OUT: run,x_m,v_m_s,a_m_s2, row by row as IN. TIME: the seconds of processor time that all of it took, without R's start and the files.
suppressMessages(library(KernSmooth))
arguments <- commandArgs(trailingOnly = TRUE)
rows <- read.csv(arguments[1])
processor_s <- function() sum(proc.time()[c("user.self", "sys.self")])
started <- processor_s()
smooth <- function(run) {
  h <- run$bandwidth_s[1]
  if (is.na(h)) h <- tryCatch(dpill(run$t_s, run$x_m), error = function(e) { message("dpill(): ", conditionMessage(e)); NaN })
  n <- nrow(run)
  if (!is.finite(h)) {  # dpill() finds none where the noise is small beside the curve
    message("KernSmooth: dpill() gives no bandwidth for run ", run$run[1])
    return(data.frame(run = run$run, x_m = rep(NaN, n), v_m_s = NaN, a_m_s2 = NaN))
  }
  # One grid point a frame: nothing is binned, and the values are those at the frames.
  derivative <- function(order) {
    degree <- if (is.na(run$degree[1])) order + 1L else run$degree[1]
    locpoly(run$t_s, run$x_m, drv = order, degree = degree, bandwidth = h, gridsize = n)$y
  }
  data.frame(run = run$run, x_m = derivative(0L), v_m_s = derivative(1L), a_m_s2 = derivative(2L))
}
result <- do.call(rbind, lapply(split(rows, factor(rows$run, levels = unique(rows$run))), smooth))
writeLines(sprintf("%.6f", processor_s() - started), arguments[3])
write.csv(format(result, digits = 17), arguments[2], row.names = FALSE, quote = FALSE)
