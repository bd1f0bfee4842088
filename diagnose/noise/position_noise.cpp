#include "diagnose/noise/position_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/math/dense.h"
#include "base/math/log_sum.h"
#include "core/math/quantile.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/fit_model.h"
#include "diagnose/fit/fit_neighbourhood.h"
#include "diagnose/scan/effect_scan.h"
#include "diagnose/tracks/neighbour_residual.h"
#include "diagnose/tracks/whitening.h"

namespace glidelab::diagnose {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr std::size_t kMostPoints = 1920;  // of all motions: more add nothing to a handful of numbers
constexpr std::size_t kFewestInChunk = 24;
constexpr double kLeastIndependent = 1e-6;  // a slow wave that is a sum of bumps to within this counts once
constexpr double kMostOff = 8.0;            // standard deviations off the neighbours

// Sine and cosine, each also times t and t². A frequency between two that are tried is off by at most half a radian at
// the ends of such points, of which these columns leave half a percent; they also cover a size that grows across the
// image.
constexpr Eigen::Index kWaveColumns = 6;

/// Number of points taken together, and frames between the bumps that are set aside as slow. A codec that predicts
/// images from earlier ones passes its errors on: errors that last for up to a dozen frames must stay visible.
struct Slow {
  std::size_t chunk = 80;
  double knot = 10.0;
};
constexpr Slow kNew, kHandedOn{160, 30.0};

/// The frames of a motion that are not outliers, in stretches. Beside a wave, the fit's errors by sub-pixel position
/// have absorbed some of it, and are set aside as well.
void add_chunks(const TrackSet& set, const MotionFit& fit, std::size_t i, double wave_hz, const Slow& slow,
                std::vector<NoiseChunk>& chunks) {
  const TrackedMotion& motion = set.motions[i];
  const SeenFrames all = seen_frames(motion, set.clips[motion.clip].frame_rate_hz);
  const std::size_t points = motion.t_s.size(), parts = std::max<std::size_t>(1, points / slow.chunk);
  for (std::size_t part = 0; part < parts; ++part) {
    NoiseChunk chunk;
    chunk.motion = i;
    std::vector<double> off, t;
    std::vector<std::vector<double>> pixel(motion.shared_m.size() -
                                           std::min(motion.shared_m.size(), motion.first_pixel_mode));
    for (std::size_t p = points * part / parts; p < points * (part + 1) / parts; ++p) {
      const bool inside = p >= 2 && p + 2 < points;
      const bool lost = inside && std::abs(neighbour_residual(motion.t_s, motion.x_m, p)) > kMostOff * motion.sd_of(p);
      if (motion.outlier[p] != 0 || lost) continue;
      chunk.frames.along_px.push_back(all.along_px[p]);
      chunk.frames.frame.push_back(all.frame[p]);
      chunk.frames.v_px_s.push_back(all.v_px_s[p]);
      t.push_back(motion.t_s[p]);
      for (std::size_t m = 0; m < pixel.size(); ++m) {
        pixel[m].push_back(motion.shared_m[motion.first_pixel_mode + m][p] / motion.m_per_px);
      }
      off.push_back(fit.motions[i].plain[static_cast<Eigen::Index>(p)] * motion.sd_of(p) / unit_m(motion));
    }
    if (off.size() < kFewestInChunk) continue;
    const auto n = std::ssize(off);
    chunk.off_px = Eigen::Map<const Eigen::VectorXd>(off.data(), n);
    const double first = chunk.frames.frame.front(), span = chunk.frames.frame.back() - first;
    const auto bumps = static_cast<Eigen::Index>(std::ceil(span / slow.knot)) + 1;
    const double width = span / static_cast<double>(bumps - 1);
    const Eigen::Index of_wave = wave_hz > 0.0 ? kWaveColumns : 0;
    const Eigen::Index of_pixels = wave_hz > 0.0 ? static_cast<Eigen::Index>(pixel.size()) : 0;
    chunk.slow = Eigen::MatrixXd::Zero(n, bumps + of_wave + of_pixels);
    for (Eigen::Index p = 0; p < n; ++p) {
      const auto q = static_cast<std::size_t>(p);
      for (Eigen::Index b = 0; b < bumps; ++b) {
        const double z = (chunk.frames.frame[q] - first) / width - static_cast<double>(b);
        chunk.slow(p, b) = std::exp(-0.5 * z * z);
      }
      for (Eigen::Index w = 0; w < of_wave; ++w) {
        const double phase = kTurn * wave_hz * t[q], along = 2.0 * (t[q] - t.front()) / (t.back() - t.front()) - 1.0;
        chunk.slow(p, bumps + w) = (w % 2 == 0 ? std::sin(phase) : std::cos(phase)) * std::pow(along, w / 2);
      }
      for (Eigen::Index m = 0; m < of_pixels; ++m) {
        chunk.slow(p, bumps + of_wave + m) = pixel[static_cast<std::size_t>(m)][q];
      }
    }
    chunk.slow = base::orthonormal_columns(chunk.slow, kLeastIndependent);
    chunks.push_back(std::move(chunk));
  }
}

}  // namespace

