#include "report/handy_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "report/number_text.h"

namespace glidelab::report {

NamedUnit name_and_unit(std::string_view key) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 13> kUnits = {{{"_kg_m", "kg/m"},
                                                                                     {"_1_m2", "1/m²"},
                                                                                     {"_1_m", "1/m"},
                                                                                     {"_n_s_m", "N s/m"},
                                                                                     {"_n_m", "N/m"},
                                                                                     {"_m_s2", "m/s²"},
                                                                                     {"_m_s", "m/s"},
                                                                                     {"_kg", "kg"},
                                                                                     {"_hz", "Hz"},
                                                                                     {"_px", "px"},
                                                                                     {"_n", "N"},
                                                                                     {"_m", "m"},
                                                                                     {"_s", "s"}}};
  for (const auto& [ending, unit] : kUnits) {
    if (key.ends_with(ending)) {
      return {std::string(key.substr(0, key.size() - ending.size())), std::string(unit)};
    }
  }
  return {std::string(key), ""};
}

std::string parameter_text(std::string_view key, double value, double sd) {
  const std::string_view member = key.substr(std::min(key.find('.'), key.size()));
  const NamedUnit of = name_and_unit(key.substr(0, key.size() - member.size()));
  return fmt::format("{}{} = {}", of.name, member, size_and_sd_text(value, sd, of.unit));
}

std::string parameter_text(const diagnose::DiagnosedParameter& parameter) {
  if (!parameter.text.empty()) return fmt::format("{} = {}", parameter.key, parameter.text);
  if (!parameter.why.empty()) return fmt::format("{}: not known: {}", parameter.key, parameter.why);
  return parameter_text(parameter.key, parameter.value, parameter.sd);
}

}  // namespace glidelab::report
