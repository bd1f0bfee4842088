#include "validate/study/certify/recording_twin.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <random>
#include <set>
#include <string_view>
#include <utility>

#include "base/errors.h"
#include "core/math/quantile.h"
#include "core/motion/lines/line_fit.h"
#include "diagnose/effects/effect_list.h"
#include "sim/motion/simulate.h"
#include "validate/random_use.h"
#include "validate/study/certify/scattered_body.h"

namespace glidelab::validate {
namespace {

constexpr std::size_t kFewestPlaces = 8;  // of a marker: fewer do not define a line (twin_camera.h)

bool is_filmed(const core::AnalysisResults& results, const std::vector<core::Experiment>& folders) {
  std::size_t i = 0;
  for (const core::Experiment& folder : folders) {
    for (std::size_t c = 0; c < folder.clips.size(); ++c) {
      const core::ClipResult& clip = results.clips.at(i++);
      if (!folder.camera || !folder.marker || !clip.images || clip.sightings.size() < kFewestPlaces) return false;
    }
  }
  return i > 0;
}

/// Variance and autocovariance as modelled by estimate_noise(), without the contribution of rounding.
ClipNoise noise_of(const core::ClipResult& clip) {
  ClipNoise noise;
  noise.rounding_m = clip.rounding_m.value_or(0.0);
  const std::vector<double>& covariance = clip.noise_autocovariance_m2;
  double variance = clip.position_noise_m * clip.position_noise_m;
  if (covariance.size() > 2 && covariance[1] > 0.0 && covariance[2] > 0.0) {
    noise.rho = std::min(covariance[2] / covariance[1], 0.999);
    noise.lasting_m = std::sqrt(covariance[1] / noise.rho);
    variance = covariance[0] - noise.lasting_m * noise.lasting_m;
  }
  variance -= noise.rounding_m * noise.rounding_m / 12.0;
  noise.white_m = std::sqrt(std::max(0.0, variance));
  return noise;
}

double size_of(const diagnose::Diagnosis& diagnosis, std::string_view id, std::string_view key) {
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    for (const diagnose::DiagnosedParameter& parameter : effect.parameters) {
      if (effect.id == id && parameter.key == key) return parameter.value;
    }
  }
  return 0.0;
}

/// The noise of the positions of every clip of the scenario, in the scenario's order.
std::vector<ClipNoise> clips_of(const core::AnalysisResults& results, const diagnose::Diagnosis& diagnosis,
                                const render::Scenario& scenario) {
  std::vector<ClipNoise> clips;
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) {
      const auto data = std::find_if(diagnosis.measured.begin(), diagnosis.measured.end(),
                                     [&](const auto& one) { return one.clip == motion.name; });
      assert(data != diagnosis.measured.end());
      const core::ClipResult& clip = results.clips.at(data->recorded);
      ClipNoise noise = noise_of(clip);
      for (const core::MotionPoint& point : clip.motion) {
        const double t_s = point.t_s - clip.motion.front().t_s;  // as the motions of a diagnosis count
        if (!point.measured_m || t_s < data->t_s.front() || t_s > data->t_s.back()) continue;
        noise.frame_s.push_back(t_s - data->start_s);
      }
      clips.push_back(std::move(noise));
    }
  }
  return clips;
}

/// Bodies and starts of the explanations that can be expressed as a scenario; cameras and durations are those of the
/// first one.
std::vector<TwinExplanation> explanations_of(const diagnose::Diagnosis& diagnosis, const render::Scenario& scenario) {
  std::vector<TwinExplanation> explanations;
  for (const diagnose::LikelyTwin& likely : diagnosis.likely_twins) {
    TwinExplanation one{
        scenario.motion.configurations, likely.probability, likely.ids, likely.q_m2_s3, likely.force_m_s2, likely.drag};
    if (!explanations.empty()) {
      std::vector<sim::ConfigurationSetup> own;
      try {
        own = render::read_scenario(likely.toml, "another explanation", render::ScenarioChecks::values)
                  .motion.configurations;
      } catch (const base::InputError&) {  // a drag below zero, for instance
        continue;
      }
      for (std::size_t c = 0; c < own.size(); ++c) {
        one.configurations[c].body = own[c].body;
        for (std::size_t m = 0; m < own[c].motions.size(); ++m) {
          one.configurations[c].motions[m].x0_m = own[c].motions[m].x0_m;
          one.configurations[c].motions[m].v0_m_s = own[c].motions[m].v0_m_s;
        }
      }
    }
    explanations.push_back(std::move(one));
  }
  return explanations;
}

}  // namespace

