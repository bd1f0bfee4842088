#include "base/toml/toml_node.h"

#include <fmt/format.h>

#include <utility>

namespace glidelab::base {
namespace {

std::string show(const toml::node* node) {
  if (node == nullptr) return "nothing";
  if (const auto* value = node->as_string()) return fmt::format("text \"{}\"", value->get());
  if (const auto* value = node->as_integer()) return fmt::format("{}", value->get());
  if (const auto* value = node->as_floating_point()) return fmt::format("{}", value->get());
  if (const auto* value = node->as_boolean()) return value->get() ? "true" : "false";
  if (const auto* value = node->as_array()) return fmt::format("an array of {}", value->size());
  if (node->is_table()) return "a table";
  return "a date or time";
}

}  // namespace

void TomlNode::reject(std::string_view key, const toml::node* at, std::string found, std::string expected) {
  document->issues.push_back({at == nullptr ? document->name : file_of(*at, document->name),
                              at == nullptr ? line : line_of(*at), prefix + std::string(key), std::move(found),
                              std::move(expected)});
}
void TomlNode::reject(std::string_view key, const toml::node* found, std::string expected) {
  unread.emplace(key);
  reject(key, found, show(found), std::move(expected));
}

toml::table parsed_toml(std::string_view text, const std::string& shown_as) {
  try {
    return toml::parse(text, shown_as);
  } catch (const toml::parse_error& error) {
    const auto at = error.source().begin;
    throw InputError(Issue{shown_as, static_cast<int>(at.line), fmt::format("column {}", at.column),
                           fmt::format("no valid TOML ({})", error.description()), "TOML 1.0"});
  }
}

}  // namespace glidelab::base
