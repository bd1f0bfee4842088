#include "diagnose/missing_frames.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/median.h"

namespace glidelab::diagnose {
namespace {

constexpr double kPlain = 8.0;         // noises that a usual step must be long: a jump scatters by less than two
constexpr double kMostTogether = 5.0;  // frames lost at one place
constexpr double kClear = 12.0;        // log likelihood that a missing frame must gain
constexpr int kMostMissing = 60;
constexpr double kEven = 0.15;  // of a step: near a reversal steps differ by as much as they are long

/// Way from one point to the next around the step to point f: the median of three steps on each side, so that other
/// jumps near by do not count.
struct UsualStep {
  double size = 0.0, spread = 0.0;  ///< the spread holds what an acceleration makes of it
};
UsualStep usual_step(const std::vector<double>& x_m, std::size_t f) {
  std::vector<double> steps;
  for (std::size_t to = f > 3 ? f - 3 : 1; to < std::min(x_m.size(), f + 4); ++to) {
    if (to != f) steps.push_back(x_m[to] - x_m[to - 1]);
  }
  UsualStep usual{core::median_of(steps), 0.0};
  for (double& step : steps) step = std::abs(step - usual.size);
  usual.spread = core::median_of(steps);
  return usual;
}

/// Best place for one more missing frame in a motion: the gain, and the point from which on all are late.
struct Place {
  double gain = 0.0;
  std::size_t point = 0;
  double step_s = 0.0;
};

/// `known`: frames are missing elsewhere for certain, so that one more needs no jump that shows by itself.
Place best_place(const ScoreSpace& space, std::size_t i, bool known) {
  const TrackedMotion& data = space.set().motions[i];
  const auto n = static_cast<Eigen::Index>(data.t_s.size());
  const auto& v = space.fit().motions[i].v_m_s;
  const double step = 1.0 / space.set().clips[data.clip].frame_rate_hz;
  const auto r = space.residual().rest.segment(space.offset(i), n);
  Place best;
  const Eigen::Index margin = known ? 1 : 3;
  for (Eigen::Index from = margin; from + margin <= n - (known ? 0 : 1); ++from) {
    const auto f = static_cast<std::size_t>(from);
    if (std::abs(v[f]) * step < (known ? 1.0 : 5.0) * data.sd_m) continue;  // too slow to tell
    // The neighbours must show the jump themselves.
    // Against the six steps around, or, where they differ much as near a reversal, the two beside it.
    const double way = data.x_m[f] - data.x_m[f - 1];
    const double after = f + 1 < data.x_m.size() ? data.x_m[f + 1] - data.x_m[f] : data.x_m[f - 1] - data.x_m[f - 2];
    const double before = f < 2 ? after : data.x_m[f - 1] - data.x_m[f - 2];
    double jump = way - usual_step(data.x_m, f).size;
    const double beside = way - 0.5 * (before + after);
    if (std::abs(beside - v[f] * step) < std::abs(jump - v[f] * step)) jump = beside;
    if (std::abs(jump - v[f] * step) > 0.35 * std::abs(v[f] * step) + 5.0 * data.sd_m) continue;
    if (!known && std::abs(jump) < 3.0 * data.sd_m) continue;
    Eigen::VectorXd change = Eigen::VectorXd::Zero(n);
    for (Eigen::Index p = from; p < n; ++p) change[p] = v[static_cast<std::size_t>(p)] * step;
    const Eigen::VectorXd c = space.own_rest(i, change);
    const double gain = c.dot(r) - 0.5 * c.squaredNorm();
    if (gain > best.gain) best = {gain, f, step};
  }
  return best;
}

/// Frames that are missing for all to see: a step that is longer by a whole number of those around it, and stays so.
Lateness plain_losses(const TrackSet& set, std::size_t& count) {
  Lateness late;
  for (const TrackedMotion& motion : set.motions) {
    const std::vector<double>& x = motion.x_m;
    const double step_s = 1.0 / set.clips[motion.clip].frame_rate_hz;
    double sum_s = 0.0;
    late.emplace_back(x.size(), 0.0);
    for (std::size_t f = 1; f < x.size(); ++f) {
      const auto [usual, spread] = usual_step(x, f);
      const double jump = x[f] - x[f - 1] - usual, times = std::round(jump / usual);
      const bool in_time = motion.t_s[f] - motion.t_s[f - 1] < 1.5 * step_s;
      const bool even = std::abs(usual) > kPlain * motion.sd_m && spread < kEven * std::abs(usual);
      const bool clear =
          even && times >= 1.0 && times <= kMostTogether && std::abs(jump - times * usual) < 0.2 * std::abs(usual);
      const bool stays = f + 1 == x.size() || (x[f + 1] - x[f]) / usual > 0.5;
      if (in_time && clear && stays) {
        sum_s += times * step_s;
        count += static_cast<std::size_t>(times);
      }
      late.back()[f] = sum_s;
    }
  }
  return late;
}

}  // namespace

MissingFrames find_missing_frames(const TrackSet& set, const MotionFit& fit) {
  MissingFrames found;
  found.effect.effect = effect_index("dropped_frames");
  found.fit = fit;
  std::size_t plain = 0;
  Lateness late = plain_losses(set, plain);
  if (plain > 0) {
    MotionFit next = fit_motions(set, fit.effects, fit.at, late);
    if (next.cost < fit.cost - 2.0 * kClear * static_cast<double>(plain)) {
      found.fit = std::move(next);
      found.count = plain;
    }
  }
  if (found.count == 0) {
    late.clear();
    for (const TrackedMotion& motion : set.motions) late.emplace_back(motion.t_s.size(), 0.0);
  }
  double points = 0.0, penalty = 0.0;
  for (const TrackedMotion& motion : set.motions) points += static_cast<double>(motion.t_s.size());
  for (int round = 0; round < kMostMissing; ++round) {
    const ScoreSpace space(set, found.fit);
    Lateness tried = late;
    std::size_t added = 0;
    for (std::size_t i = 0; i < set.motions.size(); ++i) {
      const Place place = best_place(space, i, found.count > 0);
      if (place.gain < kClear) continue;
      for (std::size_t p = place.point; p < tried[i].size(); ++p) tried[i][p] += place.step_s;
      ++added;
    }
    if (added == 0) break;
    MotionFit next = fit_motions(set, fit.effects, found.fit.at, tried);
    if (!(next.cost < found.fit.cost - 2.0 * kClear)) break;
    late = std::move(tried);
    found.fit = std::move(next);
    found.count += added;
  }
  if (found.count == 0) return found;
  // Where each one is costs the logarithm of the places; the fraction, evenly over its logarithm from 1e-4 to 0.1.
  const double share = static_cast<double>(found.count) / points;
  penalty = -static_cast<double>(found.count) * std::log(share) + points * share + std::log(7.0);
  found.effect.gain = 0.5 * (fit.cost - found.fit.cost);
  found.effect.log_evidence = found.effect.gain - penalty;
  found.effect.value = share;
  found.effect.sd = std::sqrt(static_cast<double>(found.count)) / points;
  return found;
}

}  // namespace glidelab::diagnose