std::vector<NoiseChunk> noise_chunks(const TrackSet& set, const MotionFit& fit, double wave_hz) {
  std::vector<NoiseChunk> chunks;
  const Slow& slow = set.handed_on ? kHandedOn : kNew;
  for (std::size_t i = 0; i < set.motions.size(); ++i) add_chunks(set, fit, i, wave_hz, slow, chunks);
  const std::size_t most = kMostPoints / slow.chunk;
  if (chunks.size() <= most) return chunks;
  std::vector<NoiseChunk> some;
  for (std::size_t k = 0; k < most; ++k) some.push_back(chunks[k * chunks.size() / most]);
  return some;
}

namespace {

constexpr double kSpreadOfLogS = 0.3;  // standard deviation of ln(s_i) about ln(s), s_i of one motion

// For such a codec, measured on fault-free clips whose truth is known (H.264 of crf 14 to 18, tracked positions minus
// the true ones): the errors of neighbours correlate by 0.15 to 0.35, of every other frame by 0.3 to 0.4, of the fourth
// by 0.1 to 0.3, of the eighth by 0 to 0.15. That is a lasting part, 0.8 of s, over some five frames; clips differ by a
// factor of about 1.6. This is a prior: the positions themselves have the last word.
constexpr double kLastingOverS = 0.8, kSpreadOfLogLasting = 0.5;  // expected value, and its spread

}  // namespace

NoiseLikelihood::NoiseLikelihood(std::vector<NoiseChunk> chunks, std::size_t motions, double pilot_px, bool handed_on)
    : chunks_(std::move(chunks)), motions_(motions), pilot_px_(pilot_px), handed_on_(handed_on) {}

double NoiseLikelihood::known(const NoiseShape& shape) const {
  if (!handed_on_) return 0.0;
  constexpr double kLeastLasting = 0.1;
  return -0.5 * std::pow(std::log(std::max(shape.lasting, kLeastLasting) / kLastingOverS) / kSpreadOfLogLasting, 2);
}

