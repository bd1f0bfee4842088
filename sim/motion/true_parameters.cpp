#include "sim/motion/true_parameters.h"

#include <cmath>
#include <limits>

namespace glidelab::sim {

std::optional<LinearLaw> linear_law(const Body& body) {
  LinearLaw law;
  for (const auto& term : body.forces) {
    const std::optional<LinearShare> share = term->linear();
    if (!share) return std::nullopt;
    law.k_over_m_1_s += share->k_n_s_m / body.mass_kg;
    law.mu += share->mu;
  }
  return law;
}

std::optional<double> limit_speed_m_s(const Body& body) {
  const auto drives = [&](double v) { return net_force_n(body, v, +1) > 0.0; };
  constexpr int kPerDecade = 64;
  constexpr int kDecades = 12;
  constexpr double kLowest = 1e-9;  // m/s
  double low = 0.0;
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() * std::abs(weight_along_track_n(body));
  bool drives_low = net_force_n(body, 0.0, +1) > rounding;
  for (int i = 0; i <= kDecades * kPerDecade; ++i) {
    double high = kLowest * std::pow(10.0, static_cast<double>(i) / kPerDecade);
    const bool drives_high = drives(high);
    if (drives_low && !drives_high) {
      while (true) {
        const double middle = 0.5 * (low + high);
        if (middle <= low || middle >= high) return high;
        (drives(middle) ? low : high) = middle;
      }
    }
    low = high;
    drives_low = drives_high;
  }
  return std::nullopt;
}

}  // namespace glidelab::sim
