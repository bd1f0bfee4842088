/// The gap of a diagnosis as plots: its size in each domain, its location in each clip, and in the phase plane; and a
/// twin compared with the data from which it was made.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "diagnose/result/diagnosis.h"
#include "report/html/plot.h"
#include "validate/film/twin_motions.h"

namespace glidelab::report {

/// Bars of each domain's gap over its noise, before and after; 1 is the noise. Empty if there is no domain.
std::vector<Plot> domain_plots(const diagnose::Diagnosis& diagnosis);

/// Measured minus modelled acceleration as a function of speed with its 95 % band, before and after; for several masses
/// also each one. Empty if no motion was compared.
std::vector<Plot> phase_gap_plots(const diagnose::Diagnosis& diagnosis);

/// Residuals by clip (rows) against time, or against position or speed if the gap depends on that: colour is the sum of
/// a cell's standardised residuals over sqrt(their number), before and after. Empty for lines.
std::vector<Plot> residual_maps(const diagnose::Diagnosis& diagnosis);

/// Rows of a map: one per clip, in the order of the curves; NaN if a cell contains no position.
struct ResidualMap {
  std::vector<std::string> clips;
  double low = 0.0, high = 0.0;                    ///< of the variable
  std::vector<std::vector<double>> before, after;  ///< [clip][cell]
};
/// `variable` is a time, position or speed (std::logic_error for another); the requested number of cells (at least 1),
/// of equal width. Each curve has as many noise_m as residuals.
ResidualMap residual_map(const std::vector<diagnose::ResidualCurve>& curves, diagnose::GapVariable variable,
                         std::size_t cells);

/// The deviation of the measured positions from the twin's against time, compared with noise alone; and a(v) of both.
std::vector<Plot> twin_plots(const std::vector<validate::TwinMotion>& motions);

}  // namespace glidelab::report
