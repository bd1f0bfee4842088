#include "validate/coverage.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "catch.h"
#include "test_paths.h"

using namespace glidelab;
using namespace glidelab::validate;

namespace {

/// The first mass of the paper's inclined track: one clip up, which turns, and one down.
render::Scenario one_mass() {
  render::Scenario scenario = render::read_scenario(std::string(tests::kSourceDir) + "/scenarios/paper/inclined.toml");
  scenario.motion.configurations.resize(1);
  return scenario;
}

const CoverageRow& row_of(const Coverage& coverage, const std::string& estimator, const std::string& quantity) {
  return *std::find_if(coverage.rows.begin(), coverage.rows.end(),
                       [&](const CoverageRow& row) { return row.estimator == estimator && row.quantity == quantity; });
}

}  // namespace

TEST_CASE("intervals of the estimators hold the truth in most of 60 replicates, those of the naive lines do not") {
  const Coverage coverage = measure_coverage(one_mass(), {.replicates = 60, .noise_sd_m = 5e-5, .seed = 3, .jobs = 2});
  REQUIRE(coverage.rows.size() == 16);
  for (const char* quantity : {"k_over_m_1_s", "mu", "alpha_deg", "v_lim_m_s"}) {
    INFO(quantity);
    const CoverageRow& lines = row_of(coverage, "phase-diagram", quantity);
    const CoverageRow& whole = row_of(coverage, "trajectory", quantity);
    CHECK(lines.determined == 60);
    CHECK(whole.determined == 60);
    // Of 60 intervals of 95 % fewer than 50 hold the truth once in 20,000.
    CHECK(lines.covered >= 50);
    CHECK(whole.covered >= 50);
    REQUIRE((lines.efficiency && whole.efficiency));
    // A variance of 60 values is known to 18 %; three of these below 1.
    CHECK(*whole.efficiency > 0.55);
    CHECK(*whole.efficiency < 1.9);
    CHECK(*lines.efficiency < *whole.efficiency);
  }
  // Smoothed neighbours are not independent: a textbook interval of the slope is several times too short.
  CHECK(row_of(coverage, "naive-lines", "k_over_m_1_s").covered < 50);
}

TEST_CASE("coverage is the same for any number of jobs, and another for another seed") {
  const CoverageOptions options{.replicates = 4, .noise_sd_m = 5e-5, .seed = 3, .jobs = 1};
  const Coverage one = measure_coverage(one_mass(), options);
  CoverageOptions again = options;
  again.jobs = 3;
  CHECK(row_of(measure_coverage(one_mass(), again), "trajectory", "mu").bias == row_of(one, "trajectory", "mu").bias);
  again.seed = 1000;
  CHECK(row_of(measure_coverage(one_mass(), again), "trajectory", "mu").bias != row_of(one, "trajectory", "mu").bias);
}

TEST_CASE("without a noise each clip has the least that the scenario's camera allows, and other clocks make no bias") {
  const Coverage coverage = measure_coverage(one_mass(), {.replicates = 20, .seed = 3, .jobs = 2});
  CHECK(coverage.camera_noise);
  REQUIRE(coverage.noise_sd_m.size() == 2);
  for (const double sd : coverage.noise_sd_m) {
    CHECK(sd > 5e-7);  // a two-thousandth of a pixel, which is 2 mm: no picture of 8 bits is so good
    CHECK(sd < 5e-5);  // a fortieth of one
  }
  const CoverageRow& k = row_of(coverage, "trajectory", "k_over_m_1_s");
  CHECK(std::abs(k.bias) < 4.0 * k.sd / std::sqrt(20.0));
  CHECK(k.covered >= 15);  // of 20 intervals of 95 % fewer than 15 hold the truth once in 3000
}

TEST_CASE("a noise or a number of replicates of nothing is refused") {
  CHECK_THROWS_AS(measure_coverage(one_mass(), {.replicates = 4, .noise_sd_m = 0.0}), base::InputError);
  CHECK_THROWS_AS(measure_coverage(one_mass(), {.replicates = 0, .noise_sd_m = 1e-5}), base::InputError);
}

TEST_CASE("rows fail where the count is far from 95 %, not where it is near, and never for the naive lines") {
  Coverage coverage;
  coverage.rows.resize(4);
  for (CoverageRow& row : coverage.rows) row.determined = 1000;
  coverage.rows[0].estimator = "trajectory";
  coverage.rows[0].p_value = 1e-3;
  coverage.rows[1].estimator = "phase-diagram";
  coverage.rows[1].p_value = 0.006;  // above a third of 1 %
  coverage.rows[2].estimator = "naive-lines";
  coverage.rows[2].p_value = 0.0;
  coverage.rows[3].estimator = "phase-diagram";
  coverage.rows[3].p_value = 1e-6;
  for (CoverageRow& row : coverage.rows) row.coverage = 0.93;
  coverage.rows[3].coverage = 1.0;
  const auto narrow = too_narrow(coverage), wide = too_wide(coverage);
  REQUIRE(narrow.size() == 1);
  CHECK(narrow[0].estimator == "trajectory");
  REQUIRE(wide.size() == 1);
  CHECK(wide[0].estimator == "phase-diagram");
}
