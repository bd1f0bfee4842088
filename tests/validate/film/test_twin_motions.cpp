#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "base/files/file_io.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/model/track_model.h"
#include "diagnose/twin/twin.h"
#include "diagnose/verdict/diagnose.h"
#include "render/scenario/scenario.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"
#include "tests/temp_dir.h"
#include "validate/film/twin_motions.h"
#include "validate/made_tracks/made_tracks.h"

using namespace glidelab;

namespace {

const tests::MadeEffect kDrag = {[](double, double, double v, double) { return -0.05 * v * std::abs(v); }, {}};

}  // namespace

TEST_CASE("a twin moves as the data do, to their noise") {
  const double noise = 3e-5;
  const auto made = tests::made_experiment(tests::made_launches(), kDrag, 11, noise);
  const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
  CHECK(diagnosis.twin_lacks.empty());
  tests::TempDir temp;
  base::write_file(temp / "twin.toml", diagnosis.twin);
  const auto twin = validate::make_tracks(render::read_scenario(temp / "twin.toml"), 1);
  REQUIRE(twin.setups.size() == made.setups.size());
  // x of the twin counts from the middle of the data: one offset for all clips.
  std::vector<double> off;
  for (std::size_t c = 0; c < made.setups.size(); ++c) {
    const auto at = std::find_if(twin.setups.begin(), twin.setups.end(),
                                 [&](const auto& setup) { return setup.name == made.setups[c].name; });
    REQUIRE(at != twin.setups.end());
    const core::TrackData& track = twin.tracks[static_cast<std::size_t>(at - twin.setups.begin())];
    const auto& motion = made.results.clips[c].motion;
    for (std::size_t k = 0; k < std::min(motion.size(), track.x_m.size()); ++k) {
      if (motion[k].left_out != core::LeftOut::rest) off.push_back(*motion[k].measured_m - track.x_m[k]);
    }
  }
  double mean = 0.0, square = 0.0;
  for (const double d : off) mean += d / static_cast<double>(off.size());
  for (const double d : off) square += std::pow(d - mean, 2) / static_cast<double>(off.size());
  // Some 1000 points know their root mean square to 2.2 %: five of those, and 1 % for what rounding of the file adds.
  CHECK(std::sqrt(square) < 1.12 * noise);
}

TEST_CASE("a twin has a clip for each motion, from its own start, and says that it has one frame rate") {
  auto made = tests::made_experiment(tests::made_launches(), kDrag, 11);
  const std::string whole = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2}).twin;
  CHECK(whole.find("motion-2") == std::string::npos);
  CHECK(whole.find("# Assumed: 100 frames") == std::string::npos);
  for (std::size_t k = 60; k < 90; ++k) {  // nobody saw the marker for 0.3 s
    core::MotionPoint& point = made.results.clips[0].motion[k];
    point.measured_m.reset();
    point.left_out = core::LeftOut::no_marker;
  }
  made.results.clips[1].frame_rate_hz = 100.001;
  const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  const std::string twin = diagnosis.twin;
  // Both stretches of the first clip move in the twin as in the data, to their noise of 30 µm.
  std::size_t seen = 0;
  for (const validate::TwinMotion& motion : validate::twin_motions(diagnosis, 1)) {
    if (!motion.clip.starts_with("clip0")) continue;
    CHECK(motion.clip == (seen++ == 0 ? "clip0" : "clip0-motion-2"));
    REQUIRE(motion.rest_m.size() > 30);
    double mean = 0.0, square = 0.0;
    for (const double rest_m : motion.rest_m) mean += rest_m / static_cast<double>(motion.rest_m.size());
    for (const double rest_m : motion.rest_m) square += std::pow(rest_m - mean, 2);
    CHECK(std::sqrt(square / static_cast<double>(motion.rest_m.size())) < 6e-5);
    CHECK(motion.v_m_s.size() <= motion.rest_m.size());  // the speeds of its own motion alone
    CHECK(motion.v_m_s.size() > 20);
  }
  CHECK(seen == 2);
  CHECK(twin.find("# Assumed: a clip for each of the 9 motions, without what lies between those of one clip of the "
                  "data.\n") != std::string::npos);
  CHECK(twin.find("# Assumed: 100 frames a second, the first clip's, for all clips.\n") != std::string::npos);
}

TEST_CASE("clips whose names have no letter that a scenario takes are still clips of their own in a twin") {
  auto made = tests::made_experiment(tests::made_launches(), kDrag, 11);
  const std::vector<std::string> names = {"上", "下", "上下", "---", "a b", "a-b", "a-b-2", "c"};
  for (std::size_t c = 0; c < names.size(); ++c) made.setups[c].name = made.results.clips[c].name = names[c];
  const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  const auto twins = validate::twin_motions(diagnosis, 1);  // reads the twin's scenario
  std::set<std::string> clips;
  for (const auto& motion : twins) clips.insert(motion.clip);
  CHECK(clips == std::set<std::string>{"---", "----2", "------", "----3", "a-b", "a-b-2", "a-b-2-2", "c"});
  for (const auto& motion : twins) CHECK(motion.v_m_s.size() > 20);  // each with the speeds of its own clip
}

