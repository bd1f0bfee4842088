/// Numbers and missing numbers in a JSON file: null with the reason in "why" next to it, never NaN.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/result/results.h"
#include "core/result/why_unknown.h"

namespace glidelab::report {

using Json = nlohmann::ordered_json;

/// Sets object[key] to the number, or to null with its reason if it is not finite.
void put(Json& object, const std::string& key, double value);

/// The same; if there is no number, null with the given reason.
void put(Json& object, const std::string& key, const std::optional<double>& value, const std::string& why);

/// {"value", "sd", "interval95"}; null with its reason if the value is not finite.
void put(Json& object, const std::string& key, const core::Estimate& estimate);

/// The same, with "uncorrected" and "smoothing_correction" if a correction was made; null with the reason why the data
/// do not determine it.
void put(Json& object, const std::string& key, const core::Quantity& quantity);

/// The text of a file: indented, one newline at the end, and invalid UTF-8 replaced.
std::string json_text(const Json& document);

}  // namespace glidelab::report
