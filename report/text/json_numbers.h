/// Numbers and missing numbers in a JSON file: null with the reason in "why" beside it, never NaN.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/result/results.h"
#include "core/result/why_unknown.h"

namespace glidelab::report {

using Json = nlohmann::ordered_json;

/// Sets object[key] to the number, or to null with its reason if it is not finite.
inline void put(Json& object, const std::string& key, double value) {
  if (std::isfinite(value)) {
    object[key] = value;
    return;
  }
  object[key] = nullptr;
  object["why"][key] = "the calculation gives no finite number";
}

/// The same; if there is no number, null with the given reason.
inline void put(Json& object, const std::string& key, const std::optional<double>& value, const std::string& why) {
  if (value) return put(object, key, *value);
  object[key] = nullptr;
  object["why"][key] = why.empty() ? "not known" : why;
}

/// {"value", "sd", "interval95"}; null with its reason if the value is not finite.
inline void put(Json& object, const std::string& key, const core::Estimate& estimate) {
  if (!std::isfinite(estimate.value)) return put(object, key, estimate.value);
  Json inner;
  inner["value"] = estimate.value;
  put(inner, "sd", estimate.sd);
  if (std::isfinite(estimate.low95) && std::isfinite(estimate.high95)) {
    inner["interval95"] = {estimate.low95, estimate.high95};
  } else {
    inner["interval95"] = nullptr;
    inner["why"]["interval95"] = "the calculation gives no finite number";
  }
  object[key] = std::move(inner);
}

/// The same, with "uncorrected" and "smoothing_correction" if a correction was made; null with the reason why the data
/// do not determine it.
inline void put(Json& object, const std::string& key, const core::Quantity& quantity) {
  if (quantity.estimate) {
    put(object, key, *quantity.estimate);
    if (quantity.smoothing_correction && object[key].is_object()) {
      put(object[key], "uncorrected", quantity.estimate->value - *quantity.smoothing_correction);
      put(object[key], "smoothing_correction", *quantity.smoothing_correction);
    }
    return;
  }
  object[key] = nullptr;
  const std::string why = core::why_words(quantity.why);
  object["why"][key] = why.empty() ? "the data do not determine it" : why;
}

/// The text of a file: indented, one newline at the end, and invalid UTF-8 replaced.
inline std::string json_text(const Json& document) {
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace glidelab::report
