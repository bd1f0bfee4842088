#include "core/motion/free/free_motion.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/motion/analyze_motion.h"
#include "tests/catch.h"
#include "tests/core/notes.h"
#include "tests/core/simulated_track.h"

using namespace glidelab;
using core::LeftOut;
using tests::Filming;
using tests::Law;
using tests::SimulatedMotion;

namespace {

const Law kInclined{4.3, 0.0071, 2.77};
const Law kLevel{0.02, 0.0071, 1.8};

core::ClipResult analyze(const core::ClipSetup& setup, const SimulatedMotion& motion, const Filming& how,
                         std::optional<double> bandwidth_s = {}) {
  return core::analyze_motion(setup, tests::film(motion, how), core::MotionOptions{.bandwidth_s = bandwidth_s});
}

std::size_t count(const core::ClipResult& clip, LeftOut reason) {
  return static_cast<std::size_t>(std::count_if(clip.motion.begin(), clip.motion.end(),
                                                [&](const auto& point) { return point.left_out == reason; }));
}

LeftOut at(const core::ClipResult& clip, double t_s) {
  const auto found = std::lower_bound(clip.motion.begin(), clip.motion.end(), t_s,
                                      [](const core::MotionPoint& point, double t) { return point.t_s < t; });
  return found->left_out;
}

/// Every line within four standard deviations of the truth: 1 in 16,000 by chance.
void check_lines(const core::ClipResult& clip, const Law& law) {
  for (const core::LineFit& line : clip.segments) {
    INFO("direction " << line.direction << " K/m " << line.k_over_m_1_s.value << " +- " << line.k_over_m_1_s.sd
                      << " a0 " << line.a0_m_s2.value << " +- " << line.a0_m_s2.sd);
    CHECK(std::abs(line.k_over_m_1_s.value - law.k_1_s) < 4.0 * line.k_over_m_1_s.sd);
    CHECK(std::abs(line.a0_m_s2.value - law.a0(line.direction)) < 4.0 * line.a0_m_s2.sd);
  }
}

}  // namespace

TEST_CASE("a clip in which nothing happens keeps every point but those whose kernel reaches over an end") {
  const auto clip = analyze(tests::clip_setup(core::Launched::down, 4.0), tests::launch(kInclined, 1.2, 1.7), {});
  CHECK(count(clip, LeftOut::used) + count(clip, LeftOut::kernel_end) == clip.frames);
  // 2.5 bandwidths at either end, give or take the frame on the edge
  const double margin = 2.5 * clip.bandwidth_s * clip.frame_rate_hz;
  CHECK(std::abs(static_cast<double>(count(clip, LeftOut::kernel_end)) - 2.0 * margin) <= 2.0);
  REQUIRE(clip.stretches.size() == 1);
  CHECK(clip.stretches[0].direction == 1);
  check_lines(clip, kInclined);
}

TEST_CASE("a reversal splits the motion where v crosses zero, and only the kernel's reach about it is left out") {
  const SimulatedMotion motion = tests::launch(kInclined, -1.3, 1.7);
  const auto clip = analyze(tests::clip_setup(core::Launched::up, 4.0), motion, {});
  REQUIRE(clip.stretches.size() == 2);
  // v = 0 in closed form
  const double turn = std::log1p(1.3 * kInclined.k_1_s / kInclined.a0(-1)) / kInclined.k_1_s;
  CHECK(std::abs(0.5 * (clip.stretches[0].to_s + clip.stretches[1].from_s) - turn) < 0.01);  // two frames
  CHECK(at(clip, turn - 2.0 * clip.bandwidth_s) == LeftOut::kernel_reversal);
  CHECK(at(clip, turn + 2.0 * clip.bandwidth_s) == LeftOut::kernel_reversal);
  CHECK(at(clip, turn + 3.0 * clip.bandwidth_s) == LeftOut::used);
  CHECK(count(clip, LeftOut::stop) + count(clip, LeftOut::hand) + count(clip, LeftOut::rest) == 0);
  check_lines(clip, kInclined);
}

