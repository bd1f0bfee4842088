/// JSON to text and back, compiled once: every source that calls nlohmann's dump() or parse() itself compiles a writer
/// or a reader of its own, a second each.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace glidelab::base {

/// Indented by so many spaces, or on one line; no newline at the end. Invalid UTF-8 throws nlohmann's type_error.
inline constexpr int kOnOneLine = -1;
std::string json_text(const nlohmann::json& document, int indent = 2);
std::string json_text(const nlohmann::ordered_json& document, int indent = 2);

/// The same, with U+FFFD in the place of invalid UTF-8.
std::string replaced_json_text(const nlohmann::json& document, int indent = 2);
std::string replaced_json_text(const nlohmann::ordered_json& document, int indent = 2);

/// Throws nlohmann's parse_error, or out_of_range for a number beyond any double.
nlohmann::json parsed_json(std::string_view text);

}  // namespace glidelab::base
