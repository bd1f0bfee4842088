/// What the recovered quantities and the estimators are called on a page, beside their names in files.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "core/result/results.h"

namespace glidelab::report {

struct QuantityName {
  std::string_view key;     ///< in files
  std::string_view symbol;  ///< "K/m"
  std::string_view unit;    ///< "1/s"; empty for a pure number
};

inline constexpr std::array<QuantityName, 4> kQuantities = {
    {{"k_over_m_1_s", "K/m", "1/s"}, {"mu", "µ", ""}, {"alpha_deg", "α", "°"}, {"v_lim_m_s", "limit velocity", "m/s"}}};

/// Among kQuantities; their number for what is none of them.
inline std::size_t place_of(std::string_view key) {
  std::size_t place = 0;
  while (place < kQuantities.size() && kQuantities[place].key != key) ++place;
  return place;
}

/// "K/m" for "k_over_m_1_s"; what is none of kQuantities stays as it is.
inline std::string symbol_of(std::string_view key) {
  const std::size_t place = place_of(key);
  return std::string(place < kQuantities.size() ? kQuantities[place].symbol : key);
}

/// "1/s" for "k_over_m_1_s"; empty for a pure number and for what is none of kQuantities.
inline std::string unit_of(std::string_view key) {
  const std::size_t place = place_of(key);
  return std::string(place < kQuantities.size() ? kQuantities[place].unit : "");
}

/// "v (m/s)"; the name alone of a pure number.
inline std::string with_unit(std::string_view name, std::string_view unit) {
  std::string text(name);
  if (!unit.empty()) text.append(" (").append(unit).append(")");
  return text;
}

/// "K/m (1/s)" for "k_over_m_1_s": a quantity at the head of a row or a column.
inline std::string heading_of(std::string_view key) {
  return with_unit(symbol_of(key), unit_of(key));
}

/// A unit behind a number: " 1/s", "°", and nothing of a pure number.
inline std::string unit_suffix(std::string_view unit) {
  std::string text;
  if (!unit.empty() && unit != "°") text += ' ';
  return text.append(unit);
}

/// "fit of the whole motion" for "trajectory"; what is none of the estimators stays as it is.
inline std::string estimator_name(std::string_view estimator) {
  if (estimator == "trajectory") return "fit of the whole motion";
  if (estimator == "phase-diagram-gls") return "generalised lines";
  if (estimator == "phase-diagram") return "lines of the phase diagram";
  if (estimator == "naive-lines") return "naive lines (for contrast)";
  return std::string(estimator);
}

/// A recovered quantity with its names.
struct NamedQuantity {
  QuantityName name;
  const core::Quantity* quantity = nullptr;  ///< in the configuration that was given
};

/// K/m, µ, α and the limit velocity of a configuration, in the order of kQuantities.
inline std::array<NamedQuantity, kQuantities.size()> quantities_of(const core::ConfigurationResult& configuration) {
  return {{{kQuantities[0], &configuration.k_over_m_1_s},
           {kQuantities[1], &configuration.mu},
           {kQuantities[2], &configuration.alpha_deg},
           {kQuantities[3], &configuration.v_lim_m_s}}};
}

}  // namespace glidelab::report
