#include "report/text/found_json.h"

#include <optional>
#include <string>
#include <utility>

#include "core/result/quantity.h"
#include "report/text/why_words.h"

namespace glidelab::report {

Json parameters_json(const std::vector<diagnose::DiagnosedParameter>& parameters) {
  Json object = Json::object();
  for (const diagnose::DiagnosedParameter& parameter : parameters) {
    Json value;
    if (!parameter.text.empty()) {
      value["value"] = parameter.text;
    } else if (!parameter.why) {
      put(value, "value", parameter.value);
      put(value, "sd", parameter.sd);
      if (parameter.at_end) value["at_end"] = true;
    } else {
      put(value, "value", std::optional<double>(), why_words(parameter.why));
      value["sd"] = nullptr;
    }
    object[parameter.key] = std::move(value);
  }
  return object;
}

Json recovered_json(const std::vector<diagnose::RecoveredConfiguration>& recovered) {
  Json list = Json::array();
  for (const diagnose::RecoveredConfiguration& of : recovered) {
    Json one;
    one["group"] = of.group;
    put(one, "mass_kg", of.mass_kg);
    put(one, "incline_deg", of.incline_deg);
    one["with"] = of.with;
    for (const core::QuantityName& name : core::kQuantities) {
      put(one, std::string(name.key), core::value_of(of, name.which));
    }
    list.push_back(std::move(one));
  }
  return list;
}

}  // namespace glidelab::report
