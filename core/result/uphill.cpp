#include "core/result/uphill.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/result/estimate.h"
#include "core/result/results.h"

namespace glidelab::core {

bool seems_uphill(const InclineContradiction& contradiction) {
  if (!contradiction.gross || contradiction.beyond_gravity) return false;
  if (contradiction.bound != 0) {                                 // the other sign lies beyond the bound
    constexpr double kCareless_deg = 1.0, kCarelessShare = 0.25;  // as incline_contradiction() calls gross
    const double turned_deg = -contradiction.stated.deg;
    const double careless_deg = std::max(kCareless_deg, kCarelessShare * std::abs(turned_deg));
    return turned_deg * contradiction.deg > 0.0 &&
           contradiction.bound * (turned_deg - contradiction.deg) > -careless_deg;
  }
  ConfigurationResult found;
  found.alpha_deg =
      determined(estimate(contradiction.deg, contradiction.sd_deg, std::numeric_limits<double>::infinity()));
  StatedIncline turned = contradiction.stated;
  turned.deg = -turned.deg;
  const auto then = incline_contradiction(found, contradiction.gravity_m_s2, turned);
  return !then || !then->gross;
}

}  // namespace glidelab::core
