#include "validate/study/baseline/baseline.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/long_work.h"
#include "base/text/json_text.h"
#include "core/math/quantile.h"
#include "fit/estimators.h"
#include "validate/made_tracks/oracle_bandwidth.h"
#include "validate/random_use.h"
#include "validate/truth/cramer_rao.h"

namespace glidelab::validate {
namespace {

std::pair<double, double> mean_and_sd(const std::vector<double>& values) {
  if (values.empty()) return {0.0, 0.0};
  const double n = static_cast<double>(values.size());
  double sum = 0.0, square = 0.0;
  for (const double value : values) sum += value;
  for (const double value : values) square += (value - sum / n) * (value - sum / n);
  return {sum / n, values.size() > 1 ? std::sqrt(square / (n - 1.0)) : 0.0};
}

/// Logarithms that describe one run's smoothing of a clip.
struct Smoothed {
  double log_bandwidth, log_a_error;
};

std::vector<SmoothingRecord> smoothing_of(const Truth& truth,
                                          const std::vector<std::vector<std::optional<Smoothed>>>& runs) {
  std::vector<SmoothingRecord> records;
  for (std::size_t clip = 0; clip < truth.clips.size(); ++clip) {
    std::vector<double> bandwidths, errors;
    for (const auto& run : runs) {
      if (!run.at(clip)) continue;
      bandwidths.push_back(run[clip]->log_bandwidth);
      errors.push_back(run[clip]->log_a_error);
    }
    SmoothingRecord record;
    record.clip = truth.clips[clip].name;
    record.runs = bandwidths.size();
    std::tie(record.log_bandwidth, record.log_bandwidth_sd) = mean_and_sd(bandwidths);
    std::tie(record.log_a_error, record.log_a_error_sd) = mean_and_sd(errors);
    records.push_back(std::move(record));
  }
  return records;
}

std::vector<std::optional<Smoothed>> smoothed_clips(const core::AnalysisResults& results, const Truth& truth) {
  std::vector<std::optional<Smoothed>> clips;
  for (std::size_t clip = 0; clip < truth.clips.size(); ++clip) {
    const core::ClipResult& of = results.clips.at(clip);
    const std::optional<double> error = acceleration_error_m_s2(of, truth.clips[clip]);
    const bool counts = error && *error > 0.0 && of.bandwidth_s > 0.0;
    clips.push_back(counts ? std::optional(Smoothed{std::log(of.bandwidth_s), std::log(*error)}) : std::nullopt);
  }
  return clips;
}

}  // namespace

std::vector<ErrorRecord> error_records(const std::vector<std::vector<QuantityComparison>>& runs) {
  std::vector<ErrorRecord> records;
  for (std::size_t i = 0; i < runs.front().size(); ++i) {
    if (!runs.front()[i].truth) continue;
    const QuantityComparison& first = runs.front()[i];
    ErrorRecord record;
    record.configuration = first.configuration;
    record.estimator = first.estimator;
    record.quantity = first.quantity;
    record.runs = runs.size();
    std::vector<double> errors, deviations;
    double square = 0.0;
    for (const auto& run : runs) {
      const QuantityComparison& q = run.at(i);
      if (!q.error) continue;
      if (q.sd && std::abs(*q.error) <= core::kNormal95 * *q.sd) ++record.covered;
      errors.push_back(*q.error);
      square += *q.error * *q.error;
    }
    record.answers = errors.size();
    std::tie(record.mean, record.sd) = mean_and_sd(errors);
    for (const double error : errors) deviations.push_back(std::abs(error - record.mean));
    std::tie(record.deviation, record.deviation_sd) = mean_and_sd(deviations);
    if (first.cramer_rao_sd && square > 0.0) {
      record.efficiency = std::pow(*first.cramer_rao_sd, 2) / (square / static_cast<double>(record.answers));
    }
    records.push_back(std::move(record));
  }
  return records;
}

std::vector<core::AnalysisResults> analyze_as_judged(const MadeTracks& made) {
  return fit::estimate_each(fit::judged_estimators(), [&](core::LineMethod lines) {
    return analyze_tracks(made, core::MotionOptions{.lines = lines});
  });
}

Baseline measure_baseline(const render::Scenario& scenario, const std::string& scenario_text,
                          const BaselineOptions& options, const AnalyzeTracks& analyze,
                          const base::Progress& progress) {
  Baseline baseline{scenario_text, options.noise_m, options.runs, options.seed, {}, {}};
  const MadeTracks clean = make_tracks(scenario, options.seed);
  const std::vector<LeastSd> bounds =
      least_sds(clean.truth, std::vector<double>(clean.tracks.size(), options.noise_m), clean.gravity_m_s2);
  std::vector<std::vector<QuantityComparison>> runs(options.runs);
  std::vector<std::vector<std::optional<Smoothed>>> smoothed(options.runs);
  std::atomic<std::uint64_t> done = 0;
  base::for_each_parallel(options.runs, options.jobs, [&](std::size_t run) {
    const MadeTracks made = with_noise(clean, options.noise_m, derived_seed(options.seed, run));
    const std::vector<core::AnalysisResults> all = analyze(made);
    if (!all.front().clips.empty()) smoothed[run] = smoothed_clips(all.front(), made.truth);
    for (const core::AnalysisResults& results : all) {
      for (QuantityComparison& q : with_bounds(compare_quantities(results, made.truth), bounds)) {
        runs[run].push_back(std::move(q));
      }
    }
    progress("runs", static_cast<double>(++done) / static_cast<double>(options.runs));
  });
  baseline.records = error_records(runs);
  const auto none = [](const auto& clips) { return clips.empty(); };
  if (!std::all_of(smoothed.begin(), smoothed.end(), none)) baseline.smoothing = smoothing_of(clean.truth, smoothed);
  return baseline;
}

std::uint64_t other_seed(const Baseline& then) {
  return then.seed.value_or(1) + 1;
}

std::string baseline_json(const Baseline& baseline) {
  nlohmann::ordered_json document;
  document["format"] = 2;
  document["scenario"] = baseline.scenario;
  document["noise_m"] = baseline.noise_m;
  document["runs"] = baseline.runs;
  if (baseline.seed) document["seed"] = *baseline.seed;
  document["records"] = document["smoothing"] = nlohmann::ordered_json::array();
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
  return base::json_text(document) + "\n";
}

namespace {

using nlohmann::json;

/// Keys of one object of the file, with an InputError that names the error.
class BaselineReader {
 public:
  /// `where` precedes the keys in messages.
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
    if (!value.is_number_unsigned())
      fail(key, value.is_number() ? base::json_text(value, base::kOnOneLine) : value.type_name(), kCount);
    return value;
  }
  std::string text(const char* key) const {
    const json& value = at(key, "a string");
    if (!value.is_string()) fail(key, value.type_name(), "a string");
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
    return base::parsed_json(text);
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
