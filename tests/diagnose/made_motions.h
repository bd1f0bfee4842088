/// Experiments of tracks for the tests of the diagnosis, by a generator of their own: the classical Runge and Kutta
/// method in steps of 0.2 ms, forces written out here, white noise. Nothing of it comes from diagnose/.
#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/motion/analyze_motion.h"
#include "core/result/results.h"
#include "core/track/track_data.h"

namespace glidelab::tests {

struct MadeGlider {
  double k_n_s_m = 0.93;
  double mu = 0.006;
  double gravity_m_s2 = 9.80665;
};

struct MadeLaunch {
  double mass_kg = 0.4;
  double incline_deg = 4.0;
  double x0_m = 0.3;
  double v0_m_s = -1.1;
  double mu_more = 0.0, k_more_n_s_m = 0.0;  ///< than the glider's
  double inertia = 1.0;                      ///< over the mass that weighs
};

/// What is added: a force in N (mass, x, v, t), what the camera makes of (x, t), which frames it loses, and a force
/// that is recorded with the positions; each may be empty.
struct MadeEffect {
  std::function<double(double mass_kg, double x_m, double v_m_s, double t_s)> force = {};
  std::function<double(double x_m, double t_s)> seen = {};
  std::function<bool(std::size_t clip, std::size_t frame)> lost = {};
  std::function<double(double t_s)> recorded = {};
};

inline std::vector<MadeLaunch> made_launches(const std::vector<double>& masses_kg = {0.335, 0.535}) {
  std::vector<MadeLaunch> launches;
  for (const double mass : masses_kg) {
    launches.push_back({mass, 0.0, 0.5, -1.2});
    launches.push_back({mass, 0.0, -0.5, 1.0});
    launches.push_back({mass, 4.0, 0.3, -1.1});
    launches.push_back({mass, 4.0, -0.6, 1.2});
  }
  return launches;
}

/// Positions every 1/rate seconds. At v = 0 the glider stays where friction holds it.
inline std::vector<double> made_motion(const MadeGlider& glider, const MadeLaunch& launch, const MadeEffect& effect,
                                       std::size_t frames, double rate_hz) {
  const double alpha = launch.incline_deg * std::acos(-1.0) / 180.0, m = launch.mass_kg, g = glider.gravity_m_s2;
  const double friction = (glider.mu + launch.mu_more) * m * g * std::cos(alpha);
  const double drag = glider.k_n_s_m + launch.k_more_n_s_m;
  const auto other = [&](double x, double v, double t) {
    return m * g * std::sin(alpha) - drag * v + (effect.force ? effect.force(m, x, v, t) : 0.0) +
           (effect.recorded ? effect.recorded(t) : 0.0);
  };
  double x = launch.x0_m, v = launch.v0_m_s, sign = v > 0.0 ? 1.0 : -1.0;
  const auto a = [&](double xx, double vv, double t) {
    return (other(xx, vv, t) - sign * friction) / (launch.inertia * m);
  };
  const double step = 2e-4;
  std::vector<double> seen;
  double t = 0.0;
  for (std::size_t k = 0; k < frames; ++k) {
    const double until = static_cast<double>(k) / rate_hz;
    while (t < until - 1e-12) {
      const double h = std::min(step, until - t);
      if (v == 0.0) {
        const double pull = other(x, 0.0, t);
        sign = pull > 0.0 ? 1.0 : -1.0;
        if (std::abs(pull) <= friction) {
          t += h;
          continue;
        }
      }
      const double a1 = a(x, v, t), a2 = a(x + 0.5 * h * v, v + 0.5 * h * a1, t + 0.5 * h);
      const double a3 = a(x + 0.5 * h * (v + 0.5 * h * a1), v + 0.5 * h * a2, t + 0.5 * h);
      const double a4 = a(x + h * (v + 0.5 * h * a2), v + h * a3, t + h);
      const double next = v + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
      if (v != 0.0 && next * v < 0.0) {  // to v = 0 at this acceleration, then on from rest
        const double part = v / (v - next);
        x += 0.5 * part * h * v;
        t += part * h;
        v = 0.0;
        continue;
      }
      x += h * v + h * h / 6.0 * (a1 + a2 + a3);
      v = next;
      t += h;
    }
    seen.push_back(effect.seen ? effect.seen(x, until) : x);
  }
  return seen;
}

struct MadeExperiment {
  core::AnalysisResults results;
  std::vector<core::ClipSetup> setups;
};

/// Analysed as the program does it, from the positions on. Errors of neighbouring positions correlate by `follows`, of
/// the next but one by its square.
inline MadeExperiment made_experiment(const std::vector<MadeLaunch>& launches, const MadeEffect& effect, unsigned seed,
                                      double noise_m = 3e-5, std::size_t frames = 150, double rate_hz = 100.0,
                                      double incline_sd_deg = 0.05, double follows = 0.0,
                                      const MadeGlider& glider = {}) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  MadeExperiment made;
  made.results.gravity_m_s2 = glider.gravity_m_s2;
  made.results.gravity_sd_m_s2 = core::gravity_sd_m_s2(glider.gravity_m_s2);
  for (std::size_t c = 0; c < launches.size(); ++c) {
    core::ClipSetup setup;
    setup.name = "clip" + std::to_string(c);
    setup.track = "none.csv";
    setup.mass_kg = launches[c].mass_kg;
    setup.incline_rad = launches[c].incline_deg * std::acos(-1.0) / 180.0;
    if (incline_sd_deg > 0.0) setup.incline_sd_rad = incline_sd_deg * std::acos(-1.0) / 180.0;
    setup.launched = launches[c].v0_m_s < 0.0 ? core::Launched::up : core::Launched::down;
    setup.group = launches[c].incline_deg == 0.0 ? "level" : "inclined";
    core::TrackData track;
    track.frame_rate_hz = rate_hz;
    std::size_t frame = 0;
    double error = 0.0, kept = 0.0;  // of the error before
    for (const double x : made_motion(glider, launches[c], effect, frames, rate_hz)) {
      if (effect.lost && effect.lost(c, frame++)) continue;
      track.frame.push_back(track.t_s.size());
      track.t_s.push_back(static_cast<double>(track.t_s.size()) / rate_hz);
      error = kept * error + std::sqrt(1.0 - kept * kept) * normal(random);
      kept = follows;
      track.x_m.push_back(x + noise_m * error);
      if (effect.recorded) track.force_n.push_back(effect.recorded(track.t_s.back()));
    }
    track.frame_t_s = track.t_s;
    made.results.clips.push_back(
        core::analyze_motion(setup, track, core::MotionOptions{.lost_frames = core::LostFrameTimes::kept}));
    made.setups.push_back(std::move(setup));
  }
  return made;
}

}  // namespace glidelab::tests
