#include "diagnose/scan/timed_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "base/math/dense.h"
#include "base/math/log_sum.h"
#include "diagnose/fit/fit_model.h"
#include "diagnose/model/turning_waves.h"

namespace glidelab::diagnose {
namespace {

constexpr double kLeastWave_px = 0.002;  // in images: the error of locating a marker among pixels
constexpr double kTurn = 2.0 * std::numbers::pi;

/// Information (ss, sc, cc) and score (rs, rc) of sin and cos of one frequency in one motion.
struct WavePart {
  double ss = 0.0, sc = 0.0, cc = 0.0, rs = 0.0, rc = 0.0;
};

/// The waves at the times of each motion.
std::vector<TurningWaves> waves_of(const TrackSet& set, double f, double step) {
  std::vector<TurningWaves> waves;
  for (const TrackedMotion& motion : set.motions) waves.emplace_back(motion.t_s, f, step);
  return waves;
}

std::vector<WavePart> wave_parts(const ScoreSpace& space, const std::vector<TurningWaves>& waves) {
  std::vector<WavePart> parts;
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const Eigen::VectorXd s = space.own_rest(i, waves[i].sin()), c = space.own_rest(i, waves[i].cos());
    const auto r = space.residual().rest.segment(space.offset(i), s.size());
    parts.push_back({s.dot(s), s.dot(c), c.dot(c), s.dot(r), c.dot(r)});
  }
  return parts;
}

struct WaveEvidence {
  double log_evidence = 0.0;
  double size_m = 0.0, gain = 0.0;  // at the best size
};

WaveEvidence weigh_wave(const std::vector<WavePart>& parts, double least_m) {
  constexpr int kSizes = 20, kPhases = 24;
  double square = 0.0;
  for (const WavePart& part : parts) square += 0.5 * (part.ss + part.cc);
  std::vector<double> logs;
  WaveEvidence found;
  std::array<double, kPhases> sine, cosine;
  for (std::size_t k = 0; k < kPhases; ++k) {
    sine[k] = std::sin(kTurn * static_cast<double>(k) / kPhases);
    cosine[k] = std::cos(kTurn * static_cast<double>(k) / kPhases);
  }
  for (int a = 0; a < kSizes; ++a) {
    // Three decades, from the smallest amplitude that shows and can be trusted.
    const double size = std::max(4.0 / std::sqrt(square), least_m) * std::pow(10.0, 3.0 * a / (kSizes - 1.0));
    double log_likelihood = 0.0, gain = 0.0;
    for (const WavePart& part : parts) {
      double most = -std::numeric_limits<double>::infinity();
      std::array<double, kPhases> at;
      for (std::size_t k = 0; k < kPhases; ++k) {
        const double u = size * cosine[k], w = size * sine[k];
        at[k] = u * part.rs + w * part.rc - 0.5 * (u * u * part.ss + 2.0 * u * w * part.sc + w * w * part.cc);
        most = std::max(most, at[k]);
      }
      double sum = 0.0;
      for (const double l : at) sum += std::exp(l - most);
      log_likelihood += most + std::log(sum / kPhases);
      gain += most;
    }
    logs.push_back(log_likelihood);
    if (gain > found.gain) {
      found.gain = gain;
      found.size_m = size;
    }
  }
  found.log_evidence = base::log_mean(logs);
  return found;
}

}  // namespace

Wave find_wave(const ScoreSpace& space) {
  const TrackSet& set = space.set();
  Wave wave;
  double longest = 0.0, least_m = 0.0;
  for (const TrackedMotion& motion : set.motions) {
    least_m = std::max(least_m, kLeastWave_px * motion.m_per_px);
    longest = std::max(longest, motion.t_s.back() - motion.t_s.front());
  }
  const ParameterRange hz = range_of(set, effect_of(ids::base_vibration).parameters[1]);
  std::vector<double> logs;
  const double step = 0.3 / longest;
  std::vector<TurningWaves> waves = waves_of(set, hz.low, step);
  for (double f = hz.low; f < hz.high; f += step) {
    const WaveEvidence at = weigh_wave(wave_parts(space, waves), least_m);
    logs.push_back(at.log_evidence);
    if (at.gain > wave.gain) wave = {at.gain, 0.0, at.size_m, f};
    for (TurningWaves& of_motion : waves) of_motion.turn();
  }
  if (!logs.empty()) wave.log_evidence = base::log_mean(logs);
  return wave;
}

