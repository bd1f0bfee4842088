#include "validate/made_tracks/made_tracks.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <random>

#include "base/math/angles.h"
#include "core/math/even_times.h"
#include "core/motion/configurations.h"
#include "core/pictures/marker/marker_fit.h"
#include "render/camera/frame_clock.h"
#include "render/scenario/clip_motion.h"
#include "render/scenario/scene.h"
#include "render/video/video_writer.h"
#include "sim/motion/motion_scenario.h"
#include "sim/motion/simulate.h"
#include "validate/random_use.h"

namespace glidelab::validate {
namespace {

/// Electrons of one pixel.
struct Pixel {
  double amplitude_e = 0.0;  ///< marker above wall
  double variance_e2 = 0.0;
};

Pixel pixel_of(const render::Scenario& scenario, const WithoutLimit& without) {
  const render::Sensor& sensor = scenario.sensor;
  const double white_e = render::electrons_of_white(scenario);
  const double marker_e = std::min(white_e * scenario.marker.reflectance, sensor.full_well_e);
  const double wall_e = std::min(white_e * scenario.scene.wall_albedo, sensor.full_well_e);
  Pixel pixel;
  pixel.amplitude_e = marker_e - wall_e;
  if (!without.shot_noise) pixel.variance_e2 += 0.5 * (marker_e + wall_e);
  if (!without.camera_noise) {
    const int dropped_bits = sensor.converter_bits.value_or(sensor.bit_depth) - sensor.bit_depth;
    const double step_e = std::ldexp(1.0, dropped_bits) / sensor.gain_dn_per_e;
    pixel.variance_e2 += sensor.pixels.dark_signal_e_s * scenario.recording.exposure_s;
    pixel.variance_e2 += sensor.read_noise_e * sensor.read_noise_e + step_e * step_e / 12.0;
    pixel.variance_e2 += 0.5 * sensor.pixels.prnu * sensor.pixels.prnu * (marker_e * marker_e + wall_e * wall_e);
    pixel.variance_e2 += sensor.pixels.dsnu_e * sensor.pixels.dsnu_e;
  }
  return pixel;
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

/// Mean information over four positions of the centre within a pixel.
double centre_sd_px(core::DiscImage disc) {
  double information = 0.0;
  const double reach_px = disc.radius_px + 3.0 * disc.blur_px + 2.0;
  for (const double u : {0.1, 0.4}) {
    for (const double v : {0.0, 0.3}) {
      disc.u = u;
      disc.v = v;
      information += 0.25 / std::pow(core::least_centre_sd_px(disc, reach_px), 2);
    }
  }
  return 1.0 / std::sqrt(information);
}

}  // namespace

std::vector<double> predicted_noise_m(const render::Scenario& scenario, const Truth& truth,
                                      const WithoutLimit& without) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  constexpr double kSharp_px = 0.1;        // no lens is sharper; the bound needs a finite edge
  constexpr double kSmallest_px = 1.0;     // radius: below it a disc is a dot without an edge of its own
  constexpr double kNegligible_e2 = 1e-6;  // used when all noise is removed
  const Pixel pixel = pixel_of(scenario, without);
  std::vector<double> noise_m;
  for (const TrueClip& clip : truth.clips) {
    const auto configuration =
        std::find_if(scenario.motion.configurations.begin(), scenario.motion.configurations.end(),
                     [&](const sim::ConfigurationSetup& setup) { return setup.name == clip.configuration; });
    const double middle_m = 0.5 * (*std::min_element(clip.x_m.begin(), clip.x_m.end()) +
                                   *std::max_element(clip.x_m.begin(), clip.x_m.end()));
    const Eigen::Vector3d marker_C =
        scenario.camera.X_WC.inverse() * render::marker_position_W(scenario, configuration->body.incline_rad, middle_m);
    const double px_per_m = without.finer * scenario.camera.focal_px.x() / marker_C.z();
    core::DiscImage disc;
    disc.radius_px = 0.5 * scenario.marker.diameter_m * px_per_m;
    if (!(pixel.amplitude_e > 0.0) || disc.radius_px < kSmallest_px) {
      noise_m.push_back(kNever);
      continue;
    }
    const double smear_px = without.motion_blur ? 0.0 : rms(clip.v_m_s) * scenario.recording.exposure_s * px_per_m;
    disc.blur_px = std::sqrt(kSharp_px * kSharp_px + smear_px * smear_px / 12.0);
    disc.amplitude = pixel.amplitude_e;
    disc.noise_sd = std::sqrt(std::max(pixel.variance_e2, kNegligible_e2));
    noise_m.push_back(centre_sd_px(disc) / px_per_m);
  }
  return noise_m;
}

namespace {

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
  truth.stated_incline_deg = setup.stated_incline_rad * base::kDegreesPerRad;
  truth.group = setup.group;
  if (const auto law = sim::linear_law(setup.body)) {
    truth.k_over_m_1_s = law->k_over_m_1_s;
    truth.mu = law->mu;
  }
  truth.alpha_deg = setup.body.incline_rad * base::kDegreesPerRad;
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

/// When the frames of the file were taken, and the times that an analysis takes from the file.
struct FrameTimes {
  std::vector<double> true_s;
  std::vector<double> read_s;
  std::optional<core::EvenTimes> even = {};  ///< instead of the file's time stamps
};

FrameTimes frame_times(const render::Scenario& scenario, const render::FrameClock& clock, std::size_t slots) {
  const render::Recording& recording = scenario.recording;
  FrameTimes times;
  double last_s = 0.0;
  for (std::size_t slot = 0; slot < slots; ++slot) {
    const render::FrameFate fate = clock.fate(slot);
    if (fate == render::FrameFate::dropped) continue;
    if (fate == render::FrameFate::recorded) last_s = clock.start_s(slot);
    const auto j = static_cast<double>(times.true_s.size());
    times.true_s.push_back(last_s);
    times.read_s.push_back(recording.clock.variable
                               ? render::stored_stamp_s(clock.stamp_s(slot), scenario.codec, scenario.compression)
                               : j / recording.frame_rate_hz);
  }
  if (recording.clock.variable) times.even = core::even_times(times.read_s);
  if (times.even) times.read_s = times.even->t_s;
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
      const FrameTimes times = frame_times(scenario, clock, render::frame_count(scenario.recording, motion));
      // A duplicated frame has the same instant as the previous one: simulate() needs each instant once.
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
      track.t_s = track.frame_t_s = times.read_s;
      if (times.even) {
        track.notes.emplace_back(core::EvenStamps{times.even->tick_s, times.even->step_s, times.even->half_width_s});
      }
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
    std::mt19937_64 engine = random_engine(RandomUse::by_number, seed, c);
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
  core::AnalysisResults results = core::analyze_tracks(made.setups, made.tracks, made.gravity_m_s2, how, jobs);
  for (core::ClipResult& clip : results.clips) clip.experiment = made.truth.name;
  return results;
}

}  // namespace glidelab::validate
