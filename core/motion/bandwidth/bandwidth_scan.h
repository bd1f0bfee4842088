/// What bandwidth rules share: the bandwidths that are tried, and the points that are looked at.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/motion/bandwidth/bandwidth_rule.h"
#include "core/motion/smoothing/local_polynomial.h"

namespace glidelab::core {

inline constexpr double kLeastBandwidthSteps = 1.2;  ///< time steps; a narrower kernel holds fewer than five points
inline constexpr double kBandwidthRatio = 1.1;       ///< from one bandwidth that is tried to the next

/// A point of a part, by its index there.
struct Probe {
  std::size_t part = 0;
  std::size_t point = 0;
};

class BandwidthScan {
 public:
  explicit BandwidthScan(const BandwidthProblem& problem);

  /// From kLeastBandwidthSteps time steps to a fifth of the longest part.
  const std::vector<double>& grid() const { return grid_; }
  /// At most some 400 in all parts, evenly; a tenth of each part at both ends is left out, where kernels are not
  /// complete and their variance would rule the criterion.
  const std::vector<Probe>& probes() const { return probes_; }
  const BandwidthProblem& problem() const { return problem_; }

  /// One smoother for each part.
  std::vector<LocalPolynomial> smoothers(double bandwidth_s, Kernel kernel = Kernel::gaussian) const;

  double time(const Probe& probe) const { return problem_.parts[probe.part].t_s[probe.point]; }
  double position(const Probe& probe) const { return problem_.parts[probe.part].x_m[probe.point]; }

 private:
  const BandwidthProblem& problem_;
  std::vector<double> grid_;
  std::vector<Probe> probes_;
};

/// Where the grid's least value lies; what has no value (NaN) does not count. Nothing where none has.
std::optional<std::size_t> least(const std::vector<double>& criterion);

/// The widest of the grid's local least values. Cross-validation often has spurious ones at narrow bandwidths, more so
/// with correlated noise; the widest is the better one (Hall and Marron 1991, J. R. Stat. Soc. B 53, 245).
std::optional<std::size_t> widest_local_least(const std::vector<double>& criterion);

/// " (the widest tried)" and the like, where a choice lies at an end of the grid.
std::string at_edge(const std::vector<double>& grid, std::size_t chosen);

}  // namespace glidelab::core