EffectScan scan_waves(const ScoreSpace& space, std::size_t effect, const Wave& wave) {
  const TrackSet& set = space.set();
  const EffectInfo& info = effect_list()[effect];
  EffectScan scan;
  scan.effect = effect;
  if (!(wave.f_hz > 0.0)) return scan;
  scan.visible = true;
  scan.gain = wave.gain;
  scan.log_evidence = wave.log_evidence;
  const double omega = kTurn * wave.f_hz;
  const bool force = info.law.moves();  // otherwise the measured position swings
  std::size_t i = 0;
  double amplitude = wave.size_m;
  for (const WavePart& part : wave_parts(space, waves_of(set, wave.f_hz, 0.0))) {
    const double det = std::max(part.ss * part.cc - part.sc * part.sc, 1e-12 * part.ss * part.cc + 1e-300);
    const double u = (part.cc * part.rs - part.sc * part.rc) / det, w = (part.ss * part.rc - part.sc * part.rs) / det;
    double phase = std::atan2(w, u);  // of u sin + w cos = A sin(wt + phase)
    if (force) {
      // x'' + k x' = A sin: x = Im A exp(i w t) / (-w² + i k w).
      const double k = space.fit().at.global[0] / set.masses[set.motions[i].mass].mass_kg;
      phase -= std::arg(1.0 / std::complex<double>(-omega * omega, k * omega));
    }
    scan.own.push_back({phase});
    ++i;
  }
  if (force) amplitude *= omega * omega;
  scan.values = {std::min(amplitude, 0.9 * info.parameters[0].high), wave.f_hz};
  return scan;
}

namespace {

constexpr double kShareOfAnyPushes = 0.1;  // of late releases: pushes of any size and sign, each motion its own
constexpr double kShareOfDragging = 0.1;   // of those of one hand: it drags instead of pushing; in falls, pushes
constexpr double kPushStep_m_s2 = 1e-4;    // of the finite difference
constexpr double kPushSpread = 0.5;  // sd of one hand's pushes about their common part, over that of the common part

/// The direction of a motion at a time, or as soon after it as the motion moves: 1 or -1.
double direction_at(const ScoreSpace& space, std::size_t motion, double t_s) {
  const auto& t = space.set().motions[motion].t_s;
  const auto& v = space.fit().motions[motion].v_m_s;
  std::size_t p = 0;
  while (p + 1 < t.size() && (t[p] < t_s || v[p] == 0.0)) ++p;
  return v[p] < 0.0 ? -1.0 : 1.0;
}

/// The matrix from independent unit deviates to the pushes of one hand, which act along the motions and are about
/// equal.
Eigen::MatrixXd pushes_of_one_hand(const Eigen::VectorXd& directions) {
  Eigen::MatrixXd sizes(directions.size(), directions.size() + 1);
  sizes << directions, kPushSpread * Eigen::MatrixXd::Identity(directions.size(), directions.size());
  return sizes;
}

double log_below(double z) {
  return std::log(std::max(1e-300, 0.5 * std::erfc(-z / std::numbers::sqrt2)));
}

/// log((1 - d) P(all positive) + d P(all negative)) of normal deviates, taken as independent, with d =
/// kShareOfDragging.
double log_one_sign(const Eigen::VectorXd& mean, const Eigen::VectorXd& sd) {
  double positive = std::log1p(-kShareOfDragging), negative = std::log(kShareOfDragging);
  for (Eigen::Index k = 0; k < mean.size(); ++k) {
    const double z = mean[k] / std::max(sd[k], 1e-300);
    positive += log_below(z);
    negative += log_below(-z);
  }
  return base::log_mean({positive, negative}) + std::log(2.0);
}

/// Log of the prior probability that pushes_of_one_hand() all have one given sign: the average over their common part.
double log_one_sign_beforehand(Eigen::Index pushes) {
  constexpr int kParts = 400;
  constexpr double kWidest = 8.0;
  double sum = 0.0;
  for (int i = 0; i < kParts; ++i) {
    const double common = kWidest * ((i + 0.5) / kParts * 2.0 - 1.0);
    sum += std::exp(-0.5 * common * common + static_cast<double>(pushes) * log_below(common / kPushSpread));
  }
  return std::log(sum * 2.0 * kWidest / kParts / std::sqrt(2.0 * std::numbers::pi));
}

}  // namespace

