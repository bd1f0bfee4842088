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

}  // namespace

std::optional<MayBeAFall> suspected_fall(const ClipResult& clip) {
  std::vector<double> t_s, x_m, longest_t_s, longest_x_m;
  const auto end_run = [&] {
    if (t_s.size() > longest_t_s.size()) {
      longest_t_s = t_s;
      longest_x_m = x_m;
    }
    t_s.clear();
    x_m.clear();
  };
  for (const MotionPoint& point : clip.motion) {
    if (point.left_out != LeftOut::hand) {
      end_run();
    } else if (point.measured_m) {
      t_s.push_back(point.t_s);
      x_m.push_back(*point.measured_m);
    }
  }
  end_run();
  const std::size_t positions = longest_t_s.size();
  if (positions < kFewest) return {};
  longest_t_s.resize(std::max(kFewest, positions / kParts));
  longest_x_m.resize(longest_t_s.size());
  const double a = speeding_up(longest_t_s, longest_x_m) / kStandardGravity_m_s2;
  if (std::abs(a) < kLeast || std::abs(a) > kMost) return {};
  return MayBeAFall{positions, std::abs(a) * kStandardGravity_m_s2};
}

}  // namespace glidelab::core