TEST_CASE("a twin says which effect a scenario cannot express") {
  const tests::MadeEffect bow = {[](double m, double x, double, double) { return m * 9.8 * 0.01 * x; }, {}};
  const auto made = tests::made_experiment(tests::made_launches(), bow, 7);
  const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
  CHECK(diagnosis.twin_lacks.front().what == "track_bow");
}

TEST_CASE("each force that a scenario has moves the twin as the fit's own model moves") {
  const auto made = tests::made_experiment(tests::made_launches(), {}, 5);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  // As they are fitted: 1/v_c², n - 1, s - 1.
  const std::vector<std::pair<std::string, std::vector<double>>> cases = {{"quadratic_drag", {0.05}},
                                                                          {"eddy_rolloff", {0.2}},
                                                                          {"power_law_drag", {0.15}},
                                                                          {"stribeck", {1.5, 0.1}},
                                                                          {"load_independent_friction", {0.01}},
                                                                          {"direction_asymmetry", {0.3}},
                                                                          {"rotational_inertia", {0.02}}};
  for (const auto& [id, values] : cases) {
    INFO(id);
    const std::size_t effect = diagnose::effect_index(id);
    const diagnose::MotionFit fit =
        diagnose::linearise_at(set, {effect}, diagnose::with_effect(set, nominal, effect, values, {}));
    const diagnose::Twin twin =
        diagnose::twin_of(set, fit, {{id, diagnose::Stage::dynamics, "", 1.0, {}, {}, 1.0, {}}}, false, {});
    CHECK(twin.lacks.empty());
    const auto tracks =
        validate::make_tracks(render::read_scenario(twin.toml, "twin.toml", render::ScenarioChecks::values), 1);
    double most = 0.0, moved = 0.0;
    for (std::size_t i = 0; i < set.motions.size(); ++i) {
      const diagnose::TrackedMotion& motion = set.motions[i];
      const auto at = std::find_if(tracks.setups.begin(), tracks.setups.end(), [&](const auto& setup) {
        return setup.name == diagnose::twin_name(set.clips[motion.clip].name);
      });
      REQUIRE(at != tracks.setups.end());
      const auto& x_m = tracks.tracks[static_cast<std::size_t>(at - tracks.setups.begin())].x_m;
      const std::vector<double> fitted =
          diagnose::move(diagnose::model_of(set, *fit.layout, fit.at, i), motion.t_s).x_m;
      const std::vector<double> without =
          diagnose::move(diagnose::model_of(set, *nominal.layout, nominal.at, i), motion.t_s).x_m;
      for (std::size_t p = 0; p < std::min(fitted.size(), x_m.size()); ++p) {
        most = std::max(most, std::abs(fitted[p] - twin.from_m - x_m[p]));
        moved = std::max(moved, std::abs(fitted[p] - without[p]));
      }
    }
    CHECK(moved > 1e-3);  // the effect moves the glider far more
    CHECK(most < 1e-6);   // than two integrators and nine figures of a file differ
  }
}

TEST_CASE("a twin of something without a name says that it lacks it") {
  const auto made = tests::made_experiment(tests::made_launches(), {}, 5);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::Twin twin = diagnose::twin_of(set, diagnose::fit_nominal(set), {}, true, {});
  REQUIRE(twin.lacks.size() == 1);
  CHECK(twin.lacks.front().what == "what is missing");
  CHECK(twin.toml.find("# Not in it: what is missing (it has no name).") != std::string::npos);
  CHECK(twin.toml.find("# Assumed: the camera, except for its frame rate") != std::string::npos);
}

TEST_CASE("a twin with a wrong scale lies on the data beside it, and one without what is missing does not") {
  const auto rms = [](const diagnose::Diagnosis& diagnosis) {
    double square = 0.0, noise = 0.0;
    for (const validate::TwinMotion& motion : validate::twin_motions(diagnosis, 1)) {
      REQUIRE(motion.rest_m.size() > 30);
      for (const double x : motion.rest_m) square += x * x;
      for (const double x : motion.noise_m) noise += x * x;
    }
    return std::sqrt(square / noise);
  };
  const tests::MadeEffect longer = {{}, [](double x, double) { return 1.03 * x; }};
  const auto made = tests::made_experiment(tests::made_launches(), longer, 3, 3e-5, 150, 100.0, 0.005);
  const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
  // 1200 positions each: a ratio of two such is 1 to 2.9 %; five of those.
  CHECK(std::abs(rms(diagnosis) - 1.0) < 0.15);
  auto without = diagnosis;
  without.effects.clear();
  if (diagnosis.effects.front().id == "scale_error") CHECK(rms(without) > 10.0);
}
