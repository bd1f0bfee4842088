#include "validate/film/twin_motions.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "core/motion/analyze_motion.h"
#include "diagnose/effects/effect_list.h"
#include "render/scenario/scenario.h"
#include "validate/made_tracks/made_tracks.h"

namespace glidelab::validate {
namespace {

/// Interpolates by the cubic through the four nearest of the track's own times; empty outside them.
std::optional<double> at_time(const core::TrackData& track, double t_s) {
  constexpr double kSameTime_s = 1e-9;  // s: rounding of times
  const auto& times = track.t_s;
  if (times.size() < 4 || t_s < times.front() - kSameTime_s || t_s > times.back() + kSameTime_s) return {};
  const auto after = std::lower_bound(times.begin(), times.end(), t_s - kSameTime_s) - times.begin();
  const auto from = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(after - 2, 0, std::ssize(times) - 4));
  double x = 0.0;
  for (std::size_t i = from; i < from + 4; ++i) {
    double weight = 1.0;
    for (std::size_t j = from; j < from + 4; ++j) {
      if (j != i) weight *= (t_s - times[j]) / (times[i] - times[j]);
    }
    x += weight * track.x_m[i];
  }
  return x;
}

double size_of(const diagnose::Diagnosis& diagnosis, std::string_view id, std::string_view key) {
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    for (const diagnose::DiagnosedParameter& parameter : effect.parameters) {
      if (effect.id == id && parameter.key == key) return parameter.value;
    }
  }
  return 0.0;
}

/// x as seen with a wrong scale or perspective, if one is named: (1 + e) x and x / (1 + p x), x of the data.
void see(const diagnose::Diagnosis& diagnosis, MadeTracks& made) {
  const double e = size_of(diagnosis, diagnose::ids::scale_error, "e"),
               p = size_of(diagnosis, diagnose::ids::perspective_error, "p_1_m");
  for (core::TrackData& track : made.tracks) {
    for (double& x_m : track.x_m) {
      const double there = diagnosis.twin_from_m + x_m;
      x_m = (1.0 + e) * there / (1.0 + p * there) - diagnosis.twin_from_m;
    }
  }
}

}  // namespace

std::vector<TwinMotion> twin_motions(const diagnose::Diagnosis& diagnosis, std::uint64_t seed) {
  render::Scenario scenario = render::read_scenario(diagnosis.twin, "twin.toml", render::ScenarioChecks::values);
  scenario.recording.clock.dropped_fraction = 0.0;
  scenario.recording.clock.jitter_s = 0.0;
  MadeTracks exact = make_tracks(scenario, seed);
  see(diagnosis, exact);
  std::vector<TwinMotion> motions;
  std::vector<double> noise_m(exact.tracks.size(), 0.0);
  const auto place = [&](const std::string& clip) {
    const auto at = std::find_if(exact.setups.begin(), exact.setups.end(),
                                 [&](const core::ClipSetup& setup) { return setup.name == clip; });
    return static_cast<std::size_t>(at - exact.setups.begin());
  };
  for (const diagnose::MeasuredMotion& data : diagnosis.measured) noise_m.at(place(data.clip)) = data.noise_m;
  const MadeTracks noisy = with_noise(exact, noise_m, seed);
  for (const diagnose::MeasuredMotion& data : diagnosis.measured) {
    const std::size_t c = place(data.clip);
    TwinMotion motion;
    motion.clip = data.clip;
    motion.v_m_s = data.v_m_s;
    motion.a_m_s2 = data.a_m_s2;
    for (std::size_t p = 0; p < data.t_s.size(); ++p) {
      const double t_s = data.t_s[p] - data.start_s;
      const auto x = at_time(exact.tracks[c], t_s), with = at_time(noisy.tracks[c], t_s);
      if (!x || !with) continue;
      motion.t_s.push_back(t_s);
      motion.rest_m.push_back(data.x_m[p] - diagnosis.twin_from_m - *x);
      motion.noise_m.push_back(*with - *x);
    }
    const core::ClipResult result = core::analyze_motion(
        noisy.setups[c], noisy.tracks[c],
        core::MotionOptions{.bandwidth_s = data.bandwidth_s, .lost_frames = core::LostFrameTimes::kept});
    for (const core::MotionPoint& point : result.motion) {
      if (!point.smoothed || point.left_out != core::LeftOut::used) continue;
      motion.twin_v_m_s.push_back(point.v_m_s);
      motion.twin_a_m_s2.push_back(point.a_m_s2);
    }
    motions.push_back(std::move(motion));
  }
  return motions;
}

}  // namespace glidelab::validate
