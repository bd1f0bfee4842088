#include "validate/study/baseline/baseline.h"
#include "validate/study/baseline/gate.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "fit/trajectory/trajectory_results.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "tests/validate/small_sweep.h"

using namespace glidelab;
using validate::Baseline;

namespace {

// A hand touches the glider after kEnd: what the end of the clip keeps out.
constexpr double kEnd_s = 1.3;

const render::Scenario& scenario() {
  static const render::Scenario read = [] {
    std::string text = tests::kSweptScenario;
    text.replace(text.find("duration_s = 1.2"), 16, "duration_s = 2.0");
    return render::read_scenario(text, "swept.toml", render::ScenarioChecks::values);
  }();
  return read;
}

validate::MadeTracks touched(validate::MadeTracks made, bool end_kept) {
  for (std::size_t c = 0; c < made.tracks.size(); ++c) {
    core::TrackData& track = made.tracks[c];
    for (std::size_t i = 0; i < track.t_s.size(); ++i) {
      const double late_s = std::max(0.0, track.t_s[i] - kEnd_s);
      track.x_m[i] += 0.5 * 0.1 * late_s * late_s;  // pushed with 0.1 m/s²
    }
    if (end_kept) made.setups[c].end_s = kEnd_s;
  }
  return made;
}

std::vector<core::AnalysisResults> right(const validate::MadeTracks& made) {
  return validate::analyze_as_judged(touched(made, true));
}

Baseline measured(std::uint64_t seed, const validate::AnalyzeTracks& analyze) {
  return validate::measure_baseline(scenario(), "text", {.noise_m = 2e-5, .runs = 60, .seed = seed, .jobs = 2},
                                    analyze);
}

const Baseline& then() {
  static const Baseline baseline = measured(1, right);
  return baseline;
}

bool finds(const validate::AnalyzeTracks& mistaken) {
  return !validate::compare_baselines(then(), measured(2, mistaken)).worse.empty();
}

}  // namespace

TEST_CASE("An analysis that did not change is not called worse, with other noise") {
  // At most 1 % of seeds may fail; these are fixed ones.
  for (const std::uint64_t seed : {2u, 3u, 4u}) {
    const validate::BaselineComparison comparison = validate::compare_baselines(then(), measured(seed, right));
    CHECK(comparison.worse.empty());
    CHECK(comparison.tests == 34);  // 1 configuration, 2 estimators, 4 quantities, 4 tests; 1 clip, 2 tests
    // |z| of a normal z has the mean 0.798 and the standard deviation 0.603; 3.44 is the normal quantile of 0.01/34:
    // (0.5 0.798) / (0.603 sqrt((2.25 + 1) / 60)) = 2.84, so that 0.27 of such changes are found.
    CHECK(std::abs(comparison.power_spread - 0.27) < 0.01);
    CHECK(comparison.power_doubled > 0.99);
  }
}

TEST_CASE("A sign that is wrong in the estimator is found") {
  CHECK(finds([](const validate::MadeTracks& made) {
    std::vector<core::AnalysisResults> all = right(made);
    for (core::ConfigurationResult& configuration : all[0].configurations) {
      if (configuration.mu.estimate) configuration.mu.estimate->value *= -1.0;
    }
    return all;
  }));
}

TEST_CASE(
    "A bandwidth that is doubled is found although its bias is taken off, and also where its report is not doubled") {
  for (const bool reported : {true, false}) {
    const auto doubled = [&](const validate::MadeTracks& made) {
      std::vector<core::AnalysisResults> all = right(made);
      const double chosen_s = all[0].clips.front().bandwidth_s;
      all[0] = validate::analyze_tracks(touched(made, true), 2.0 * chosen_s);
      if (!reported) {
        for (core::ClipResult& clip : all[0].clips) clip.bandwidth_s = chosen_s;
      }
      return all;
    };
    const std::vector<validate::Worse> worse = validate::compare_baselines(then(), measured(2, doubled)).worse;
    const bool by_bandwidth = std::any_of(worse.begin(), worse.end(), [](const validate::Worse& one) {
      return one.quantity == "bandwidth" && one.now > 1.9 * one.then;
    });
    INFO((reported ? "reported" : "hidden"));
    CHECK(by_bandwidth == reported);
    CHECK_FALSE(worse.empty());
  }
}

TEST_CASE("A clip's end that is left in is found") {
  CHECK(finds([](const validate::MadeTracks& made) { return validate::analyze_as_judged(touched(made, false)); }));
}

TEST_CASE("A file keeps every number of a baseline") {
  const Baseline& baseline = then();
  REQUIRE(baseline.records.size() == 8);
  const tests::TempDir dir;
  base::write_file(dir / "b.json", validate::baseline_json(baseline));
  const Baseline read = validate::read_baseline(dir / "b.json");
  REQUIRE(read.records.size() == 8);
  for (std::size_t i = 0; i < 8; ++i) {
    CHECK(read.records[i].mean == baseline.records[i].mean);
    CHECK(read.records[i].sd == baseline.records[i].sd);
    CHECK(read.records[i].covered == baseline.records[i].covered);
  }
  REQUIRE(read.smoothing.size() == baseline.smoothing.size());
  CHECK(read.smoothing.back().log_bandwidth == baseline.smoothing.back().log_bandwidth);
  CHECK(read.smoothing.back().log_a_error_sd == baseline.smoothing.back().log_a_error_sd);
  CHECK(validate::compare_baselines(read, baseline).worse.empty());
  CHECK(read.seed == baseline.seed);
  CHECK(read.seed.has_value());
}

