#include "fit/estimators.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "base/files/file_io.h"
#include "core/result/estimate.h"
#include "sim/oracle/closed_forms.h"
#include "test_paths.h"
#include "tests/catch.h"

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

}  // namespace

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
