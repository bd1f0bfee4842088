#include "report/text/quantity_names.h"

#include <cstddef>

#include "fit/estimators.h"
#include "validate/study/coverage/interval_coverage.h"

namespace glidelab::report {

std::string with_unit(std::string_view name, std::string_view unit) {
  std::string text(name);
  if (!unit.empty()) text.append(" (").append(unit).append(")");
  return text;
}

std::string heading_of(std::string_view key) {
  return with_unit(symbol_of(key), unit_of(key));
}

std::string unit_suffix(std::string_view unit) {
  std::string text;
  if (!unit.empty() && unit != "°") text += ' ';
  return text.append(unit);
}

std::string estimator_name(std::string_view estimator) {
  if (const fit::Estimator* known = fit::find_estimator(estimator)) return std::string(known->title);
  if (estimator == validate::kNaiveLines) return "naive lines (for contrast)";
  return std::string(estimator);
}

std::array<NamedQuantity, kQuantities.size()> quantities_of(const core::ConfigurationResult& configuration) {
  std::array<NamedQuantity, kQuantities.size()> named;
  for (std::size_t i = 0; i < named.size(); ++i) {
    named[i] = {kQuantities[i], &core::value_of(configuration, kQuantities[i].which)};
  }
  return named;
}

}  // namespace glidelab::report
