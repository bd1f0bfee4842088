#include <algorithm>
#include <cmath>

#include "base/staged_output.h"
#include "catch.h"
#include "diagnose/diagnose.h"
#include "diagnose/made_motions.h"
#include "render/scenario.h"
#include "temp_dir.h"
#include "validate/made_tracks.h"

using namespace glidelab;

namespace {

const tests::MadeEffect kDrag = {[](double, double, double v, double) { return -0.05 * v * std::abs(v); }, {}};

}  // namespace

TEST_CASE("a twin moves as the data do, to their noise") {
  const double noise = 3e-5;
  const auto made = tests::made_experiment(tests::made_launches(), kDrag, 11, noise);
  const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  REQUIRE(diagnosis.verdict == "effect");
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

TEST_CASE("a twin says which effect a scenario cannot express") {
  const tests::MadeEffect bow = {[](double m, double x, double, double) { return m * 9.8 * 0.01 * x; }, {}};
  const auto made = tests::made_experiment(tests::made_launches(), bow, 7);
  const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  REQUIRE(diagnosis.verdict == "effect");
  CHECK(diagnosis.twin_lacks == std::vector<std::string>{"track_bow"});
}
