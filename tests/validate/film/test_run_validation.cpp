#include "validate/film/run_validation.h"

#include <cmath>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/analysis/analyze.h"
#include "render/scenario/scenario.h"
#include "report/analysis/result_files.h"
#include "report/text/why_words.h"
#include "tests/catch.h"
#include "tests/small_scenario.h"
#include "tests/temp_dir.h"
#include "validate/truth/truth_folder.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

struct Loop {
  Loop() {
    base::write_file(temp / "scenario.toml", tests::kSmallScenario);
    fs::create_directory(experiment());
    fs::create_directory(truth());
  }
  fs::path experiment() const { return temp / "experiment"; }
  fs::path truth() const { return temp / "experiment.truth"; }
  render::Scenario scenario() const { return render::read_scenario(temp / "scenario.toml"); }
  tests::TempDir temp;
};

}  // namespace

TEST_CASE("an analysis gives the same results.json with the truth folder deleted, and for any number of jobs") {
  const Loop loop;
  render::render_experiment(loop.scenario(), loop.experiment(), loop.truth(), {.seed = 5, .jobs = 2});
  REQUIRE(fs::exists(loop.truth() / "truth.json"));
  const std::string beside = report::results_json(core::analyze({loop.experiment()}, {.bandwidth_s = {}, .jobs = 2}));
  fs::remove_all(loop.truth());
  const std::string alone = report::results_json(core::analyze({loop.experiment()}, {.bandwidth_s = {}, .jobs = 1}));
  CHECK(beside == alone);
  CHECK(beside.find("\"k_over_m_1_s\": {") != std::string::npos);  // it did find something
}

TEST_CASE("the closed loop of a small scenario recovers its truth within the stated errors") {
  const Loop loop;
  const validate::ValidationResult result =
      validate::run_validation(loop.scenario(), loop.experiment(), loop.truth(), {{5, 2}, {{}, 2}});
  const validate::Comparison& comparison = result.comparison;
  CHECK(comparison.frames == 290);
  CHECK(comparison.detected == 290);
  REQUIRE(comparison.quantities.size() == 8);  // of the lines, and of the whole motion
  for (const validate::QuantityComparison& quantity : comparison.quantities) {
    INFO(quantity.quantity << ": " << report::why_words(quantity.why));
    REQUIRE(quantity.error);
    // Fixed seed; four standard deviations of a normal error are exceeded once in 16,000 draws.
    CHECK(std::abs(*quantity.error) < 4.0 * *quantity.sd);
    // No estimator states less than the bound of independent noise; what it estimates of the noise itself is known
    // to a tenth with 290 frames.
    REQUIRE(quantity.efficiency);
    CHECK(*quantity.efficiency < 1.2);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(comparison.quantities[i].estimator == "phase-diagram");
    CHECK(comparison.quantities[i + 4].estimator == "trajectory");
    CHECK(comparison.quantities[i + 4].quantity == comparison.quantities[i].quantity);
  }
  // The paper's figure for the restitution, 0.1 % of the field of view (section 2.2): 400 px of 4 mm.
  CHECK(comparison.restitution.max_m < 1e-3 * 1.6);
}

TEST_CASE("the truth of one experiment does not compare with the results of another") {
  const Loop loop;
  render::render_experiment(loop.scenario(), loop.experiment(), loop.truth(), {.seed = 5, .jobs = 2});
  validate::Truth truth = validate::read_truth(loop.truth());
  CHECK(truth.clips.size() == 2);
  truth.clips[0].name = "another";
  core::AnalysisResults results;
  results.clips.resize(1);
  results.clips[0].name = "up";
  CHECK_THROWS_AS(validate::compare(results, truth), base::InputError);
}