Likelihood NoiseLikelihood::of(const NoiseShape& shape) const {
  std::vector<Left> left(motions_);
  for (const NoiseChunk& chunk : chunks_) left[chunk.motion] = with(chunk, shape, left[chunk.motion]);
  Likelihood found;
  double log_s = std::log(pilot_px_);
  std::vector<double> own(motions_, log_s);
  for (int round = 0; round < 8; ++round) {
    double mean = 0.0, many = 0.0;
    for (std::size_t i = 0; i < motions_; ++i) {
      own[i] = log_s;
      if (left[i].freedom <= 0.0) continue;
      // Newton steps to the maximum of -freedom log s_i - square/(2 s_i²) - (log(s_i/s)/kSpreadOfLogS)²/2.
      for (int step = 0; step < 12; ++step) {
        const double over = left[i].square * std::exp(-2.0 * own[i]);
        const double slope = -left[i].freedom + over - (own[i] - log_s) / (kSpreadOfLogS * kSpreadOfLogS);
        own[i] += std::clamp(slope / (2.0 * over + 1.0 / (kSpreadOfLogS * kSpreadOfLogS)), -0.5, 0.5);
      }
      mean += own[i];
      many += 1.0;
    }
    if (many > 0.0) log_s = mean / many;
  }
  found.value = known(shape);
  for (std::size_t i = 0; i < motions_; ++i) {
    found.value -= left[i].freedom * own[i] + 0.5 * left[i].square * std::exp(-2.0 * own[i]) + 0.5 * left[i].logs +
                   0.5 * std::pow((own[i] - log_s) / kSpreadOfLogS, 2);
    found.own_px.push_back(std::exp(own[i]));
  }
  found.white_px = std::exp(log_s);
  return found;
}

NoiseLikelihood::Left NoiseLikelihood::with(const NoiseChunk& chunk, const NoiseShape& shape, Left left) const {
  const Eigen::Index n = chunk.off_px.size(), k = chunk.slow.cols();
  const Eigen::MatrixXd lower = base::cholesky_lower(covariance_of(chunk.frames, shape, pilot_px_));
  const Eigen::MatrixXd slow = base::solve_lower(lower, chunk.slow), off = base::solve_lower(lower, chunk.off_px);
  const Eigen::MatrixXd normal = base::transposed_product(slow, slow);
  // As a sum of squared remainders and not as a difference of squares: nearly all of a residual may be slow.
  const Eigen::MatrixXd taken = base::solve_positive(normal, base::transposed_product(slow, off));
  left.square += (off - base::product(slow, taken)).squaredNorm();
  left.logs += 2.0 * lower.diagonal().array().log().sum();
  const Eigen::MatrixXd factor = base::cholesky_lower(normal);
  for (Eigen::Index c = 0; c < k; ++c) left.logs += 2.0 * std::log(factor(c, c));
  left.freedom += static_cast<double>(n - k);
  return left;
}

namespace {

constexpr std::size_t kFewestPoints = 80;   // of all motions
constexpr double kWaveShownEvidence = 5.0;  // log evidence
constexpr double kLeastNoiseGain = 1.0;     // log likelihood that one more part of the noise must gain

// It also recodes what moves and leaves what rests unchanged: its errors grow with the speed as those of timing jitter
// do. Measured on fault-free clips by two renderers (H.264 of crf 14 to 23, 60 to 240 frames a second, 25 experiments):
// at top speed 0.4 to 1.5 of s, and in two cases 2 and 5, where a marker moves by two pixels a frame at most.
constexpr double kCodecMoves = 1.0, kCodecMovesFactor = 0.8;  // expected value, and its spread

struct Dial {
  double NoiseShape::*member;
  std::vector<double> values;
  double NoiseShape::*beside = nullptr;  ///< the length that goes with it
  std::vector<double> lengths;
};

/// Sets each part of the noise in turn to its most likely value, until nothing changes. A part that gains less than
/// kLeastNoiseGain is left out.
void climb(const NoiseLikelihood& likelihood, const std::vector<Dial>& dials, NoiseShape& shape, Likelihood& best) {
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    const double before = best.value;
    for (const Dial& dial : dials) {
      NoiseShape without = shape;
      without.*dial.member = 0.0;
      NoiseShape chosen = without;
      Likelihood most = likelihood.of(without);
      const double bar = most.value + kLeastNoiseGain;
      for (const double length : dial.lengths) {
        double last = -std::numeric_limits<double>::infinity();
        for (const double value : dial.values) {
          NoiseShape with = shape;
          with.*dial.member = value;
          if (dial.beside != nullptr) with.*dial.beside = length;
          const Likelihood at = likelihood.of(with);
          if (at.value > std::max(bar, most.value)) {
            most = at;
            chosen = with;
          }
          if (at.value < last - 3.0) break;  // past the top
          last = at.value;
        }
      }
      shape = chosen;
      best = most;
    }
    if (best.value - before < 0.5) break;
  }
}

