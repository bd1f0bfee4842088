#include "report/text/configuration_name.h"

#include <fmt/format.h>

#include <algorithm>

namespace glidelab::report {

std::string configuration_name(const core::AnalysisResults& results, const core::ConfigurationResult& configuration) {
  const auto alike = std::count_if(
      results.configurations.begin(), results.configurations.end(), [&](const core::ConfigurationResult& other) {
        return other.mass_kg == configuration.mass_kg && other.incline_deg == configuration.incline_deg;
      });
  const std::string name = fmt::format("{:.6g} kg, {:.4g}°", configuration.mass_kg, configuration.incline_deg);
  return alike > 1 ? name + ", " + configuration.group : name;
}

}  // namespace glidelab::report
