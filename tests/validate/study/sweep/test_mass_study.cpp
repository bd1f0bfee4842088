#include "validate/study/sweep/mass_study.h"

#include <cmath>

#include "base/errors.h"
#include "report/text/why_words.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "tests/validate/small_sweep.h"
#include "validate/study/sweep/run_sweep.h"
#include "validate/study/sweep/sweep_summary.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

/// Two masses whose mu differ by `fall`.
validate::MassRow row(double bandwidth_s, double fall, double r2, double se = 0.0) {
  validate::MassRow of;
  of.bandwidth_s = bandwidth_s;
  of.masses = {{0.3, 0.007 + fall, 3.0 * se, r2}, {0.5, 0.007, 4.0 * se, 1.0}};
  return of;
}

const validate::PublishedFall kPublished{"level", 0.0075, 0.0051, 0.999, "a table"};

}  // namespace

TEST_CASE("A published fall lies between the bandwidths that make less and more of it, R² on a line in its logarithm") {
  // Falls by 0.0012 a step, and 1 - R² tenfold a step: half of the way from the second step to the third.
  const auto answer = validate::answer_of(
      kPublished, {row(0.04, 0.0006, 0.9999, 1e-6), row(0.06, 0.0018, 0.999, 1e-6), row(0.08, 0.0030, 0.99, 1e-6)});
  REQUIRE(answer.whole);
  CHECK(answer.whole->bandwidth_s == Approx(0.07));
  CHECK(answer.whole->fall == Approx(0.0024));
  CHECK(answer.whole->r2 == Approx(1.0 - std::sqrt(1e-3 * 1e-2)));
  // Each end's standard error is the hypotenuse of 3 and 4; half of two independent ones.
  CHECK(answer.whole->fall_se == Approx(5e-6 / std::sqrt(2.0)));
  REQUIRE(answer.at_r2);
  CHECK(answer.at_r2->bandwidth_s == Approx(0.06));
  CHECK(answer.at_r2->fall == Approx(0.0018));
}

TEST_CASE("A fall that no bandwidth makes, and an R² that none has, have no answer") {
  const auto small = validate::answer_of(kPublished, {row(0.04, 0.0006, 0.9999), row(0.06, 0.0018, 0.9998)});
  CHECK_FALSE(small.whole);
  CHECK_FALSE(small.at_r2);
  CHECK(small.widest.bandwidth_s == 0.06);
}

TEST_CASE("A sweep over masses with lines through all points has a row for each track, bandwidth and noise") {
  const tests::TempDir dir;
  tests::write_sweep(dir.path(),
                     "replicates = 3\nestimators = [\"phase-diagram\"]\nall_points_bandwidths_s = [0.03, 0.1]", R"(
[[vary]]
name = "mass_kg"
keys = ["configuration[*].mass_kg"]
values = [0.335, 0.535]
[[vary]]
key = "tracks.noise_m"
values = [0.0, 1e-4]
[[published_fall]]
configuration = "m1"
mu_lightest = 0.0075
mu_heaviest = 0.0074
r2 = 0.9
source = "nobody"
)");
  // K stays when the mass changes, as of the paper's glider; on the level the smoothing then makes a fall.
  base::write_file(dir / "scenario.toml",
                   std::string("format = 1\nname = \"swept\"\n[camera]\nwidth_px = 320\nheight_px = 240\n"
                               "frame_rate_hz = 200.0\nfocal_px = [480.0, 480.0]\nposition_m = [0.0, 0.1, 2.4]\n") +
                       "[[configuration]]\nname = \"m1\"\nmass_kg = 0.335\nincline_deg = 0.0\n"
                       "[[configuration.force]]\nlaw = \"viscous\"\nk_n_s_m = 0.927\n"
                       "[[configuration.force]]\nlaw = \"coulomb\"\nmu = 0.0071\n"
                       "[[configuration.clip]]\nname = \"up\"\nlaunched = \"up\"\nx0_m = 0.45\nv0_m_s = -1.2\n"
                       "duration_s = 1.2\n[[configuration.clip]]\nname = \"down\"\nlaunched = \"down\"\n"
                       "x0_m = -0.45\nv0_m_s = 1.2\nduration_s = 1.2\n");
  const validate::Sweep sweep = validate::read_sweep(dir / "sweep.toml");
  validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}, report::why_words);
  REQUIRE(validate::run_sweep(sweep, database, {}, 1).failed == 0);
  const validate::MassStudy study = validate::summarize(sweep, database.database()).masses;
  REQUIRE(study.rows.size() == 4);  // two noises, two bandwidths
  for (const validate::MassRow& of : study.rows) {
    INFO(of.others << ", h = " << of.bandwidth_s);
    REQUIRE(of.masses.size() == 2);
    CHECK(of.masses[0].mass_kg == 0.335);
    CHECK(of.truth == 0.0071);
    CHECK(of.r2() < 1.0);
    CHECK(of.r2() > 0.5);
    // Exact positions make every replicate the same; noise does not.
    CHECK((of.fall_se() > 0.0) == (of.others == "tracks.noise_m = 0.0001"));
  }
  // The mean of a line's slope and intercept is as biased with noise as without: five standard errors.
  CHECK(study.rows[1].bandwidth_s == 0.1);
  CHECK(std::abs(study.rows[1].fall() - study.rows[3].fall()) < 5.0 * study.rows[3].fall_se());
  CHECK(study.rows[1].fall() > study.rows[0].fall());  // a wider kernel makes more
  CHECK(study.answers.size() == 2);
  CHECK_THAT(tests::refusal_of_sweep("", tests::kNoise + "[[published_fall]]\nconfiguration = \"m1\"\n"
                                                         "mu_lightest = 0.005\nmu_heaviest = 0.007\nr2 = 0.9\n"
                                                         "source = \"a\"\n"),
             Contains("mu_heaviest: found 0.007"));
}