TEST_CASE("A baseline is compared with other noise than its own, one without a seed with that of seed 2") {
  validate::Baseline baseline = then();
  for (const std::uint64_t seed : {std::uint64_t{1}, std::uint64_t{2}, ~std::uint64_t{0}}) {
    baseline.seed = seed;
    CHECK(validate::other_seed(baseline) != seed);
  }
  baseline.seed.reset();
  const tests::TempDir dir;
  base::write_file(dir / "b.json", validate::baseline_json(baseline));
  const validate::Baseline old = validate::read_baseline(dir / "b.json");
  CHECK_FALSE(old.seed.has_value());
  CHECK(validate::other_seed(old) == 2);
}

TEST_CASE("What is wrong with a baseline's file is said by its key, in no library's words") {
  const tests::TempDir dir;
  const auto refusal = [&](const std::string& text) -> std::string {
    base::write_file(dir / "b.json", text);
    try {
      validate::read_baseline(dir / "b.json");
    } catch (const base::InputError& error) {
      CHECK(std::string(error.what()).find("json.exception") == std::string::npos);
      return error.what();
    }
    return "no error";
  };
  const std::string head = R"({"format": 2, "scenario": "", "noise_m": 2e-5, "runs": 9)";
  const std::string name = (dir / "b.json").string();
  const auto says = [&](const std::string& text, const std::string& what) {
    INFO(text << " " << refusal(text));
    CHECK(refusal(text).find(name + what) != std::string::npos);
  };
  says("{}", ": format: found nothing");
  says("[1, 2]", ": found array");
  says("{\n\"format\": oops}", ":2: found what is no JSON");
  says("", ":1: found what is no JSON");
  says(R"({"format": "2"})", ": format: found string");
  says(R"({"format": 2, "scenario": 3})", ": scenario: found number, expected a string");
  says(head + "}", ": records: found nothing");
  says(head + R"(, "seed": -1, "records": [], "smoothing": []})", ": seed: found -1");
  says(head + R"(, "seed": 1e999})", ": found a number beyond");
  says(head + R"(, "records": 5})", ": records: found number, expected a list");
  says(head + R"(, "records": [{}]})", ": records[0].configuration: found nothing");
  says(head + R"(, "records": [], "smoothing": [{"clip": "a", "runs": 2, "log_bandwidth": null}]})",
       ": smoothing[0].log_bandwidth: found null, expected a number");
}

TEST_CASE("A baseline of another scenario, noise or form is refused") {
  Baseline other = then();
  other.scenario = "another";
  CHECK_THROWS_AS(validate::compare_baselines(other, then()), base::InputError);
  other = then();
  other.noise_m = 1.0;
  CHECK_THROWS_AS(validate::compare_baselines(other, then()), base::InputError);
  const tests::TempDir dir;
  for (const char* text :
       {"", "{}", "[1, 2]", "{\"format\": 2}", "{\"format\": 1}", "{\"format\": 2, \"scenario\": 3}"}) {
    base::write_file(dir / "b.json", text);
    CHECK_THROWS_AS(validate::read_baseline(dir / "b.json"), base::InputError);
  }
}

TEST_CASE("A quantity or a clip that only one of two baselines has is refused by its name, whichever it is") {
  const Baseline whole = then();
  Baseline fewer = whole, without_clip = whole;
  fewer.records.erase(fewer.records.begin());
  without_clip.smoothing.clear();
  const validate::ErrorRecord& gone = whole.records.front();
  const std::string name = gone.configuration + " " + gone.estimator + " " + gone.quantity;
  CHECK_THROWS_WITH(validate::compare_baselines(whole, fewer), Catch::Matchers::Contains(name + ": found nothing now"));
  CHECK_THROWS_WITH(validate::compare_baselines(fewer, whole),
                    Catch::Matchers::Contains(name + ": found nothing in the baseline"));
  CHECK_THROWS_WITH(validate::compare_baselines(without_clip, whole),
                    Catch::Matchers::Contains(whole.smoothing.front().clip + ": found nothing in the baseline"));
}

TEST_CASE(
    "An estimator that tells nothing of clips is judged by its quantities alone, and its baseline is read again") {
  const auto unbiased = [](const validate::MadeTracks& made) {
    core::AnalysisResults results = validate::analyze_as_judged(made).front();
    results.clips.clear();
    return std::vector<core::AnalysisResults>{results};
  };
  const Baseline first = measured(1, unbiased), second = measured(2, unbiased);
  CHECK(first.smoothing.empty());
  CHECK(validate::compare_baselines(first, second).tests == 16);  // 4 quantities, 4 tests
  const tests::TempDir temp;
  base::write_file(temp / "baseline.json", validate::baseline_json(first));
  const Baseline again = validate::read_baseline(temp / "baseline.json");
  CHECK(again.smoothing.empty());
  CHECK(validate::baseline_json(again) == validate::baseline_json(first));
}