double median_noise(const core::AnalysisResults& results) {
  std::vector<double> noise_m;
  for (const core::ClipResult& clip : results.clips) noise_m.push_back(clip.position_noise_m);
  return core::median_of(std::move(noise_m));
}

void scale_noise(render::Sensor& sensor, double factor) {
  sensor.full_well_e /= factor * factor;
  sensor.gain_dn_per_e *= factor * factor;
  sensor.read_noise_e /= factor;
}

namespace {

/// For a filmed recording it is not known whether the remainder comes from the clips or from filming.
void drop_remainders(RecordingTwin& twin) {
  bool any = false;
  for (TwinExplanation& one : twin.explanations) {
    any = any || !one.leaves_nothing();
    one.q_m2_s3 = one.force_m_s2 = one.drag = 0.0;
  }
  if (any) twin.without.emplace_back(lacking::ClipScatter{});
}

}  // namespace

RecordingTwin twin_of_recording(const core::AnalysisResults& results, const diagnose::Diagnosis& diagnosis,
                                const std::vector<core::Experiment>& folders) {
  RecordingTwin twin;
  constexpr const char* kName = "twin of the recording";
  twin.scenario = render::read_scenario(diagnosis.twin, kName, render::ScenarioChecks::values);
  twin.by_scale = std::ranges::any_of(folders, [](const core::Experiment& folder) { return folder.scale.has_value(); });
  if (is_filmed(results, folders)) {
    try {
      const auto checks = twin.by_scale ? render::ScenarioChecks::clips : render::ScenarioChecks::all;
      twin.scenario = render::read_scenario(diagnosis.twin, kName, checks);
      twin.filmed = true;
      const bool has_pattern =
          std::ranges::any_of(folders, [](const auto& folder) { return folder.calibration.has_value(); });
      if (twin.by_scale && has_pattern) twin.without.emplace_back(lacking::Pattern{});
    } catch (const base::InputError& error) {  // the camera of a scenario cannot see it
      twin.without.emplace_back(lacking::Images{error.what()});
    }
  }
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) twin.causes.push_back(effect.id);
  for (const diagnose::TwinLack& lack : diagnosis.twin_lacks) {
    std::erase(twin.causes, lack.what);
    twin.without.emplace_back(lacking::Inexpressible{lack.what, lack.why});
  }
  std::set<std::size_t> recorded;
  for (const diagnose::MeasuredMotion& motion : diagnosis.measured) recorded.insert(motion.recorded);
  twin.recorded_clips = recorded.size();
  twin.explanations = explanations_of(diagnosis, twin.scenario);
  twin.noise_m = median_noise(results);
  for (const core::ClipResult& clip : results.clips) {
    twin.scale_sd_relative = std::max(twin.scale_sd_relative, clip.scale_sd_relative);
  }
  twin.from_m = diagnosis.twin_from_m;
  if (!twin.filmed) {
    twin.scale_error = size_of(diagnosis, diagnose::ids::scale_error, "e");
    twin.perspective_1_m = size_of(diagnosis, diagnose::ids::perspective_error, "p_1_m");
    twin.clips = clips_of(results, diagnosis, twin.scenario);
    return twin;
  }
  drop_remainders(twin);
  if (!results.calibrations.empty()) {
    constexpr std::size_t kFewest = 3, kMost = 99;  // limits of a scenario
    twin.scenario.pattern.views = static_cast<int>(std::clamp(results.calibrations.front().views_used, kFewest, kMost));
  }
  return twin;
}

std::size_t explanation_of(const RecordingTwin& twin, std::uint64_t seed) {
  std::vector<double> probabilities;
  for (const TwinExplanation& one : twin.explanations) probabilities.push_back(std::max(0.0, one.probability));
  if (probabilities.size() < 2) return 0;
  std::mt19937_64 engine = random_engine(RandomUse::twin_explanation, seed);
  return std::discrete_distribution<std::size_t>(probabilities.begin(), probabilities.end())(engine);
}

