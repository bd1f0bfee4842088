#include "base/text/json_text.h"

#include <nlohmann/json.hpp>

namespace glidelab::base {

std::string json_text(const nlohmann::json& document, int indent) {
  return document.dump(indent);
}

std::string json_text(const nlohmann::ordered_json& document, int indent) {
  return document.dump(indent);
}

std::string replaced_json_text(const nlohmann::json& document, int indent) {
  return document.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string replaced_json_text(const nlohmann::ordered_json& document, int indent) {
  return document.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

nlohmann::json parsed_json(std::string_view text) {
  return nlohmann::json::parse(text);
}

}  // namespace glidelab::base
