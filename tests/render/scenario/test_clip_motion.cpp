#include "render/scenario/clip_motion.h"

#include <cmath>

#include "sim/force/law_list.h"
#include "tests/catch.h"

using namespace glidelab;
using namespace glidelab::render;

namespace {

sim::Body paper_like_body() {
  sim::Body body;
  body.mass_kg = 0.335;
  body.incline_rad = 0.075;
  body.forces = {sim::laws::viscous().with({0.93}), sim::laws::coulomb().with({0.007})};
  return body;
}

}  // namespace

TEST_CASE("A clip has the frames whose exposure ends within the motion") {
  const Recording recording{200.0, 0.001};
  const auto frames = [&](double duration_s) {
    sim::MotionSetup motion;
    motion.duration_s = duration_s;
    return frame_count(recording, motion);
  };
  CHECK(frames(1.8) == 360);  // the last exposure is [1.795, 1.796]
  CHECK(frames(1.796) == 360);
  CHECK(frames(1.7959) == 359);
  CHECK(frames(0.0001) == 1);
}

TEST_CASE("The middle of a frame is its mid-exposure, on a clock that starts with the first one") {
  const Recording recording{200.0, 0.002};
  sim::MotionSetup motion;
  motion.x0_m = 0.2;
  motion.v0_m_s = -1.3;
  motion.duration_s = 1.0;
  const sim::Body body = paper_like_body();
  std::vector<double> times;
  for (std::size_t k = 0; k < frame_count(recording, motion); ++k)
    times.push_back(static_cast<double>(k) / 200.0 + 0.001);
  const sim::Trajectory direct = sim::simulate(body, motion.x0_m, motion.v0_m_s, times);
  std::size_t next = 0;
  for_each_frame(body, motion, recording, 0.0005, [&](const FrameMotion& frame) {
    REQUIRE(frame.frame == next);
    const sim::State& expected = direct.states[next++];
    // Both are within the solver's 1e-9 m of the true motion.
    CHECK(std::abs(frame.middle.x_m - expected.x_m) < 1e-9);
    CHECK(std::abs(frame.middle.v_m_s - expected.v_m_s) < 1e-8);
    CHECK(frame.middle.t_s == static_cast<double>(frame.frame) / 200.0);
    // The parts lie evenly about the middle, no farther apart than asked.
    REQUIRE_FALSE(frame.x_m.empty());
    CHECK(std::abs(expected.v_m_s) * 0.002 / static_cast<double>(frame.x_m.size()) <= 0.0005 * (1.0 + 1e-6));
    double mean = 0.0;
    for (const double x : frame.x_m) mean += x / static_cast<double>(frame.x_m.size());
    // The mean over the exposure is off the middle by a T²/24 at most, 5 m/s² * 4e-6 s² / 24 ~ 1e-6 m.
    CHECK(std::abs(mean - expected.x_m) < 1e-6);
  });
  CHECK(next == times.size());
}

TEST_CASE("A long clip, simulated in chunks, is the motion simulated at once") {
  // 2,500 frames are three chunks; the glider comes to its limit speed and on. Both within the solver's tolerance.
  const Recording recording{1000.0, 0.001};
  sim::MotionSetup motion;
  motion.v0_m_s = -1.0;
  motion.duration_s = 2.5;
  const sim::Body body = paper_like_body();
  std::vector<double> times;
  for (int k = 0; k < 2500; ++k) times.push_back(k / 1000.0 + 0.0005);
  const sim::Trajectory direct = sim::simulate(body, 0.0, -1.0, times);
  std::size_t next = 0;
  for_each_frame(body, motion, recording, 0.001, [&](const FrameMotion& frame) {
    const sim::State& expected = direct.states[next++];
    CHECK(std::abs(frame.middle.x_m - expected.x_m) < 2e-9);
    CHECK(frame.middle.mode == expected.mode);
  });
  CHECK(next == 2500);
}
