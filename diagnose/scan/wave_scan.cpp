#include "diagnose/scan/wave_scan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "diagnose/fit/effect_ranges.h"

namespace glidelab::diagnose {
namespace {

constexpr double kLeastWave_px = 0.002;  // in images: what finding a marker among pixels errs by itself
constexpr double kTurn = 2.0 * std::numbers::pi;

/// Score and information of (sin, cos) of one frequency in one motion.
struct WavePart {
  double ss = 0.0, sc = 0.0, cc = 0.0, rs = 0.0, rc = 0.0;
};

std::vector<WavePart> wave_parts(const ScoreSpace& space, double f) {
  std::vector<WavePart> parts;
  for (std::size_t i = 0; i < space.set().motions.size(); ++i) {
    const auto& t = space.set().motions[i].t_s;
    const auto n = static_cast<Eigen::Index>(t.size());
    Eigen::VectorXd s(n), c(n);
    for (Eigen::Index p = 0; p < n; ++p) {
      s[p] = std::sin(kTurn * f * t[static_cast<std::size_t>(p)]);
      c[p] = std::cos(kTurn * f * t[static_cast<std::size_t>(p)]);
    }
    s = space.own_rest(i, s);
    c = space.own_rest(i, c);
    const auto r = space.residual().rest.segment(space.offset(i), n);
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
    // Three decades from what begins to show and can be trusted.
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
  found.log_evidence = log_mean(logs);
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
  for (double f = hz.low; f < hz.high; f += 0.3 / longest) {
    const WaveEvidence at = weigh_wave(wave_parts(space, f), least_m);
    logs.push_back(at.log_evidence);
    if (at.gain > wave.gain) wave = {at.gain, 0.0, at.size_m, f};
  }
  if (!logs.empty()) wave.log_evidence = log_mean(logs);
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
  const bool force = info.law.moves();  // else what is seen swings
  std::size_t i = 0;
  double amplitude = wave.size_m;
  for (const WavePart& part : wave_parts(space, wave.f_hz)) {
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

}  // namespace glidelab::diagnose
