/// The data behind a TomlFile and its TomlTables: the parsed document and, for each table that was handed out, the keys
/// that were asked for. Private to base/toml, because it includes the TOML parser.
#pragma once

#include <toml++/toml.h>

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"

namespace glidelab::base {

struct TomlNode;

struct TomlDocument {
  std::string name;
  toml::table tree;
  std::vector<Issue> issues;
  std::vector<std::shared_ptr<TomlNode>> nodes;  // every table that was handed out
};

struct TomlNode {
  TomlDocument* document;    // nodes live in the document, so this never dangles
  const toml::table* table;  // null: a table that was required and is missing
  std::string prefix;        // "camera." or "clip[2]."
  int line;
  std::set<std::string, std::less<>> known;
  std::set<std::string, std::less<>> ignored;
  std::map<std::string, std::shared_ptr<TomlNode>, std::less<>> children;
  std::set<std::string, std::less<>> unread = {};  // keys whose value is not what was asked for

  const toml::node* find(std::string_view key) {
    known.emplace(key);
    return table == nullptr ? nullptr : table->get(key);
  }
  /// `at`: the wrong node, or null if it is the table itself.
  void reject(std::string_view key, const toml::node* at, std::string found, std::string expected);
  /// The value cannot be read.
  void reject(std::string_view key, const toml::node* found, std::string expected);
};

/// Parses the text. InputError, in the file `shown_as`, if it is not valid TOML.
toml::table parsed_toml(std::string_view text, const std::string& shown_as);

/// The file that a value comes from.
inline std::string file_of(const toml::node& node, const std::string& otherwise) {
  return node.source().path ? *node.source().path : otherwise;
}

inline int line_of(const toml::node& node) {
  return static_cast<int>(node.source().begin.line);
}

}  // namespace glidelab::base
