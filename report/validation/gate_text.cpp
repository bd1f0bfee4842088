#include "report/validation/gate_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/text/number_text.h"
#include "report/text/display_text.h"
#include "report/text/json_numbers.h"
#include "report/text/outside_text.h"

namespace glidelab::report {

std::string errors_table(const validate::Baseline& baseline) {
  std::vector<std::vector<std::string>> rows = {
      {"configuration", "estimator", "quantity", "results", "mean error", "sd of errors", "covered", "efficiency"}};
  for (const validate::ErrorRecord& record : baseline.records) {
    rows.push_back({record.configuration, record.estimator, record.quantity,
                    fmt::format("{} / {}", record.answers, record.runs), base::number_text(record.mean, 3),
                    base::number_text(record.sd, 3), fmt::format("{} / {}", record.covered, record.answers),
                    record.efficiency > 0.0 ? base::number_text(record.efficiency, 2) : "–"});
  }
  return text_table(rows, 3);
}

std::string power_text(const validate::BaselineComparison& comparison) {
  return fmt::format(
      "{} tests with an overall significance of {}; probability of detecting errors 1.5 times as "
      "large: {:.2f}, a bias of half a standard deviation: {:.2f}, a doubled bandwidth: {:.2f}",
      comparison.tests, comparison.significance, comparison.power_spread, comparison.power_bias,
      comparison.power_doubled);
}

std::string detectable_text(const validate::Gate& gate) {
  std::vector<std::vector<std::string>> rows = {{"configuration", "estimator", "quantity",
                                                 "errors larger by a factor of", "or mean error larger by",
                                                 fmt::format("runs for a factor of {}", validate::kSmallFactor)}};
  for (const validate::Detectable& of : gate.detectable) {
    rows.push_back({of.configuration, of.estimator, of.quantity,
                    of.factor ? base::number_text(*of.factor, 3) : "not detected",
                    of.bias ? base::number_text(*of.bias, 2) : "–", fmt::format("{}", of.runs_for_small)});
  }
  return fmt::format(
      "smallest worsening that is detected with probability {}, and the number of runs, in the baseline and now, "
      "that detect errors {} times as large with the same probability:\n{}",
      validate::kDetectionProbability, validate::kSmallFactor, text_table(rows, 3));
}

std::string weak_text(const validate::Gate& gate) {
  std::size_t weak = 0;
  std::uint64_t runs = 0;
  for (const validate::Detectable& of : gate.detectable) {
    if (!of.weak()) continue;
    ++weak;
    runs = std::max(runs, of.runs_for_weak);
  }
  if (weak == 0) return "";
  return fmt::format(
      "warning: a weak gate: for {} of {} quantities only errors more than {} times as large are detected with this "
      "probability; about {} runs, in the baseline and now (--runs), suffice for a factor of {}",
      weak, gate.detectable.size(), validate::kWeakFactor, runs, validate::kWeakFactor);
}

std::string worse_text(const validate::BaselineComparison& comparison) {
  std::string what;
  for (const validate::Worse& worse : comparison.worse) {
    what += fmt::format("{} {} {}: {} was {}, is {} (p {:.1g})\n", worse.configuration, worse.estimator, worse.quantity,
                        worse.what, base::number_text(worse.then, 3), base::number_text(worse.now, 3), worse.p);
  }
  return what;
}

std::string gate_text(const validate::Gate& gate) {
  std::string text;
  if (gate.comparison) {
    const std::string worse = worse_text(*gate.comparison);
    text = (worse.empty() ? "Nothing is worse than the baseline.\n" : "Worse than the baseline:\n" + worse) + "\n";
  }
  if (gate.outside) text += outside_text(*gate.outside) + "\n\n";
  text += errors_table(gate.now);
  if (!gate.comparison) return text;
  text += "\n" + power_text(*gate.comparison) + "\n\n" + detectable_text(gate);
  const std::string weak = weak_text(gate);
  return weak.empty() ? text : text + "\n" + weak + "\n";
}

std::string gate_json(const validate::Gate& gate) {
  Json document{{"runs", gate.now.runs}, {"seed", *gate.now.seed}, {"noise_m", gate.now.noise_m}};
  document["errors"] = Json::array();
  for (const validate::ErrorRecord& record : gate.now.records) {
    Json one{{"configuration", record.configuration},
             {"estimator", record.estimator},
             {"quantity", record.quantity},
             {"runs", record.runs},
             {"answered", record.answers},
             {"covered", record.covered},
             {"bias", nullptr},
             {"sd", nullptr},
             {"efficiency", nullptr}};
    if (record.answers > 0) put(one, "bias", record.mean);
    if (record.answers > 1) put(one, "sd", record.sd);
    if (record.efficiency > 0.0) put(one, "efficiency", record.efficiency);
    document["errors"].push_back(std::move(one));
  }
  if (gate.outside) document["outside"] = outside_json(*gate.outside);
  if (!gate.comparison) return json_text(document);
  document["tests"] = gate.comparison->tests;
  document["significance"] = gate.comparison->significance;
  document["passed"] = gate.comparison->worse.empty();
  document["worse"] = Json::array();
  for (const validate::Worse& of : gate.comparison->worse) {
    document["worse"].push_back({{"configuration", of.configuration},
                                 {"estimator", of.estimator},
                                 {"quantity", of.quantity},
                                 {"what", of.what},
                                 {"then", of.then},
                                 {"now", of.now},
                                 {"p_value", of.p}});
  }
  document["detectable"] = Json::array();
  for (const validate::Detectable& of : gate.detectable) {
    Json one{{"configuration", of.configuration},
             {"estimator", of.estimator},
             {"quantity", of.quantity},
             {"factor", nullptr},
             {"bias", nullptr},
             {"runs_for_1_1", of.runs_for_small}};
    if (of.factor) put(one, "factor", *of.factor);
    if (of.bias) put(one, "bias", *of.bias);
    document["detectable"].push_back(std::move(one));
  }
  return json_text(document);
}

}  // namespace glidelab::report