TEST_CASE("rest, push and release at the start are found whatever the camera, and the lines do not know of them") {
  unsigned seed = 1;
  for (const double rate : {100.0, 240.0, 1000.0}) {
    for (const double noise : {1e-5, 2e-4}) {
      for (const double push : {5.0, 20.0}) {
        for (const int direction : {-1, 1}) {
          for (const Law& law : {kLevel, kInclined}) {
            SimulatedMotion motion;
            const double duration = push > 10.0 ? 0.1 : 0.2;
            motion.rest(0.3).push(duration, direction * push).slide(law, 2.5);
            const auto setup = tests::clip_setup(direction > 0 ? core::Launched::down : core::Launched::up,
                                                 law.alpha_deg > 1.0 ? 4.0 : 0.0);
            const auto clip = analyze(setup, motion, {rate, 2.5, noise, ++seed});
            INFO("rate " << rate << " noise " << noise << " push " << push << " direction " << direction << " alpha "
                         << law.alpha_deg);
            CHECK(at(clip, 0.1) == LeftOut::rest);
            CHECK(at(clip, 0.3 + 0.5 * duration) == LeftOut::hand);
            REQUIRE(!clip.stretches.empty());
            CHECK(clip.stretches[0].direction == direction);
            // Not before the release; not later than the pilot's own smearing, some hundredths of a second.
            CHECK(clip.stretches[0].from_s >= 0.3 + duration - 2.0 / rate);
            CHECK(clip.stretches[0].from_s <= 0.3 + duration + 0.2);
            check_lines(clip, law);
          }
        }
      }
    }
  }
}

TEST_CASE("a glider that stops by friction rests, and the end of its motion is an end for the kernel") {
  const SimulatedMotion motion = tests::launch(kLevel, 0.5, 4.0);
  const auto clip = analyze(tests::clip_setup(core::Launched::down, 0.0), motion, {200.0, 4.0, 2e-5});
  const double stop = std::log1p(0.5 * kLevel.k_1_s / -kLevel.a0(1)) / kLevel.k_1_s;
  REQUIRE(clip.stretches.size() == 1);
  // Within 3 sd of the resting place: half a0 tau^2 = 6e-5 m, tau = 42 ms before the stop; never after it.
  CHECK(clip.stretches[0].to_s < stop + 0.011);
  CHECK(clip.stretches[0].to_s > stop - 0.06);
  CHECK(at(clip, 3.0) == LeftOut::rest);
  check_lines(clip, kLevel);
}

TEST_CASE("an end stop within the data, its rebound and what follows do not change the lines beyond their sd") {
  for (const double restitution : {0.0, 0.2, 0.6}) {
    SimulatedMotion motion;
    motion.kick(1.1).slide(kInclined, 2.5, 0.45, restitution);
    const auto clip = analyze(tests::clip_setup(core::Launched::down, 4.0), motion, {200.0, 2.5, 2e-5});
    INFO("restitution " << restitution);
    REQUIRE(!clip.stretches.empty());
    const double hit = clip.stretches[0].to_s;
    CHECK(motion.x(hit) <= 0.45);
    CHECK(motion.x(hit) > 0.35);
    check_lines(clip, kInclined);
  }
}

TEST_CASE("many bounces give a stretch for each run up and down, of one law") {
  const Law law{2.0, 0.003, 0.05};
  SimulatedMotion motion;
  motion.rest(0.5).slide(law, 20.0, 0.7, 0.75);
  const auto clip = analyze(tests::clip_setup(core::Launched::released, 2.0), motion, {100.0, 20.0, 2e-4});
  // The runs get shorter by the coefficient of restitution, 0.75. Those below 0.57 of the first one in their direction
  // are left out.
  CHECK(clip.stretches.size() == 4);
  CHECK(count(clip, LeftOut::short_stretch) > 0);
  for (std::size_t i = 1; i < clip.stretches.size(); ++i) {
    CHECK(clip.stretches[i].from_s > clip.stretches[i - 1].to_s);
  }
  CHECK(count(clip, LeftOut::stop) > 0);
  CHECK(count(clip, LeftOut::rest) > 0);
  check_lines(clip, law);
}

TEST_CASE("a turn through v = 0 with a friction of 0.005 on a slope that hardly beats it is a reversal, not a rest") {
  const Law law{0.4, 0.005, 0.8};
  const auto clip =
      analyze(tests::clip_setup(core::Launched::up, 0.4), tests::launch(law, -0.5, 4.0), {200.0, 4.0, 2e-5});
  REQUIRE(clip.segments.size() == 2);
  CHECK(count(clip, LeftOut::rest) == 0);
  check_lines(clip, law);
}

