#include "base/toml/toml_set.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "base/errors.h"
#include "base/toml/toml_node.h"

namespace glidelab::base {
namespace {

/// One part of a path: `key` and, for an array, which of its elements.
struct Step {
  enum class Pick { none, index, all, matching };
  std::string key;
  Pick pick = Pick::none;
  std::size_t index = 0;  ///< from 0
  std::string match_key, match_value;
};

class Setter {
 public:
  Setter(const std::string& file, const TomlAssignment& assignment) : file_(file), assignment_(assignment) {}

  /// The places that took the value, with arrays indexed by number.
  std::vector<std::string> apply(toml::table& tree) const {
    std::vector<std::string> places;
    into(tree, parse(), places);
    return places;
  }

 private:
  [[noreturn]] void fail(std::string found, std::string expected) const {
    throw InputError(Issue{file_, 0, assignment_.path, std::move(found), std::move(expected)});
  }

  Step parse_step(std::string_view part) const {
    constexpr const char* kForm = "a path such as camera.exposure_s, configuration[1].mass_kg or force[law=viscous].mu";
    Step step;
    const std::size_t open = part.find('[');
    step.key = std::string(part.substr(0, open));
    if (step.key.empty()) fail("an empty part", kForm);
    const auto bare = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    };
    if (!std::all_of(step.key.begin(), step.key.end(), bare)) fail(fmt::format("\"{}\"", part), kForm);
    if (open == std::string_view::npos) return step;
    if (part.back() != ']') fail(fmt::format("\"{}\"", part), kForm);
    const std::string_view inner = part.substr(open + 1, part.size() - open - 2);
    const std::size_t equals = inner.find('=');
    if (inner == "*") {
      step.pick = Step::Pick::all;
    } else if (equals != std::string_view::npos) {
      step.pick = Step::Pick::matching;
      step.match_key = std::string(inner.substr(0, equals));
      step.match_value = std::string(inner.substr(equals + 1));
    } else {
      step.pick = Step::Pick::index;
      const auto read = std::from_chars(inner.data(), inner.data() + inner.size(), step.index);
      if (read.ec != std::errc() || read.ptr != inner.data() + inner.size() || step.index == 0) {
        fail(fmt::format("[{}]", inner), "[1], [2], …, [*] or [key=text]");
      }
      --step.index;
    }
    return step;
  }

  std::vector<Step> parse() const {
    std::vector<Step> steps;
    std::string_view rest = assignment_.path;
    while (true) {
      // A dot within brackets belongs to the text inside them.
      std::size_t end = 0;
      int depth = 0;
      while (end < rest.size() && !(rest[end] == '.' && depth == 0)) {
        depth += rest[end] == '[' ? 1 : rest[end] == ']' ? -1 : 0;
        ++end;
      }
      steps.push_back(parse_step(rest.substr(0, end)));
      if (end >= rest.size()) return steps;
      rest.remove_prefix(end + 1);
    }
  }

  void put(toml::table& table, const std::string& key) const {
    if (assignment_.value) {
      std::visit([&](const auto& value) { insert(table, key, value); }, *assignment_.value);
    } else {
      table.erase(key);
    }
  }
  static void insert(toml::table& table, const std::string& key, double value) {
    if (is_whole(value)) {
      table.insert_or_assign(key, static_cast<std::int64_t>(value));
    } else {
      table.insert_or_assign(key, value);
    }
  }
  template <typename Value>
  static void insert(toml::table& table, const std::string& key, const Value& value) {
    table.insert_or_assign(key, value);
  }
  void put(toml::array& array, std::size_t index) const {
    if (!assignment_.value) fail("an element of an array", "a key: an array keeps its elements");
    const auto replace = [&](const auto& value) { array.replace(array.begin() + static_cast<long>(index), value); };
    std::visit(replace, *assignment_.value);
  }

  static bool is_whole(double value) {
    constexpr double kExact = 9007199254740992.0;  // 2^53
    return std::abs(value) < kExact && value == std::floor(value);
  }

  std::vector<std::size_t> picked(const toml::array& array, const Step& step) const {
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < array.size(); ++i) {
      if (step.pick == Step::Pick::index && i != step.index) continue;
      if (step.pick == Step::Pick::matching) {
        const toml::table* element = array.get(i)->as_table();
        const toml::value<std::string>* text =
            element == nullptr ? nullptr : element->get_as<std::string>(step.match_key);
        if (text == nullptr || text->get() != step.match_value) continue;
      }
      indices.push_back(i);
    }
    return indices;
  }

