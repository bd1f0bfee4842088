#include <algorithm>
#include <cmath>
#include <random>

#include "core/motion/analyze_motion.h"
#include "core/motion/configurations.h"
#include "tests/catch.h"
#include "tests/core/notes.h"
#include "tests/core/simulated_track.h"

using namespace glidelab;
using core::LeftOut;

namespace {

/// A bead in glycerol, seen in bursts of three positions 0.1 s apart, one in `every` tenths of a second.
core::TrackData seen_in_bursts(double v_m_s, double noise_m, unsigned seed, int every = 11) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, noise_m);
  core::TrackData track;
  for (int i = 0; i < 200; ++i) {
    if (i % every > 2) continue;
    track.t_s.push_back(0.1 * i);
    track.x_m.push_back(v_m_s * track.t_s.back() + normal(random));
  }
  core::take_rows_as_frames(track);
  return track;
}

std::size_t at_rest(const core::ClipResult& clip) {
  return static_cast<std::size_t>(std::ranges::count(clip.motion, LeftOut::rest, &core::MotionPoint::left_out));
}

}  // namespace

TEST_CASE("a motion too slow for its speed to be seen between gaps is no rest if it covers a distance") {
  core::ClipSetup setup = tests::clip_setup(core::Launched::unknown, 90.0);
  for (unsigned seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    // 70 mm with a noise of 0.12 mm, and none.
    const core::ClipResult moves = core::analyze_motion(setup, seen_in_bursts(3.5e-3, 1.2e-4, seed), {});
    CHECK(10 * at_rest(moves) < moves.motion.size());  // noise may turn the last positions back
    const core::ClipResult rests = core::analyze_motion(setup, seen_in_bursts(0.0, 1.2e-4, seed), {});
    CHECK(at_rest(rests) == rests.motion.size());
  }
}

TEST_CASE("a line that is missing because of gaps says how many positions they cost") {
  const core::ClipSetup setup = tests::clip_setup(core::Launched::unknown, 4.0);
  const core::TrackData track = seen_in_bursts(3.5e-3, 1.2e-4, 1, 25);
  const core::AnalysisResults results = core::analyze_tracks({setup}, {track}, tests::kGravity, {}, 1);
  const auto* const why = tests::reason_of<core::unknown::NoLine>(results.configurations.front().k_over_m_1_s);
  REQUIRE(why != nullptr);
  CHECK(why->positions == track.t_s.size());
  const auto gaps = std::ranges::find(why->left_out, LeftOut::kernel_gap, &std::pair<LeftOut, std::size_t>::first);
  REQUIRE(gaps != why->left_out.end());
  CHECK(2 * gaps->second > why->positions);
}
