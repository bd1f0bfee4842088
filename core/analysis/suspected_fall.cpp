#include "core/analysis/suspected_fall.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/experiment/local_gravity.h"
#include "core/math/parabola.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kFewest = 8;                              // positions
constexpr double kLeast = 0.5, kMost = 1.05, kSlowStart = 0.5;  // of g; the speed at the start, of that at the end
constexpr std::size_t kParts = 3;                               // drag takes its part in the first of these already

/// The mean acceleration of positions that begin slowly; 0 if they do not.
double speeding_up(const std::vector<double>& t_s, const std::vector<double>& x_m) {
  const Parabola parabola = parabola_through(t_s, x_m);
  const double half_change = 0.5 * parabola.a * (t_s.back() - t_s.front());
  return std::abs(parabola.v - half_change) < kSlowStart * std::abs(parabola.v + half_change) ? parabola.a : 0.0;
}

/// Whether the body slows down where it goes on in the same direction, until nearly the farthest position: a cart does
/// that after a push. A fall gains speed, or keeps it, until the body meets the floor.
bool slows_down(const std::vector<double>& t_s, const std::vector<double>& x_m, double direction) {
  constexpr double kFirstPart = 0.25, kLastPart = 0.75, kNearlyAll = 0.9;  // of the way
  constexpr double kSlower = 0.9;                                          // of the speed at first
  if (t_s.size() < kFewest) return false;
  double farthest = 0.0;
  for (const double x : x_m) farthest = std::max(farthest, direction * (x - x_m[0]));
  const auto time_at = [&](double part) {
    std::size_t i = 0;
    while (direction * (x_m[i] - x_m[0]) < part * farthest) ++i;
    return t_s[i] - t_s[0];
  };
  const double early = time_at(kFirstPart), late = time_at(kNearlyAll) - time_at(kLastPart);
  return farthest > 0.0 && (kNearlyAll - kLastPart) * early < kSlower * kFirstPart * late;
}

}  // namespace

std::optional<MayBeAFall> suspected_fall(const ClipResult& clip) {
  std::vector<double> t_s, x_m, longest_t_s, longest_x_m;
  std::size_t after_longest = 0;
  const auto end_run = [&](std::size_t after) {
    if (t_s.size() > longest_t_s.size()) {
      longest_t_s = t_s;
      longest_x_m = x_m;
      after_longest = after;
    }
    t_s.clear();
    x_m.clear();
  };
  for (std::size_t i = 0; i < clip.motion.size(); ++i) {
    const MotionPoint& point = clip.motion[i];
    if (point.left_out != LeftOut::hand) {
      end_run(i);
    } else if (point.measured_m) {
      t_s.push_back(point.t_s);
      x_m.push_back(*point.measured_m);
    }
  }
  end_run(clip.motion.size());
  const std::size_t positions = longest_t_s.size();
  if (positions < kFewest) return {};
  longest_t_s.resize(std::max(kFewest, positions / kParts));
  longest_x_m.resize(longest_t_s.size());
  const double a = speeding_up(longest_t_s, longest_x_m) / kStandardGravity_m_s2;
  if (std::abs(a) < kLeast || std::abs(a) > kMost) return {};
  t_s.clear();
  x_m.clear();
  for (std::size_t i = after_longest; i < clip.motion.size(); ++i) {
    if (!clip.motion[i].measured_m) continue;
    t_s.push_back(clip.motion[i].t_s);
    x_m.push_back(*clip.motion[i].measured_m);
  }
  if (slows_down(t_s, x_m, std::copysign(1.0, a))) return {};
  return MayBeAFall{positions, std::abs(a) * kStandardGravity_m_s2};
}

}  // namespace glidelab::core