  /// If a path leads through several tables, at least one must take the value.
  void into(toml::table& table, const std::vector<Step>& steps, std::vector<std::string>& places) const {
    if (through(table, steps, 0, "", places) == 0) {
      fail("nothing at this path", "a path that leads to one or more keys of the scenario");
    }
  }

  /// The number of values that were set.
  std::size_t through(toml::table& table, const std::vector<Step>& steps, std::size_t at, const std::string& before,
                      std::vector<std::string>& places) const {
    const Step& step = steps[at];
    const std::string here = before + (before.empty() ? "" : ".") + step.key;
    const bool last = at + 1 == steps.size();
    if (step.pick == Step::Pick::none) {
      if (last) {
        put(table, step.key);
        places.push_back(here);
        return 1;
      }
      toml::node* inner = table.get(step.key);
      if (inner == nullptr && !assignment_.value) return 1;  // the key to be removed is not there
      if (inner == nullptr) inner = &table.insert(step.key, toml::table{}).first->second;
      if (inner->is_array()) {
        fail(fmt::format("\"{}\", of which there are {}", step.key, inner->as_array()->size()),
             fmt::format("which one: {0}[1], {0}[*] or {0}[name=…]", step.key));
      }
      if (!inner->is_table()) fail(fmt::format("\"{}\", which is not a table", step.key), "a table");
      return through(*inner->as_table(), steps, at + 1, here, places);
    }
    toml::node* inner = table.get(step.key);
    toml::array* array = inner == nullptr ? nullptr : inner->as_array();
    if (array == nullptr) fail(fmt::format("no array \"{}\"", step.key), "an array or tables [[…]] of this name");
    if (step.pick == Step::Pick::index && step.index >= array->size()) {
      fail(fmt::format("number {} of {}", step.index + 1, array->size()), "one that exists");
    }
    std::size_t count = 0;
    for (const std::size_t i : picked(*array, step)) {
      const std::string element_here = fmt::format("{}[{}]", here, i + 1);
      if (last) {
        put(*array, i);
        places.push_back(element_here);
        ++count;
      } else if (toml::table* element = array->get(i)->as_table()) {
        count += through(*element, steps, at + 1, element_here, places);
      } else {
        fail(fmt::format("\"{}\", whose elements are not tables", step.key), "tables");
      }
    }
    return count;
  }

  const std::string& file_;
  const TomlAssignment& assignment_;
};

std::string text_of(const toml::table& tree) {
  std::ostringstream text;
  text << tree << '\n';
  return text.str();
}

}  // namespace

std::string toml_string(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (code < 0x20 || code == 0x7f) {
      quoted += fmt::format("\\u{:04X}", static_cast<unsigned>(code));
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

std::string toml_text(const TomlScalar& value) {
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  return toml_string(std::get<std::string>(value));
}

std::string with_missing(std::string_view toml, const std::string& shown_as, std::string_view others,
                         const std::string& others_shown_as, const std::vector<TomlSection>& sections,
                         std::string_view taken_out) {
  toml::table tree = parsed_toml(toml, shown_as);
  const toml::table more = parsed_toml(others, others_shown_as);
  for (const TomlSection& section : sections) {
    const toml::table* from = more.get_as<toml::table>(section.name);
    if (from == nullptr) continue;
    // The code that reads the document reports a section that is not a table.
    toml::table* to = tree.insert(section.name, toml::table{}).first->second.as_table();
    if (to == nullptr) continue;
    for (const auto& [key, value] : *from) {
      if (std::find(section.without.begin(), section.without.end(), key.str()) == section.without.end()) {
        to->insert(key, value);
      }
    }
  }
  tree.erase(taken_out);
  return text_of(tree);
}

std::string with_values(std::string_view toml, const std::string& shown_as,
                        const std::vector<TomlAssignment>& assignments) {
  toml::table tree = parsed_toml(toml, shown_as);
  for (const TomlAssignment& assignment : assignments) Setter(shown_as, assignment).apply(tree);
  return text_of(tree);
}

std::vector<std::string> reached_by(std::string_view toml, const std::string& shown_as, const std::string& path) {
  toml::table tree = parsed_toml(toml, shown_as);
  return Setter(shown_as, TomlAssignment{path, 0.0}).apply(tree);
}

}  // namespace glidelab::base