EffectScan scan_pushes(const ScoreSpace& space, std::size_t effect) {
  const TrackSet& set = space.set();
  EffectScan scan;
  scan.effect = effect;
  std::vector<std::size_t> from_start;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    if (!begins_with_its_clip(set, set.motions[i])) continue;
    from_start.push_back(i);
  }
  if (from_start.empty()) return scan;
  const double beforehand = log_one_sign_beforehand(std::ssize(from_start));
  std::vector<double> logs;
  double best = 0.0;
  const ParameterRange range = range_of(set, effect_list()[effect].parameters[0]);
  for (double t_r = range.low; t_r < range.high; t_r *= 1.3) {
    std::vector<ScoreColumn> columns;
    for (const std::size_t i : from_start)
      columns.push_back(space.of_own(i, {effect, 1}, kPushStep_m_s2, {effect, 0}, t_r));
    const auto n = static_cast<Eigen::Index>(columns.size());
    Eigen::MatrixXd products(n, n);
    Eigen::VectorXd scores(n);
    for (Eigen::Index a = 0; a < n; ++a) {
      const auto& column = columns[static_cast<std::size_t>(a)];
      scores[a] = space.dot(column, space.residual());
      for (Eigen::Index b = 0; b <= a; ++b) {
        products(a, b) = products(b, a) = space.dot(column, columns[static_cast<std::size_t>(b)]);
      }
    }
    Eigen::VectorXd directions(n);
    for (Eigen::Index k = 0; k < n; ++k)
      directions[k] = direction_at(space, from_start[static_cast<std::size_t>(k)], t_r);
    const Eigen::MatrixXd sizes = pushes_of_one_hand(directions), seen = base::product(products, sizes);
    const SpreadEvidence evidence =
        log_spread_evidence(base::transposed_product(sizes, seen), base::transposed_product(sizes, scores));
    const SpreadEvidence any = log_spread_evidence(products, scores);
    if (evidence.mean.size() == 0 || any.mean.size() == 0) {
      logs.push_back(0.0);  // says nothing
      continue;
    }
    Eigen::VectorXd push = base::product(sizes, evidence.mean);
    const Eigen::MatrixXd covariance = base::product(base::product(sizes, evidence.covariance), sizes.transpose());
    // A hand pushes what it launches. It seldom holds back what it lets go, or does so in one clip and not in the next.
    // What it lets fall it holds back.
    const double usual = only_falls(set) ? -1.0 : 1.0;
    const double one_sign =
        log_one_sign(usual * push.cwiseProduct(directions), covariance.diagonal().cwiseMax(0.0).cwiseSqrt()) -
        beforehand;
    const double of_one_hand = std::log1p(-kShareOfAnyPushes) + evidence.log_evidence + one_sign;
    const double of_any = std::log(kShareOfAnyPushes) + any.log_evidence;
    logs.push_back(base::log_sum({of_one_hand, of_any}));
    const bool alike = of_one_hand >= of_any;
    if (!alike) push = any.mean;
    const double gain = alike ? evidence.gain : any.gain;
    if (gain <= best) continue;
    best = gain;
    scan.gain = evidence.free_gain;  // the gain with which a full fit is compared
    scan.values = {t_r};
    scan.own.assign(set.motions.size(), {0.0});
    for (std::size_t k = 0; k < from_start.size(); ++k) {
      scan.own[from_start[k]] = {push[static_cast<Eigen::Index>(k)]};
    }
  }
  if (logs.empty() || scan.values.empty()) return scan;
  scan.visible = true;
  scan.log_evidence = base::log_mean(logs);
  return scan;
}

}  // namespace glidelab::diagnose