namespace {

/// Whether frames are lost or unevenly spaced, as named by the diagnosis: they then differ in every twin.
bool has_uneven_clock(const render::Scenario& scenario) {
  const render::ClockSetup& clock = scenario.recording.clock;
  return clock.jitter_s > 0.0 || clock.dropped_fraction > 0.0 || clock.duplicated_fraction > 0.0;
}

/// K/m and mu of the viscous and Coulomb terms if further forces act: the law without the named causes.
void add_own_law(const render::Scenario& scenario, Truth& truth) {
  for (std::size_t c = 0; c < truth.configurations.size(); ++c) {
    TrueConfiguration& configuration = truth.configurations[c];
    if (configuration.k_over_m_1_s || configuration.mu) continue;
    const sim::Body& body = scenario.motion.configurations[c].body;
    sim::LinearLaw law;
    for (const auto& term : body.forces) {
      const std::optional<sim::LinearShare> share = term->linear();
      if (!share) continue;
      law.k_over_m_1_s += share->k_n_s_m / body.mass_kg;
      law.mu += share->mu;
    }
    if (law.k_over_m_1_s > 0.0) configuration.k_over_m_1_s = law.k_over_m_1_s;
    if (law.mu > 0.0) configuration.mu = law.mu;
  }
}

/// The scenario with the motions of an explanation.
render::Scenario explained(const RecordingTwin& twin, std::size_t explanation) {
  render::Scenario scenario = twin.scenario;
  if (!twin.explanations.empty()) scenario.motion.configurations = twin.explanations[explanation].configurations;
  return scenario;
}

/// Keeps only the viscous and the Coulomb friction.
void take_out_causes(render::Scenario& scenario) {
  for (sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    std::erase_if(configuration.body.forces, [](const auto& term) { return !term->linear(); });
  }
}

render::Scenario changed(const RecordingTwin& twin, const TwinChange& change, std::uint64_t seed, double clock_ppm) {
  render::Scenario scenario = explained(twin, explanation_of(twin, seed));
  scenario.recording.clock.rate_error_ppm += clock_ppm;
  scenario.marker.diameter_m *= change.marker;
  if (change.lossless) scenario.codec = render::Codec::magicyuv;
  if (change.noise != 1.0) scale_noise(scenario.sensor, change.noise);
  if (change.nominal) take_out_causes(scenario);
  if (change.twice) {
    for (sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
      const std::vector<sim::MotionSetup> once = configuration.motions;
      for (sim::MotionSetup motion : once) {
        motion.name += "-again";
        configuration.motions.push_back(std::move(motion));
      }
    }
  }
  return scenario;
}

/// The noise of every clip of the scenario, as in changed().
std::vector<ClipNoise> changed_clips(const RecordingTwin& twin, const TwinChange& change) {
  std::vector<ClipNoise> clips;
  std::size_t at = 0;
  for (const sim::ConfigurationSetup& configuration : twin.scenario.motion.configurations) {
    const auto first = twin.clips.begin() + static_cast<std::ptrdiff_t>(at);
    at += configuration.motions.size();
    for (int k = 0; k < (change.twice ? 2 : 1); ++k) {
      clips.insert(clips.end(), first, first + static_cast<std::ptrdiff_t>(configuration.motions.size()));
    }
  }
  for (ClipNoise& clip : clips) {
    clip.white_m *= change.noise;
    clip.lasting_m *= change.noise;
    if (change.unrounded) clip.rounding_m = 0.0;
    if (!change.double_rate) continue;
    std::vector<double> twice;
    for (const double t_s : clip.frame_s) {
      if (!twice.empty()) twice.push_back(0.5 * (twice.back() + t_s));
      twice.push_back(t_s);
    }
    clip.frame_s = std::move(twice);
    clip.rho = std::sqrt(clip.rho);  // the correlation time stays the same
  }
  return clips;
}

/// Computes the clip at its recorded times, according to this twin's clock.
void move_at(const sim::Body& body, const sim::MotionSetup& motion, const std::vector<double>& frame_s, double rate,
             TrueClip& truth, core::TrackData& track) {
  truth.t_s.clear();
  for (const double t_s : frame_s) truth.t_s.push_back(t_s / rate);
  const sim::Trajectory trajectory = sim::simulate(body, motion.x0_m, motion.v0_m_s, truth.t_s);
  truth.x_m.clear();
  truth.v_m_s.clear();
  truth.a_m_s2.clear();
  track.frame.clear();
  for (const sim::State& state : trajectory.states) {
    truth.x_m.push_back(state.x_m);
    truth.v_m_s.push_back(state.v_m_s);
    truth.a_m_s2.push_back(state.a_m_s2);
    track.frame.push_back(track.frame.size());
  }
  track.x_m = truth.x_m;
  track.t_s = track.frame_t_s = frame_s;
}

void add_errors(const RecordingTwin& twin, const ClipNoise& noise, double scale, std::uint64_t seed, std::size_t clip,
                std::vector<double>& x_m) {
  std::mt19937_64 engine = random_engine(RandomUse::twin_noise, seed, clip);
  std::normal_distribution<double> deviate(0.0, 1.0);
  double lasting = deviate(engine);
  const double fresh = std::sqrt(1.0 - noise.rho * noise.rho);
  for (double& x : x_m) {
    const double there = twin.from_m + x;
    x = scale * (1.0 + twin.scale_error) * there / (1.0 + twin.perspective_1_m * there) - twin.from_m;
    x += noise.white_m * deviate(engine) + noise.lasting_m * lasting;
    lasting = noise.rho * lasting + fresh * deviate(engine);
    if (noise.rounding_m > 0.0) x = noise.rounding_m * std::round(x / noise.rounding_m);
  }
}

MadeTracks simulated(const RecordingTwin& twin, const TwinChange& change, const render::Scenario& scenario,
                     double scale, std::uint64_t seed) {
  MadeTracks made = make_tracks(scenario, seed);
  const std::vector<ClipNoise> clips = changed_clips(twin, change);
  const double rate = 1.0 + 1e-6 * scenario.recording.clock.rate_error_ppm;
  std::size_t c = 0;
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) {
      if (!has_uneven_clock(scenario))
        move_at(configuration.body, motion, clips[c].frame_s, rate, made.truth.clips[c], made.tracks[c]);
      add_errors(twin, clips[c], scale, seed, c, made.tracks[c].x_m);
      made.tracks[c].scale_sd_relative = change.camera_known ? 0.0 : twin.scale_sd_relative;
      if (change.double_rate) made.tracks[c].frame_rate_hz *= 2.0;
      ++c;
    }
  }
  return made;
}

}  // namespace

