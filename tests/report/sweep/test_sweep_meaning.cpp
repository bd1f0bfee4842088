#include "report/sweep/sweep_meaning.h"

#include "tests/catch.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

validate::GroupStatistics group(double position, double rms, std::uint64_t answered = 100) {
  validate::GroupStatistics made;
  made.label = std::to_string(static_cast<int>(position));
  made.position = position;
  made.statistics.runs = 100;
  made.statistics.answered = answered;
  made.statistics.rms = rms;
  return made;
}

/// Errors of K/m: overall, and at three rates of one axis.
validate::SweepSummary made_summary() {
  validate::SweepSummary summary;
  summary.overall = {{"k_over_m_1_s", "phase-diagram", {group(0, 0.4)}},
                     {"k_over_m_1_s", "phase-diagram gcv", {group(0, 0.5)}},
                     {"k_over_m_1_s", "phase-diagram ebbs", {group(0, 0.1, 50)}},
                     {"k_over_m_1_s", "phase-diagram h=0.02 s", {group(0, 0.05)}},
                     {"k_over_m_1_s", "phase-diagram best-possible", {group(0, 0.2)}},
                     {"k_over_m_1_s", "trajectory", {group(0, 0.1)}}};
  validate::AxisSummary axis;
  axis.name = "rate";
  axis.series = {
      {"k_over_m_1_s", "phase-diagram", {group(30, 0.6), group(60, 0.6), group(90, 0.2), group(120, 0.3)}},
      {"k_over_m_1_s", "phase-diagram gcv", {group(30, 0.4), group(60, 0.3), group(90, 0.19), group(120, 0.9)}}};
  summary.axes = {axis};
  return summary;
}

}  // namespace

TEST_CASE("The advice names the best rule that answers, and how much the default loses") {
  const std::string text = report::sweep_advice(made_summary());
  // ebbs answers half of the runs only; h = 0.02 s is no rule; the best possible bandwidth is none either.
  // The fit of the whole motion has less: the sentence must not be of all estimators.
  CHECK_THAT(text, Contains("the smallest rms error among the rules is that of phase-diagram in K/m (0.4"));
  CHECK_THAT(text, Contains("best possible bandwidth: 2"));
  CHECK_THAT(text, Contains("whole motion: 4"));
}

TEST_CASE("The advice names the part of an axis in which another rule is clearly better") {
  const std::string text = report::sweep_advice(made_summary());
  CHECK_THAT(text, Contains(" by more than 10 %: phase-diagram gcv in K/m at rate = 30 to 60."));
  // 1.5 and 2 times; 1.1 (1 + 2 / sqrt(n)) is 1.32 with 100 runs and 2.2 with four.
  validate::SweepSummary few = made_summary();
  for (validate::Series& series : few.axes[0].series) {
    for (validate::GroupStatistics& of : series.groups) of.statistics.answered = 4;
  }
  CHECK_THAT(report::sweep_advice(few), Contains("No rule beats it by more than 10 % anywhere"));
  validate::SweepSummary even = made_summary();
  even.axes[0].series.erase(even.axes[0].series.begin() + 1);
  CHECK_THAT(report::sweep_advice(even), Contains("No rule beats it by more than 10 % anywhere"));
}

TEST_CASE("A sweep without rules to choose from gets no advice") {
  validate::SweepSummary one = made_summary();
  one.overall.erase(one.overall.begin() + 1, one.overall.begin() + 3);
  CHECK(report::sweep_advice(one).empty());
  CHECK(report::sweep_advice({}).empty());
}
