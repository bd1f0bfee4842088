#include "diagnose/gap/gap_sizes.h"

#include <cmath>

#include "diagnose/fit/nominal_fit.h"
#include "diagnose/unnamed/unnamed.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

TEST_CASE("the gap of each domain is the root mean square of its differences over their noise") {
  diagnose::GapSizes gap;
  gap.before = 5.0;
  gap.after = 1.0;
  const auto bin = [](double before, double after) {
    return diagnose::PhaseBin{0.0, 0.1, 0.05, 9, {before, 0.5}, {after, 0.25}};
  };
  gap.phase_plane = {{{}, {bin(100.0, 100.0)}}, {0.3, {bin(1.5, 0.25)}}, {0.4, {bin(-2.0, 0.0)}}};
  gap.parameters = {{"mu", diagnose::Against::all_clips, "a", 3.0, 0.0},
                    {"mu", diagnose::Against::all_clips, "b", 4.0, 1.0},
                    {"mu", diagnose::Against::all_clips, "c"}};
  diagnose::ImageFinding blur, blocks, light;
  blur.id = "exposure_blur";
  blur.log_evidence = 8.0;
  blocks.id = "compression";
  blocks.log_evidence = 50.0;
  blocks.stated = true;
  light.id = "light_flicker";
  light.log_evidence = -2.0;
  auto domains =
      diagnose::gap_domains(gap, {blur, blocks, light}, {{"exposure_blur", diagnose::Stage::optics, "", 1.0, {}, {}}});
  REQUIRE(domains.size() == 4);
  CHECK(domains[0].before == 5.0);
  CHECK(domains[1].before == Approx(std::sqrt((9.0 + 16.0) / 2.0)));  // of the masses; all together are the same points
  CHECK(*domains[1].after == Approx(std::sqrt(0.5)));
  CHECK(domains[2].before == Approx(std::sqrt(12.5)));
  CHECK(*domains[2].after == Approx(std::sqrt(0.5)));
  CHECK(domains[3].before == Approx(4.0));  // sqrt(2 x 8)
  CHECK(*domains[3].after == 1.0);
  gap.parameters.front().z_after.reset();
  domains = diagnose::gap_domains(gap, {}, {});
  REQUIRE(domains.size() == 3);   // tracks have no image
  CHECK_FALSE(domains[2].after);  // not that of fewer parameters than before
}

TEST_CASE("residuals after what has no name are those with its likeliest curve taken out") {
  // A pull of 5 mN at one place that no effect of the list has; the noise is 30 µm.
  const tests::MadeEffect pull = {
      .force = [](double, double x, double, double) { return 0.005 * std::exp(-std::pow((x - 0.1) / 0.08, 2)); }};
  const auto made = tests::made_experiment(tests::made_launches(), pull, 5);
  const auto set = diagnose::track_set(made.results, made.setups, true);
  const auto nominal = diagnose::fit_nominal(set);
  const diagnose::ScoreSpace space(set, nominal);
  const auto families = diagnose::unnamed_families(space);
  const auto* family = diagnose::likeliest_shared(families);
  REQUIRE(family != nullptr);
  double before = 0.0, after = 0.0, count = 0.0;
  for (const auto& curve : diagnose::residuals_of(set, nominal, diagnose::with_unnamed(set, nominal, *family))) {
    REQUIRE(curve.noise_m.size() == curve.before_m.size());
    for (std::size_t p = 0; p < curve.before_m.size(); ++p) {
      before += std::pow(curve.before_m[p] / curve.noise_m[p], 2);
      after += std::pow(curve.after_m[p] / curve.noise_m[p], 2);
      count += 1.0;
    }
  }
  // White noise alone: 1 ± sqrt(1.82/1200), less what the fit takes up.
  CHECK(std::sqrt(before / count) > 1.5);
  CHECK(std::sqrt(after / count) < 1.2);
}
