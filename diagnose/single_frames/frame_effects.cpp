#include "diagnose/single_frames/frame_effects.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/math/log_sum.h"
#include "core/math/quantile.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/fit_model.h"
#include "diagnose/single_frames/point_scatter.h"

namespace glidelab::diagnose {
namespace {

constexpr double kMostScatter = 6.0;  // standard deviations
constexpr double kMostAside = 0.2;    // of a motion's points

}  // namespace

FrameEffect scan_jitter(const TrackSet& set, const MotionFit& fit) {
  if (set.position_noise) {
    const PositionNoise& noise = *set.position_noise;
    return {effect_index(ids::timestamp_jitter), noise.jitter_gain, noise.jitter_log_evidence, noise.jitter_s,
            noise.jitter_sd_s};
  }
  SpeedScatter scatter;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const TrackedMotion& motion = set.motions[i];
    const Leftover left = leftover_of(set, fit, i);
    for (std::size_t p = 0; p < left.v_m_s.size(); ++p) {
      if (std::abs(left.over_sd[p]) < kMostScatter) scatter.add(motion, p, left.over_sd[p], left.v_m_s[p]);
    }
  }
  const SpeedNoise noise = find_speed_noise(set, scatter, 1.0);
  FrameEffect found{effect_index(ids::timestamp_jitter), noise.gain, noise.log_evidence, noise.jitter_s, noise.sd_s};
  found.visible = scatter.squares.size() >= kFewestScatter;
  return found;
}

namespace {

constexpr std::size_t kSpeedPoints = 61;  // that give the scatter at a speed: known to a seventh

constexpr double kLeastScatter = 0.05;  // relative to the noise: positions may have been placed on the curve

/// Standard deviation of values, from the median of their magnitudes.
double scatter_of(std::vector<double> sizes) {
  return std::max(core::kSdOverMedian * core::median_of(std::move(sizes)), kLeastScatter);
}

/// Scatter of values by how fast the marker moves (median of the nearest in speed), over that of all of them.
std::vector<double> scatter_by_speed(const std::vector<double>& over_sd, const std::vector<double>& v) {
  std::vector<std::size_t> order(v.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return std::abs(v[a]) < std::abs(v[b]); });
  const std::size_t many = std::min(kSpeedPoints, order.size());
  std::vector<double> scatter(v.size(), 0.0);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t from = std::min(k - std::min(k, many / 2), order.size() - many);
    std::vector<double> near;
    for (std::size_t j = from; j < from + many; ++j) near.push_back(std::abs(over_sd[order[j]]));
    scatter[order[k]] = scatter_of(std::move(near));
  }
  return scatter;
}

struct TailResiduals {
  std::vector<double> over_scatter;  ///< of all points, one motion after the other
  std::vector<double> scatter_m;
};

/// All points' residuals over their motion's own scatter, so that clips of different noise make no tails. Those of
/// filmed points are over the scatter at their speed, as a smeared marker is located less well.
TailResiduals tail_residuals(const TrackSet& set, const MotionFit& fit) {
  std::vector<double> over_sd, v, scatter;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    Leftover left = leftover_of(set, fit, i);
    // Rounding affects a single position in the same way anywhere; frames with the same error are `wider` together.
    const TrackedMotion& motion = set.motions[i];
    for (std::size_t p = 0; motion.step_m > 0.0 && p < left.over_sd.size(); ++p) {
      left.over_sd[p] *= motion.sd_of(p) / motion.own_sd_of(p);
    }
    over_sd.insert(over_sd.end(), left.over_sd.begin(), left.over_sd.end());
    v.insert(v.end(), left.v_m_s.begin(), left.v_m_s.end());
    std::vector<double> size;
    for (const double r : left.over_sd) size.push_back(std::abs(r));
    scatter.resize(over_sd.size(), scatter_of(std::move(size)));
  }
  if (set.images) scatter = scatter_by_speed(over_sd, v);
  TailResiduals residuals;
  std::size_t at = 0;
  for (const TrackedMotion& motion : set.motions) {
    for (std::size_t p = 0; p < motion.t_s.size(); ++p, ++at) {
      residuals.over_scatter.push_back(over_sd[at] / scatter[at]);
      residuals.scatter_m.push_back(scatter[at] * (motion.step_m > 0.0 ? motion.own_sd_of(p) : motion.sd_of(p)));
    }
  }
  return residuals;
}

