#include "diagnose/causes/parameter_prior.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "base/math/log_sum.h"
#include "diagnose/causes/spread_prior.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/drag_of_air.h"

namespace glidelab::diagnose {
namespace {

constexpr double kDecades = 9.2;    // ln 10^4: sizes are uniform in their logarithm over four decades
constexpr double kLeastSeen = 2.0;  // standard deviations: a smaller size cannot be told from none

constexpr EffectSlot kPush = slot_of(ids::late_release, 1);

const EffectParameter* parameter_of(EffectSlot slot) {
  return &effect_list()[slot.effect].parameters[slot.parameter];
}

bool is_phase(const EffectParameter* parameter) {
  return effect_list()[parameter->slot.effect].search == Search::wave;
}

constexpr double kAnyPushes = 0.1;   // of late releases: pushes of any size and sign, each motion its own
constexpr double kPushSpread = 0.5;  // standard deviation of one hand's pushes, relative to their mean

/// The direction in which a motion starts: 1 or -1.
double start_direction(const FitMotion& motion) {
  const auto moves = std::find_if(motion.v_m_s.begin(), motion.v_m_s.end(), [](double v) { return v != 0.0; });
  return moves != motion.v_m_s.end() && *moves < 0.0 ? -1.0 : 1.0;
}

/// The pushes of a hand that lets go late, positive along the motion, in a fall against it. Nine times in ten they are
/// those of one hand, about equal and positive. Otherwise they have any size and sign.
struct Pushes {
  std::vector<double> along, sds;

  void add(double push, double sd) {
    along.push_back(push);
    sds.push_back(sd);
  }
  /// Log prior density in units of each push's standard deviation.
  double log_prior() const {
    const double root = 0.5 * std::log(2.0 * std::numbers::pi), n = static_cast<double>(along.size());
    double any = std::log(kAnyPushes), mean = 0.0, mean_sd = 0.0;
    for (std::size_t k = 0; k < along.size(); ++k) {
      any += root - std::log(std::max(std::abs(along[k]) / sds[k], kLeastSeen) * kDecades);
      mean += along[k] / n;
      mean_sd += sds[k] / n;
    }
    if (!(mean > 0.0)) return any;
    const double of_mean = std::max(kPushSpread * mean, mean_sd) / std::sqrt(n);  // standard deviation of the mean
    double one_hand =
        std::log1p(-kAnyPushes) + root + std::log(of_mean / (std::max(mean, kLeastSeen * of_mean) * kDecades));
    for (std::size_t k = 0; k < along.size(); ++k) {
      const double width = std::max(kPushSpread * mean, sds[k]), off = (along[k] - mean) / width;
      one_hand -= std::log(width / sds[k]) + 0.5 * off * off;
    }
    return base::log_sum({any, one_hand});
  }
};

}  // namespace

double log_prior(const TrackSet& set, const MotionFit& fit, const RemainderSpace::Solution& solution) {
  double log = 0.0;
  const double root = 0.5 * std::log(2.0 * std::numbers::pi);
  std::map<const EffectParameter*, std::size_t> kinds;
  std::vector<Eigen::Index> spread;
  std::vector<std::size_t> kind_of_spread;
  const auto& globals = fit.layout->globals();
  for (std::size_t g = 0; g < globals.size(); ++g) {
    const auto& of = globals[g];
    const auto at = static_cast<Eigen::Index>(g);
    const double sd = std::sqrt(std::max(0.0, solution.covariance(at, at)));
    if (of.kind == ParameterLayout::Global::Kind::k && set.through_air) {
      const double k = std::max(std::abs(fit.at.global[at] + solution.change[at]), kLeastSeen * sd);
      if (!holds_drag(set, fit.effects)) log += root - std::log(k * kDecades);
    }
    const bool normal =
        of.kind == ParameterLayout::Global::Kind::k || of.kind == ParameterLayout::Global::Kind::gravity;
    for (const FitStatement& s : fit.statements) log -= normal && s.global == g ? std::log(s.prior().sd) : 0.0;
    if (of.kind != ParameterLayout::Global::Kind::effect) continue;
    const EffectInfo& info = effect_list()[of.effect];
    const double fitted = fit.at.global[at] + solution.change[at];
    if (info.search == Search::spread) {
      // Bumps along the track are of one kind. So are the values of one parameter for the clips or configurations.
      const bool of_all = of.parameter->each == Each::experiment;
      const EffectParameter* kind = of_all ? &info.parameters.front() : of.parameter;
      spread.push_back(at);
      kind_of_spread.push_back(kinds.try_emplace(kind, kinds.size()).first->second);
    } else if (of.parameter == &info.parameters.front()) {
      const double size = std::max(std::abs(fitted), kLeastSeen * sd);
      log += root - std::log(size * kDecades * (info.both_signs ? 2.0 : 1.0));
    } else {
      // A parameter that the data leave open has the width of its prior and costs nothing.
      log += root - std::log(std::max(of.range.high - of.range.low, sd / std::exp(-root)));
    }
  }
  if (!spread.empty()) {
    const Eigen::VectorXd fitted = fit.at.global + solution.change;
    log += log_spread_prior(fitted(spread), solution.covariance(spread, spread), kind_of_spread);
  }
  const auto& own = fit.layout->own();
  const double usual = only_falls(set) ? -1.0 : 1.0;  // a hand pushes what it launches, and holds what it lets fall
  Pushes pushes;
  for (std::size_t i = 0; i < fit.motions.size(); ++i) {
    for (Eigen::Index o = 2; o < fit.motions[i].own.cols(); ++o) {
      const double norm = fit.motions[i].own.col(o).norm();
      const double size = fit.at.own[i][o], seen = std::abs(size) * norm;
      if (own[static_cast<std::size_t>(o - 2)] == parameter_of(kPush)) {
        if (norm > 0.0) pushes.add(usual * size * start_direction(fit.motions[i]), 1.0 / norm);
        continue;
      }
      if (is_phase(own[static_cast<std::size_t>(o - 2)])) {
        // All phases are equally likely, whatever the origin of time.
        log += root - std::log(std::max(2.0 * std::numbers::pi * norm, std::exp(root)));
        continue;
      }
      log += root - std::log(std::max(seen, kLeastSeen) * kDecades);
    }
  }
  if (!pushes.along.empty()) log += pushes.log_prior();
  return log;
}

}  // namespace glidelab::diagnose
