/// The four quantities that an analysis recovers, in the order used by every table and page.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace glidelab::core {

/// K/m, the friction coefficient, the inclination and the terminal (limit) velocity.
enum class Measurand { k_over_m, mu, alpha, v_lim };

struct QuantityName {
  Measurand which;
  std::string_view key;     ///< in options and files
  std::string_view symbol;  ///< on pages: "K/m"
  std::string_view unit;    ///< "1/s"; empty for a pure number
};

inline constexpr std::array<QuantityName, 4> kQuantities = {{
    {Measurand::k_over_m, "k_over_m_1_s", "K/m", "1/s"},
    {Measurand::mu, "mu", "µ", ""},
    {Measurand::alpha, "alpha_deg", "α", "°"},
    {Measurand::v_lim, "v_lim_m_s", "terminal velocity", "m/s"},
}};

/// As in options and files: "mu".
constexpr std::string_view key_of(Measurand which) {
  return kQuantities[static_cast<std::size_t>(which)].key;
}

/// The quantity's member of a struct that has all four: results, truths, bounds.
template <typename Four>
constexpr auto& value_of(Four& four, Measurand which) {
  switch (which) {
    case Measurand::k_over_m:
      return four.k_over_m_1_s;
    case Measurand::mu:
      return four.mu;
    case Measurand::alpha:
      return four.alpha_deg;
    default:
      return four.v_lim_m_s;
  }
}

/// The keys, as options take them.
std::vector<std::string> quantity_keys();

/// Index in kQuantities; their number if the key is not among them.
std::size_t place_of(std::string_view key);

/// "K/m" for "k_over_m_1_s"; any other key stays as it is.
std::string symbol_of(std::string_view key);

/// "1/s" for "k_over_m_1_s"; empty for a pure number and for any other key.
std::string unit_of(std::string_view key);

}  // namespace glidelab::core