namespace {

/// Displacements at these times due to a white acceleration of spectral density q, in the motion of a body with these
/// speeds, whose drag takes the additional speed away.
std::vector<double> wander(const std::vector<double>& t_s, const sim::Trajectory& motion, const sim::Body& body,
                           double q_m2_s3, std::mt19937_64& engine) {
  std::normal_distribution<double> deviate(0.0, 1.0);
  std::vector<double> x_m;
  double x = 0.0, v = 0.0;
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    // A step of white acceleration gives v the variance q h, x the variance q h³/3, and both the covariance q h²/2.
    const double h = i > 0 ? t_s[i] - t_s[i - 1] : 0.0, root = std::sqrt(q_m2_s3 * h);
    const double a = deviate(engine), b = deviate(engine);
    x += v * h + root * h * (0.5 * a + b / std::sqrt(12.0));
    v = v * std::exp(-drag_rate_1_s(body, motion.states[i].v_m_s) * h) + root * a;
    x_m.push_back(x);
  }
  return x_m;
}

/// Adds to the positions the change in x due to the remainder.
void add_remainder(const TwinExplanation& explanation, const render::Scenario& scenario, std::uint64_t seed,
                   MadeTracks& made) {
  if (explanation.leaves_nothing()) return;
  std::size_t c = 0;
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) {
      std::mt19937_64 engine = random_engine(RandomUse::twin_remainder, seed, c);
      std::normal_distribution<double> deviate(0.0, 1.0);
      ClipScatter by;
      by.incline_m_s2 = explanation.force_m_s2 * deviate(engine);
      by.friction_m_s2 = explanation.force_m_s2 * deviate(engine);
      by.drag = explanation.drag * deviate(engine);
      const TrueClip& truth = made.truth.clips[c];
      std::vector<double> instants = truth.t_s;  // a duplicated frame has one instant
      instants.erase(std::unique(instants.begin(), instants.end()), instants.end());
      const sim::Body body = scattered(configuration.body, by);
      const sim::Trajectory trajectory = sim::simulate(body, motion.x0_m, motion.v0_m_s, instants);
      std::vector<double> by_m = wander(instants, trajectory, body, explanation.q_m2_s3, engine);
      core::TrackData& track = made.tracks[c++];
      for (std::size_t i = 0; i < track.x_m.size(); ++i) {
        const auto frame = static_cast<std::size_t>(track.frame[i]);
        const auto at = static_cast<std::size_t>(
            std::lower_bound(instants.begin(), instants.end(), truth.t_s.at(frame)) - instants.begin());
        track.x_m[i] += trajectory.states[at].x_m - truth.x_m[frame] + by_m[at];
      }
    }
  }
}

}  // namespace

/// A seed's calibration, and the stage of a change. Stills show the recorded marker: what it is in the clips does not
/// matter to the calibration.
class TwinFilm {
 public:
  TwinFilm(TwinStudios& studios, const TwinChange& change, std::size_t explanation, std::uint64_t seed,
           LengthFrom length)
      : studios_(studios), change_(change), explanation_(explanation), seed_(seed), length_(length) {}

