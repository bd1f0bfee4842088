/// The phase diagram's bands and bars, and the files of its numbers.
#include "report/analysis/motion_plots.h"

#include <cmath>
#include <cstdio>
#include <random>

#include "report/validation/validation_report.h"
#include "tests/catch.h"
#include "tests/report/made_results.h"

using namespace glidelab;
using report::line_half95_m_s2;

namespace {

core::LineFit correlated_line() {
  core::LineFit line = tests::made_line(1, 2.768, 0.667);
  line.covariance = 0.8 * line.k_over_m_1_s.sd * line.a0_m_s2.sd;
  return line;
}

const report::PlotData& block(const report::Plot& plot, const std::string& name) {
  for (const report::PlotData& data : plot.drawing.data) {
    if (data.name == name) return data;
  }
  FAIL("no block " << name);
  return plot.drawing.data.front();
}

}  // namespace

TEST_CASE("the band of a line holds 95 % of the lines that its errors allow, at every speed") {
  const core::LineFit line = correlated_line();
  // At v = 0 it is the interval of a0 itself.
  CHECK(std::abs(line_half95_m_s2(line, 0.0) - (line.a0_m_s2.high95 - line.a0_m_s2.value)) < 1e-12);
  // Elsewhere: lines drawn with these errors and this correlation. 40000 of them put the share within 4 standard
  // deviations, 4 sqrt(0.95 x 0.05 / 40000) = 0.0044.
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0.0, 1.0);
  constexpr int kLines = 40000;
  for (const double v : {-1.0, 0.3, 1.2}) {
    const double half = line_half95_m_s2(line, v);
    int within = 0;
    for (int i = 0; i < kLines; ++i) {
      const double u = normal(random), w = normal(random);
      const double k = line.k_over_m_1_s.sd * u, a0 = line.a0_m_s2.sd * (0.8 * u + 0.6 * w);
      if (std::abs(a0 - k * v) <= half) ++within;
    }
    INFO("v = " << v);
    CHECK(std::abs(within / static_cast<double>(kLines) - 0.95) < 0.0044);
  }
}

TEST_CASE("a phase diagram carries its lines' bands and the bars of some points, and says what its columns are") {
  const core::AnalysisResults results = tests::made_results();
  const std::vector<report::PhaseGroup> groups = report::phase_groups(results);
  REQUIRE_FALSE(groups.empty());
  const std::vector<report::Plot> plots = report::phase_plots(results, groups.front());
  REQUIRE(plots.size() == 3);
  for (const report::Plot& plot : plots) {
    for (const report::PlotData& data : plot.drawing.data) {
      INFO(plot.description << ": " << data.name);
      REQUIRE_FALSE(data.columns.empty());
      CHECK(data.columns.front() == "v (m/s)");
      for (const auto& row : data.rows) CHECK((row.empty() || row.size() == data.columns.size()));
    }
    CHECK(plot.drawing.script.find("filledcurves") != std::string::npos);
    // v = 0 and a = 0 are drawn within the axes only: where all accelerations are positive, the latter is not.
    CHECK(plot.drawing.script.find("set arrow") == std::string::npos);
    CHECK(plot.drawing.script.find("set xzeroaxis") != std::string::npos);
    CHECK(plot.drawing.script.find("with vectors nohead") != std::string::npos);
  }
  // Seven labels of v at most, of -1.2 to 0.23 m/s (the lines), of 15 % of what is used both ways, and of -1 to 0.2
  // m/s.
  CHECK(plots[0].drawing.script.find("set xtics 0.5\n") != std::string::npos);
  CHECK(plots[1].drawing.script.find("set xtics 0.05\n") != std::string::npos);
  CHECK(plots[2].drawing.script.find("set xtics 0.2\n") != std::string::npos);
  const core::ConfigurationResult& first = results.configurations[groups.front().configurations.front()];
  for (const auto& row : block(plots[0], "lines0").rows) {
    if (row.empty() || row[0] == 0.0) continue;
    const core::LineFit& line = first.lines[row[0] < 0.0 ? 0 : 1];
    CHECK(row[2] == line_half95_m_s2(line, row[0]));
    CHECK(std::abs(row[1] - (line.a0_m_s2.value - line.k_over_m_1_s.value * row[0])) < 1e-12);
  }
  // 1.96 of the points' own standard deviation, 0.02 m/s².
  for (const auto& row : block(plots[0], "bars0").rows) CHECK(std::abs(row[3] - 0.0392) < 1e-5);
  CHECK(block(plots[0], "bars0").rows.size() <= 13);
}