constexpr double kLeastFilmedWide = 10.0;
constexpr double kLeastLost_px = 0.05;     // a smaller error is not due to a missing frame,
constexpr double kMostOfSmallError = 3.0;  // and counts no more than this, in standard deviations
constexpr double kFewestRuns = 4.0;        // a frame or two beside another error is no pattern yet
constexpr double kFewestFirst = 2.0;       // two errors in all, both in first frames: these count as one
constexpr double kPartInRuns = 0.25;
constexpr double kFirstFrames = 3.0;  // of a clip

struct Tails {
  double gain = 0.0, log_evidence = 0.0;
  double share = 0.0, wide = 1.0, variance = 1.0;  // at the best: of the narrow part
};

/// Of residuals whose standard deviation itself varies (Student's t of `freedom`), at the best scale; up to the
/// constant of the normal distribution.
double uneven_log_likelihood(const std::vector<double>& e, double freedom) {
  const auto n = static_cast<double>(e.size());
  double s2 = 1.0, sum = 0.0;
  for (int em = 0; em < 12; ++em) {
    double squares = 0.0;
    sum = 0.0;
    for (const double r : e) {
      squares += (freedom + 1.0) / (freedom + r * r / s2) * r * r;
      sum -= 0.5 * (freedom + 1.0) * std::log1p(r * r / (freedom * s2)) + 0.5 * std::log(s2);
    }
    s2 = squares / n;
  }
  return sum + n * (std::lgamma(0.5 * (freedom + 1.0)) - std::lgamma(0.5 * freedom) - 0.5 * std::log(0.5 * freedom));
}

/// A marker is located better at some places in the image and in some frames (of a codec) than in others, by a factor
/// of two or three: that is not a tail. The usual scatter is therefore given a size that varies, by an unknown amount.
Tails find_tails(const std::vector<double>& e, bool filmed) {
  Tails tails;
  const auto n = static_cast<double>(e.size());
  double squares = 0.0;
  for (const double r : e) squares += r * r;
  double usual = -0.5 * n * (std::log(squares / n) + 1.0);
  if (filmed) {
    std::vector<double> logs = {usual};
    for (const double freedom : {24.0, 12.0, 8.0, 5.0}) logs.push_back(uneven_log_likelihood(e, freedom));
    usual = base::log_mean(logs);
  }
  std::vector<double> logs;
  for (const double share : {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2}) {
    if (share * n < 1.5) continue;
    for (const double wide : {3.0, 5.0, 10.0, 20.0, 50.0, 100.0}) {
      if (filmed && wide < kLeastFilmedWide) continue;
      double s2 = 1.0, log_likelihood = 0.0;
      for (int em = 0; em < 4; ++em) {
        double sum = 0.0;
        log_likelihood = 0.0;
        for (const double r : e) {
          const double a = (1.0 - share) * std::exp(-0.5 * r * r / s2);
          const double b = share / wide * std::exp(-0.5 * r * r / (s2 * wide * wide));
          const double in = a / (a + b + 1e-300), w = in + (1.0 - in) / (wide * wide);
          sum += w * r * r;
          log_likelihood += std::log(a + b + 1e-300) - 0.5 * std::log(s2);
        }
        s2 = sum / n;
      }
      logs.push_back(log_likelihood - usual);
      if (logs.back() > tails.gain) tails = {logs.back(), 0.0, share, wide, s2};
    }
  }
  if (!logs.empty()) tails.log_evidence = base::log_mean(logs);
  return tails;
}

/// Log odds that this position belongs to the majority rather than to the tails.
double of_the_many(const Tails& tails, double e) {
  const double square = e * e / tails.variance, wide = tails.wide * tails.wide;
  return std::log((1.0 - tails.share) * tails.wide / tails.share) - 0.5 * square * (1.0 - 1.0 / wide);
}

/// Log evidence that `together` of `all`, `fewest` or more, exceeds what chance gives.
double more_than_chance(double together, double all, double chance, double fewest) {
  if (together < std::max(fewest, kPartInRuns * all)) return 0.0;
  return std::lgamma(together + 1.0) + std::lgamma(all - together + 1.0) - std::lgamma(all + 2.0) -
         together * std::log(chance) - (all - together) * std::log1p(-chance);
}

struct TailsTogether {
  double log_evidence = 0.0;
  std::optional<ErrorRun> run;
};

