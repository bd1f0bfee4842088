#include "validate/study/baseline/baseline_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/files/staged_output.h"

namespace glidelab::validate {

std::string baseline_json(const Baseline& baseline) {
  nlohmann::ordered_json document;
  document["format"] = 2;
  document["scenario"] = baseline.scenario;
  document["noise_m"] = baseline.noise_m;
  document["runs"] = baseline.runs;
  if (baseline.seed) document["seed"] = *baseline.seed;
  for (const ErrorRecord& record : baseline.records) {
    document["records"].push_back({{"configuration", record.configuration},
                                   {"estimator", record.estimator},
                                   {"quantity", record.quantity},
                                   {"runs", record.runs},
                                   {"answers", record.answers},
                                   {"covered", record.covered},
                                   {"mean_error", record.mean},
                                   {"sd_error", record.sd},
                                   {"mean_deviation", record.deviation},
                                   {"sd_deviation", record.deviation_sd},
                                   {"efficiency", record.efficiency}});
  }
  for (const SmoothingRecord& record : baseline.smoothing) {
    document["smoothing"].push_back({{"clip", record.clip},
                                     {"runs", record.runs},
                                     {"log_bandwidth", record.log_bandwidth},
                                     {"log_bandwidth_sd", record.log_bandwidth_sd},
                                     {"log_a_error", record.log_a_error},
                                     {"log_a_error_sd", record.log_a_error_sd}});
  }
  return document.dump(2) + "\n";
}

namespace {

using nlohmann::json;

/// Keys of one object of the file, with an InputError that names what is wrong.
class BaselineReader {
 public:
  /// `where` comes before the keys in what is said.
  BaselineReader(const json& object, const std::filesystem::path& file, std::string where = {})
      : object_(object), file_(file), where_(std::move(where)) {
    if (!object.is_object()) fail("", object.type_name(), "an object that --write-baseline has made");
  }
  double number(const char* key) const {
    const json& value = at(key, "a number");
    if (!value.is_number()) fail(key, value.type_name(), "a number");
    return value;
  }
  /// A conversion of a negative or broken number to a count would be undefined.
  std::uint64_t count(const char* key) const {
    constexpr const char* kCount = "a whole number, 0 or more";
    const json& value = at(key, kCount);
    if (!value.is_number_unsigned()) fail(key, value.is_number() ? value.dump() : value.type_name(), kCount);
    return value;
  }
  std::string text(const char* key) const {
    const json& value = at(key, "a text");
    if (!value.is_string()) fail(key, value.type_name(), "a text");
    return value;
  }
  const json& list(const char* key) const {
    const json& value = at(key, "a list");
    if (!value.is_array()) fail(key, value.type_name(), "a list");
    return value;
  }
  bool has(const char* key) const { return object_.contains(key); }
  [[noreturn]] void fail(const std::string& key, const std::string& found, const std::string& expected) const {
    throw base::InputError(base::Issue{file_.string(), 0, where_ + key, found, expected});
  }

 private:
  const json& at(const char* key, const char* expected) const {
    if (!has(key)) fail(key, "nothing", fmt::format("{}, as --write-baseline writes it", expected));
    return object_.at(key);
  }
  const json& object_;
  std::filesystem::path file_;
  std::string where_;
};

json parsed(const std::filesystem::path& file) {
  const std::string text = base::read_file(file);
  try {
    return json::parse(text);
  } catch (const json::parse_error& error) {
    const std::size_t end = std::min(error.byte, text.size());
    const auto lines = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n');
    throw base::InputError(base::Issue{file.string(), static_cast<int>(lines) + 1, "", "what is no JSON",
                                       "a baseline that --write-baseline has made"});
  } catch (const json::exception&) {
    throw base::InputError(base::Issue{file.string(), 0, "", "a number beyond those of this machine",
                                       "a baseline that --write-baseline has made"});
  }
}

}  // namespace

Baseline read_baseline(const std::filesystem::path& file) {
  Baseline baseline;
  const json document = parsed(file);
  const BaselineReader whole(document, file);
  constexpr std::uint64_t kFormat = 2;
  if (const std::uint64_t format = whole.count("format"); format != kFormat) {
    whole.fail("format", fmt::format("{}", format), "2, as --write-baseline of this version writes it");
  }
  baseline.scenario = whole.text("scenario");
  baseline.noise_m = whole.number("noise_m");
  baseline.runs = whole.count("runs");
  if (whole.has("seed")) baseline.seed = whole.count("seed");
  for (const json& object : whole.list("records")) {
    const BaselineReader of(object, file, fmt::format("records[{}].", baseline.records.size()));
    baseline.records.push_back({of.text("configuration"), of.text("estimator"), of.text("quantity"), of.count("runs"),
                                of.count("answers"), of.count("covered"), of.number("mean_error"),
                                of.number("sd_error"), of.number("mean_deviation"), of.number("sd_deviation"),
                                of.number("efficiency")});
    const ErrorRecord& record = baseline.records.back();
    if (record.runs == 0 || record.answers > record.runs || record.covered > record.answers) {
      whole.fail("records", "counts that do not fit", "runs >= answers >= covered");
    }
  }
  for (const json& object : whole.list("smoothing")) {
    const BaselineReader of(object, file, fmt::format("smoothing[{}].", baseline.smoothing.size()));
    baseline.smoothing.push_back({of.text("clip"), of.count("runs"), of.number("log_bandwidth"),
                                  of.number("log_bandwidth_sd"), of.number("log_a_error"),
                                  of.number("log_a_error_sd")});
  }
  return baseline;
}

}  // namespace glidelab::validate
