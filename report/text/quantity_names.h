/// What a page calls the recovered quantities (core/result/quantity.h) and the estimators (fit/estimators.h).
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "core/result/quantity.h"
#include "core/result/results.h"

namespace glidelab::report {

using core::kQuantities;
using core::place_of;
using core::QuantityName;
using core::symbol_of;
using core::unit_of;

/// "v (m/s)"; the name alone of a pure number.
std::string with_unit(std::string_view name, std::string_view unit);

/// "K/m (1/s)" for "k_over_m_1_s": a quantity at the head of a row or a column.
std::string heading_of(std::string_view key);

/// A unit behind a number: " 1/s", "°", and nothing of a pure number.
std::string unit_suffix(std::string_view unit);

/// "fit of the whole motion" for "trajectory"; any other name stays as it is.
std::string estimator_name(std::string_view estimator);

/// A recovered quantity with its names.
struct NamedQuantity {
  QuantityName name;
  const core::Quantity* quantity = nullptr;  ///< in the configuration that was given
};

/// K/m, µ, α and the limit velocity of a configuration, in the order of kQuantities.
std::array<NamedQuantity, kQuantities.size()> quantities_of(const core::ConfigurationResult& configuration);

}  // namespace glidelab::report
