#include "core/motion/bandwidth/bandwidth_cross_validation.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "core/motion/bandwidth/bandwidth_scan.h"
#include "core/motion/smoothing/kernel_constants.h"

namespace glidelab::core {
namespace {

/// Residuals of the probes and the weights of the points in their own smoothed values; nothing where a kernel holds
/// too few points.
struct Residuals {
  std::vector<double> residual, own_weight;
};

std::optional<Residuals> residuals_at(const BandwidthScan& scan, double bandwidth_s, Kernel kernel) {
  const std::vector<LocalPolynomial> smoothers = scan.smoothers(bandwidth_s, kernel);
  Residuals found;
  for (const Probe& probe : scan.probes()) {
    const auto row = smoothers[probe.part].row_of_point(probe.point);
    if (!row) return {};
    found.residual.push_back(scan.position(probe) - weighted_sums(*row, scan.problem().parts[probe.part].x_m).x_m);
    found.own_weight.push_back(row->weights->x[probe.point - row->first]);
  }
  if (found.residual.empty()) return {};
  return found;
}

template <typename Criterion>
std::optional<BandwidthPick> choose_by(const BandwidthProblem& problem, Kernel kernel, const KernelConstants& constants,
                                       const char* name, Criterion criterion) {
  const BandwidthScan scan(problem);
  std::vector<double> values;
  for (const double h : scan.grid()) {
    const auto residuals = residuals_at(scan, h, kernel);
    values.push_back(residuals ? criterion(*residuals) : std::numeric_limits<double>::quiet_NaN());
  }
  const auto best = widest_local_least(values);
  if (!best) return {};
  const double of_x = scan.grid()[*best];
  BandwidthPick pick;
  pick.bandwidth_s = convert_bandwidth(of_x, constants, kGaussianA);
  pick.method = fmt::format("{}: {:.1f} ms for x{}, converted for a", name, 1e3 * of_x, at_edge(scan.grid(), *best));
  return pick;
}

double mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return sum / static_cast<double>(values.size());
}

}  // namespace

std::optional<BandwidthPick> LeaveOneOut::choose(const BandwidthProblem& problem) const {
  return choose_by(problem, Kernel::gaussian, kGaussianX, "leave-one-out cross-validation", [](const Residuals& of) {
    std::vector<double> predicted;
    for (std::size_t i = 0; i < of.residual.size(); ++i) predicted.push_back(of.residual[i] / (1.0 - of.own_weight[i]));
    return mean_square(predicted);
  });
}

std::optional<BandwidthPick> GeneralisedCrossValidation::choose(const BandwidthProblem& problem) const {
  return choose_by(problem, Kernel::gaussian, kGaussianX, "generalised cross-validation", [](const Residuals& of) {
    double own = 0.0;
    for (const double weight : of.own_weight) own += weight / static_cast<double>(of.own_weight.size());
    return mean_square(of.residual) / std::pow(1.0 - own, 2);
  });
}

std::optional<BandwidthPick> CorrelatedCrossValidation::choose(const BandwidthProblem& problem) const {
  return choose_by(problem, Kernel::bimodal, kBimodalX, "cross-validation for correlated noise",
                   [](const Residuals& of) { return mean_square(of.residual); });
}

}  // namespace glidelab::core