TEST_CASE("the overview has all configurations, with the inclination where there are several") {
  core::AnalysisResults results = tests::made_results();
  results.configurations.resize(1);
  results.configurations.push_back(results.configurations.front());
  results.configurations.back().incline_deg += 1.0;
  REQUIRE(report::phase_groups(results).size() == 2);
  const std::optional<report::Plot> plot = report::phase_overview(results);
  REQUIRE(plot);
  CHECK(plot->drawing.data.size() == 2 * 3);  // points, bars and lines of each
  const report::PhaseGroup both = {4.0, {0, 1}};
  const std::string one = report::phase_label(results, both, 0), other = report::phase_label(results, both, 1);
  CHECK(one.ends_with("°"));
  CHECK(one != other);
  CHECK(plot->drawing.script.find("unset key") == std::string::npos);
  for (std::size_t i = 0; i < report::kColors.size(); ++i)
    results.configurations.push_back(results.configurations.front());
  CHECK(report::phase_overview(results)->drawing.script.find("unset key") != std::string::npos);
  results.clips.clear();
  CHECK_FALSE(report::phase_overview(results));
}

TEST_CASE("a line is drawn to v = 0 only from points that reach as far as it is drawn beyond them") {
  core::AnalysisResults results = tests::made_results();
  const report::PhaseGroup group = report::phase_groups(results).front();
  const auto first_v = [&](double from_v_m_s, double to_v_m_s) {
    for (const std::size_t c : group.configurations) {
      core::LineFit line = tests::made_line(1, 2.768, 0.667);
      line.from_v_m_s = from_v_m_s;
      line.to_v_m_s = to_v_m_s;
      results.configurations[c].lines = {line};
    }
    const std::vector<report::Plot> plots = report::phase_plots(results, group);
    const double first = block(plots.front(), "lines0").rows.front()[0];
    CHECK(plots.size() == (first == 0.0 ? 3 : 2));  // without a line at v = 0 there is no detail of it
    return first;
  };
  CHECK(first_v(0.1, 0.5) == 0.0);
  CHECK(first_v(0.25, 0.5) == 0.0);
  CHECK(first_v(1.298, 1.302) == 1.298);  // a fall near its terminal velocity
  CHECK(first_v(-1.302, -1.298) == -1.298);
}

TEST_CASE("residuals that are far below their intervals are drawn beside these") {
  core::AnalysisResults results = tests::made_results();
  // Every point on the line of its direction, as smoothers leave them that know the law's exponential.
  const report::PhaseGroup first = report::phase_groups(results).front();
  const report::PhaseGroup group{first.incline_deg, {first.configurations.front()}};
  for (core::ClipResult& clip : results.clips) {
    for (core::MotionPoint& point : clip.motion) {
      for (const core::LineFit& line : results.configurations[group.configurations.front()].lines) {
        if (line.direction * point.v_m_s <= 0.0) continue;
        point.a_m_s2 = line.a0_m_s2.value - line.k_over_m_1_s.value * point.v_m_s + 1e-6 * point.t_s;
      }
    }
  }
  const std::string script = report::phase_plots(results, group)[2].drawing.script;
  const std::size_t at = script.find("set yrange [");
  REQUIRE(at != std::string::npos);
  double low = 0.0, high = 0.0;
  REQUIRE(std::sscanf(script.c_str() + at, "set yrange [%lf:%lf]", &low, &high) == 2);
  // 1.96 of the points' own standard deviation, 0.02 m/s², and a margin of 8 % of both.
  CHECK(low <= -0.0392);
  CHECK(low > -0.0392 * 1.2);
  CHECK(high >= 0.0392);
  CHECK(high < 0.0392 * 1.2);
}

TEST_CASE("colours that stand for clips are told by name where each clip has its own") {
  core::AnalysisResults results = tests::made_results();
  validate::Comparison comparison;
  for (const std::size_t clips : {std::size_t{2}, std::size_t{9}}) {
    results.clips.resize(2);
    for (std::size_t c = 2; c < clips; ++c) results.clips.push_back(results.clips[0]);
    comparison.restitution.points.clear();
    for (std::size_t c = 0; c < clips; ++c) {
      results.clips[c].name = "run " + std::to_string(c);
      validate::RestitutionPoint point{};
      point.clip = c;
      comparison.restitution.points.push_back(point);
    }
    for (const report::Plot& plot : report::validation_plots(results, comparison)) {
      if (plot.description != "Restitution error against the true position") continue;
      CHECK((plot.drawing.script.find("title 'run 1'") != std::string::npos) == (clips == 2));
      CHECK((plot.caption.find("in turn") != std::string::npos) == (clips != 2));
    }
  }
}
