#include "validate/truth/truth_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/text/csv.h"
#include "base/text/json_text.h"
#include "core/result/quantity.h"

namespace glidelab::validate {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// One object of the file with its path ("configurations[2]."), which records errors and continues.
class Reader {
 public:
  Reader(const json& value, std::string file, std::string prefix, std::vector<base::Issue>& issues)
      : value_(value), file_(std::move(file)), prefix_(std::move(prefix)), issues_(issues) {}

  std::string text(const char* key) const {
    const json* found = find(key);
    if (found != nullptr && found->is_string() && !found->get_ref<const std::string&>().empty()) return *found;
    reject(key, found, "a string");
    return {};
  }
  double number(const char* key) const {
    const json* found = find(key);
    if (found != nullptr && found->is_number() && std::isfinite(found->get<double>())) return *found;
    reject(key, found, "a finite number");
    return 0.0;
  }
  std::optional<double> number_or_null(const char* key) const {
    const json* found = find(key);
    if (found != nullptr && found->is_null()) return std::nullopt;
    if (found != nullptr && found->is_number() && std::isfinite(found->get<double>())) return found->get<double>();
    reject(key, found, "a finite number or null");
    return std::nullopt;
  }
  std::uint64_t count(const char* key) const {
    const json* found = find(key);
    if (found != nullptr && found->is_number_unsigned()) return *found;
    reject(key, found, "a whole number of at least 0");
    return 0;
  }
  std::vector<std::string> texts(const char* key) const {
    const json* found = find(key);
    std::vector<std::string> values;
    if (found != nullptr && found->is_array() && !found->empty()) {
      for (const json& element : *found) {
        if (element.is_string()) values.push_back(element);
      }
      if (values.size() == found->size()) return values;
    }
    reject(key, found, "an array of one or more texts");
    return {};
  }
  std::vector<Reader> objects(const char* key) const {
    const json* found = find(key);
    std::vector<Reader> readers;
    const auto is_object = [](const json& element) { return element.is_object(); };
    if (found == nullptr || !found->is_array() || found->empty() ||
        !std::all_of(found->begin(), found->end(), is_object)) {
      reject(key, found, "an array of one or more objects");
      return readers;
    }
    for (std::size_t i = 0; i < found->size(); ++i) {
      readers.emplace_back((*found)[i], file_, fmt::format("{}{}[{}].", prefix_, key, i), issues_);
    }
    return readers;
  }
  void reject(const char* key, std::string found, std::string expected) const {
    issues_.push_back({file_, 0, prefix_ + key, std::move(found), std::move(expected)});
  }

 private:
  const json* find(const char* key) const {
    const auto found = value_.find(key);
    return found == value_.end() ? nullptr : &*found;
  }
  void reject(const char* key, const json* found, std::string expected) const {
    constexpr std::size_t kShown = 40;  // characters: enough to recognise a value, short enough for one line
    // Not the text of an array or an object: writing one nested a million deep needs an equally deep stack.
    const bool large = found != nullptr && found->is_structured() && !found->empty();
    std::string shown = found == nullptr ? "nothing" : large ? std::string("an ") + found->type_name() : found->dump();
    if (shown.size() > kShown) shown = shown.substr(0, kShown) + "…";
    reject(key, std::move(shown), std::move(expected));
  }

  const json& value_;
  std::string file_;
  std::string prefix_;
  std::vector<base::Issue>& issues_;
};

TrueConfiguration read_configuration(const Reader& reader) {
  TrueConfiguration configuration;
  configuration.name = reader.text("name");
  configuration.mass_kg = reader.number("mass_kg");
  configuration.stated_incline_deg = reader.number("stated_incline_deg");
  configuration.group = reader.text("group");
  for (const core::QuantityName& quantity : core::kQuantities) {
    core::value_of(configuration, quantity.which) = reader.number_or_null(std::string(quantity.key).c_str());
  }
  configuration.clips = reader.texts("clips");
  return configuration;
}

void read_trajectory(const fs::path& file, std::uint64_t frames, TrueClip& clip) {
  const base::CsvTable table = base::read_csv(file, {"t_s", "x_m", "v_m_s", "a_m_s2"}, {}, true);
  clip.t_s = table.column("t_s");
  clip.x_m = table.column("x_m");
  clip.v_m_s = table.column("v_m_s");
  clip.a_m_s2 = table.column("a_m_s2");
  if (clip.t_s.size() != frames) {
    throw base::InputError(base::Issue{file.string(), 0, "", fmt::format("{} rows", clip.t_s.size()),
                                       fmt::format("{} rows, one for each frame", frames)});
  }
}

bool is_plain_file_name(const std::string& name) {
  const fs::path path(name);
  return !name.empty() && path.filename() == path && name != "." && name != "..";
}

}  // namespace

Truth read_truth(const fs::path& truth_dir) {
  const fs::path file = truth_dir / "truth.json";
  const std::string name = file.string();
  const std::string bytes = base::read_file(file);
  json document;
  try {
    document = base::parsed_json(bytes);
  } catch (const json::parse_error& error) {
    throw base::InputError(base::Issue{name, 0, fmt::format("byte {}", error.byte), "no valid JSON", "a JSON object"});
  } catch (const json::out_of_range& error) {  // a number beyond any double
    throw base::InputError(base::Issue{name, 0, "", error.what(), "numbers that fit into a double"});
  }
  if (!document.is_object()) throw base::InputError(base::Issue{name, 0, "", "no object", "a JSON object"});

  std::vector<base::Issue> issues;
  const Reader root(document, name, "", issues);
  if (root.count("format") != 1) root.reject("format", "another format", "1");
  Truth truth;
  truth.name = root.text("name");
  truth.seed = root.count("seed");
  for (const Reader& reader : root.objects("configurations")) {
    truth.configurations.push_back(read_configuration(reader));
  }

  std::set<std::string> names;
  std::vector<std::string> trajectories;
  std::vector<std::uint64_t> frames;
  for (const Reader& reader : root.objects("clips")) {
    TrueClip clip;
    clip.name = reader.text("name");
    clip.configuration = reader.text("configuration");
    clip.x_origin_m = reader.number("x_origin_m");
    frames.push_back(reader.count("frames"));
    trajectories.push_back(reader.text("trajectory"));
    if (!is_plain_file_name(trajectories.back())) {
      reader.reject("trajectory", fmt::format("\"{}\"", trajectories.back()), "the name of a file in this folder");
    }
    if (!names.insert(clip.name).second) reader.reject("name", fmt::format("\"{}\" twice", clip.name), "it once");
    const bool known =
        std::any_of(truth.configurations.begin(), truth.configurations.end(), [&](const TrueConfiguration& c) {
          return c.name == clip.configuration && std::find(c.clips.begin(), c.clips.end(), clip.name) != c.clips.end();
        });
    if (!known) {
      reader.reject("configuration", fmt::format("\"{}\"", clip.configuration),
                    fmt::format("a configuration that lists the clip \"{}\"", clip.name));
    }
    truth.clips.push_back(std::move(clip));
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
  for (std::size_t i = 0; i < truth.clips.size(); ++i) {
    read_trajectory(truth_dir / trajectories[i], frames[i], truth.clips[i]);
  }
  return truth;
}

}  // namespace glidelab::validate
