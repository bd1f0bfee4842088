#include "core/result/uphill.h"

#include <limits>

#include "core/result/estimate.h"
#include "core/result/results.h"

namespace glidelab::core {

bool seems_uphill(const InclineContradiction& contradiction) {
  if (!contradiction.gross || contradiction.beyond_gravity || contradiction.bound != 0) return false;
  ConfigurationResult found;
  found.alpha_deg =
      determined(estimate(contradiction.deg, contradiction.sd_deg, std::numeric_limits<double>::infinity()));
  StatedIncline turned = contradiction.stated;
  turned.deg = -turned.deg;
  const auto then = incline_contradiction(found, contradiction.gravity_m_s2, turned);
  return !then || !then->gross;
}

}  // namespace glidelab::core