/// As FrameEffect::in_runs.
TailsTogether tails_together(const TrackSet& set, const TailResiduals& residuals, const Tails& tails) {
  const std::vector<double>& e = residuals.over_scatter;
  double all = 0.0, before_another = 0.0, followed = 0.0, first = 0.0, firsts = 0.0;
  ErrorRun at_first, one_by_one, open;  // open: that the last frame belongs to
  std::size_t at = 0;
  for (const TrackedMotion& motion : set.motions) {
    bool goes_on = false;
    for (std::size_t p = 0; p < motion.t_s.size(); ++p, ++at) {
      const bool begins = motion.t_s[p] < (kFirstFrames - 0.5) / set.clips[motion.clip].frame_rate_hz;
      firsts += begins ? 1.0 : 0.0;
      if (of_the_many(tails, e[at]) > 0.0) continue;
      all += 1.0;
      const double excess = std::abs(e[at]), size_m = excess * residuals.scatter_m[at];
      if (begins) {
        first += 1.0;
        at_first.to_s = std::max(at_first.to_s, motion.t_s[p]);
        if (excess > at_first.excess) at_first.excess = excess, at_first.size_m = size_m;
      }
      const bool has_next = p + 1 < motion.t_s.size();
      const bool next = has_next && of_the_many(tails, e[at + 1]) <= 0.0 && e[at] * e[at + 1] > 0.0;
      before_another += has_next ? 1.0 : 0.0;
      followed += next ? 1.0 : 0.0;
      if (!goes_on) open = {motion.clip, motion.t_s[p], motion.t_s[p], size_m, excess};
      open.to_s = motion.t_s[p];
      if (excess > open.excess) open.excess = excess, open.size_m = size_m;
      if (goes_on && !next && open.excess > one_by_one.excess) one_by_one = open;
      goes_on = next;
    }
  }
  const auto points = static_cast<double>(e.size());
  const double in_row = more_than_chance(followed, before_another, 0.5 * all / points, kFewestRuns);
  const double in_first = more_than_chance(first, all, firsts / points, kFewestFirst);
  if (std::max(in_row, in_first) <= 0.0) return {};
  return {std::max(in_row, in_first), in_first >= in_row ? at_first : one_by_one};
}

/// In images, an error smaller than that of any lost marker counts as none: an edge that the marker passes can cause
/// it.
void spare_small(const TrackSet& set, std::vector<double>& e) {
  std::size_t at = 0;
  for (const TrackedMotion& motion : set.motions) {
    for (std::size_t p = 0; p < motion.t_s.size(); ++p, ++at) {
      if (motion.m_per_px > 0.0 && std::abs(e[at]) * motion.sd_of(p) < kLeastLost_px * motion.m_per_px) {
        e[at] = std::clamp(e[at], -kMostOfSmallError, kMostOfSmallError);
      }
    }
  }
}

}  // namespace

FrameEffect scan_tails(const TrackSet& set, const MotionFit& fit) {
  FrameEffect found;
  found.effect = effect_index(ids::heavy_tailed_noise);
  TailResiduals residuals = tail_residuals(set, fit);
  std::vector<double>& e = residuals.over_scatter;
  found.visible = e.size() >= kFewestScatter;
  if (!found.visible) return found;
  spare_small(set, e);
  const Tails tails = find_tails(e, set.images);
  found.gain = tails.gain;
  found.log_evidence = tails.log_evidence;
  found.value = tails.share;
  found.sd = std::sqrt(tails.share / static_cast<double>(e.size()));
  const TailsTogether together = tails_together(set, residuals, tails);
  found.in_runs = together.log_evidence;
  found.run = together.run;
  return found;
}

std::size_t set_tails_aside(TrackSet& set, const MotionFit& fit) {
  const std::vector<double> e = tail_residuals(set, fit).over_scatter;
  if (e.size() < kFewestScatter) return 0;
  const Tails tails = find_tails(e, set.images);
  if (tails.log_evidence < kBeyondDoubt) return 0;
  std::size_t count = 0, at = 0;
  TrackSet marked = set;
  for (TrackedMotion& motion : marked.motions) {
    std::size_t of_motion = 0;
    for (char& outlier : motion.outlier) {
      const bool in = of_the_many(tails, e[at]) > 0.0;
      ++at;
      if (outlier || in) continue;
      outlier = 1;
      ++count;
      ++of_motion;
    }
    // A scatter that would cost a motion a fifth of its points is not a matter of single positions.
    if (static_cast<double>(of_motion) > kMostAside * static_cast<double>(motion.t_s.size())) return 0;
  }
  set = std::move(marked);
  return count;
}

}  // namespace glidelab::diagnose
