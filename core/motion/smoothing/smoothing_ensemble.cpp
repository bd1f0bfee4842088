#include "core/motion/smoothing/smoothing_ensemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/errors.h"
#include "base/math/distributions.h"

namespace glidelab::core {
namespace {

/// exp(-u^2 / 2), or its mean over an estimated variance.
double tail(double u2, double freedom) {
  return std::isinf(freedom) ? std::exp(-0.5 * u2) : std::pow(1.0 + u2 / freedom, -0.5 * freedom);
}

/// Data for the crossings of one side between two nodes, without c.
struct Crossing {
  double sd, off;  // sd of the band, and offset of the member's mean from the band's middle, both over the member's own
                   // sd
  double angle;    // arc cosine of the correlation of a here and at the next node
};

double crossings(const std::vector<std::vector<Crossing>>& parts, double c, double freedom) {
  double expected = 0.0;
  for (const auto& part : parts) {
    for (const double sign : {-1.0, 1.0}) {
      expected += base::student_t_tail(freedom, c * part.front().sd - sign * part.front().off);
      for (const Crossing& at : part) {
        const double u = std::max(c * at.sd - sign * at.off, 0.0);
        // The mean over angles 0 … angle of u^2 / (1 + cos) is u^2 / 2 (1 + angle^2 / 12) to the required order.
        expected += at.angle / (2.0 * std::numbers::pi) * tail(u * u * (1.0 + at.angle * at.angle / 12.0), freedom);
      }
    }
  }
  return expected;
}

}  // namespace

template <int N>
std::vector<EnsembleNode> nodes_of(const ChainPosterior<N>& posterior, double noise_sd) {
  std::vector<EnsembleNode> made(posterior.size());
  const double variance = noise_sd * noise_sd;
  for (std::size_t k = 0; k < made.size(); ++k) {
    made[k].mean = posterior.mean(k).template head<3>();
    made[k].variance = variance * posterior.covariance(k).diagonal().template head<3>().array();
    if (k + 1 < made.size()) made[k].with_next = variance * posterior.covariance_with_next(k)(2, 2);
  }
  return made;
}

/// Where a falling function is 0. NumericalError where it is no number at an end, or both have one sign: a variance
/// that rounding has spoilt.
template <typename Function>
double zero_of(const Function& function, double from, double to, std::uintmax_t most, double t_s) {
  const double at_from = function(from), at_to = function(to);
  if (!(at_from >= 0.0 && at_to <= 0.0)) {
    throw base::NumericalError(fmt::format(
        "the smoother's uncertainty from t = {:g} s on cannot be computed: too wide a range of numbers (a gap "
        "of many times the smoothing time, or very large positions); smooth the parts of the motion one by one",
        t_s));
  }
  const auto found = boost::math::tools::toms748_solve(function, from, to, at_from, at_to,
                                                       boost::math::tools::eps_tolerance<double>(10), most);
  return 0.5 * (found.first + found.second);
}

/// The half width that holds 95 % of the members' mixture about the smoothed value, over base::kNormal95.
double standard_deviation(const SmoothingEnsemble& ensemble, std::size_t p, std::size_t k, int d) {
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (const EnsembleMember& member : ensemble.members) {
    const EnsembleNode& at = member.parts[p][k];
    const double off = std::abs(at.mean[d] - ensemble.smoothed[p][k][d]), sd = std::sqrt(at.variance[d]);
    low = std::min(low, base::kNormal95 * sd);
    high = std::max(high, off + base::kNormal95 * sd);
  }
  const auto outside = [&](double half) {
    double sum = 0.0;
    for (const EnsembleMember& member : ensemble.members) {
      const EnsembleNode& at = member.parts[p][k];
      const double off = std::abs(at.mean[d] - ensemble.smoothed[p][k][d]);
      const double per_sd = 1.0 / std::sqrt(2.0 * at.variance[d]);
      sum += 0.5 * member.weight * (std::erfc((half - off) * per_sd) + std::erfc((half + off) * per_sd));
    }
    return std::log(sum / 0.05);
  };
  if (!(high > low * (1.0 + 1e-6))) return low / base::kNormal95;
  return zero_of(outside, 0.999 * low, 1.001 * high, 30, ensemble.nodes[p][k].t_s) / base::kNormal95;
}

std::vector<std::vector<Eigen::Array3d>> standard_deviations(const SmoothingEnsemble& ensemble,
                                                             const base::StopCheck& stop_check) {
  std::vector<std::vector<Eigen::Array3d>> made;
  const double wider = base::student_t_quantile(ensemble.freedom, 0.975) / base::kNormal95;
  for (std::size_t p = 0; p < ensemble.nodes.size(); ++p) {
    const std::vector<ChainNode>& nodes = ensemble.nodes[p];
    std::vector<Eigen::Array3d> sd(nodes.size());
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      stop_check();
      for (int d = 0; d < 3; ++d) sd[k][d] = wider * standard_deviation(ensemble, p, k, d);
    }
    std::vector<double> more(nodes.size(), 0.0);
    for (std::size_t b = 1; b < nodes.size(); ++b) {
      if (!nodes[b].after_break) continue;
      constexpr double kSide = 2.6;  // standard deviations of the time: 1 % lie beyond
      const double before = ensemble.smoothed[p][b - 1][2], after = ensemble.smoothed[p][b][2];
      const double reach = kSide * sd[b][1] / std::max(0.5 * (std::abs(before) + std::abs(after)), 1e-300);
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        if (std::abs(nodes[k].t_s - nodes[b].t_s) < reach)
          more[k] = std::max(more[k], std::abs(after - before) / base::kNormal95);
      }
    }
    for (std::size_t k = 0; k < nodes.size(); ++k) sd[k][2] = std::hypot(sd[k][2], more[k]);
    made.push_back(std::move(sd));
  }
  return made;
}

double simultaneous_factor(const SmoothingEnsemble& ensemble, const std::vector<std::vector<Eigen::Array3d>>& sd,
                           const base::StopCheck& stop_check) {
  std::vector<std::vector<std::vector<Crossing>>> of;
  for (const EnsembleMember& member : ensemble.members) {
    stop_check();
    of.emplace_back();
    for (std::size_t p = 0; p < ensemble.nodes.size(); ++p) {
      std::vector<Crossing> part;
      const std::vector<EnsembleNode>& nodes = member.parts[p];
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        const double own = std::sqrt(nodes[k].variance[2]);
        const bool last = k + 1 == nodes.size();
        const double correlation = last ? 1.0 : nodes[k].with_next / (own * std::sqrt(nodes[k + 1].variance[2]));
        part.push_back({sd[p][k][2] / own, (nodes[k].mean[2] - ensemble.smoothed[p][k][2]) / own,
                        std::acos(std::clamp(correlation, -1.0, 1.0))});
      }
      of.back().push_back(std::move(part));
    }
  }
  const auto excess = [&](double c) {
    double outside = 0.0;
    for (std::size_t m = 0; m < of.size(); ++m) {
      stop_check();
      outside += ensemble.members[m].weight * -std::expm1(-crossings(of[m], c, ensemble.freedom));
    }
    return std::log(outside / 0.05);
  };
  double high = 4.0;
  while (excess(high) > 0.0) high *= 1.5;
  return zero_of(excess, 1.0, high, 20, ensemble.nodes.front().front().t_s);
}

template std::vector<EnsembleNode> nodes_of(const ChainPosterior<3>&, double);
template std::vector<EnsembleNode> nodes_of(const ChainPosterior<4>&, double);
template std::vector<EnsembleNode> nodes_of(const ChainPosterior<5>&, double);

}  // namespace glidelab::core
