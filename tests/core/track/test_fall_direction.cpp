#include "core/track/fall_direction.h"

#include <cmath>
#include <functional>

#include "tests/catch.h"
#include "tests/core/notes.h"

using namespace glidelab;

namespace {

constexpr double kG = 9.81;

core::TrackData track_of(double until_s, const std::function<double(double)>& x) {
  core::TrackData track;
  for (int i = 0; i * 0.01 <= until_s; ++i) {
    track.t_s.push_back(0.01 * i);
    track.x_m.push_back(x(0.01 * i));
  }
  return track;
}

/// x = (v²/g) ln cosh(g t/v), positive downwards: from rest towards the terminal velocity v with quadratic drag.
double with_drag(double t_s, double v_m_s) {
  return v_m_s * v_m_s / kG * std::log(std::cosh(kG * t_s / v_m_s));
}

core::TrackData reversed(core::TrackData track) {
  for (double& x : track.x_m) x = -x;
  return track;
}

void check_sign(const core::TrackData& downwards) {
  CHECK(core::signed_drop(downwards) > 0.0);
  CHECK(core::signed_drop(reversed(downwards)) < 0.0);
}

}  // namespace

TEST_CASE("a body falls in the direction in which x is counted downwards, wherever it lands") {
  check_sign(track_of(1.0, [](double t) { return with_drag(t, 1.3); }));
  check_sign(track_of(0.5, [](double t) { return 0.5 * kG * t * t; }));
  // Thrown upwards at 4 m/s: it lands above its start, or is still on its way up at the end.
  check_sign(track_of(0.6, [](double t) { return -4.0 * t + 0.5 * kG * t * t; }));
  check_sign(track_of(0.35, [](double t) { return -4.0 * t + 0.5 * kG * t * t; }));
  // Faster than its terminal velocity of 1 m/s: it slows down, by less than g, and still goes down.
  check_sign(track_of(0.5, [](double t) { return t + 0.5 / 9.81 * (1.0 - std::exp(-9.81 * t)); }));
  // It falls for 0.4 s and lies on the floor for 0.6 s: no parabola.
  check_sign(track_of(1.0, [](double t) { return 0.5 * kG * std::pow(std::min(t, 0.4), 2); }));
}

TEST_CASE("the tracks of a set-up share one sign, and a second reversal takes the first one's note back") {
  core::TrackData fall = reversed(track_of(1.0, [](double t) { return with_drag(t, 1.3); }));
  core::TrackData unclear = track_of(0.1, [](double t) { return 0.01 * t; });  // a hand at the end of the rail
  const double x_m = unclear.x_m.back();
  core::count_downwards({&fall, &unclear});
  CHECK(fall.x_m.back() > fall.x_m.front());
  CHECK(unclear.x_m.back() == -x_m);
  CHECK(tests::note_of<core::CountedAlongMotion>(unclear.notes) != nullptr);
  fall = reversed(fall);
  core::count_downwards({&fall, &unclear});
  CHECK(unclear.x_m.back() == x_m);
  CHECK(tests::note_of<core::CountedAlongMotion>(unclear.notes) == nullptr);
}

TEST_CASE("speeds and forces are reversed with their track") {
  core::TrackData track = track_of(0.5, [](double t) { return -0.5 * kG * t * t; });
  track.force_n.assign(track.t_s.size(), 2.0);
  core::count_downwards({&track});
  CHECK(track.force_n.front() == -2.0);
  core::TrackData speeds;
  for (int i = 0; i < 20; ++i) {
    speeds.t_s.push_back(0.01 * i);
    speeds.v_m_s.push_back(-0.1 * i);
  }
  core::count_downwards({&speeds});
  CHECK(speeds.v_m_s.back() == Approx(1.9));
}
