#include "fit/estimators.h"

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "base/files/file_io.h"
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
