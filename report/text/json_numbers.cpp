#include "report/text/json_numbers.h"

#include <cmath>
#include <utility>

#include "base/text/json_text.h"
#include "report/text/why_words.h"

namespace glidelab::report {

void put(Json& object, const std::string& key, double value) {
  if (std::isfinite(value)) {
    object[key] = value;
    return;
  }
  object[key] = nullptr;
  object["why"][key] = "the calculation gives no finite number";
}

void put(Json& object, const std::string& key, const std::optional<double>& value, const std::string& why) {
  if (value) return put(object, key, *value);
  object[key] = nullptr;
  object["why"][key] = why.empty() ? "not known" : why;
}

void put(Json& object, const std::string& key, const core::Estimate& estimate) {
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

void put(Json& object, const std::string& key, const core::Quantity& quantity) {
  if (quantity.estimate) {
    put(object, key, *quantity.estimate);
    if (quantity.smoothing_correction && object[key].is_object()) {
      put(object[key], "uncorrected", quantity.estimate->value - *quantity.smoothing_correction);
      put(object[key], "smoothing_correction", *quantity.smoothing_correction);
    }
    return;
  }
  object[key] = nullptr;
  const std::string why = why_words(quantity.why);
  object["why"][key] = why.empty() ? "the data do not determine it" : why;
}

std::string json_text(const Json& document) {
  return base::replaced_json_text(document) + "\n";
}

}  // namespace glidelab::report