TEST_CASE("start_s and end_s are taken at their word, and a reversal between them still splits the motion") {
  SimulatedMotion motion;
  motion.rest(0.3).push(0.1, -12.0).slide(kInclined, 2.0);
  auto setup = tests::clip_setup(core::Launched::up, 4.0);
  setup.start_s = 0.45;
  setup.end_s = 1.8;
  const auto clip = analyze(setup, motion, {200.0, 2.0});
  CHECK(count(clip, LeftOut::before_start) == 90);  // 0 to 0.445 s
  CHECK(count(clip, LeftOut::after_end) == 40);     // 1.805 to 2 s
  CHECK(count(clip, LeftOut::hand) + count(clip, LeftOut::stop) + count(clip, LeftOut::rest) == 0);
  REQUIRE(clip.stretches.size() == 2);
  CHECK(clip.stretches[0].from_s == Approx(0.45).margin(1e-12));  // the frame itself
  check_lines(clip, kInclined);
}

TEST_CASE("a hand that carries the glider up before it lets it slide down is left out, and said to be") {
  // Half a cosine of 0.4 m in 1 s, a second's rest, then down.
  core::TrackData track;
  const SimulatedMotion down = SimulatedMotion().rest(2.0).slide(kInclined, 3.6);
  std::mt19937_64 random(4);
  std::normal_distribution<double> noise(0.0, 2e-5);
  for (std::size_t frame = 0; frame <= 720; ++frame) {
    const double t = static_cast<double>(frame) / 200.0;
    const double carried = t < 1.0 ? 0.2 * (1.0 + std::cos(std::numbers::pi * t)) : 0.0;
    track.t_s.push_back(t);
    track.x_m.push_back(carried + down.x(t) + noise(random));
    track.frame.push_back(frame);
  }
  track.frame_t_s = track.t_s;
  track.frame_rate_hz = 200.0;
  const auto clip =
      core::analyze_motion(tests::clip_setup(core::Launched::released, 4.0), track, core::MotionOptions{});
  CHECK(at(clip, 0.5) == LeftOut::hand);
  REQUIRE(clip.segments.size() == 1);
  CHECK(clip.segments[0].direction == 1);
  CHECK(clip.stretches[0].from_s >= 2.0);
  check_lines(clip, kInclined);
}

TEST_CASE("a glider that never moves gives no line and says so by its rest") {
  const auto clip =
      analyze(tests::clip_setup(core::Launched::released, 0.0), SimulatedMotion().rest(3.0), {100.0, 3.0, 1e-4});
  CHECK(clip.segments.empty());
  CHECK(clip.stretches.empty());
  CHECK(count(clip, LeftOut::rest) == clip.frames);
  CHECK_FALSE(clip.v_lim_m_s.estimate);
  CHECK(tests::reason_of<core::unknown::NoDownhillLine>(clip.v_lim_m_s) != nullptr);
}

TEST_CASE("a constant position, and a rounded one that flickers, are rest") {
  core::TrackData track = tests::film(SimulatedMotion(0.42).rest(10.0), {100.0, 10.0, 0.0});
  const auto setup = tests::clip_setup(core::Launched::released, 2.0);
  CHECK(count(core::analyze_motion(setup, track, core::MotionOptions{}), LeftOut::rest) == track.t_s.size());
  for (std::size_t i = 0; i < track.x_m.size(); ++i) track.x_m[i] = (i / 37) % 3 == 1 ? 0.43 : 0.42;
  const auto clip = core::analyze_motion(setup, track, core::MotionOptions{});
  CHECK(clip.segments.empty());
  CHECK(count(clip, LeftOut::used) == 0);
}

TEST_CASE("single positions off the motion are left out as outliers, impacts and their neighbours are not") {
  SimulatedMotion motion;
  motion.kick(1.1).slide(kInclined, 2.0, 0.45, 0.3);
  core::TrackData track = tests::film(motion, {200.0, 2.0, 2e-5});
  for (const std::size_t frame : {20u, 21u, 60u, 300u}) track.x_m[frame] += 0.01;
  const auto clip = core::analyze_motion(tests::clip_setup(core::Launched::down, 4.0), track, core::MotionOptions{});
  CHECK(count(clip, LeftOut::outlier) == 4);
  for (const std::size_t frame : {20u, 21u, 60u, 300u}) {
    CHECK(clip.motion[frame].left_out == LeftOut::outlier);
    CHECK(clip.motion[frame].measured_m == track.x_m[frame]);
  }
  check_lines(clip, kInclined);
}

