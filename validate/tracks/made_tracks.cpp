#include "validate/tracks/made_tracks.h"

#include <algorithm>
#include <cassert>
#include <numbers>
#include <random>

#include "base/parallel.h"
#include "core/motion/analyze_motion.h"
#include "core/motion/join_configurations.h"
#include "render/camera/frame_clock.h"
#include "render/scenario/clip_motion.h"
#include "sim/motion/simulate.h"
#include "sim/motion/true_parameters.h"

namespace glidelab::validate {
namespace {

constexpr double kDegreesPerRad = 180.0 / std::numbers::pi;

core::Launched launched_of(sim::Launched launched) {
  switch (launched) {
    case sim::Launched::up:
      return core::Launched::up;
    case sim::Launched::down:
      return core::Launched::down;
    case sim::Launched::released:
      break;
  }
  return core::Launched::released;
}

TrueConfiguration true_configuration(const sim::ConfigurationSetup& setup) {
  TrueConfiguration truth;
  truth.name = setup.name;
  truth.mass_kg = setup.body.mass_kg;
  truth.stated_incline_deg = setup.stated_incline_rad * kDegreesPerRad;
  truth.group = setup.group;
  if (const auto law = sim::linear_law(setup.body)) {
    truth.k_over_m_1_s = law->k_over_m_1_s;
    truth.mu = law->mu;
  }
  truth.alpha_deg = setup.body.incline_rad * kDegreesPerRad;
  truth.v_lim_m_s = sim::limit_speed_m_s(setup.body);
  for (const sim::MotionSetup& motion : setup.motions) truth.clips.push_back(motion.name);
  return truth;
}

core::ClipSetup clip_setup(const sim::ConfigurationSetup& configuration, const sim::MotionSetup& motion) {
  core::ClipSetup setup;
  setup.name = motion.name;
  setup.mass_kg = configuration.body.mass_kg;
  setup.incline_rad = configuration.stated_incline_rad;
  setup.incline_sd_rad = configuration.stated_incline_sd_rad;
  setup.launched = launched_of(motion.launched);
  setup.group = configuration.group;
  return setup;
}

/// When the frames of the file were taken, and what the file says.
struct FrameTimes {
  std::vector<double> true_s;
  std::vector<double> stated_s;
};

FrameTimes frame_times(const render::Recording& recording, const render::FrameClock& clock, std::size_t slots) {
  FrameTimes times;
  double last_s = 0.0;
  for (std::size_t slot = 0; slot < slots; ++slot) {
    const render::FrameFate fate = clock.fate(slot);
    if (fate == render::FrameFate::dropped) continue;
    if (fate == render::FrameFate::recorded) last_s = clock.start_s(slot);
    const auto j = static_cast<double>(times.true_s.size());
    times.true_s.push_back(last_s);
    times.stated_s.push_back(recording.clock.variable ? clock.stamp_s(slot) - clock.stamp_s(0)
                                                      : j / recording.frame_rate_hz);
  }
  return times;
}

}  // namespace

MadeTracks make_tracks(const render::Scenario& scenario, std::uint64_t seed) {
  MadeTracks made;
  made.gravity_m_s2 = scenario.motion.gravity_m_s2;
  made.truth.name = scenario.motion.name;
  made.truth.seed = seed;
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    made.truth.configurations.push_back(true_configuration(configuration));
    for (const sim::MotionSetup& motion : configuration.motions) {
      const render::FrameClock clock(scenario.recording.clock, scenario.recording.frame_rate_hz, seed,
                                     static_cast<std::uint32_t>(made.tracks.size()));
      const FrameTimes times = frame_times(scenario.recording, clock, render::frame_count(scenario.recording, motion));
      // A duplicated frame has the instant of the one before: simulate() wants each once.
      std::vector<double> instants = times.true_s;
      instants.erase(std::unique(instants.begin(), instants.end()), instants.end());
      const sim::Trajectory trajectory = sim::simulate(configuration.body, motion.x0_m, motion.v0_m_s, instants);
      TrueClip truth;
      truth.name = motion.name;
      truth.configuration = configuration.name;
      core::TrackData track;
      std::size_t at = 0;
      for (std::size_t j = 0; j < times.true_s.size(); ++j) {
        if (times.true_s[j] > instants[at]) ++at;
        const sim::State& state = trajectory.states[at];
        truth.t_s.push_back(state.t_s);
        truth.x_m.push_back(state.x_m);
        truth.v_m_s.push_back(state.v_m_s);
        truth.a_m_s2.push_back(state.a_m_s2);
        track.frame.push_back(j);
      }
      track.x_m = truth.x_m;
      track.t_s = track.frame_t_s = times.stated_s;
      track.frame_rate_hz = scenario.recording.frame_rate_hz;
      made.truth.clips.push_back(std::move(truth));
      made.tracks.push_back(std::move(track));
      made.setups.push_back(clip_setup(configuration, motion));
    }
  }
  return made;
}

MadeTracks with_noise(const MadeTracks& clean, double noise_sd_m, std::uint64_t seed) {
  return with_noise(clean, std::vector<double>(clean.tracks.size(), noise_sd_m), seed);
}

MadeTracks with_noise(const MadeTracks& clean, const std::vector<double>& noise_sd_m, std::uint64_t seed) {
  assert(noise_sd_m.size() == clean.tracks.size());
  MadeTracks noisy = clean;
  for (std::size_t c = 0; c < noisy.tracks.size(); ++c) {
    std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                           static_cast<std::uint32_t>(c)};
    std::mt19937_64 engine(sequence);
    std::normal_distribution<double> deviate(0.0, std::max(noise_sd_m[c], 1e-300));
    const std::vector<double>& true_s = clean.truth.clips[c].t_s;
    std::vector<double>& x_m = noisy.tracks[c].x_m;
    for (std::size_t i = 0; i < x_m.size(); ++i) {
      const bool again = i > 0 && true_s[i] == true_s[i - 1];
      x_m[i] = again ? x_m[i - 1] : x_m[i] + (noise_sd_m[c] > 0.0 ? deviate(engine) : 0.0);
    }
  }
  return noisy;
}

core::AnalysisResults analyze_tracks(const MadeTracks& made, std::optional<double> bandwidth_s, int jobs) {
  return analyze_tracks(made, core::MotionOptions{.bandwidth_s = bandwidth_s}, jobs);
}

core::AnalysisResults analyze_tracks(const MadeTracks& made, const core::MotionOptions& how, int jobs) {
  core::AnalysisResults results;
  results.estimator = core::name_of(how.lines);
  results.gravity_m_s2 = made.gravity_m_s2;
  results.clips.resize(made.tracks.size());
  base::for_each_parallel(made.tracks.size(), jobs, [&](std::size_t c) {
    results.clips[c] = core::analyze_motion(made.setups[c], made.tracks[c], how);
    results.clips[c].experiment = made.truth.name;
  });
  results.configurations = core::join_configurations(made.setups, results.clips, made.gravity_m_s2, how.lines);
  return results;
}

}  // namespace glidelab::validate
