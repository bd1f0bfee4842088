#include "validate/challenge/challenge_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/analysis/analyze.h"
#include "core/result/quantity.h"
#include "render/film/render_experiment.h"
#include "render/scenario/scenario.h"
#include "validate/blind/case/everyday_case.h"
#include "validate/made_tracks/made_tracks.h"
#include "validate/made_tracks/outside_runs.h"
#include "validate/random_use.h"

namespace glidelab::validate {
namespace {

namespace fs = std::filesystem;

constexpr double kFilmedAtRest_s = 0.3;
constexpr std::size_t kFewestFrames = 30;
constexpr int kMostDesigns = 200;  // designs tried until one has clips that are long enough

/// How a level draws: the ranges of its gliders and its camera.
struct LevelDesign {
  std::size_t pairs = 1;  ///< of an upward and a downward clip
  double reach_m = 1.2;   ///< a clip ends where the glider is farther from the middle
  double longest_s = 2.5;
  double least_k = 1.5, most_k = 4.0, least_mu = 0.003, most_mu = 0.015, least_deg = 2.5, most_deg = 5.0;
  double level_part = 0.0;  ///< fraction of the cases with a level track
  std::vector<double> rates_hz = {200.0};
  double least_noise_m = 2e-5, most_noise_m = 2e-5;
  double dropped_fraction = 0.0;
};

LevelDesign design_of(ChallengeLevel level) {
  LevelDesign design;
  if (level == ChallengeLevel::easy) design.pairs = 2;
  if (level == ChallengeLevel::camera) {
    design.reach_m = 0.6;
    design.rates_hz = {120.0};
  }
  if (level == ChallengeLevel::hard) {
    design = {.pairs = 1,
              .reach_m = 1.2,
              .longest_s = 2.0,
              .least_k = 0.4,
              .most_k = 3.0,
              .least_mu = 0.002,
              .most_mu = 0.03,
              .least_deg = 1.0,
              .most_deg = 5.0,
              .level_part = 0.3,
              .rates_hz = {25.0, 30.0, 50.0, 60.0},
              .least_noise_m = 2e-4,
              .most_noise_m = 1.5e-3,
              .dropped_fraction = 0.02};
  }
  return design;
}

struct Launch {
  double x0_m = 0.0, v0_m_s = 0.0, duration_s = 0.0;
};

/// Everything that makes up a case of tracks or a film.
struct Drawn {
  double k_1_s = 0.0, mu = 0.0, incline_deg = 0.0, stated_deg = 0.0, mass_kg = 0.0, rate_hz = 0.0, noise_m = 0.0;
  double exposure_s = 0.0, focal_px = 0.0, camera_x_m = 0.0;
  std::vector<Launch> launches;
};

/// Rounds to ten digits: the file is then the same on machines that round differently.
double rounded(double value) {
  return std::stod(fmt::format("{:.10g}", value));
}

Drawn draw(const LevelDesign& design, BlindRandom& random) {
  Drawn drawn;
  drawn.k_1_s = rounded(log_uniform(random, design.least_k, design.most_k));
  drawn.mu = rounded(log_uniform(random, design.least_mu, design.most_mu));
  const bool level = uniform(random, 0.0, 1.0) < design.level_part;
  const double off_deg = uniform(random, -0.3, 0.3);
  drawn.stated_deg = level ? 0.0 : std::round(10.0 * uniform(random, design.least_deg, design.most_deg)) / 10.0;
  drawn.incline_deg = rounded(drawn.stated_deg + (level ? 0.2 : 1.0) * off_deg);
  drawn.mass_kg = std::round(1e3 * uniform(random, 0.2, 0.6)) * 1e-3;
  drawn.rate_hz = design.rates_hz[std::min(
      design.rates_hz.size() - 1,
      static_cast<std::size_t>(uniform(random, 0.0, static_cast<double>(design.rates_hz.size()))))];
  drawn.noise_m = rounded(log_uniform(random, design.least_noise_m, 1.0000001 * design.most_noise_m));
  drawn.exposure_s = rounded(uniform(random, 5e-4, 3e-3));
  drawn.focal_px = rounded(uniform(random, 600.0, 720.0));
  drawn.camera_x_m = rounded(uniform(random, -0.1, 0.1));
  for (std::size_t pair = 0; pair < design.pairs; ++pair) {
    drawn.launches.push_back(
        {rounded(design.reach_m * uniform(random, 0.2, 0.7)), rounded(-uniform(random, 0.8, 1.6)), design.longest_s});
    drawn.launches.push_back(
        {rounded(-design.reach_m * uniform(random, 0.5, 0.9)), rounded(uniform(random, 0.5, 1.4)), design.longest_s});
  }
  return drawn;
}

std::string clip_name(std::size_t launch) {
  return fmt::format("{}-{}", launch % 2 == 0 ? "up" : "down", launch / 2 + 1);
}

std::string scenario_text(const LevelDesign& design, const Drawn& drawn) {
  std::string text = fmt::format(
      "format = 1\nname = \"challenge\"\n\n[camera]\nwidth_px = 480\nheight_px = 360\nframe_rate_hz = {}\n"
      "exposure_s = {}\nfocal_px = [{}, {}]\nposition_m = [{}, 0.05, 1.75]\ntarget_m = [0.0, 0.0, 0.0]\n\n"
      "[calibration]\ninner_corners = [9, 6]\nsquare_m = 0.04\nviews = 10\n\n"
      "[clock]\ndropped_fraction = {}\n\n"
      "[[configuration]]\nname = \"glider\"\nmass_kg = {}\nincline_deg = {}\nstated_incline_deg = {}\n"
      "stated_incline_sd_deg = 0.3\n[[configuration.force]]\nlaw = \"viscous\"\nk_over_m_1_s = {}\n"
      "[[configuration.force]]\nlaw = \"coulomb\"\nmu = {}\n",
      drawn.rate_hz, drawn.exposure_s, drawn.focal_px, drawn.focal_px, drawn.camera_x_m, design.dropped_fraction,
      drawn.mass_kg, drawn.incline_deg, drawn.stated_deg, drawn.k_1_s, drawn.mu);
  for (std::size_t i = 0; i < drawn.launches.size(); ++i) {
    const Launch& launch = drawn.launches[i];
    text += fmt::format(
        "[[configuration.clip]]\nname = \"{}\"\nlaunched = \"{}\"\nx0_m = {}\nv0_m_s = {}\nduration_s = {}\n",
        clip_name(i), launch.v0_m_s < 0.0 ? "up" : "down", launch.x0_m, launch.v0_m_s, launch.duration_s);
  }
  return text;
}

render::Scenario scenario_of(const LevelDesign& design, const Drawn& drawn, render::ScenarioChecks checks) {
  return render::read_scenario(scenario_text(design, drawn), "challenge.toml", checks);
}

/// Duration until it is out of reach or has rested for a while, in whole frames.
double seconds_on_track(const TrueClip& clip, const LevelDesign& design, double rate_hz) {
  std::size_t k = 0;
  double rested_s = 0.0;
  for (; k < clip.x_m.size(); ++k) {
    rested_s = clip.v_m_s[k] == 0.0 ? rested_s + 1.0 / rate_hz : 0.0;
    if (std::abs(clip.x_m[k]) > design.reach_m || rested_s > kFilmedAtRest_s) break;
  }
  return static_cast<double>(k) / rate_hz;
}

Drawn drawn_case(const LevelDesign& design, ChallengeLevel level, std::uint64_t seed, std::size_t index) {
  BlindRandom random =
      random_engine(RandomUse::challenge, seed, index * kChallengeLevels.size() + static_cast<std::size_t>(level));
  for (int attempt = 0; attempt < kMostDesigns; ++attempt) {
    Drawn drawn = draw(design, random);
    LevelDesign whole = design;
    whole.dropped_fraction = 0.0;
    const MadeTracks made = make_tracks(scenario_of(whole, drawn, render::ScenarioChecks::values), seed);
    bool long_enough = true;
    for (std::size_t i = 0; i < drawn.launches.size(); ++i) {
      drawn.launches[i].duration_s = rounded(seconds_on_track(made.truth.clips[i], design, drawn.rate_hz));
      long_enough = long_enough && drawn.launches[i].duration_s * drawn.rate_hz >= static_cast<double>(kFewestFrames);
    }
    if (long_enough) return drawn;
  }
  throw base::NumericalError(fmt::format("challenge {}, case {} of seed {}: none of {} designs stays on the track",
                                         word(level), index, seed, kMostDesigns));
}

std::optional<double> rounded(const std::optional<double>& value) {
  return value ? std::optional(rounded(*value)) : std::nullopt;
}

std::vector<ChallengeConfiguration> true_of(const Truth& truth) {
  std::vector<ChallengeConfiguration> all;
  for (const TrueConfiguration& of : truth.configurations) {
    all.push_back({of.clips, rounded(of.k_over_m_1_s), rounded(of.mu), rounded(of.alpha_deg), rounded(of.v_lim_m_s)});
  }
  return all;
}

std::vector<ChallengeConfiguration> filmed(const render::Scenario& scenario, std::uint64_t seed,
                                           const fs::path& folder) {
  const base::TemporaryFolder truth("truth");
  fs::create_directories(folder);
  render::render_experiment(scenario, folder, truth.path(), {.seed = seed, .jobs = 1});
  write_measured_tracks(core::analyze({folder}, {}), folder);
  return true_of(read_truth(truth.path()));
}

std::vector<ChallengeConfiguration> everyday(std::uint64_t seed, std::size_t index, const fs::path& folder) {
  const EverydayCase one = make_everyday_case(seed, index);
  write_blind_folder(one, folder);
  std::vector<ChallengeConfiguration> all;
  std::map<std::pair<std::string, double>, std::size_t> place_of;  // by group and stated mass
  for (const EverydayConfiguration& of : one.truth.configurations) {
    place_of[{of.group, of.mass_kg}] = all.size();
    all.push_back({{}, rounded(of.k_over_m_1_s), rounded(of.mu), rounded(of.alpha_deg), rounded(of.v_lim_m_s)});
  }
  for (const BlindClip& clip : one.design.clips) {
    const std::pair key(one.design.groups[clip.group].name, one.design.masses[clip.mass].stated_kg);
    all[place_of.at(key)].clips.push_back(clip.name);
  }
  return all;
}

}  // namespace

std::string_view word(ChallengeLevel level) {
  switch (level) {
    case ChallengeLevel::easy:
      return "easy";
    case ChallengeLevel::camera:
      return "camera";
    case ChallengeLevel::hard:
      return "hard";
    case ChallengeLevel::everyday:
      break;
  }
  return "everyday";
}

std::optional<ChallengeLevel> challenge_level(std::string_view name) {
  const auto found = std::ranges::find_if(kChallengeLevels, [&](ChallengeLevel level) { return word(level) == name; });
  return found == kChallengeLevels.end() ? std::nullopt : std::optional(*found);
}

std::vector<ChallengeConfiguration> make_challenge_case(ChallengeLevel level, std::uint64_t seed, std::size_t index,
                                                        const fs::path& folder) {
  if (level == ChallengeLevel::everyday) return everyday(seed, index, folder);
  const LevelDesign design = design_of(level);
  const Drawn drawn = drawn_case(design, level, seed, index);
  const std::uint64_t noise_seed = derived_seed(seed, index);
  if (level == ChallengeLevel::camera) {
    return filmed(scenario_of(design, drawn, render::ScenarioChecks::all), noise_seed, folder);
  }
  const MadeTracks clean = make_tracks(scenario_of(design, drawn, render::ScenarioChecks::values), noise_seed);
  write_track_folder(with_noise(clean, drawn.noise_m, noise_seed), folder);
  return true_of(clean.truth);
}

}  // namespace glidelab::validate