  MadeTracks film(const render::Scenario& scenario, const std::optional<core::CameraModel>& lens,
                  const base::Progress& progress) {
    const std::shared_ptr<FilmStudio> studio = studio_of(scenario, progress);
    const bool own_marker = change_.marker != 1.0;
    MadeTracks made = studio->film(scenario, seed_, 1, lens, own_marker ? stage_of(scenario, progress) : nullptr);
    const std::lock_guard lock(studios_.mutex_);
    if (studio->stage()) studios_.stages_.try_emplace(scene(1.0), studio->stage());
    if (as_recorded() && studios_.of_seed_.size() < studios_.most_) studios_.of_seed_.try_emplace(seed_, studio);
    return made;
  }

 private:
  using Scene = std::tuple<std::size_t, double, double>;
  Scene scene(double marker) const { return {explanation_, change_.noise, marker}; }
  bool as_recorded() const { return change_.noise == 1.0; }

  std::shared_ptr<const render::Stage> kept_stage(const Scene& scene) const {
    const std::lock_guard lock(studios_.mutex_);
    const auto drawn = studios_.stages_.find(scene);
    return drawn == studios_.stages_.end() ? nullptr : drawn->second;
  }

  std::shared_ptr<const render::Stage> stage_of(const render::Scenario& scenario, const base::Progress& progress) {
    if (auto kept = kept_stage(scene(change_.marker))) return kept;
    auto stage = render::set_stage(scenario, 1, [&] { progress("stage", 0.0); });
    const std::lock_guard lock(studios_.mutex_);
    return studios_.stages_.try_emplace(scene(change_.marker), std::move(stage)).first->second;
  }

  std::shared_ptr<FilmStudio> studio_of(const render::Scenario& scenario, const base::Progress& progress) {
    if (as_recorded()) {
      const std::lock_guard lock(studios_.mutex_);
      if (const auto kept = studios_.of_seed_.find(seed_); kept != studios_.of_seed_.end()) return kept->second;
    }
    render::Scenario stills = scenario;
    stills.marker.diameter_m /= change_.marker;
    return std::make_shared<FilmStudio>(stills, seed_, 1, kept_stage(scene(1.0)), progress, length_);
  }

  TwinStudios& studios_;
  const TwinChange& change_;
  std::size_t explanation_;
  std::uint64_t seed_;
  LengthFrom length_;
};

namespace {

MadeTracks filmed(const RecordingTwin& twin, const TwinChange& change, const render::Scenario& scenario, double scale,
                  std::uint64_t seed, TwinStudios& studios, const base::Progress& progress) {
  const auto lens = change.camera_known ? true_camera(scenario.camera) : std::nullopt;
  const LengthFrom length = twin.by_scale ? LengthFrom::scale : LengthFrom::pattern;
  MadeTracks made = TwinFilm(studios, change, explanation_of(twin, seed), seed, length).film(scenario, lens, progress);
  if (!twin.by_scale) return made;
  for (core::TrackData& track : made.tracks) {
    track.shared_m.clear();
    track.scale_sd_relative = change.camera_known ? 0.0 : twin.scale_sd_relative;
    for (double& x_m : track.x_m) x_m *= scale;
  }
  return made;
}

}  // namespace

MadeTracks record_twin(const RecordingTwin& twin, const TwinChange& change, std::uint64_t seed, TwinStudios& studios,
                       const base::Progress& progress) {
  std::mt19937_64 engine = random_engine(RandomUse::twin_camera, seed);
  std::normal_distribution<double> deviate(0.0, 1.0);
  const double clock_ppm = 1e6 * core::kClockSdRelative * deviate(engine);
  const double scale = 1.0 + (change.camera_known ? 0.0 : twin.scale_sd_relative * deviate(engine));
  const render::Scenario scenario = changed(twin, change, seed, clock_ppm);
  MadeTracks made = twin.filmed ? filmed(twin, change, scenario, scale, seed, studios, progress)
                                : simulated(twin, change, scenario, scale, seed);
  if (!twin.explanations.empty() && !change.alike)
    add_remainder(twin.explanations[explanation_of(twin, seed)], scenario, seed, made);
  return made;
}

Truth truth_of(const RecordingTwin& twin, std::size_t explanation, bool nominal) {
  render::Scenario scenario = explained(twin, explanation);
  if (nominal) take_out_causes(scenario);
  Truth truth = make_tracks(scenario, 1).truth;
  add_own_law(scenario, truth);
  return truth;
}

}  // namespace glidelab::validate
