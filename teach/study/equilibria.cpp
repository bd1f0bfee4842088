#include "teach/study/equilibria.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/motion/simulate.h"

namespace glidelab::teach {
namespace {

constexpr double kSlowest = 1e-9;  // m/s
constexpr int kPerDecade = 256;

/// What takes a glider on the side s of v = 0 farther from it.
double outward_n(const sim::Body& body, int s, double speed) {
  return s * sim::net_force_n(body, s * speed, s);
}

std::optional<Equilibrium> at_rest(const sim::Body& body) {
  const double up = outward_n(body, -1, kSlowest), down = outward_n(body, 1, kSlowest);
  if (sim::mode_at_rest(body) != sim::Mode::stick || (up == 0.0 && down == 0.0)) return std::nullopt;
  bool stops = outward_n(body, -1, 0.0) < 0.0 && outward_n(body, 1, 0.0) < 0.0;
  for (const auto& force : body.forces) stops = stops || force->exponent_at_rest() < 1.0;
  const bool stable = up < 0.0 && down < 0.0;
  return Equilibrium{0.0, stable, stable && stops};
}

void add_moving(const sim::Body& body, int s, double fastest, std::vector<Equilibrium>& found) {
  double low = kSlowest;
  bool was_outward = outward_n(body, s, low) > 0.0;
  for (int i = 1; low < fastest; ++i) {
    const double high = std::min(fastest, kSlowest * std::pow(10.0, static_cast<double>(i) / kPerDecade));
    const bool outward = outward_n(body, s, high) > 0.0;
    if (outward != was_outward) {
      double below = low, above = high;
      for (double middle = 0.5 * (below + above); middle > below && middle < above; middle = 0.5 * (below + above)) {
        ((outward_n(body, s, middle) > 0.0) == was_outward ? below : above) = middle;
      }
      found.push_back({s * above, was_outward, false});
    }
    low = high;
    was_outward = outward;
  }
}

}  // namespace

std::vector<Equilibrium> equilibria(const sim::Body& body, double lowest_m_s, double highest_m_s) {
  std::vector<Equilibrium> found;
  add_moving(body, -1, -lowest_m_s, found);
  if (const auto rest = at_rest(body); rest && lowest_m_s <= 0.0 && highest_m_s >= 0.0) found.push_back(*rest);
  add_moving(body, 1, highest_m_s, found);
  std::ranges::sort(found, {}, &Equilibrium::v_m_s);
  return found;
}

}  // namespace glidelab::teach
