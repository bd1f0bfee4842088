#include "sim/sensitivity/driven_track.h"

#include <cmath>
#include <limits>
#include <vector>

#include "base/errors.h"
#include "sim/oracle/closed_forms.h"
#include "tests/catch.h"

using namespace glidelab;
using namespace glidelab::sim;

namespace {

std::vector<double> times(double step_s, int count) {
  std::vector<double> t_s;
  for (int i = 0; i < count; ++i) t_s.push_back(i * step_s);
  return t_s;
}

/// A drive that changes its sign, has a corner, and ends.
RecordedDrive uneven_drive() {
  return {{0.0, 0.11, 0.35, 0.5, 0.9, 1.3, 1.7}, {0.3, 1.9, -1.4, -1.6, 0.05, 2.1, 0.0}};
}

struct Case {
  const char* what;
  double k, drive, friction, x0, v0;
};

constexpr Case kCases[] = {{"down", 2.7, 0.73, 0.07, -0.2, 0.1},
                           {"up and back", 2.7, 0.73, 0.07, 0.5, -1.2},
                           {"level, sticks between", 2.1, 0.0, 0.4, 0.0, 0.3},
                           {"from rest", 1.1, 0.0, 0.5, 0.1, 0.0},
                           {"no damping", 0.0, 0.1, 0.1, 0.0, -0.7},
                           {"driving damping", -0.4, 0.0, 0.2, 0.0, 0.5}};

double drive_at(const RecordedDrive& drive, double t) {
  if (t <= drive.t_s.front()) return drive.p_m_s2.front();
  for (std::size_t i = 1; i < drive.t_s.size(); ++i) {
    if (t > drive.t_s[i]) continue;
    const double part = (t - drive.t_s[i - 1]) / (drive.t_s[i] - drive.t_s[i - 1]);
    return drive.p_m_s2[i - 1] + part * (drive.p_m_s2[i] - drive.p_m_s2[i - 1]);
  }
  return drive.p_m_s2.back();
}

/// Euler's method by the half-explicit rule at v = 0, in steps of 2 us: an error of about 1e-6 m.
std::vector<double> stepped(const Case& c, const RecordedDrive& drive, const std::vector<double>& t_s) {
  constexpr double kStep_s = 2e-6;
  std::vector<double> x_m;
  double x = c.x0, v = c.v0;
  long n = 0;
  for (const double until : t_s) {
    for (; static_cast<double>(n) * kStep_s < until - 0.5 * kStep_s; ++n) {
      const double pull = c.drive + drive_at(drive, (static_cast<double>(n) + 0.5) * kStep_s) - c.k * v;
      const double free = v + kStep_s * pull;  // without friction, which takes as much as it can of it
      const double next = std::copysign(std::max(0.0, std::abs(free) - kStep_s * c.friction), free);
      x += 0.5 * kStep_s * (v + next);
      v = next;
    }
    x_m.push_back(x);
  }
  return x_m;
}

}  // namespace

TEST_CASE("the driven motion is that of small steps, through turns, rests and release") {
  const std::vector<double> t_s = times(0.02, 100);
  for (const Case& c : kCases) {
    const auto closed = driven_track_sensitive(c.k, c.drive, c.friction, c.x0, c.v0, t_s, uneven_drive());
    const std::vector<double> small = stepped(c, uneven_drive(), t_s);
    for (std::size_t i = 0; i < t_s.size(); ++i) {
      INFO(c.what << " at " << t_s[i] << " s");
      CHECK(std::abs(closed[i].x_m - small[i]) < 2e-5);
    }
  }
}

TEST_CASE("its derivatives are those of finite differences") {
  const std::vector<double> t_s = times(0.02, 100);
  constexpr double kStep = 1e-6;
  for (const Case& c : kCases) {
    const auto at = [&](int parameter, double by) {
      double p[5] = {c.k, c.drive, c.friction, c.x0, c.v0};
      p[parameter] += by;
      return driven_track_sensitive(p[0], p[1], p[2], p[3], p[4], t_s, uneven_drive());
    };
    const auto exact = at(0, 0.0);
    for (int parameter = 0; parameter < 5; ++parameter) {
      if (parameter == 4 && c.v0 == 0.0) continue;  // to either side of rest it goes another way
      const auto above = at(parameter, kStep), below = at(parameter, -kStep);
      for (std::size_t i = 0; i < t_s.size(); ++i) {
        INFO(c.what << ", parameter " << parameter << " at " << t_s[i] << " s");
        const double difference = (above[i].x_m - below[i].x_m) / (2.0 * kStep);
        // h² times a third derivative of some 10², and rounding of 1e-15/h.
        CHECK(std::abs(exact[i].by_parameter(0, parameter) - difference) < 2e-6 * (1.0 + std::abs(difference)));
      }
    }
  }
}

