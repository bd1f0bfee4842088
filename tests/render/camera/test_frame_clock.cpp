#include "render/camera/frame_clock.h"

#include <cmath>
#include <vector>

#include "render/scenario/clip_motion.h"
#include "tests/catch.h"

using namespace glidelab;
using namespace glidelab::render;

namespace {

constexpr std::size_t kSlots = 20'000;
constexpr double kClaim = 4.5;  // standard errors; two-sided 7e-6 a check

double part(const FrameClock& clock, FrameFate fate) {
  double count = 0.0;
  for (std::size_t k = 1; k < kSlots; ++k) count += clock.fate(k) == fate ? 1.0 : 0.0;
  return count / (kSlots - 1.0);
}

}  // namespace

TEST_CASE("A right clock starts frame k at k / rate and records every one") {
  const FrameClock clock({}, 200.0, 5, 1);
  for (std::size_t k = 0; k < 3000; k += 7) {
    CHECK(clock.start_s(k) == static_cast<double>(k) / 200.0);
    CHECK(clock.stamp_s(k) == static_cast<double>(k) / 200.0);
    CHECK(clock.fate(k) == FrameFate::recorded);
  }
  CHECK(clock.frames_of(3000) == 3000);
}

TEST_CASE("A rate error shortens the frames, and the camera's own stamps do not show it") {
  const FrameClock clock({.rate_error_ppm = 500.0}, 240.0, 5, 1);
  CHECK(std::abs(clock.start_s(24'000) - 100.0 / 1.0005) < 1e-9);
  CHECK(clock.stamp_s(24'000) == 100.0);
}

TEST_CASE("Jitter is normal, white, of the given size, and the same for the same clip") {
  const FrameClock clock({.jitter_s = 1e-4}, 100.0, 5, 1);
  const FrameClock other({.jitter_s = 1e-4}, 100.0, 5, 2);
  double square = 0.0, fourth = 0.0, lag = 0.0, across = 0.0, last = 0.0;
  const double n = kSlots - 1.0;
  for (std::size_t k = 1; k < kSlots; ++k) {
    const double z = (clock.start_s(k) - static_cast<double>(k) / 100.0) / 1e-4;
    REQUIRE(std::abs(z) <= kLargestJitter);
    square += z * z / n;
    fourth += z * z * z * z / n;
    lag += z * last / n;
    across += z * (other.start_s(k) - static_cast<double>(k) / 100.0) / 1e-4 / n;
    last = z;
    // A stamp shows the jitter that was.
    REQUIRE(std::abs(clock.stamp_s(k) - clock.start_s(k)) < 1e-12);
  }
  CHECK(clock.start_s(0) == 0.0);
  CHECK(std::abs(square - 1.0) < kClaim * std::sqrt(2.0 / n));
  CHECK(std::abs(fourth - 3.0) < kClaim * std::sqrt(96.0 / n));
  CHECK(std::abs(lag) < kClaim / std::sqrt(n));
  CHECK(std::abs(across) < kClaim / std::sqrt(n));
  CHECK(FrameClock({.jitter_s = 1e-4}, 100.0, 5, 1).start_s(77) == clock.start_s(77));
}

TEST_CASE("Stamps are rounded to their tick") {
  const FrameClock clock({.variable = true, .stamp_tick_s = 1.0 / 600.0}, 240.0, 5, 1);
  // 2.5 ticks a frame: intervals of 2 and 3 ticks, 3.33 and 5 ms, as phones write them.
  for (std::size_t k = 0; k < 100; ++k) {
    const double ticks = clock.stamp_s(k) * 600.0;
    CHECK(std::abs(ticks - std::round(ticks)) < 1e-9);
    CHECK(std::abs(ticks - 2.5 * static_cast<double>(k)) <= 0.5 + 1e-9);
  }
}

TEST_CASE("Frames are dropped and duplicated as often as asked, never the first") {
  const FrameClock clock({.dropped_fraction = 0.03, .duplicated_fraction = 0.05}, 100.0, 9, 0);
  CHECK(clock.fate(0) == FrameFate::recorded);
  CHECK(std::abs(part(clock, FrameFate::dropped) - 0.03) < kClaim * std::sqrt(0.03 * 0.97 / kSlots));
  CHECK(std::abs(part(clock, FrameFate::duplicated) - 0.05) < kClaim * std::sqrt(0.05 * 0.95 / kSlots));
  std::size_t frames = 0;
  for (std::size_t k = 0; k < 1000; ++k) frames += clock.fate(k) == FrameFate::dropped ? 0 : 1;
  CHECK(clock.frames_of(1000) == frames);
}

TEST_CASE("The glider is where it is at the true times of the exposures, over the chunks' ends") {
  sim::Body body;
  body.mass_kg = 0.3;  // no forces on a level track: x = x0 + v t
  sim::MotionSetup motion;
  motion.x0_m = -0.4;
  motion.v0_m_s = 0.05;
  motion.duration_s = 15.0;
  Recording recording{100.0, 0.002};
  recording.clock = {.rate_error_ppm = 800.0, .jitter_s = 2e-4};
  const FrameClock clock(recording.clock, 100.0, 3, 0);
  std::size_t count = 0;
  for_each_frame(body, motion, recording, clock, 0.001, [&](const FrameMotion& frame) {
    REQUIRE(frame.start_s == clock.start_s(frame.frame));
    // The solver's 1e-9 m over 10 s, twice where a second chunk starts from the first.
    REQUIRE(std::abs(frame.middle.x_m - (-0.4 + 0.05 * (clock.start_s(frame.frame) + 0.001))) < 2e-9);
    ++count;
  });
  CHECK(count == 1501);  // floor(14.998 s * 100.08 Hz) + 1: the error gives 1 frame more
}
