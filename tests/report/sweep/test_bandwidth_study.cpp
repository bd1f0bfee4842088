#include "report/sweep/bandwidth_study.h"

#include <fmt/format.h>

#include <cmath>

#include "report/sweep/sweep_report.h"
#include "tests/catch.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

validate::Series series(const std::string& quantity, const std::string& estimator, double bias, double noise, double sd,
                        double coverage) {
  validate::ErrorStatistics of;
  of.runs = of.answered = 400;
  of.bias = bias;
  of.bias_sd = noise / 20.0;
  of.rms = std::hypot(bias, noise);
  of.sd = sd;
  of.coverage = coverage;
  of.least_sd = 1e-5;
  return {quantity, estimator, {{"", 0.0, of, {}}}};
}

/// Noise as h^-2.5 and bias as h², which are equal at 0.04 s; the stated sd knows the noise alone up to there, and is
/// four times too large beyond.
validate::SweepSummary study() {
  validate::SweepSummary summary;
  summary.name = "one camera";
  summary.runs = summary.planned = 400;
  for (const double h : {0.01, 0.02, 0.03, 0.04, 0.05, 0.08, 0.16}) {
    const double bias = 1e-4 * std::pow(h / 0.04, 2), noise = 1e-4 * std::pow(h / 0.04, -2.5);
    const double rms = std::hypot(bias, noise);
    const bool wide = h > 0.05;
    summary.overall.push_back(series("mu", fmt::format("phase-diagram h={} s", h), bias, noise, wide ? 4.0 * rms : rms,
                                     wide        ? 1.0
                                     : h < 0.015 ? 0.8
                                                 : 0.95));
  }
  summary.overall.push_back(series("mu", "phase-diagram", 0.0, 2e-4, 2e-4, 0.95));
  summary.overall.push_back(series("mu", "trajectory", 0.0, 2e-5, 2e-5, 0.95));
  summary.bandwidths = {{"phase-diagram", 0.05, 0.045, 0.06}};
  return summary;
}

}  // namespace

TEST_CASE("a bandwidth study says which h to use, what is nearly as good, and where intervals fail") {
  const std::optional<report::BandwidthAnswer> answer = report::bandwidth_answer(study());
  REQUIRE(answer);
  // The least of h^-5 + h^4 in units of 0.04 s lies at (5/4)^(1/9) = 1.025: 0.04 s is the nearest that was run. At 0.03
  // and 0.05 s the total is 1.53 and 1.20 times that at 0.04 s.
  CHECK(answer->use_s == 0.04);
  CHECK(answer->from_s == 0.04);
  CHECK(answer->to_s == 0.05);
  CHECK(answer->wide_s == std::vector<double>{0.08, 0.16});
  CHECK(answer->narrow_s == std::vector<double>{0.01});
  CHECK(
      answer->text.starts_with("Use `--estimator trajectory`: the fit of the whole motion needs no bandwidth, and its "
                               "errors are 7.1 times smaller. For lines, use h = 0.04 s; "));
  CHECK_THAT(answer->text, Contains("use h = 0.04 s; anything from 0.04 to 0.05 s gives errors at most 30 % larger"));
  CHECK_THAT(answer->text, Contains("at 0.01 s the stated intervals are too narrow"));
  CHECK_THAT(answer->text, Contains("beyond 0.05 s the stated intervals are too wide"));
  CHECK_THAT(answer->text, Contains("the default rule chooses 0.05 s (0.045 to 0.06 in eight of ten clips)"));
  std::string plain = answer->text;
  std::erase(plain, '`');  // marks of code, for pages
  CHECK(report::sweep_text(study()).starts_with(plain + "\n"));
}

TEST_CASE("a bandwidth whose intervals hold is preferred to one that errs a little less") {
  validate::SweepSummary summary = study();
  summary.overall[3].groups[0].statistics.sd *= 4.0;  // at 0.04 s, the least error
  summary.overall[3].groups[0].statistics.coverage = 1.0;
  const std::optional<report::BandwidthAnswer> answer = report::bandwidth_answer(summary);
  REQUIRE(answer);
  CHECK(answer->use_s == 0.05);
  CHECK(answer->from_s == 0.03);  // 1.53 / 1.20 = 1.27 times
}