TEST_CASE("a drive that stays the same is a constant one, and no drive none") {
  const std::vector<double> t_s = times(0.013, 150);
  const RecordedDrive same{{0.0, 0.2, 0.21, 1.0, 3.0}, {0.4, 0.4, 0.4, 0.4, 0.4}};
  for (const Case& c : kCases) {
    if (c.v0 == 0.0 && std::abs(c.drive) <= c.friction) continue;  // it sticks under either, of the same place
    const auto driven = driven_track_sensitive(c.k, c.drive, c.friction, c.x0, c.v0, t_s, same);
    const auto constant = track_motion_sensitive(c.k, c.drive + 0.4, c.friction, c.x0, c.v0, t_s);
    const auto none = driven_track_sensitive(c.k, c.drive, c.friction, c.x0, c.v0, t_s, {});
    const auto plain = track_motion_sensitive(c.k, c.drive, c.friction, c.x0, c.v0, t_s);
    for (std::size_t i = 0; i < t_s.size(); ++i) {
      INFO(c.what << " at " << t_s[i] << " s");
      CHECK(std::abs(driven[i].x_m - constant[i].x_m) < 1e-11);
      CHECK((driven[i].by_parameter - constant[i].by_parameter).cwiseAbs().maxCoeff() < 1e-9);
      CHECK(none[i].x_m == plain[i].x_m);
    }
  }
}

TEST_CASE("a glider that stops exactly where a sample lies turns there") {
  // a = -1 from v = 1: at rest at 1 s, where the drive turns from -1 to a slope; no friction, no drag.
  const RecordedDrive drive{{0.0, 1.0, 2.0}, {-1.0, -1.0, -1.0}};
  const auto at = driven_track_sensitive(0.0, 0.0, 0.0, 0.0, 1.0, times(0.5, 5), drive);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double t = 0.5 * static_cast<double>(i);
    CHECK(std::abs(at[i].x_m - (t - 0.5 * t * t)) < 1e-14);
  }
  CHECK(at.back().mode == Mode::slide_up);
}

TEST_CASE("a driven motion of no number is an error") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(driven_track_sensitive(nan, 0.0, 0.1, 0.0, 1.0, times(0.1, 3), uneven_drive()), base::NumericalError);
}

TEST_CASE(
    "a motion that turns again and again is followed, and one of more than a hundred thousand turns is an error") {
  // No friction and no drag under +1, -1, +1, …, a second each, from v = -1/2: v falls and rises as a saw between -1/2
  // and 1/2 and turns in the middle of every piece. It never rests, so that the turns alone can count.
  const auto turning = [](std::size_t turns) {
    RecordedDrive saw;
    for (std::size_t i = 0; i < turns; ++i) {
      const double from = static_cast<double>(i), p = i % 2 == 0 ? 1.0 : -1.0;
      saw.t_s.insert(saw.t_s.end(), {from, std::nextafter(from + 1.0, 0.0)});
      saw.p_m_s2.insert(saw.p_m_s2.end(), {p, p});
    }
    return driven_track_sensitive(0.0, 0.0, 0.0, 0.0, -0.5, {{0.0, static_cast<double>(turns)}}, saw).back().x_m;
  };
  // Each piece brings it back, by half of the way from rest as far as by the half before. A time of 1e5 s is rounded to
  // 1.5e-11 s in each of 1e5 pieces and v to as much in m/s, which adds up to 5e-9 m/s, in 1e5 s to less than 1e-3 m.
  CHECK(std::abs(turning(99998)) < 1e-3);
  CHECK_THROWS_AS(turning(100002), base::NumericalError);
}
