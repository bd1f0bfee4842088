#include "diagnose/noise/position_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/quantile.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/common_limits.h"
#include "diagnose/fit/score_space.h"
#include "diagnose/noise/noise_likelihood.h"
#include "diagnose/scan/effect_scan.h"
#include "diagnose/tracks/whitening.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kFewestPoints = 80;   // of all motions
constexpr double kWaveShownEvidence = 5.0;  // log evidence
constexpr double kLeastNoiseGain = 1.0;     // log likelihood that one more part of the noise must gain

// It also codes anew what moves and leaves what rests as it was: its errors grow with the speed as those of uneven
// times do. Measured on clips with nothing wrong by two renderers (H.264 of crf 14 to 23, 60 to 240 frames a second, 25
// experiments): at top speed 0.4 to 1.5 of s, and twice 2 and 5, where a marker moves by two pixels a frame at most.
constexpr double kCodecMoves = 1.0, kCodecMovesFactor = 0.8;  // over s; in its logarithm

struct Dial {
  double NoiseShape::*member;
  std::vector<double> values;
  double NoiseShape::*beside = nullptr;  ///< the length that goes with it
  std::vector<double> lengths;
};

/// One after the other, each part of the noise gets what makes the positions most likely, until nothing changes. A part
/// that gains less than kLeastNoiseGain is left out.
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

/// What the likeliest noise gains by its part that lasts, and the evidence over all sizes and lengths.
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
  noise.lasting_log_evidence = log_mean(logs);
}

/// Noise in proportion to the speed, of one size.
struct OfSpeed {
  double at_top = 0.0;  ///< what it makes at top speed, over the pilot's s
  double jitter_s = 0.0;
  double gain = 0.0;  ///< log likelihood, against the likeliest noise without
  Likelihood likelihood;
};

/// Uneven times, of any size alike, against the likeliest noise without, to which a codec's own errors belong. Returns
/// the size that the positions have beyond doubt, whatever makes it; nullptr: none.
const OfSpeed* weigh_speed(const std::vector<OfSpeed>& sizes, bool handed_on, PositionNoise& noise) {
  if (sizes.empty()) return nullptr;
  std::vector<double> uneven, of_codec;
  const OfSpeed *likeliest = nullptr, *codecs = nullptr;
  double codecs_gain = 0.0;
  double weights = 0.0;
  for (const OfSpeed& size : sizes) {
    uneven.push_back(size.gain);
    if (size.gain > (likeliest != nullptr ? likeliest->gain : 0.0)) likeliest = &size;
    const double known = -0.5 * std::pow(std::log(size.at_top / kCodecMoves) / kCodecMovesFactor, 2);
    of_codec.push_back(size.gain + known);
    weights += std::exp(known);
    if (of_codec.back() > codecs_gain) {
      codecs_gain = of_codec.back();
      codecs = &size;
    }
  }
  const auto many = static_cast<double>(sizes.size());
  // Sizes below the least that is tried are as good as none.
  const double codecs_evidence = handed_on ? std::max(0.0, log_mean(of_codec) + std::log(many / weights)) : 0.0;
  noise.jitter_log_evidence = log_mean(uneven) - codecs_evidence;
  if (likeliest != nullptr) {
    noise.jitter_s = likeliest->jitter_s;
    noise.jitter_gain = std::max(0.0, likeliest->gain - (handed_on ? codecs_gain : 0.0));
    noise.jitter_sd_s = noise.jitter_s / std::sqrt(std::max(1.0, 2.0 * likeliest->gain));
  }
  if (noise.jitter_log_evidence > kBeyondDoubt) return likeliest;
  return codecs_evidence > kBeyondDoubt ? codecs : nullptr;
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
    if (set.pictures && motion.along_px.empty()) return false;
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
  if (set.pictures) {
    dials = {{&NoiseShape::pixels, sizes, &NoiseShape::pixels_px, {0.25, 0.4, 0.7}},
             {&NoiseShape::phase, sizes, &NoiseShape::phase_px, {5.0, 20.0, 80.0}}};
  }
  std::vector<double> lengths = {1.0, 2.0, 4.0};
  if (set.handed_on) lengths.push_back(8.0);
  const bool may_last = set.lossy || !set.pictures;
  if (may_last) dials.push_back({&NoiseShape::lasting, sizes, &NoiseShape::lasting_frames, lengths});
  PositionNoise noise;
  Likelihood best = likelihood.of(noise.shape);
  climb(likelihood, dials, noise.shape, best);
  if (may_last) weigh_lasting(likelihood, dials.back(), noise);
  // What lasts for the longest that is tried may as well be what the model lacks: that is no noise.
  const auto short_lived = [&](const NoiseShape& shape) {
    return shape.lasting > 0.0 && shape.lasting_frames < lengths.back();
  };
  if (!set.pictures && (!short_lived(noise.shape) || noise.lasting_log_evidence < kBeyondDoubt)) return false;

  // From what begins to show among so many points, in units of what s makes at top speed.
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
  std::vector<OfSpeed> of_speed;
  for (const double tau : times.values) {
    uneven.jitter_s = tau;
    Likelihood there = likelihood.of(uneven);
    const double jitter_s = tau * there.white_px / pilot_px;  // the pilot may hold the jitter of the mean speed
    if (jitter_s < kLeastFilmedJitter_s || jitter_s > 0.5 * step_s) continue;
    of_speed.push_back({tau / unit, jitter_s, there.value - best.value, std::move(there)});
  }
  if (const OfSpeed* chosen = weigh_speed(of_speed, set.handed_on, noise)) {
    noise.shape = uneven;
    noise.shape.jitter_s = chosen->jitter_s;
    best = chosen->likelihood;
  }
  if (!set.pictures && !short_lived(noise.shape)) return false;
  set.position_noise = noise;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    TrackedMotion& motion = set.motions[i];
    motion.sd_m = best.own_px[i] * unit_m(motion);
    whiten(motion, noise.shape, set.clips[motion.clip].frame_rate_hz);
  }
  return true;
}

}  // namespace glidelab::diagnose
