#include "diagnose/causes/further_causes.h"

#include <cmath>
#include <optional>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/single_frames/missing_frames.h"
#include "diagnose/tracks/track_set.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"
#include "tests/diagnose/scattering_friction.h"

using namespace glidelab;

TEST_CASE("a law that is lost among clips that scatter shows beside their scatter") {
  // Friction that differs by a fifth, and a track that is bowed.
  tests::ScatteringFriction friction(0.02, {0.2, -0.25, 0.1, -0.15, 0.25, 0.05, -0.2, -0.1});
  tests::MadeEffect both;
  both.force = [&](double m, double x, double v, double t) { return 0.06 * m * x + friction(m, v, t); };
  const auto made = tests::made_experiment(tests::made_launches(), both, 5, 5e-5, 100, 60.0, 0.05, 0.0, {.mu = 0.02});
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const std::size_t bow = diagnose::effect_index("track_bow"), scatter = diagnose::effect_index("clip_scatter");
  const std::optional<diagnose::MotionFit> clips = diagnose::with_clip_scatter(set, diagnose::fit_nominal(set));
  REQUIRE(clips);
  const diagnose::RemainderSizes sizes = diagnose::RemainderSpace(set, *clips).likeliest().sizes;
  const std::vector<diagnose::MotionFit> found = diagnose::laws_beside_scatter(set, *clips, sizes, {});
  REQUIRE_FALSE(found.empty());
  CHECK(found.size() <= 3);
  CHECK(found.front().effects == std::vector<std::size_t>{scatter, bow});
  // By the noise alone the pair fits far better than the scatter: 100 in log likelihood.
  CHECK(found.front().cost < clips->cost - 200.0);
  // What is left out is not looked for.
  for (const diagnose::MotionFit& other : diagnose::laws_beside_scatter(set, *clips, sizes, {bow})) {
    CHECK(other.effects.back() != bow);
  }
}

TEST_CASE("of missing frames that were found in several ways those stay that are worth their price") {
  tests::MadeEffect losses;
  losses.lost = [](std::size_t clip, std::size_t frame) { return clip % 2 == 0 && (frame == 40 || frame == 90); };
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), losses, 3, 3e-5);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  CHECK_FALSE(diagnose::lost_frames_alone(set, {nominal}, 1));
  const diagnose::MotionFit found = diagnose::find_missing_frames(set, nominal).fit;
  REQUIRE(diagnose::missing_in(set, found) == 8);  // four clips of eight
  const auto with = [&](double step_s) {  // later by so much from the last but fortieth position of the first motion on
    diagnose::Lateness late = found.late;
    for (std::size_t p = late[0].size() - 40; p < late[0].size(); ++p) late[0][p] += step_s;
    return diagnose::fit_motions(set, {}, found.at, late);
  };
  const diagnose::MotionFit one_more = with(0.01), one_less = with(-0.01);
  for (const std::vector<diagnose::MotionFit>& order : std::vector<std::vector<diagnose::MotionFit>>{
           {nominal, one_less, found, one_more}, {one_more, found, one_less}}) {
    const auto best = diagnose::lost_frames_alone(set, order, 2);
    REQUIRE(best);
    CHECK(best->late == found.late);
    CHECK(best->effects.empty());
  }
}

TEST_CASE("a hand is fitted beside two causes where it shows, and nowhere else") {
  // A drag with the square of the speed, a bowed track, and a hand that lets go after a tenth of a second.
  const double push_m_s2[] = {0.9, -0.5, 0.4, -0.7, 0.6, -0.8, 0.5, -0.4};
  const auto fits_of = [&](bool pushes) {
    std::size_t clip = 0;
    double before = 1.0;
    tests::MadeEffect both;
    both.force = [&](double m, double x, double v, double t) {
      if (t < before - 0.1) ++clip;
      before = t;
      return 0.06 * m * x - 0.2 * v * std::abs(v) + (pushes && t < 0.1 ? m * push_m_s2[(clip - 1) % 8] : 0.0);
    };
    const auto made = tests::made_experiment(tests::made_launches(), both, 5, 1e-4, 100, 60.0);
    const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    diagnose::MotionFit pair = diagnose::fit_nominal(set);
    for (const auto& [id, size] : {std::pair{"quadratic_drag", 0.2}, std::pair{"track_bow", 0.006}}) {
      const std::size_t effect = diagnose::effect_index(id);
      pair = diagnose::fit_with_effect(set, pair, effect, diagnose::with_effect(set, pair, effect, {size}, {}));
    }
    const diagnose::RemainderSizes sizes = diagnose::RemainderSpace(set, pair).likeliest().sizes;
    return std::pair(pair,
                     diagnose::with_further(set, pair, diagnose::effect_index(diagnose::ids::late_release), sizes));
  };
  const auto [pair, with_hand] = fits_of(true);
  REQUIRE(with_hand);
  CHECK(with_hand->effects.size() == 3);
  CHECK(with_hand->cost < pair.cost - 200.0);  // 100 in log likelihood
  const auto release =
      static_cast<Eigen::Index>(with_hand->layout->first_of(diagnose::effect_index(diagnose::ids::late_release)));
  CHECK(with_hand->at.global[release] == Approx(0.1).margin(0.02));
  CHECK_FALSE(fits_of(false).second);
}
