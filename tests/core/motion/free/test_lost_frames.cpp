#include "core/motion/free/lost_frames.h"

#include <cmath>

#include "core/motion/analyze_motion.h"
#include "tests/catch.h"
#include "tests/core/notes.h"
#include "tests/core/simulated_track.h"

using namespace glidelab;
using namespace glidelab::core;

namespace {

const tests::Law kLaw{4.3, 0.0071, 2.77};

/// The motion filmed, without the given frames; those behind move up, as in a file of constant rate.
TrackData film_without(const tests::SimulatedMotion& motion, const tests::Filming& how,
                       const std::vector<std::size_t>& lost) {
  const TrackData whole = tests::film(motion, how);
  TrackData track;
  track.frame_rate_hz = how.frame_rate_hz;
  for (std::size_t i = 0; i < whole.x_m.size(); ++i) {
    if (std::find(lost.begin(), lost.end(), i) != lost.end()) continue;
    track.frame.push_back(track.t_s.size());
    track.t_s.push_back(static_cast<double>(track.t_s.size()) / how.frame_rate_hz);
    track.x_m.push_back(whole.x_m[i]);
  }
  track.frame_t_s = track.t_s;
  return track;
}

std::vector<LostFrames> lost_in(const TrackData& track) {
  return find_lost_frames(track, motion_of(track, 0.335));
}

/// Up a slope and down again.
tests::SimulatedMotion up_and_down() {
  return tests::launch(kLaw, -1.4, 2.0);
}

}  // namespace

TEST_CASE("frames lost without a gap in the times are found one by one with their number") {
  // 30 frames per second and a noise of 25 um: the glider moves 20 to 45 mm per frame at these places.
  const tests::Filming how{30.0, 2.0, 2.5e-5, 3};
  const TrackData track = film_without(up_and_down(), how, {5, 11, 12, 40, 43, 50});
  const auto lost = lost_in(track);
  REQUIRE(lost.size() == 5);
  const std::size_t last_before[] = {4, 9, 36, 38, 44};  // frames of the file
  const std::size_t counts[] = {1, 2, 1, 1, 1};
  for (std::size_t i = 0; i < lost.size(); ++i) {
    CHECK(std::lround(lost[i].after_s * 30.0) == static_cast<long>(last_before[i]));
    CHECK(lost[i].count == counts[i]);
  }
  // With the times put right every position is where the motion is at that time, to six deviations of its noise.
  const TrackData right = put_right(track, lost);
  for (std::size_t i = 0; i < right.t_s.size(); ++i)
    CHECK(std::abs(right.x_m[i] - up_and_down().x(right.t_s[i])) < 6.0 * how.noise_m);
}

TEST_CASE("a frame alone between two losses is found, with one before it and one behind") {
  const tests::Filming how{30.0, 2.0, 2.5e-5, 4};
  const auto lost = lost_in(film_without(up_and_down(), how, {6, 8}));
  REQUIRE(lost.size() == 2);
  CHECK(std::lround(lost[0].after_s * 30.0) == 5);
  CHECK(std::lround(lost[1].after_s * 30.0) == 6);
  CHECK(lost[0].count == 1);
  CHECK(lost[1].count == 1);
}

TEST_CASE("frames lost next to a turn, where friction steps, are found at their place") {
  // The acceleration steps there by 2 mu g, 0.39 m/s²: within a frame's time of it no cubic comes nearer than 50 um.
  const tests::SimulatedMotion motion = tests::launch({4.3, 0.02, 2.77}, -1.4, 2.0);
  double turn_s = 0.0;
  while (motion.x(turn_s + 1e-4) < motion.x(turn_s)) turn_s += 1e-4;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    for (const double rate : {30.0, 60.0}) {
      const auto behind = static_cast<std::size_t>(std::ceil(turn_s * rate));
      for (const std::size_t frame : {behind + 1, behind + 2}) {
        const auto lost = lost_in(film_without(motion, {rate, 2.0, 5e-6, seed}, {frame}));
        INFO("seed " << seed << ", rate " << rate << ", frame " << frame);
        REQUIRE(lost.size() == 1);
        CHECK(std::lround(lost[0].after_s * rate) == static_cast<long>(frame) - 1);
        CHECK(lost[0].count == 1);
      }
    }
  }
}

TEST_CASE("no frame is taken for lost in whole motions with pushes, stops, impacts and outliers") {
  std::size_t found = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    for (const double rate : {30.0, 60.0, 240.0}) {
      for (const double noise : {2.5e-6, 5e-5, 1e-3}) {
        tests::Filming how{rate, 3.0, noise, seed};
        const double push = 3.0 + 0.3 * seed;  // m/s² against the slope, then free, an end stop and its rebounds
        const tests::SimulatedMotion motion =
            tests::SimulatedMotion().rest(0.2).push(0.25, -push).slide(kLaw, 3.0, 0.1, 0.6);
        TrackData track = tests::film(motion, how);
        track.x_m[track.x_m.size() / 2] += 0.03;
        found += lost_in(track).size();
        how.rounding_m = 0.002;
        found += lost_in(tests::film(motion, how)).size();
      }
    }
  }
  CHECK(found == 0);
}

TEST_CASE("stamps that show a gap are taken at their word") {
  const tests::Filming how{60.0, 2.0, 5e-6, 1};
  const TrackData whole = tests::film(up_and_down(), how);
  TrackData track = whole;
  for (auto* values : {&track.t_s, &track.x_m, &track.frame_t_s}) values->erase(values->begin() + 20);
  track.frame.pop_back();
  CHECK(lost_in(track).empty());
}

TEST_CASE("a clip with lost frames is analysed with its times put right, and says so") {
  const tests::Filming how{60.0, 2.0, 1e-5, 7};
  const TrackData track = film_without(up_and_down(), how, {12, 30, 95});
  ClipSetup setup = tests::clip_setup(Launched::up, kLaw.alpha_deg);
  const ClipResult right = analyze_motion(setup, track, MotionOptions{});
  const ClipResult kept = analyze_motion(setup, track, MotionOptions{.lost_frames = LostFrameTimes::kept});
  REQUIRE(right.lost_frames.size() == 3);
  CHECK(kept.lost_frames.size() == 3);
  const auto off = [](const ClipResult& clip) {
    REQUIRE(clip.segments.size() == 2);
    return std::abs(clip.segments[0].k_over_m_1_s.value - kLaw.k_1_s) / clip.segments[0].k_over_m_1_s.sd;
  };
  CHECK(off(right) < 4.0);  // fixed seed
  const auto* const of_right = tests::note_of<FramesMissing>(right.notes);
  const auto* const of_kept = tests::note_of<FramesMissing>(kept.notes);
  REQUIRE(of_right != nullptr);
  REQUIRE(of_kept != nullptr);
  CHECK(of_right->frames == 3);
  CHECK(of_right->after_s.size() == 3);
  CHECK(of_right->put_right);
  CHECK_FALSE(of_kept->put_right);
  // The end that a person reads off the file's times goes with them: three lost frames are 50 ms.
  CHECK(right.motion.back().t_s == Approx(track.t_s.back() + 3.0 / 60.0).margin(1e-12));  // sums of eps
}
