#include "base/toml/strict_toml.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <set>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/text/nearest_word.h"
#include "base/toml/toml_node.h"

namespace glidelab::base {
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
    // A whole table, or something that is none: whoever reads it says so. Moving keeps the line and the file.
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
