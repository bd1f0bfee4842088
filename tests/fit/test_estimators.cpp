#include "fit/estimators.h"

#include <algorithm>
#include <filesystem>
#include <random>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "base/files/file_io.h"
#include "base/math/angles.h"
#include "core/motion/configurations.h"
#include "core/result/estimate.h"
#include "sim/oracle/closed_forms.h"
#include "test_paths.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

/// Sources of the program that hold the quoted word.
std::vector<std::string> sources_with(const std::string& quoted) {
  std::vector<std::string> found;
  for (const char* room : {"core", "fit", "diagnose", "validate", "report", "teach", "app"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(fs::path(tests::kSourceDir) / room)) {
      const std::string ending = entry.path().extension();
      if (ending != ".h" && ending != ".cpp") continue;
      std::string text = base::read_file(entry.path());
      if (text.find(quoted) != std::string::npos) found.push_back(entry.path().filename());
    }
  }
  return found;
}

/// Eight launches on a track whose slope changes by `bow_1_m` a metre, without drag or with it; noise of 20 µm.
core::AnalysisResults of_bowed_track(double bow_1_m, core::LineMethod lines) {
  tests::MadeEffect bow;
  bow.force = [&](double mass_kg, double x, double, double) { return -mass_kg * 9.80665 * bow_1_m * x; };
  std::mt19937_64 random(4);
  std::normal_distribution<double> noise(0.0, 2e-5);
  std::vector<core::ClipSetup> setups;
  std::vector<core::TrackData> tracks;
  for (const tests::MadeLaunch& launch : tests::made_launches()) {
    core::ClipSetup setup;
    setup.name = "clip" + std::to_string(setups.size());
    setup.mass_kg = launch.mass_kg;
    setup.incline_rad = launch.incline_deg * base::kRadPerDegree;
    setup.launched = launch.v0_m_s < 0.0 ? core::Launched::up : core::Launched::down;
    setup.group = std::to_string(launch.incline_deg);
    core::TrackData track;
    track.frame_rate_hz = 100.0;
    for (const double x : tests::made_motion({}, launch, bow, 150, 100.0)) {
      track.frame.push_back(track.t_s.size());
      track.t_s.push_back(static_cast<double>(track.t_s.size()) / 100.0);
      track.x_m.push_back(x + noise(random));
    }
    track.frame_t_s = track.t_s;
    setups.push_back(setup);
    tracks.push_back(track);
  }
  core::MotionOptions how;
  how.lines = lines;
  return core::analyze_tracks(setups, tracks, 9.80665, how, 1);
}

}  // namespace

TEST_CASE("an estimate by lines is told with how far the positions lie from the law over the whole motion") {
  for (const fit::Estimator& estimator : fit::estimators()) {
    INFO(estimator.name);
    for (const core::ConfigurationResult& of :
         fit::estimate_and_compare(estimator, of_bowed_track(0.0, estimator.lines), {}).configurations) {
      CHECK(of.scatter.value_or(1.0) < 1.3);
    }
    const core::AnalysisResults lines = of_bowed_track(0.004, estimator.lines);
    const core::AnalysisResults alone = estimator.estimate(lines, {});
    const core::AnalysisResults compared = fit::estimate_and_compare(estimator, lines, {});
    const core::AnalysisResults motion = fit::find_estimator("trajectory")->estimate(lines, {});
    REQUIRE(compared.configurations.size() == 4);
    for (std::size_t c = 0; c < 4; ++c) {
      CHECK_FALSE((alone.configurations[c].scatter && estimator.of_lines));
      CHECK(compared.configurations[c].scatter == motion.configurations[c].scatter);
      CHECK(compared.configurations[c].k_over_m_1_s.estimate->value ==
            alone.configurations[c].k_over_m_1_s.estimate->value);
    }
    // On a slope 4e-3 of gravity a metre, over half a metre and half a second, make some 2 mm: a hundred times the
    // noise, of which the law's parameters take most.
    CHECK(std::ranges::count_if(compared.configurations, [](const auto& of) { return of.scatter > 3.0; }) >= 1);
  }
}

