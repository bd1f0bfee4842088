#include "base/toml/toml_node.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/text/pattern.h"

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

namespace {

/// The line of that number, counted from 1.
std::string line_of(std::string_view text, std::size_t number) {
  for (; number > 1 && !text.empty(); --number) {
    text.remove_prefix(std::min(text.size(), text.find('\n') == text.npos ? text.size() : text.find('\n') + 1));
  }
  return std::string(text.substr(0, text.find('\n')));
}

/// "mass_kg = 0.335" for "mass_kg = 0,335"; empty for a line whose value is not such a number.
std::string with_decimal_point(const std::string& line) {
  static const Pattern kComma(R"(^(\s*[A-Za-z0-9_-]+\s*=\s*[-+]?[0-9]+),([0-9]+)\s*(#.*)?$)");
  const std::vector<Captured> found = kComma.matches(line);
  return found.empty() ? std::string() : found.front()[1] + "." + found.front()[2];
}

}  // namespace

toml::table parsed_toml(std::string_view text, const std::string& shown_as) {
  try {
    return toml::parse(text, shown_as);
  } catch (const toml::parse_error& error) {
    const auto at = error.source().begin;
    const std::string expected = with_decimal_point(line_of(text, at.line));
    throw InputError(Issue{
        shown_as, static_cast<int>(at.line), fmt::format("column {}", at.column),
        expected.empty() ? fmt::format("no valid TOML ({})", error.description()) : std::string("a decimal comma"),
        expected.empty() ? "TOML 1.0" : fmt::format("a decimal point: {}", expected)});
  }
}

}  // namespace glidelab::base
