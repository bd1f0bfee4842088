#include "validate/study/sweep/design/sweep_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "validate/study/sweep/design/sweep_design.h"

namespace glidelab::validate {
namespace {

using base::TomlTable;
using Kind = AxisSource::Kind;

/// Rounded to whole numbers, neighbours of a short range would come twice.
void check_apart(const TomlTable& table, const AxisSource& source) {
  if (!std::isfinite(source.from) || !std::isfinite(source.to)) return;
  const std::vector<base::TomlScalar> values = all_values(source);
  if (std::adjacent_find(values.begin(), values.end()) == values.end()) return;
  table.reject("count", fmt::format("{} values, of which some are alike as whole numbers", source.count),
               "fewer values, or a longer range");
}

/// { from = …, to = …, count = …, whole = … }, from < to.
void read_range(const TomlTable& axis, const char* key, Kind kind, Design design, AxisSource& source) {
  const TomlTable table = axis.table(key);
  const bool ratio = kind == Kind::logarithmic || kind == Kind::log_uniform;
  source.kind = kind;
  source.from = table.number("from", ratio ? base::above(0.0) : base::any_number());
  source.to = table.number("to", ratio ? base::above(0.0) : base::any_number());
  if (!(source.from < source.to) && std::isfinite(source.from) && std::isfinite(source.to)) {
    table.reject("to", fmt::format("{}: an empty range", source.to),
                 fmt::format("a number above from = {}", source.from));
  }
  source.whole = table.boolean_or("whole", false);
  for (const char* end : {"from", "to"}) {
    const double value = std::string_view(end) == "from" ? source.from : source.to;
    if (source.whole && std::isfinite(value) && value != std::floor(value)) {
      table.reject(end, fmt::format("{}", value), "a whole number, with whole = true");
    }
  }
  if (source.drawn()) return;
  if (design == Design::factorial) {
    source.count = static_cast<std::size_t>(table.integer("count", 2, 1000000));
    if (source.whole) check_apart(table, source);
  } else if (table.has("count")) {
    table.reject("count", "a number of values", "no count: the design places its samples anywhere in the range");
  }
}

void read_random(const TomlTable& axis, Design design, AxisSource& source) {
  const TomlTable table = axis.table("random");
  const std::string word = table.word("distribution", {"uniform", "log_uniform", "normal", "log_normal"});
  if (word == "uniform" || word == "log_uniform") {
    return read_range(axis, "random", word == "uniform" ? Kind::uniform : Kind::log_uniform, design, source);
  }
  source.kind = word == "normal" ? Kind::normal : Kind::log_normal;
  source.mean = source.kind == Kind::normal ? table.number("mean") : table.number("median", base::above(0.0));
  source.sd = table.number(source.kind == Kind::normal ? "sd" : "sd_of_log", base::above(0.0));
}

/// "rolling, line_readout_s = 2e-05": words speak for themselves.
std::string label_of(const std::vector<base::TomlAssignment>& keys) {
  std::string words, others;
  for (const auto& [path, value] : keys) {
    if (const auto* word = std::get_if<std::string>(&value.value())) {
      words += (words.empty() ? "" : ", ") + *word;
    } else {
      others += fmt::format(", {} = {}", path.substr(path.rfind('.') + 1), base::toml_text(*value));
    }
  }
  return words.empty() ? others.substr(std::min<std::size_t>(2, others.size())) : words + others;
}

/// [[vary]] choices = [{ "shutter.kind" = "global" }, { "shutter.kind" = "rolling", "shutter.line_readout_s" = 2e-5 }]
void read_choices(const TomlTable& table, Axis& axis) {
  std::set<std::string> keys;
  const auto same = [](const Choice& a, const Choice& b) {
    return std::equal(a.keys.begin(), a.keys.end(), b.keys.begin(), b.keys.end(),
                      [](const auto& x, const auto& y) { return x.path == y.path && x.value == y.value; });
  };
  for (const TomlTable& given : table.tables_or_none("choices")) {
    Choice choice;
    choice.line = given.line();
    for (auto& [path, value] : given.scalars()) {
      if (path == "label") continue;
      if (path == "camera_file") given.reject(path, "a camera", "cameras = [...], an axis of its own");
      choice.keys.push_back({path, std::move(value)});
      if (keys.insert(path).second) axis.keys.push_back(path);
    }
    choice.label = given.has("label") ? given.text("label") : label_of(choice.keys);
    if (choice.keys.empty()) given.reject("", "a choice without a key", "a key of the scenario or more");
    for (const Choice& other : axis.choices) {
      if (same(choice, other)) {
        given.reject("", fmt::format("the choice of line {} again", other.line), "each choice once");
      } else if (choice.label == other.label) {
        given.reject("label", fmt::format("\"{}\" twice", choice.label), "a label of its own for each choice");
      }
    }
    axis.source.values.emplace_back(choice.label);
    axis.choices.push_back(std::move(choice));
  }
}

/// A value given twice would be a point that comes twice.
void check_values_once(const TomlTable& table, const std::string& form, const std::vector<base::TomlScalar>& values) {
  for (std::size_t i = 1; i < values.size(); ++i) {
    const auto here = values.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::find(values.begin(), here, *here) == here) continue;
    table.reject(form, fmt::format("{} twice", base::toml_text(*here)), "each one once");
    return;
  }
}

void read_source(const TomlTable& table, Design design, Axis& axis, const std::filesystem::path& folder) {
  const std::vector<std::string> forms = {"values",  "words", "switch",    "choices",
                                          "cameras", "range", "log_range", "random"};
  std::vector<std::string> given;
  for (const std::string& form : forms) {
    if (table.has(form)) given.push_back(form);
  }
  if (given.size() != 1) {
    table.reject("key", given.empty() ? "no values for it" : fmt::format("{} and {}", given[0], given[1]),
                 fmt::format("exactly one of {}", fmt::join(forms, ", ")));
    return;
  }
  AxisSource& source = axis.source;
  const std::string& form = given.front();
  if (form == "values") {
    for (const double value : table.numbers("values", 0)) source.values.emplace_back(value);
    if (source.values.empty()) table.reject("values", "an empty list", "one value or more");
    check_values_once(table, form, source.values);
  } else if (form == "words") {
    for (std::string& word : table.texts_or_none("words")) source.values.emplace_back(std::move(word));
    if (source.values.empty()) table.reject("words", "an empty list", "one text or more");
    check_values_once(table, form, source.values);
  } else if (form == "switch") {
    table.boolean_or("switch", true);
    source.values = {false, true};
  } else if (form == "choices") {
    read_choices(table, axis);
  } else if (form == "cameras") {
    axis.keys = {"camera_file"};
    for (const std::string& name : table.texts_or_none("cameras")) {
      std::error_code ignored;  // what cannot be looked at says so when it is read
      const std::filesystem::path resolved = std::filesystem::weakly_canonical(folder / name, ignored);
      const std::filesystem::path path = resolved.empty() ? folder / name : resolved;
      if (!std::filesystem::is_directory(path, ignored)) {
        source.values.emplace_back(path.string());
        continue;
      }
      std::set<std::string> found;
      for (const auto& entry : std::filesystem::directory_iterator(path)) {
        if (entry.path().extension() == ".toml") found.insert(entry.path().string());
      }
      for (const std::string& file : found) source.values.emplace_back(file);
    }
    if (source.values.empty()) table.reject("cameras", "no camera file", "camera files, or folders with some");
    check_values_once(table, form, source.values);
  } else if (form == "random") {
    read_random(table, design, source);
  } else {
    read_range(table, form.c_str(), form == "range" ? Kind::linear : Kind::logarithmic, design, source);
  }
}

/// Keys that the form has no use for; asked for, they are not called unknown.
void refuse_beside(const TomlTable& table, const std::vector<std::string>& keys, const char* form,
                   const char* expected) {
  for (const std::string& key : keys) {
    if (table.has(key)) table.reject(key, fmt::format("a key beside {}", form), expected);
  }
}

}  // namespace

Axis read_axis(const TomlTable& table, Design design, const std::filesystem::path& folder) {
  Axis axis;
  if (table.has("choices")) {
    axis.name = table.text("name");
    axis.line = table.line("choices");
    refuse_beside(table, {"key", "keys"}, "choices", "none: each choice names its own");
  } else if (table.has("cameras")) {
    axis.line = table.line("cameras");
    refuse_beside(table, {"key", "keys"}, "cameras", "none: the files are the values");
    axis.name = table.text_or("name", "camera_file");
  } else if (table.has("keys")) {
    axis.line = table.line("keys");
    refuse_beside(table, {"key"}, "keys", "one of the two");
    axis.keys = table.texts_or_none("keys");
    axis.name = table.text("name");
  } else {
    axis.line = table.line("key");
    axis.keys = {table.text("key")};
    axis.name = table.text_or("name", axis.keys.front());
  }
  read_source(table, design, axis, folder);
  return axis;
}

}  // namespace glidelab::validate
