#include "fit/outside/estimator_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "base/errors.h"
#include "base/math/angles.h"
#include "base/text/json_text.h"
#include "base/text/readable_text.h"
#include "core/result/estimate.h"
#include "core/result/quantity.h"

namespace glidelab::fit {
namespace {

using nlohmann::json;

constexpr int kFormat = 1;

/// The errors of a document, key by key.
class Findings {
 public:
  explicit Findings(const std::filesystem::path& file) : file_(file.string()) {}
  void add(const std::string& key, const std::string& found, const std::string& expected) {
    issues_.push_back({file_, 0, key, found, expected});
  }
  bool any() const { return !issues_.empty(); }
  void throw_if_any() const {
    if (any()) throw base::InputError(issues_);
  }

 private:
  std::string file_;
  std::vector<base::Issue> issues_;
};

/// A value as a message shows it: short values themselves, others by their type.
std::string shown(const json& value) {
  constexpr std::size_t kMostShown = 40;
  const std::string text = base::replaced_json_text(value, base::kOnOneLine);
  return text.size() <= kMostShown ? text : value.type_name();
}

/// What stands where the text stops to be JSON, with its place; Python's json writes NaN and Infinity, which are none.
void add_json_fault(std::string_view text, const json::exception& error, Findings& findings) {
  const auto* const parse = dynamic_cast<const json::parse_error*>(&error);
  if (parse == nullptr) return findings.add("", error.what(), "JSON");
  constexpr std::string_view kEnds = " \t\r\n,:[]{}\"";
  constexpr std::size_t kMostShown = 40;
  const std::size_t at = std::min(parse->byte > 0 ? parse->byte - 1 : 0, text.size());
  const std::string_view before = text.substr(0, at);
  const std::size_t last_end = before.find_last_of(kEnds);
  const std::size_t start = last_end == std::string_view::npos ? 0 : last_end + 1;
  const std::size_t end = std::max(at + 1, std::min(text.find_first_of(kEnds, at), text.size()));
  const std::string word = at == text.size()
                               ? "the end of the text"
                               : base::first_bytes(base::printable_text(text.substr(start, end - start)), kMostShown);
  const std::size_t line_start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  const bool no_number = word == "NaN" || word == "nan" || word == "Infinity" || word == "-Infinity";
  findings.add("",
               fmt::format("{} at line {}, column {}", word, 1 + std::ranges::count(before, '\n'),
                           start < line_start ? 1 : start - line_start + 1),
               no_number ? "a number, or null where nothing is determined: JSON has no NaN and no infinity" : "JSON");
}

/// The member; if there is none, null and a finding.
const json* member(const json& object, const std::string& key, const std::string& where, const char* expected,
                   Findings& findings) {
  const auto found = object.find(key);
  if (found != object.end()) return &*found;
  findings.add(where + key, "nothing", expected);
  return nullptr;
}

std::optional<double> number_in(const json& object, const std::string& key, const std::string& where,
                                Findings& findings) {
  constexpr const char* kExpected = "a finite number";
  const json* const value = member(object, key, where, kExpected, findings);
  if (value == nullptr) return std::nullopt;
  if (value->is_number() && std::isfinite(value->get<double>())) return value->get<double>();
  findings.add(where + key, shown(*value), kExpected);
  return std::nullopt;
}

/// The reason that the object's `why` gives for a quantity.
core::AnyReason reason_in(const json& configuration, const std::string& key, const std::string& where,
                          Findings& findings) {
  const core::unknown::NotTold not_told;
  const auto why = configuration.find("why");
  if (why == configuration.end()) return not_told;
  if (!why->is_object()) {
    findings.add(where + "why", shown(*why), "an object with a string for each quantity that is null");
    return not_told;
  }
  const auto reason = why->find(key);
  if (reason == why->end()) return not_told;
  if (reason->is_string()) return core::unknown::Told{reason->get<std::string>()};
  findings.add(where + "why." + key, shown(*reason), "a string");
  return not_told;
}

core::Quantity quantity_in(const json& configuration, const std::string& key, const std::string& where,
                           Findings& findings) {
  constexpr const char* kExpected = "an object with value and sd, or null";
  const json* const object = member(configuration, key, where, kExpected, findings);
  if (object == nullptr) return {};
  if (object->is_null()) return core::undetermined(reason_in(configuration, key, where, findings));
  if (!object->is_object()) {
    findings.add(where + key, shown(*object), kExpected);
    return {};
  }
  const std::string within = where + key + ".";
  const std::optional<double> value = number_in(*object, "value", within, findings);
  const std::optional<double> sd = number_in(*object, "sd", within, findings);
  if (sd && *sd < 0.0) findings.add(within + "sd", fmt::format("{}", *sd), "a number that is not negative");
  if (!value || !sd || *sd < 0.0) return {};
  core::Estimate estimate = core::estimate(*value, *sd, std::numeric_limits<double>::infinity());
  const auto interval = object->find("interval95");
  if (interval != object->end() && !interval->is_null()) {
    const bool pair = interval->is_array() && interval->size() == 2 && (*interval)[0].is_number() &&
                      (*interval)[1].is_number() && (*interval)[0].get<double>() <= *value &&
                      (*interval)[1].get<double>() >= *value && std::isfinite((*interval)[0].get<double>()) &&
                      std::isfinite((*interval)[1].get<double>());
    if (!pair) {
      findings.add(within + "interval95", shown(*interval), "two finite numbers with the value between them");
      return {};
    }
    estimate.low95 = (*interval)[0].get<double>();
    estimate.high95 = (*interval)[1].get<double>();
  }
  return core::determined(estimate);
}

/// The index of the configuration that these clips form; if they do not form one, empty and a finding.
std::optional<std::size_t> place_in(const core::AnalysisResults& results, const json& configuration,
                                    const std::string& where, std::set<std::string>& taken, Findings& findings) {
  constexpr const char* kExpected = "a list of names of clips";
  const json* const clips = member(configuration, "clips", where, kExpected, findings);
  if (clips == nullptr) return std::nullopt;
  if (!clips->is_array() || clips->empty()) {
    findings.add(where + "clips", shown(*clips), kExpected);
    return std::nullopt;
  }
  std::optional<std::size_t> place;
  for (std::size_t i = 0; i < clips->size(); ++i) {
    const json& clip = (*clips)[i];
    const std::string key = fmt::format("{}clips[{}]", where, i);
    const std::string name = clip.is_string() ? clip.get<std::string>() : std::string();
    const auto found = std::ranges::find_if(results.configurations, [&](const core::ConfigurationResult& one) {
      return std::ranges::find(one.clips, name) != one.clips.end();
    });
    if (found == results.configurations.end()) {
      findings.add(key, shown(clip), "the name of a clip in experiment.toml");
      return std::nullopt;
    }
    if (!taken.insert(name).second) {
      findings.add(key, shown(clip), "each clip once");
      return std::nullopt;
    }
    const auto at = static_cast<std::size_t>(std::distance(results.configurations.begin(), found));
    if (place && *place != at) {
      findings.add(key, shown(clip), "clips of one mass, stated inclination and group");
      return std::nullopt;
    }
    place = at;
  }
  return place;
}

void read_configuration(const json& configuration, const std::string& where, core::AnalysisResults& results,
                        std::vector<bool>& answered, std::set<std::string>& taken, Findings& findings) {
  if (!configuration.is_object()) {
    findings.add(where.substr(0, where.size() - 1), shown(configuration), "an object");
    return;
  }
  const std::optional<std::size_t> place = place_in(results, configuration, where, taken, findings);
  if (place && answered[*place]) {
    findings.add(where + "clips", shown(configuration.at("clips")),
                 "each configuration once: all clips of one mass, stated inclination and group together");
  }
  for (const core::QuantityName& quantity : core::kQuantities) {
    const core::Quantity read = quantity_in(configuration, std::string(quantity.key), where, findings);
    if (place) core::value_of(results.configurations[*place], quantity.which) = read;
  }
  if (place) answered[*place] = true;
}

}  // namespace

core::AnalysisResults undetermined_results(const std::vector<core::ClipSetup>& clips, const std::string& estimator,
                                           const core::AnyReason& why) {
  core::AnalysisResults results;
  results.estimator = estimator;
  std::vector<const core::ClipSetup*> firsts;  // the first clip of each configuration
  for (const core::ClipSetup& clip : clips) {
    const auto same = std::ranges::find_if(firsts, [&](const core::ClipSetup* first) {
      return first->mass_kg == clip.mass_kg && first->group == clip.group &&
             std::abs(first->incline_rad - clip.incline_rad) < core::kSameIncline_rad;
    });
    if (same != firsts.end()) {
      results.configurations[static_cast<std::size_t>(same - firsts.begin())].clips.push_back(clip.name);
      continue;
    }
    firsts.push_back(&clip);
    core::ConfigurationResult configuration;
    configuration.mass_kg = clip.mass_kg;
    configuration.incline_deg = clip.incline_rad * base::kDegreesPerRad;
    configuration.group = clip.group;
    configuration.clips = {clip.name};
    for (const core::QuantityName& quantity : core::kQuantities) {
      core::value_of(configuration, quantity.which) = core::undetermined(why);
    }
    results.configurations.push_back(std::move(configuration));
  }
  return results;
}

core::AnalysisResults read_estimator_results(std::string_view text, const std::filesystem::path& file,
                                             const std::vector<core::ClipSetup>& clips, const std::string& estimator) {
  core::AnalysisResults results = undetermined_results(clips, estimator, core::unknown::NotAnswered{});
  Findings findings(file);
  json document;
  try {
    document = base::parsed_json(text);
  } catch (const json::exception& error) {
    add_json_fault(text, error, findings);
    findings.throw_if_any();
  }
  if (!document.is_object()) findings.add("", document.type_name(), "an object");
  findings.throw_if_any();
  const json* const format = member(document, "format", "", "1", findings);
  if (format != nullptr && *format != kFormat) findings.add("format", shown(*format), "1");
  const json* const list = member(document, "configurations", "", "a list", findings);
  if (list != nullptr && !list->is_array()) findings.add("configurations", shown(*list), "a list");
  findings.throw_if_any();
  std::vector<bool> answered(results.configurations.size());
  std::set<std::string> taken;
  for (std::size_t i = 0; i < list->size(); ++i) {
    read_configuration((*list)[i], fmt::format("configurations[{}].", i), results, answered, taken, findings);
  }
  findings.throw_if_any();
  return results;
}

}  // namespace glidelab::fit
