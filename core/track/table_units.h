/// Units of length and time as tables state them: symbols, and words in English, German, French, Spanish, Portuguese
/// and Italian.
#pragma once

#include <optional>
#include <string_view>

namespace glidelab::core {

/// Metres for a unit of length ("mm", "Zentimeter", "inches"), seconds for a unit of time; empty for any other text.
/// "um" and "µm" are the same.
std::optional<double> metres_per(std::string_view unit);
std::optional<double> seconds_per(std::string_view unit);

}  // namespace glidelab::core
