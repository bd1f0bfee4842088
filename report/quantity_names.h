/// What the recovered quantities are called on a page, beside their names in files.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace glidelab::report {

struct QuantityName {
  std::string_view key;     ///< in files
  std::string_view symbol;  ///< "K/m"
  std::string_view unit;    ///< "1/s"; empty for a pure number
};

inline constexpr std::array<QuantityName, 4> kQuantities = {
    {{"k_over_m_1_s", "K/m", "1/s"}, {"mu", "µ", ""}, {"alpha_deg", "α", "°"}, {"v_lim_m_s", "limit velocity", "m/s"}}};

inline std::string symbol_of(std::string_view key) {
  for (const QuantityName& name : kQuantities) {
    if (name.key == key) return std::string(name.symbol);
  }
  return std::string(key);
}

/// Among kQuantities; their number for what is none of them.
inline std::size_t place_of(std::string_view key) {
  std::size_t place = 0;
  while (place < kQuantities.size() && kQuantities[place].key != key) ++place;
  return place;
}

inline std::string unit_of(std::string_view key) {
  for (const QuantityName& name : kQuantities) {
    if (name.key == key) return std::string(name.unit);
  }
  return {};
}

}  // namespace glidelab::report