TEST_CASE("the plot of a bandwidth study has bias, noise and total, and the choices beside them") {
  const std::vector<report::Plot> plots = report::bandwidth_plots(study());
  REQUIRE(plots.size() == 1);
  const report::Drawing& drawing = plots.front().drawing;
  for (const char* title : {"'total'", "'noise'", "'bias'", "'stated sd'", "'best h'", "'default rule'",
                            "'fit of the whole motion'", "'limit of one configuration'"}) {
    CHECK_THAT(drawing.script, Contains(title));
  }
  const std::vector<double>& at = drawing.data.front().rows[3];  // h = 0.04 s
  CHECK(at[0] == 0.04);
  CHECK(at[1] == Approx(std::sqrt(2.0) * 1e-4));
  CHECK(at[2] == Approx(1e-4));
  CHECK(at[3] == Approx(1e-4));
  const std::string html = report::sweep_report(study()).html;
  CHECK(html.find("use h = ") < html.find("<figure"));
}

TEST_CASE("an estimator without a bandwidth that errs more in a quantity is not what to use first") {
  validate::SweepSummary summary = study();
  summary.overall.back().groups[0].statistics.rms = 2e-4;
  CHECK(report::bandwidth_answer(summary)->text.starts_with("Use h = 0.04 s; "));
}

TEST_CASE("a sweep without three bandwidths is no bandwidth study") {
  validate::SweepSummary summary = study();
  summary.overall.erase(summary.overall.begin(), summary.overall.begin() + 5);
  CHECK_FALSE(report::bandwidth_answer(summary));
  CHECK(report::bandwidth_plots(summary).empty());
}

TEST_CASE("a bandwidth with which some clips have no line is not recommended, and named") {
  validate::SweepSummary summary = study();
  summary.overall[3].groups[0].statistics.answered = 300;
  const std::optional<report::BandwidthAnswer> answer = report::bandwidth_answer(summary);
  REQUIRE(answer);
  CHECK(answer->use_s == 0.05);
  CHECK_THAT(answer->text, Contains("with 0.04 s some clips have no line"));
  summary.overall[2].groups[0].statistics.answered = 300;
  CHECK_THAT(report::bandwidth_answer(summary)->text, Contains(" and 0.04 s some clips have no line"));
}

TEST_CASE("the table of a bandwidth study keeps a bandwidth that one of its quantities does not have") {
  validate::SweepSummary summary = study();
  for (const double h : {0.01, 0.02, 0.03, 0.04, 0.05, 0.08}) {
    summary.overall.push_back(series("alpha_deg", fmt::format("phase-diagram h={} s", h), 0.0, 1e-3, 1e-3, 0.95));
  }
  const std::string table = report::bandwidth_table(summary);
  const std::size_t row = table.find(">0.16<");
  REQUIRE(row != std::string::npos);
  const std::string cells = table.substr(row, table.find("</tr>", row) - row);
  CHECK_THAT(cells, Contains("0.00160") && Contains("–"));
}

TEST_CASE("on a terminal a bandwidth study is its answer and one row a bandwidth, not all columns of the database") {
  const std::string text = report::sweep_text(study());
  INFO(text);
  const auto spaces = [](std::size_t count) { return std::string(count, ' '); };
  // The first column is as wide as "default rule", the second as "0.0000200"; 1e-4 hypot(32, 1/16).
  CHECK_THAT(text, Contains("\n\nh (s)" + spaces(17) + "µ\n0.01" + spaces(12) + "0.00320\n"));
  CHECK_THAT(text,
             Contains("\ntrajectory    0.0000200\nRoot mean square errors, known to 4 % or better"));  // 1/sqrt(800)
  CHECK_THAT(text, !Contains("coverage"));
}
