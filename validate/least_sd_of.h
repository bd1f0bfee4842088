/// The bound of one quantity, by its name as results have it.
#pragma once

#include <optional>
#include <string_view>

#include "validate/cramer_rao.h"

namespace glidelab::validate {

/// Of k_over_m_1_s, mu, alpha_deg or v_lim_m_s, in the quantity's unit; none where the motions do not determine it.
inline std::optional<double> least_sd_of(const LeastSd& least, std::string_view quantity) {
  return quantity == "k_over_m_1_s" ? least.k_over_m_1_s
         : quantity == "mu"         ? least.mu
         : quantity == "alpha_deg"  ? least.alpha_deg
                                    : least.v_lim_m_s;
}

}  // namespace glidelab::validate
