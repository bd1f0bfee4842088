// Cross-validation of the local cubic: of x, converted to the bandwidth for a. If the criterion has several local
// minima, that of the widest bandwidth is used.
//
//   cv             CV(h) = mean ((x_j - xs_j) / (1 - w_jj))^2, with w_jj the weight of a point in its own smoothed
//   value:
//                  the error of predicting it from the others, exactly, for any linear smoother whose weights are
//                  renormalised (Stone 1974).
//   gcv            GCV(h) = mean (x_j - xs_j)^2 / (1 - mean w_jj)^2 (Craven and Wahba 1979).
//   cv-correlated  With the kernel u^2 exp(-u^2), which gives a point no weight in its own value and little to its
//                  neighbours', the residual sum of squares is least at about the right h even if the noise of
//                  neighbours is correlated; that h times 1.0143 is the Gaussian kernel's (De Brabanter, De Brabanter,
//                  Suykens, De Moor 2011, JMLR 12, 1955-1976).
#include <cmath>
#include <limits>

#include "core/motion/bandwidth/bandwidth_rule.h"
#include "core/motion/smoothing/local_polynomial.h"

namespace glidelab::core {
namespace {

/// Residuals of the probes and the weights of the points in their own smoothed values; empty if a kernel holds too few
/// points.
struct Residuals {
  std::vector<double> residual, own_weight;
};

std::optional<Residuals> residuals_at(const BandwidthScan& scan, double bandwidth_s, Kernel kernel) {
  const std::vector<LocalPolynomial> smoothers = scan.smoothers(bandwidth_s, kernel);
  Residuals found;
  for (const Probe& probe : scan.probes()) {
    scan.problem().stop_check();
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
                                       fmt::format_string<const double&> found, Criterion criterion) {
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
  pick.by = found_by_rule(found, 1e3 * of_x);
  pick.by.edge = edge_of(scan.grid(), *best);
  pick.by.converted = true;
  return pick;
}

double mean_of_squares(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return sum / static_cast<double>(values.size());
}

std::optional<BandwidthPick> leave_one_out(const BandwidthProblem& problem) {
  return choose_by(problem, Kernel::gaussian, kGaussianX, "leave-one-out cross-validation: {:.1f} ms for x",
                   [](const Residuals& of) {
                     std::vector<double> predicted;
                     for (std::size_t i = 0; i < of.residual.size(); ++i)
                       predicted.push_back(of.residual[i] / (1.0 - of.own_weight[i]));
                     return mean_of_squares(predicted);
                   });
}

std::optional<BandwidthPick> generalised_cross_validation(const BandwidthProblem& problem) {
  return choose_by(problem, Kernel::gaussian, kGaussianX, "generalised cross-validation: {:.1f} ms for x",
                   [](const Residuals& of) {
                     double own = 0.0;
                     for (const double weight : of.own_weight)
                       own += weight / static_cast<double>(of.own_weight.size());
                     return mean_of_squares(of.residual) / std::pow(1.0 - own, 2);
                   });
}

std::optional<BandwidthPick> correlated_cross_validation(const BandwidthProblem& problem) {
  return choose_by(problem, Kernel::bimodal, kBimodalX, "cross-validation for correlated noise: {:.1f} ms for x",
                   [](const Residuals& of) { return mean_of_squares(of.residual); });
}

}  // namespace

extern const BandwidthRule kLeaveOneOut = {
    "cv", "leave-one-out cross-validation: predicts each position from the others", "white noise", leave_one_out};
extern const BandwidthRule kGeneralisedCrossValidation = {
    "gcv", "generalised cross-validation: the same with one mean weight", "white noise", generalised_cross_validation};
extern const BandwidthRule kCorrelatedCrossValidation = {
    "cv-correlated",
    "cross-validation with a kernel that gives a point and its neighbours no weight, then a factor of 1.0143",
    "noise correlated over times much shorter than h", correlated_cross_validation};

}  // namespace glidelab::core