/// The gain of the lasting part of the likeliest noise, and its evidence over all sizes and lengths.
void weigh_lasting(const NoiseLikelihood& likelihood, const Dial& lasting, PositionNoise& noise) {
  NoiseShape shape = noise.shape;
  shape.lasting = 0.0;
  const double without = likelihood.of(shape).value - likelihood.known(shape);
  std::vector<double> logs;
  for (const double length : lasting.lengths) {
    for (const double size : lasting.values) {
      shape.lasting = size;
      shape.lasting_frames = length;
      logs.push_back(likelihood.of(shape).value - likelihood.known(shape) - without);
    }
  }
  noise.lasting_gain = std::max(0.0, *std::max_element(logs.begin(), logs.end()));
  noise.lasting_log_evidence = base::log_mean(logs);
}

/// Noise in proportion to the speed, of one size.
struct OfSpeed {
  double at_top = 0.0;  ///< its noise at top speed, over the pilot's s
  double jitter_s = 0.0;
  double gain = 0.0;  ///< log likelihood, relative to the likeliest noise without it
  Likelihood likelihood;
  bool may_be_uneven = true;  ///< no less than least_filmed_jitter_s()
};

/// Weighs timing jitter, all sizes equally likely, against the likeliest noise without it, to which a codec's own
/// errors belong, and those of a marker's place in the pixel. Returns the size that the positions show beyond doubt,
/// whatever its cause; nullptr: none.
const OfSpeed* weigh_speed(const std::vector<OfSpeed>& sizes, bool handed_on, PositionNoise& noise) {
  if (sizes.empty()) return nullptr;
  std::vector<double> uneven, of_others;
  const OfSpeed *likeliest = nullptr, *others = nullptr;
  double others_gain = 0.0, weights = 0.0;
  for (const OfSpeed& size : sizes) {
    if (size.may_be_uneven) uneven.push_back(size.gain);
    if (size.may_be_uneven && size.gain > (likeliest != nullptr ? likeliest->gain : 0.0)) likeliest = &size;
    if (!handed_on && size.may_be_uneven) continue;
    const double known = handed_on ? -0.5 * std::pow(std::log(size.at_top / kCodecMoves) / kCodecMovesFactor, 2) : 0.0;
    of_others.push_back(size.gain + known);
    weights += std::exp(known);
    if (of_others.back() > others_gain) {
      others_gain = of_others.back();
      others = &size;
    }
  }
  // Sizes below the smallest one tried count as none.
  const double to_mean = std::log(static_cast<double>(of_others.size()) / weights);
  const double others_evidence = of_others.empty() ? 0.0 : std::max(0.0, base::log_mean(of_others) + to_mean);
  noise.jitter_log_evidence = (uneven.empty() ? 0.0 : base::log_mean(uneven)) - others_evidence;
  if (likeliest != nullptr) {
    noise.jitter_s = likeliest->jitter_s;
    noise.jitter_gain = std::max(0.0, likeliest->gain - others_gain);
    noise.jitter_sd_s = noise.jitter_s / std::sqrt(std::max(1.0, 2.0 * likeliest->gain));
  }
  if (noise.jitter_log_evidence > kBeyondDoubt) return likeliest;
  return others_evidence > kBeyondDoubt ? others : nullptr;
}

double wave_frequency(const TrackSet& set, const MotionFit& fit) {
  const ScoreSpace space(set, fit);
  const EffectScan wave = scan_effect(space, effect_index(ids::camera_motion));
  return wave.log_evidence > kWaveShownEvidence && wave.values.size() > 1 ? wave.values[1] : 0.0;
}

}  // namespace

