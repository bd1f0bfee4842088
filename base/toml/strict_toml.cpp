#include "base/toml/strict_toml.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/text/nearest_word.h"
#include "base/toml/toml_node.h"

namespace glidelab::base {
namespace {

std::optional<double> as_number(const toml::node& node) {
  if (const auto* value = node.as_floating_point()) return value->get();
  if (const auto* value = node.as_integer()) return static_cast<double>(value->get());
  return std::nullopt;
}

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

bool Range::contains(double value) const {
  if (!std::isfinite(value)) return false;
  return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
}

std::string Range::describe() const {
  const bool has_low = std::isfinite(low);
  const bool has_high = std::isfinite(high);
  if (has_low && has_high) {
    if (low_open || high_open) {
      return fmt::format("a number {} {} and {} {}", low_open ? "above" : "of at least", low,
                         high_open ? "below" : "at most", high);
    }
    return fmt::format("a number from {} to {}", low, high);
  }
  if (has_low) return fmt::format("a number {} {}", low_open ? "above" : "of at least", low);
  if (has_high) return fmt::format("a number {} {}", high_open ? "below" : "of at most", high);
  return "a finite number";
}

Range any_number() {
  return {};
}
Range above(double low) {
  return {.low = low, .low_open = true};
}
Range at_least(double low) {
  return {.low = low};
}
Range between(double low, double high) {
  return {.low = low, .high = high};
}
Range between_open(double low, double high) {
  return {.low = low, .high = high, .low_open = true, .high_open = true};
}

bool TomlTable::has(std::string_view key) const {
  return node_->find(key) != nullptr;
}
int TomlTable::line() const {
  return node_->line;
}
int TomlTable::line(std::string_view key) const {
  const toml::node* found = node_->find(key);
  return found == nullptr ? node_->line : line_of(*found);
}
std::string TomlTable::path(std::string_view key) const {
  return node_->prefix + std::string(key);
}

double TomlTable::number(std::string_view key, Range range) const {
  const toml::node* found = node_->find(key);
  if (found == nullptr) {
    node_->reject(key, nullptr, range.describe());
    return kMissing;
  }
  return maybe_number(key, range).value_or(kMissing);
}

double TomlTable::number_or(std::string_view key, double otherwise, Range range) const {
  return has(key) ? number(key, range) : otherwise;
}

std::optional<double> TomlTable::maybe_number(std::string_view key, Range range) const {
  const toml::node* found = node_->find(key);
  if (found == nullptr) return std::nullopt;
  const std::optional<double> value = as_number(*found);
  if (value && range.contains(*value)) return value;
  node_->reject(key, found, range.describe());
  return kMissing;
}

long TomlTable::integer(std::string_view key, long low, long high) const {
  const toml::node* found = node_->find(key);
  const auto* value = found == nullptr ? nullptr : found->as_integer();
  if (value != nullptr && value->get() >= low && value->get() <= high) return static_cast<long>(value->get());
  node_->reject(key, found,
                low == high ? fmt::format("{}", low) : fmt::format("a whole number from {} to {}", low, high));
  return low;
}

long TomlTable::integer_or(std::string_view key, long otherwise, long low, long high) const {
  return has(key) ? integer(key, low, high) : otherwise;
}

bool TomlTable::boolean_or(std::string_view key, bool otherwise) const {
  const toml::node* found = node_->find(key);
  if (found == nullptr) return otherwise;
  if (const auto* value = found->as_boolean()) return value->get();
  node_->reject(key, found, "true or false");
  return otherwise;
}

std::string TomlTable::text(std::string_view key) const {
  const toml::node* found = node_->find(key);
  const auto* value = found == nullptr ? nullptr : found->as_string();
  if (value != nullptr && !value->get().empty()) return value->get();
  node_->reject(key, found, "a string");
  return {};
}

std::string TomlTable::text_or(std::string_view key, std::string_view otherwise) const {
  return has(key) ? text(key) : std::string(otherwise);
}

std::optional<std::string> TomlTable::maybe_text(std::string_view key) const {
  if (!has(key)) return std::nullopt;
  return text(key);
}

std::string TomlTable::word(std::string_view key, const std::vector<std::string>& allowed,
                            std::string_view otherwise) const {
  const toml::node* found = node_->find(key);
  if (found == nullptr && !otherwise.empty()) return std::string(otherwise);
  const auto* value = found == nullptr ? nullptr : found->as_string();
  if (value != nullptr && std::find(allowed.begin(), allowed.end(), value->get()) != allowed.end()) return value->get();
  node_->reject(key, found,
                fmt::format("one of \"{}\"{}", fmt::join(allowed, "\", \""),
                            value == nullptr ? "" : did_you_mean(value->get(), allowed)));
  return allowed.front();
}

std::optional<std::string> TomlTable::one_of(std::string_view key, const std::vector<std::string>& allowed) const {
  const std::size_t issues_before = node_->document->issues.size();
  std::string word_found = word(key, allowed);
  if (node_->document->issues.size() > issues_before) return std::nullopt;
  return word_found;
}

std::vector<double> TomlTable::numbers(std::string_view key, std::size_t count, Range range) const {
  const toml::node* found = node_->find(key);
  const std::string expected =
      fmt::format("an array of {}numbers, each {}", count == 0 ? "" : fmt::format("{} ", count), range.describe());
  const auto* array = found == nullptr ? nullptr : found->as_array();
  if (array == nullptr || (count != 0 && array->size() != count)) {
    node_->reject(key, found, expected);
    return std::vector<double>(count, kMissing);
  }
  std::vector<double> values;
  for (const toml::node& element : *array) {
    const std::optional<double> value = as_number(element);
    if (!value || !range.contains(*value)) {
      node_->reject(key, &element, expected);
      return std::vector<double>(array->size(), kMissing);
    }
    values.push_back(*value);
  }
  return values;
}

std::optional<std::vector<double>> TomlTable::maybe_numbers(std::string_view key, std::size_t count,
                                                            Range range) const {
  if (!has(key)) return std::nullopt;
  return numbers(key, count, range);
}

std::vector<std::string> TomlTable::texts_or_none(std::string_view key) const {
  const toml::node* found = node_->find(key);
  if (found == nullptr) return {};
  std::vector<std::string> values;
  if (const auto* array = found->as_array()) {
    for (const toml::node& element : *array) {
      if (const auto* value = element.as_string()) values.push_back(value->get());
    }
    if (values.size() == array->size()) return values;
  }
  node_->reject(key, found, "an array of texts");
  return {};
}

std::vector<std::pair<std::string, TomlScalar>> TomlTable::scalars() const {
  std::vector<std::pair<std::string, TomlScalar>> all;
  for (const std::string& key : keys()) {
    const toml::node* found = node_->find(key);
    if (found->is_table()) {
      for (auto& [inner, value] : table(key).scalars()) all.emplace_back(key + "." + inner, std::move(value));
    } else if (const auto* text = found->as_string()) {
      all.emplace_back(key, text->get());
    } else if (const auto* flag = found->as_boolean()) {
      all.emplace_back(key, flag->get());
    } else if (const std::optional<double> number = as_number(*found); number && std::isfinite(*number)) {
      all.emplace_back(key, *number);
    } else {
      node_->reject(key, found, "a finite number, a string, true or false");
    }
  }
  return all;
}

std::optional<TomlTable> TomlTable::maybe_table(std::string_view key) const {
  const toml::node* found = node_->find(key);
  if (found == nullptr) return std::nullopt;
  if (const auto child = node_->children.find(key); child != node_->children.end()) return TomlTable(child->second);
  const toml::table* inner = found->as_table();
  if (inner == nullptr) node_->reject(key, found, fmt::format("a table [{}]", path(key)));
  auto node =
      std::make_shared<TomlNode>(TomlNode{node_->document, inner, path(key) + ".", line_of(*found), {}, {}, {}});
  node_->document->nodes.push_back(node);
  node_->children.emplace(key, node);
  return TomlTable(node);
}

TomlTable TomlTable::table(std::string_view key) const {
  if (const std::optional<TomlTable> found = maybe_table(key)) return *found;
  node_->reject(key, nullptr, fmt::format("a table [{}]", path(key)));
  // The keys of a missing table are missing too, but one message is enough: a dummy document takes the further
  // requests.
  static const toml::table kEmpty;
  auto orphanage = std::make_shared<TomlDocument>();
  auto node =
      std::shared_ptr<TomlNode>(new TomlNode{orphanage.get(), &kEmpty, path(key) + ".", node_->line, {}, {}, {}},
                                [orphanage](TomlNode* orphan) { delete orphan; });
  return TomlTable(node);
}

std::vector<TomlTable> TomlTable::tables_or_none(std::string_view key) const {
  const toml::node* found = node_->find(key);
  if (found == nullptr) return {};
  const toml::array* array = found->as_array();
  if (array == nullptr || !array->is_homogeneous(toml::node_type::table)) {
    node_->reject(key, found, fmt::format("tables [[{}]]", path(key)));
    return {};
  }
  std::vector<TomlTable> tables;
  for (std::size_t i = 0; i < array->size(); ++i) {
    const std::string child_key = fmt::format("{}[{}]", key, i + 1);
    const auto child = node_->children.find(child_key);
    if (child != node_->children.end()) {
      tables.push_back(TomlTable(child->second));
      continue;
    }
    const toml::node& element = *array->get(i);
    auto node = std::make_shared<TomlNode>(
        TomlNode{node_->document, element.as_table(), path(child_key) + ".", line_of(element), {}, {}, {}});
    node_->document->nodes.push_back(node);
    node_->children.emplace(child_key, node);
    tables.push_back(TomlTable(node));
  }
  return tables;
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) const {
  std::vector<TomlTable> found = tables_or_none(key);
  if (found.empty() && !has(key)) node_->reject(key, nullptr, fmt::format("one or more tables [[{}]]", path(key)));
  return found;
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> found;
  if (node_->table == nullptr) return found;
  for (const auto& [key, value] : *node_->table) found.emplace_back(key.str());
  return found;
}

void TomlTable::ignore(std::string_view key) const {
  node_->known.emplace(key);
  node_->ignored.emplace(key);
}

void TomlTable::reject(std::string_view key, std::string found, std::string expected) const {
  if (node_->unread.contains(key)) return;
  node_->reject(key, node_->find(key), std::move(found), std::move(expected));
}

namespace {

std::string list_of_known(std::string_view key, const std::set<std::string, std::less<>>& known) {
  if (known.empty()) return "no key here";
  const std::string nearest = nearest_word(key, {known.begin(), known.end()});
  if (!nearest.empty()) return fmt::format("a known key; did you mean \"{}\"?", nearest);
  return fmt::format("one of {}", fmt::join(known, ", "));
}

}  // namespace

TomlFile::TomlFile(std::shared_ptr<TomlDocument> document) : document_(std::move(document)) {}
TomlFile::~TomlFile() = default;
TomlFile::TomlFile(TomlFile&&) noexcept = default;
TomlFile& TomlFile::operator=(TomlFile&&) noexcept = default;

TomlFile TomlFile::load(const std::filesystem::path& path) {
  return parse(read_file(path), path.string());
}

TomlFile TomlFile::parse(std::string_view text, std::string shown_as) {
  auto document = std::make_shared<TomlDocument>();
  document->name = std::move(shown_as);
  document->tree = parsed_toml(text, document->name);
  document->nodes.push_back(std::make_shared<TomlNode>(TomlNode{document.get(), &document->tree, "", 1, {}, {}, {}}));
  return TomlFile(std::move(document));
}

void TomlFile::add_missing(std::string_view table, TomlFile& others, const std::vector<std::string>& without) {
  toml::node* from = others.document_->tree.get(table);
  if (from == nullptr) return;
  toml::node* to = document_->tree.get(table);
  if (to == nullptr || !from->is_table() || !to->is_table()) {
    // A whole table, or something that is not a table: the code that reads it reports that. Moving keeps the line and
    // the file.
    if (to == nullptr) from->visit([&](auto& node) { document_->tree.insert(table, std::move(node)); });
    return;
  }
  for (auto&& [key, value] : *from->as_table()) {
    if (std::find(without.begin(), without.end(), key.str()) != without.end()) continue;
    if (to->as_table()->contains(key)) continue;
    value.visit([&, &name = key](auto& node) { to->as_table()->insert(name, std::move(node)); });
  }
}

TomlTable TomlFile::root() const {
  return TomlTable(document_->nodes.front());
}
const std::string& TomlFile::name() const {
  return document_->name;
}

void TomlFile::finish() const {
  std::vector<Issue> issues = document_->issues;
  for (const auto& node : document_->nodes) {
    if (node->table == nullptr) continue;
    for (const auto& [key, value] : *node->table) {
      if (node->known.contains(key.str())) continue;
      issues.push_back({file_of(value, document_->name), line_of(value), node->prefix + std::string(key.str()),
                        "an unknown key", list_of_known(key.str(), node->known)});
    }
  }
  std::stable_sort(issues.begin(), issues.end(),
                   [](const Issue& a, const Issue& b) { return a.file != b.file ? a.file < b.file : a.line < b.line; });
  if (!issues.empty()) throw InputError(std::move(issues));
}

}  // namespace glidelab::base
