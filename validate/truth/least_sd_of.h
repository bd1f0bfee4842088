/// The bound of one quantity, by its name as results have it.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "validate/truth/cramer_rao.h"

namespace glidelab::validate {

/// Of k_over_m_1_s, mu, alpha_deg or v_lim_m_s, in the quantity's unit; none where the motions do not determine it.
/// std::logic_error of any other name.
inline std::optional<double> least_sd_of(const LeastSd& least, std::string_view quantity) {
  if (quantity == "k_over_m_1_s") return least.k_over_m_1_s;
  if (quantity == "mu") return least.mu;
  if (quantity == "alpha_deg") return least.alpha_deg;
  if (quantity == "v_lim_m_s") return least.v_lim_m_s;
  throw std::logic_error("no quantity: " + std::string(quantity));
}

}  // namespace glidelab::validate