TEST_CASE("frames without a marker are told from the others, and a wide gap from a narrow one") {
  core::TrackData track = tests::film(tests::launch(kInclined, 1.2, 1.7), {});
  const auto drop = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = 0; i < track.t_s.size();) {
      if (track.frame[i] < from || track.frame[i] >= to) {
        ++i;
        continue;
      }
      track.t_s.erase(track.t_s.begin() + static_cast<std::ptrdiff_t>(i));
      track.x_m.erase(track.x_m.begin() + static_cast<std::ptrdiff_t>(i));
      track.frame.erase(track.frame.begin() + static_cast<std::ptrdiff_t>(i));
    }
  };
  drop(100, 101);
  drop(200, 230);
  const auto clip = core::analyze_motion(tests::clip_setup(core::Launched::down, 4.0), track,
                                         core::MotionOptions{.bandwidth_s = 0.02});
  CHECK(clip.detected == 310);
  CHECK(clip.motion[100].left_out == LeftOut::no_marker);
  CHECK(clip.motion[100].smoothed);
  CHECK(clip.motion[101].left_out == LeftOut::used);
  CHECK(count(clip, LeftOut::no_marker) == 31);
  CHECK(clip.motion[199].left_out == LeftOut::kernel_gap);
  CHECK(clip.motion[230].left_out == LeftOut::kernel_gap);
  check_lines(clip, kInclined);
}

TEST_CASE("what is stated to be free motion is neither at rest nor in a hand") {
  SimulatedMotion motion;
  motion.rest(0.3).kick(0.02).slide(kInclined, 1.7);
  core::ClipSetup setup = tests::clip_setup(core::Launched::down, 4.0);
  CHECK(count(analyze(setup, motion, {}), LeftOut::rest) > 40);  // 0.3 s at 200 Hz, less what a kernel blurs
  const auto of = [&](std::optional<double> start_s, std::optional<double> end_s) {
    setup.start_s = start_s;
    setup.end_s = end_s;
    const core::ClipResult clip = analyze(setup, motion, {});
    return count(clip, LeftOut::rest) + count(clip, LeftOut::hand) + count(clip, LeftOut::stop);
  };
  CHECK(of(0.0, 1.6) == 0);
  CHECK(of(0.0, {}) == 0);
  CHECK(of({}, 1.6) > 40);  // of the start nothing is stated
}

TEST_CASE("a fall from rest towards its terminal velocity is free from the start, in either direction of x") {
  constexpr double kTerminal_m_s = 1.3;  // with a drag in proportion to the square of the speed, as of a coffee filter
  for (const int direction : {1, -1}) {
    core::TrackData track;
    track.frame_rate_hz = 60.0;
    std::mt19937_64 random(3);
    std::normal_distribution<double> noise(0.0, 5e-4);
    for (std::size_t frame = 0; frame < 73; ++frame) {
      const double t = static_cast<double>(frame) / 60.0;
      const double x =
          kTerminal_m_s * kTerminal_m_s / tests::kGravity * std::log(std::cosh(tests::kGravity * t / kTerminal_m_s));
      track.t_s.push_back(t);
      track.x_m.push_back(direction * x + noise(random));
      track.frame.push_back(frame);
    }
    track.frame_t_s = track.t_s;
    const auto clip =
        core::analyze_motion(tests::clip_setup(core::Launched::unknown, direction * 90.0, 0.002), track, {});
    CHECK(count(clip, LeftOut::hand) == 0);
    CHECK(count(clip, LeftOut::stop) == 0);
    REQUIRE(clip.stretches.size() == 1);
    CHECK(clip.stretches[0].from_s < 0.1);
    // The same motion on a track that nobody calls a fall: what speeds up by g there is a hand.
    const auto on_track = core::analyze_motion(tests::clip_setup(core::Launched::unknown, 0.0, 0.002), track, {});
    CHECK(count(on_track, LeftOut::hand) > 15);
  }
}

TEST_CASE("a fall that ends on the floor has its impact left out") {
  SimulatedMotion motion;
  motion.slide({90.0, 0.0, 0.3}, 1.4, 2.0, 0.5);  // released at 0, floor at 2 m, rebounds with half the speed
  const auto clip = analyze(tests::clip_setup(core::Launched::released, 90.0), motion, {240.0, 1.0, 1e-4});
  const double floor_s = 0.64;  // sqrt(2 * 2 m / g) = 0.639 s, and a little more with drag
  CHECK(at(clip, 0.3) == LeftOut::used);
  REQUIRE_FALSE(clip.stretches.empty());
  CHECK(clip.stretches[0].to_s < floor_s + 0.03);
  check_lines(clip, {90.0, 0.0, 0.3});
}