TEST_CASE("every estimator has a name of its own, words for a page and for help, and is found by its name") {
  std::set<std::string_view> names;
  for (const fit::Estimator& estimator : fit::estimators()) {
    INFO(estimator.name);
    CHECK(names.insert(estimator.name).second);
    CHECK_FALSE(estimator.title.empty());
    CHECK_FALSE(estimator.method.empty());
    REQUIRE(estimator.estimate != nullptr);
    CHECK(fit::find_estimator(estimator.name) == &estimator);
  }
  CHECK(fit::find_estimator("magic") == nullptr);
  CHECK(fit::default_estimator().name == core::AnalysisResults{}.estimator);
}

TEST_CASE("the results of an estimator carry its name, and lines that several start from are made once") {
  std::vector<core::LineMethod> asked;
  const auto analyze = [&](core::LineMethod lines) {
    asked.push_back(lines);
    core::AnalysisResults results;
    results.gravity_m_s2 = 9.81;
    results.estimator = core::name_of(lines);
    return results;
  };
  const std::vector<core::AnalysisResults> results = fit::estimate_each(fit::estimators(), analyze);
  REQUIRE(results.size() == fit::estimators().size());
  for (std::size_t i = 0; i < results.size(); ++i) CHECK(results[i].estimator == fit::estimators()[i].name);
  CHECK(asked == std::vector{core::LineMethod::ordinary, core::LineMethod::generalised});
}

TEST_CASE("an estimator of lines keeps what the lines say, and one that takes robust leaves outliers out, no other") {
  core::FreeBlock block;
  for (double t = 0.0; t < 1.7; t += 0.01) {
    block.t_s.push_back(t);
    block.x_m.push_back(sim::viscous_coulomb_motion({0.7, 0.05, 0.05}, 2.0, 0.0, 1.0, t).x_m);
  }
  block.x_m[80] += 0.05;
  block.directions = {1};
  core::ClipResult clip;
  clip.name = "down";
  clip.noise_autocovariance_m2 = {1e-10};
  clip.blocks = {block};
  core::ConfigurationResult configuration;
  configuration.clips = {"down"};
  constexpr double kOfLines = 7.0;
  configuration.k_over_m_1_s = core::determined(core::estimate(kOfLines, 0.1, 10.0));
  core::AnalysisResults lines;
  lines.gravity_m_s2 = 9.81;
  lines.clips = {clip};
  lines.configurations = {configuration};
  for (const fit::Estimator& estimator : fit::estimators()) {
    INFO(estimator.name);
    const core::ConfigurationResult found = estimator.estimate(lines, {.robust = true}).configurations.at(0);
    REQUIRE(found.k_over_m_1_s.estimate);
    CHECK((found.k_over_m_1_s.estimate->value == kOfLines) == estimator.of_lines);
    const bool left_out = std::ranges::any_of(found.notes, [](const auto& note) {
      const auto* const robust = std::get_if<core::RobustFit>(&note);
      return robust != nullptr && robust->left_out > 0;
    });
    CHECK(left_out == estimator.takes_robust);
  }
}

TEST_CASE("the guide explains every estimator") {
  const std::string guide = base::read_file(fs::path(tests::kSourceDir) / "docs/guide/estimators.md");
  for (const std::string& name : fit::estimator_names()) {
    INFO(name);
    CHECK(guide.find("\n| `" + name + "`") != std::string::npos);
  }
}

TEST_CASE("the name of an estimator stands in one source") {
  CHECK(sources_with("\"" + std::string(core::name_of(core::LineMethod::ordinary)) + "\"") ==
        std::vector<std::string>{"results.h"});
  CHECK(sources_with("\"" + std::string(core::name_of(core::LineMethod::generalised)) + "\"") ==
        std::vector<std::string>{"results.h"});
}
