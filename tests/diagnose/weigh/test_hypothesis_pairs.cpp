#include "diagnose/weigh/hypothesis_pairs.h"

#include <string_view>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/weigh/hypotheses.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"
#include "tests/diagnose/scattering_friction.h"

using namespace glidelab;

TEST_CASE("a scale that contradicts the stated inclination is weighed beside clips that scatter") {
  // Lengths are 4 % too long, which makes 4 degrees look like 4.16; friction differs by up to 1 % from clip to clip.
  tests::ScatteringFriction friction(0.02, {0.01, -0.008, 0.005, -0.01, 0.008, 0.003, -0.005, -0.003});
  tests::MadeEffect both;
  both.force = [&](double m, double, double v, double t) { return friction(m, v, t); };
  both.seen = [](double x, double) { return 1.04 * x; };
  const auto made = tests::made_experiment(tests::made_launches(), both, 5, 2e-4, 100, 60.0, 0.015, 0.0, {.mu = 0.02});
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const std::size_t scatter = diagnose::effect_index(diagnose::ids::clip_scatter);
  const diagnose::Comparison all = diagnose::compare_hypotheses(set);
  const diagnose::Comparison without = diagnose::compare_hypotheses(set, {scatter});
  // A frame rate, or a friction that depends on the direction, shifts the inclination as a scale does.
  int found = 0;
  for (const std::string_view id :
       {diagnose::ids::scale_error, diagnose::ids::frame_rate_error, diagnose::ids::direction_asymmetry}) {
    const std::size_t effect = diagnose::effect_index(id);
    const diagnose::Hypothesis* pair = diagnose::find(all, {effect, scatter});
    const diagnose::Hypothesis* alone = diagnose::find(all, {effect});
    CHECK(diagnose::find(without, {effect, scatter}) == nullptr);
    if (pair == nullptr || alone == nullptr) continue;
    CHECK(pair->gain > alone->gain + 5.0);
    ++found;
  }
  CHECK(found > 0);
}
