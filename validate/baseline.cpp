#include "validate/baseline.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "base/errors.h"
#include "base/parallel.h"
#include "base/staged_output.h"
#include "core/quantile.h"
#include "diagnose/trajectory_results.h"
#include "validate/comparison.h"
#include "validate/cramer_rao.h"
#include "validate/oracle_bandwidth.h"

namespace glidelab::validate {
namespace {

using boost::math::cdf;
using boost::math::complement;
using boost::math::quantile;

/// One-sided p that the mean now is no larger, by Welch's t test. Each side: mean, standard deviation, number.
struct Side {
  double mean, sd, count;
};
double p_of_mean(const Side& then, const Side& now) {
  const double a = then.sd * then.sd / then.count, b = now.sd * now.sd / now.count;
  const double more = now.mean - then.mean;
  if (a + b == 0.0) return more > 0.0 ? 0.0 : 1.0;
  const double degrees = (a + b) * (a + b) / (a * a / (then.count - 1.0) + b * b / (now.count - 1.0));
  return cdf(complement(boost::math::students_t(degrees), more / std::sqrt(a + b)));
}

double p_of_spread(const ErrorRecord& then, const ErrorRecord& now) {
  return p_of_mean({then.deviation, then.deviation_sd, static_cast<double>(then.answers)},
                   {now.deviation, now.deviation_sd, static_cast<double>(now.answers)});
}

/// That the mean error now is no farther from zero.
double p_of_bias(const ErrorRecord& then, const ErrorRecord& now) {
  return p_of_mean({std::abs(then.mean), then.sd, static_cast<double>(then.answers)},
                   {std::abs(now.mean), now.sd, static_cast<double>(now.answers)});
}

/// One-sided p that the proportion now is no smaller.
double p_of_proportion(std::uint64_t then, std::uint64_t of_then, std::uint64_t now, std::uint64_t of_now) {
  const double n = static_cast<double>(of_then), m = static_cast<double>(of_now);
  const double pooled = static_cast<double>(then + now) / (n + m);
  const double variance = pooled * (1.0 - pooled) * (1.0 / n + 1.0 / m);
  if (variance == 0.0) return 1.0;
  const double fewer = static_cast<double>(then) / n - static_cast<double>(now) / m;
  return cdf(complement(boost::math::normal(), fewer / std::sqrt(variance)));
}

std::pair<double, double> mean_and_sd(const std::vector<double>& values) {
  if (values.empty()) return {0.0, 0.0};
  const double n = static_cast<double>(values.size());
  double sum = 0.0, square = 0.0;
  for (const double value : values) sum += value;
  for (const double value : values) square += (value - sum / n) * (value - sum / n);
  return {sum / n, values.size() > 1 ? std::sqrt(square / (n - 1.0)) : 0.0};
}

std::vector<ErrorRecord> records_of(const std::vector<std::vector<QuantityComparison>>& runs) {
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

/// Logarithms of what one run's smoothing did to a clip.
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

std::vector<core::AnalysisResults> analyze_both(const MadeTracks& made) {
  core::AnalysisResults lines = analyze_tracks(made, core::MotionOptions{});
  core::AnalysisResults whole = diagnose::with_trajectory_fits(lines);
  return {std::move(lines), std::move(whole)};
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
    const MadeTracks made = with_noise(clean, options.noise_m, options.seed * 1000003u + run);
    const std::vector<core::AnalysisResults> all = analyze(made);
    smoothed[run] = smoothed_clips(all.front(), made.truth);
    for (const core::AnalysisResults& results : all) {
      for (QuantityComparison& q : with_bounds(compare_quantities(results, made.truth), bounds)) {
        runs[run].push_back(std::move(q));
      }
    }
    progress("runs", static_cast<double>(++done) / static_cast<double>(options.runs));
  });
  baseline.records = records_of(runs);
  baseline.smoothing = smoothing_of(clean.truth, smoothed);
  return baseline;
}

BaselineComparison compare_baselines(const Baseline& then, const Baseline& now) {
  const auto reject = [](const char* key, const std::string& found, const std::string& expected) {
    throw base::InputError(base::Issue{"baseline", 0, key, found, expected});
  };
  if (then.scenario != now.scenario) reject("scenario", "another scenario", "the scenario that it was made with");
  if (then.noise_m != now.noise_m) {
    reject("noise_m", fmt::format("{}", now.noise_m), fmt::format("{} as in the baseline", then.noise_m));
  }
  BaselineComparison comparison;
  constexpr std::size_t kTestsEach = 4, kTestsOfClip = 2;
  comparison.tests = kTestsEach * then.records.size() + kTestsOfClip * then.smoothing.size();
  const double level = comparison.significance / static_cast<double>(comparison.tests);
  for (const ErrorRecord& before : then.records) {
    const auto found = std::find_if(now.records.begin(), now.records.end(), [&](const ErrorRecord& record) {
      return record.configuration == before.configuration && record.estimator == before.estimator &&
             record.quantity == before.quantity;
    });
    const std::string name = fmt::format("{} {} {}", before.configuration, before.estimator, before.quantity);
    if (found == now.records.end()) reject(name.c_str(), "nothing now", "a quantity of both");
    const auto judge = [&](const char* what, double p, double value_then, double value_now) {
      if (p < level) {
        comparison.worse.push_back(
            {before.configuration, before.estimator, before.quantity, what, value_then, value_now, p});
      }
    };
    const auto part = [](std::uint64_t some, std::uint64_t all) {
      return static_cast<double>(some) / static_cast<double>(all);
    };
    judge("answers", p_of_proportion(before.answers, before.runs, found->answers, found->runs),
          part(before.answers, before.runs), part(found->answers, found->runs));
    if (before.answers < 2 || found->answers < 2) continue;
    judge("spread", p_of_spread(before, *found), before.deviation, found->deviation);
    judge("bias", p_of_bias(before, *found), before.mean, found->mean);
    judge("coverage", p_of_proportion(before.covered, before.answers, found->covered, found->answers),
          part(before.covered, before.answers), part(found->covered, found->answers));
  }
  comparison.power_doubled = then.smoothing.empty() ? 0.0 : 1.0;
  for (const SmoothingRecord& before : then.smoothing) {
    const auto found = std::find_if(now.smoothing.begin(), now.smoothing.end(),
                                    [&](const SmoothingRecord& record) { return record.clip == before.clip; });
    if (found == now.smoothing.end()) reject(before.clip.c_str(), "nothing now", "a clip of both");
    if (before.runs < 2 || found->runs < 2) continue;
    const auto side = [](double mean, double sd, std::uint64_t count) {
      return Side{mean, sd, static_cast<double>(count)};
    };
    const auto judge = [&](const char* quantity, const char* what, double p, double log_then, double log_now) {
      if (p >= level) return;
      comparison.worse.push_back(
          {before.clip, "phase-diagram", quantity, what, std::exp(log_then), std::exp(log_now), p});
    };
    judge("a", "rms error",
          p_of_mean(side(before.log_a_error, before.log_a_error_sd, before.runs),
                    side(found->log_a_error, found->log_a_error_sd, found->runs)),
          before.log_a_error, found->log_a_error);
    const Side h_then = side(before.log_bandwidth, before.log_bandwidth_sd, before.runs);
    const Side h_now = side(found->log_bandwidth, found->log_bandwidth_sd, found->runs);
    judge("bandwidth", "mean", std::min(1.0, 2.0 * std::min(p_of_mean(h_then, h_now), p_of_mean(h_now, h_then))),
          before.log_bandwidth, found->log_bandwidth);
    const double sd = before.log_bandwidth_sd * std::sqrt(1.0 / h_then.count + 1.0 / h_now.count);
    if (sd > 0.0) {
      const boost::math::normal normal;
      const double power = cdf(normal, std::log(2.0) / sd - quantile(complement(normal, 0.5 * level)));
      comparison.power_doubled = std::min(comparison.power_doubled, power);
    }
  }
  const double n = static_cast<double>(now.runs), m = static_cast<double>(then.runs);
  if (now.runs > 2 && then.runs > 2) {
    constexpr double kLarger = 1.5, kBias = 0.5;
    const boost::math::normal normal;
    const double needed = quantile(complement(normal, level));
    // Of |z|, z standard normal: mean sqrt(2/pi), standard deviation sqrt(1 - 2/pi).
    constexpr double kMean = 0.7978845608, kSd = 0.6028102750;
    comparison.power_spread =
        cdf(normal, (kLarger - 1.0) * kMean / (kSd * std::sqrt(kLarger * kLarger / n + 1.0 / m)) - needed);
    comparison.power_bias = cdf(normal, kBias / std::sqrt(1.0 / n + 1.0 / m) - needed);
  }
  return comparison;
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
