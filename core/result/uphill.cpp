#include "core/result/uphill.h"

#include <limits>

#include "core/result/estimate.h"
#include "core/result/results.h"

namespace glidelab::core {

bool seems_uphill(const InclineContradiction& contradiction) {
  if (!contradiction.gross || contradiction.beyond_gravity) return false;
  if (contradiction.bound != 0) {  // the other sign lies beyond the bound
    constexpr double kCareless_deg = 1.25;
    const double turned_deg = -contradiction.stated.deg;
    return turned_deg * contradiction.deg > 0.0 &&
           contradiction.bound * (turned_deg - contradiction.deg) > -kCareless_deg;
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
