#include "report/text/handy_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "base/text/number_text.h"

namespace glidelab::report {

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
