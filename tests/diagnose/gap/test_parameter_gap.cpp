#include "diagnose/gap/domain_gaps.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "diagnose/fit/nominal_fit.h"
#include "diagnose/single_frames/missing_frames.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

diagnose::TrackSet set_of(const tests::MadeExperiment& made) {
  return diagnose::track_set(made.results, made.setups, true);
}

const diagnose::GapOfParameter* find(const std::vector<diagnose::GapOfParameter>& gaps, const std::string& quantity,
                                     const std::string& group) {
  const auto found = std::find_if(gaps.begin(), gaps.end(), [&](const diagnose::GapOfParameter& gap) {
    return gap.quantity == quantity && gap.group == group;
  });
  return found == gaps.end() ? nullptr : &*found;
}

diagnose::MotionFit with(const diagnose::TrackSet& set, const diagnose::MotionFit& nominal, const char* id,
                         double start) {
  const std::size_t effect = diagnose::effect_index(id);
  return diagnose::fit_motions(set, {effect}, diagnose::with_effect(set, nominal, effect, {start}, {}));
}

}  // namespace

TEST_CASE("a drag that differs between masses shows as the drag of each alone") {
  // K of 0.335 kg is 0.93, of 0.535 kg 0.97.
  const tests::MadeEffect effect{.force = [](double m, double, double v, double) { return m > 0.4 ? -0.04 * v : 0.0; }};
  const auto set = set_of(tests::made_experiment(tests::made_launches(), effect, 4));
  const auto nominal = diagnose::fit_nominal(set);
  const auto gaps = diagnose::parameter_gaps(set, nominal, nullptr);
  const auto* light = find(gaps, "k_n_s_m", "0.335 kg");
  const auto* heavy = find(gaps, "k_n_s_m", "0.535 kg");
  REQUIRE((light != nullptr && heavy != nullptr && light->alone && heavy->alone));
  CHECK(std::abs(light->alone->value - 0.93) < 4.0 * light->alone->sd);
  CHECK(std::abs(heavy->alone->value - 0.97) < 4.0 * heavy->alone->sd);
  CHECK(*light->z_before < -10.0);
  CHECK(*heavy->z_before > 10.0);
  CHECK_FALSE(light->z_after);  // what is missing has no name
  const auto* mu = find(gaps, "mu", "0.335 kg");
  REQUIRE((mu != nullptr && mu->alone));
  CHECK(std::abs(mu->alone->value - tests::MadeGlider{}.mu) < 4.0 * mu->alone->sd);
}

TEST_CASE("a friction that does not grow with the load shows between the masses, and no more with its name") {
  // mu alone is mu + F/(m g): 0.006 + 0.00305 and 0.006 + 0.00191 on level track.
  const tests::MadeEffect effect{.force = [](double, double, double v, double) { return v > 0.0 ? -0.01 : 0.01; }};
  const auto set = set_of(tests::made_experiment(tests::made_launches(), effect, 6));
  const auto nominal = diagnose::fit_nominal(set);
  const auto fit = with(set, nominal, "load_independent_friction", 0.005);
  const auto gaps = diagnose::parameter_gaps(set, nominal, &fit);
  for (const auto& [group, mass] : {std::pair("0.335 kg", 0.335), std::pair("0.535 kg", 0.535)}) {
    const auto* gap = find(gaps, "mu", group);
    REQUIRE((gap != nullptr && gap->alone && gap->z_before && gap->z_after));
    INFO(group);
    CHECK(std::abs(gap->alone->value - (0.006 + 0.01 / (mass * 9.80665))) < 4.0 * gap->alone->sd);
    CHECK(std::abs(*gap->z_before) > 10.0);
    CHECK(std::abs(*gap->z_after) < 4.0);
  }
}

TEST_CASE("lost frames that are known leave no gap between the masses and directions") {
  // Two in each clip, each worth a displacement of 5 to 10 mm, fifty times the noise.
  const auto lost = [](std::size_t clip, std::size_t frame) { return (frame + 7 * clip) % 60 == 20; };
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), {.lost = lost}, 5, 2e-4);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const diagnose::MissingFrames missing = diagnose::find_missing_frames(set, nominal);
  REQUIRE(missing.count > 10);
  double before = 0.0;
  std::size_t seen = 0;
  for (const auto& gap : diagnose::parameter_gaps(set, nominal, &missing.fit)) {
    if (!gap.z_before || !gap.z_after) continue;
    ++seen;
    before = std::max(before, std::abs(*gap.z_before));
    CHECK(std::abs(*gap.z_after) < 4.0);  // six of them: once in three thousand runs
  }
  CHECK(seen >= 4);
  CHECK(before > 10.0);
}

TEST_CASE("z of a part against the whole is a standard normal deviate where nothing is missing") {
  // With an effect in the model (its size taken from all clips) and without. 40 experiments, each with eight entries
  // that hang together: as if three were independent, one standard error of the mean square is sqrt(2/120) = 0.13.
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal(0.0, 1.0);
  double before = 0.0, after = 0.0, count = 0.0, wrong = 0.0, named = 0.0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    auto set = set_of(tests::made_experiment(tests::made_launches(), {}, seed, 3e-5, 80));
    for (auto& group : set.groups) {
      for (auto& statement : group.statements) statement.alpha_rad += statement.sd_rad * normal(random);
    }
    const auto nominal = diagnose::fit_nominal(set);
    const auto fit = with(set, nominal, "quadratic_drag", 0.001);
    for (const auto& gap : diagnose::parameter_gaps(set, nominal, &fit)) {
      if (!gap.z_before || !gap.z_after) continue;
      before += *gap.z_before * *gap.z_before;
      after += *gap.z_after * *gap.z_after;
      count += 1.0;
      // Were the part independent of the whole, its variance would be the sum: then z would be too small.
      wrong += std::pow(gap.alone->value - gap.together->value, 2) /
               (gap.alone->sd * gap.alone->sd + gap.together->sd * gap.together->sd);
      named += gap.quantity == "mu" && gap.group == "0.335 kg, uphill" ? 1.0 : 0.0;
    }
  }
  INFO(count << " entries");
  CHECK(named > 0.0);
  CHECK(before / count == Approx(1.0).margin(0.4));
  CHECK(after / count == Approx(1.0).margin(0.4));
  CHECK(wrong < before);
}

TEST_CASE("the friction of one direction on a set-up whose inclination nobody states is not determined") {
  const std::vector<tests::MadeLaunch> launches = {{0.4, 4.0, 0.3, -1.1}, {0.4, 4.0, -0.6, 1.2}};
  const auto set = set_of(tests::made_experiment(launches, {}, 2, 3e-5, 150, 100.0, 0.0));
  const auto nominal = diagnose::fit_nominal(set);
  const auto gaps = diagnose::parameter_gaps(set, nominal, &nominal);
  CHECK(find(gaps, "k_n_s_m", "0.4 kg") == nullptr);  // one mass is all there is
  const auto* down = find(gaps, "mu", "0.4 kg, downhill");
  REQUIRE(down != nullptr);
  CHECK_FALSE(down->z_before);
  CHECK_FALSE(down->alone);
}