bool find_position_noise(TrackSet& set, const MotionFit& fit) {
  std::size_t points = 0;
  std::vector<double> sds;
  double top_px_s = 0.0, step_s = 0.0;
  for (const TrackedMotion& motion : set.motions) {
    if (set.images && motion.along_px.empty()) return false;
    points += motion.t_s.size();
    sds.push_back(motion.sd_m / unit_m(motion));
    step_s = std::max(step_s, 1.0 / set.clips[motion.clip].frame_rate_hz);
    for (const double v : seen_frames(motion, 1.0).v_px_s) top_px_s = std::max(top_px_s, std::abs(v));
  }
  if (points < kFewestPoints) return false;
  std::vector<NoiseChunk> chunks = noise_chunks(set, fit, wave_frequency(set, fit));
  if (chunks.empty()) return false;
  const double pilot_px = core::median_of(std::move(sds));
  const NoiseLikelihood likelihood(std::move(chunks), set.motions.size(), pilot_px, set.handed_on);

  const std::vector<double> sizes = {0.25, 0.5, 0.75, 1.1, 1.6, 2.4, 3.6, 5.4};
  std::vector<Dial> dials;
  if (set.images) {
    dials = {{&NoiseShape::pixels, sizes, &NoiseShape::pixels_px, {0.25, 0.4, 0.7}},
             {&NoiseShape::phase, sizes, &NoiseShape::phase_px, {5.0, 20.0, 80.0}}};
  }
  std::vector<double> lengths = {1.0, 2.0, 4.0};
  if (set.handed_on) lengths.push_back(8.0);
  const bool may_last = set.lossy || !set.images;
  if (may_last) dials.push_back({&NoiseShape::lasting, sizes, &NoiseShape::lasting_frames, lengths});
  PositionNoise noise;
  Likelihood best = likelihood.of(noise.shape);
  climb(likelihood, dials, noise.shape, best);
  if (may_last) weigh_lasting(likelihood, dials.back(), noise);
  // A correlation over the longest time tried may as well be due to what the model lacks, and is then not noise.
  const auto short_lived = [&](const NoiseShape& shape) {
    return shape.lasting > 0.0 && shape.lasting_frames < lengths.back();
  };
  if (!set.images && (!short_lived(noise.shape) || noise.lasting_log_evidence < kBeyondDoubt)) return false;

  // Starts at the size that begins to show among this many points, in units of the jitter that makes s at top speed.
  const double unit = pilot_px / top_px_s;
  Dial times{&NoiseShape::jitter_s, {}, nullptr, {0.0}};
  for (double tau = 2.0 * std::pow(2.0 / static_cast<double>(points), 0.25) * unit; tau < 40.0 * unit; tau *= 1.3) {
    times.values.push_back(tau);
  }
  NoiseShape uneven = noise.shape;
  Likelihood with = best;
  std::vector<Dial> all = {times};
  all.insert(all.end(), dials.begin(), dials.end());
  climb(likelihood, all, uneven, with);
  const double least_s = least_filmed_jitter_s(set.images ? top_px_s : 0.0);
  std::vector<OfSpeed> of_speed;
  for (const double tau : times.values) {
    uneven.jitter_s = tau;
    Likelihood there = likelihood.of(uneven);
    const double jitter_s = tau * there.white_px / pilot_px;  // the pilot may hold the jitter of the mean speed
    if (jitter_s < least_filmed_jitter_s(0.0) || jitter_s > 0.5 * step_s) continue;
    of_speed.push_back({tau / unit, jitter_s, there.value - best.value, std::move(there), jitter_s >= least_s});
  }
  if (const OfSpeed* chosen = weigh_speed(of_speed, set.handed_on, noise)) {
    noise.shape = uneven;
    noise.shape.jitter_s = chosen->jitter_s;
    best = chosen->likelihood;
  }
  if (!set.images && !short_lived(noise.shape)) return false;
  set.position_noise = noise;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    TrackedMotion& motion = set.motions[i];
    motion.sd_m = best.own_px[i] * unit_m(motion);
    whiten(motion, noise.shape, set.clips[motion.clip].frame_rate_hz);
  }
  return true;
}

}  // namespace glidelab::diagnose
