/// The page of a sweep: what it says first, and what is apart by configuration.
#include <cmath>

#include "report/html/gnuplot.h"
#include "report/sweep/sweep_meaning.h"
#include "report/sweep/sweep_plots.h"
#include "report/sweep/sweep_report.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

validate::GroupStatistics group(const std::string& label, double position, double rms) {
  validate::ErrorStatistics of;
  of.runs = of.answered = 400;
  of.rms = of.sd = rms;
  of.coverage = 0.95;
  return {label, position, of};
}

/// Two estimators of mu over a rate; twice the error without the reversal.
validate::SweepSummary summary() {
  validate::SweepSummary of;
  of.name = "small";
  of.runs = of.planned = 800;
  const auto series = [](const std::string& estimator, double rms) {
    return validate::Series{"mu", estimator, {group("", 0.0, rms)}};
  };
  of.overall = {series("phase-diagram", 3e-4), series("trajectory", 1e-4)};
  of.configurations = {{"turning", {series("phase-diagram", 2e-4), series("trajectory", 8e-5)}},
                       {"straight", {series("phase-diagram", 4e-4), series("trajectory", 1.6e-4)}}};
  of.axes.resize(1);
  validate::AxisSummary& axis = of.axes.front();
  axis.name = "rate_hz";
  axis.unit = "Hz";
  const auto over = [](double factor) {
    return std::vector<validate::Series>{
        {"mu", "phase-diagram", {group("50", 50.0, factor * 6e-4), group("200", 200.0, factor * 3e-4)}},
        {"mu", "trajectory", {group("50", 50.0, factor * 2e-4), group("200", 200.0, factor * 1e-4)}}};
  };
  axis.series = over(1.0);
  axis.of_configurations = {over(0.8), over(1.6)};
  return of;
}

}  // namespace

TEST_CASE("every sweep's page says first who errs least, along which key it changes, and whose intervals fail") {
  validate::SweepSummary of = summary();
  const std::string meaning = report::sweep_meaning(of);
  CHECK(has(meaning, "smallest rms error over all runs is that of trajectory in µ (0.0001)"));
  CHECK(has(meaning, "<li>along rate_hz: 0.0001 at 200 Hz and 0.0002 at 50 Hz, 2 times as much</li>"));
  CHECK(has(meaning, "turning: 0.00008; straight: 0.00016"));
  CHECK(has(meaning, "as often as stated"));
  of.overall[0].groups[0].statistics.coverage = 0.9;  // 4.6 binomial standard errors of 400
  CHECK(has(report::sweep_meaning(of), "less often: µ with phase-diagram (90 %)"));
  of.overall.clear();
  CHECK(report::sweep_meaning(of).empty());
}

TEST_CASE("a sweep's page names the best of several given bandwidths, for each quantity that it is best in") {
  validate::SweepSummary of = summary();
  const auto add = [&](const std::string& quantity, const std::string& estimator, double rms) {
    of.overall.push_back({quantity, estimator, {group("", 0.0, rms)}});
  };
  add("k_over_m_1_s", "phase-diagram h=0.02 s", 0.004);
  add("mu", "phase-diagram h=0.02 s", 5e-4);
  CHECK_FALSE(has(report::sweep_meaning(of), "given bandwidths"));  // of one there is nothing to choose
  add("k_over_m_1_s", "phase-diagram h=0.04 s", 0.001);
  add("alpha_deg", "phase-diagram h=0.04 s", 0.003);
  add("mu", "phase-diagram h=0.04 s", 4e-4);
  CHECK(has(report::sweep_meaning(of),
            "Of the 2 given bandwidths of the lines, the smallest rms error is that of h=0.04 s in K/m (0.001 1/s), µ "
            "(0.0004), α (0.003°). Two whose errors differ by less than 10 % may be equivalent."));  // 2 / sqrt(400)
  of.overall.back().groups.front().statistics.rms = 6e-4;
  CHECK(has(report::sweep_meaning(of), "h=0.04 s in K/m (0.001 1/s); h=0.02 s in µ (0.0005); h=0.04 s in α"));
}

TEST_CASE("a sweep's tables have the quantities as all pages do, whatever order the database has") {
  validate::SweepSummary of = summary();
  of.overall.insert(of.overall.begin(), {"alpha_deg", "trajectory", {group("", 0.0, 0.003)}});
  of.overall.push_back({"k_over_m_1_s", "trajectory", {group("", 0.0, 0.003)}});
  for (const std::string& text : {report::sweep_text(of), report::sweep_report(of).html}) {
    const std::size_t k = text.find("K/m (1/s)"), alpha = text.find("α (°)");
    CHECK(k < alpha);
    CHECK(alpha != std::string::npos);
  }
}

TEST_CASE("where runs have no answer the page compares like runs, or says that it cannot") {
  validate::SweepSummary of = summary();
  validate::Series& series = of.axes[0].series[1];
  series.likeness = {false, 6, 4};
  for (validate::GroupStatistics& group : series.groups) {
    group.alike = group.statistics;
    group.alike->rms = group.position == 50.0 ? 1.5e-4 : 1e-4;
  }
  const std::string meaning = report::sweep_meaning(of);
  CHECK(has(meaning,
            "along rate_hz: 0.0001 at 200 Hz and 0.00015 at 50 Hz, 1.5 times as much, over those 4 of 6 "
            "combinations of the other keys that have a result at each value"));
  of.axes[0].of_configurations.clear();
  std::vector<report::Plot> plots = report::sweep_plots(of.axes[0], "mu");
  CHECK(plots[0].drawing.data[1].rows[0][1] == 1.5e-4);
  CHECK(has(plots[0].drawing.script, "'trajectory, 4 of 6'"));
  CHECK(has(plots[0].caption, "n of m: over those combinations of the other keys that have a result at every value"));
  series.likeness = {false, 0, 0};  // with drawn values
  for (validate::GroupStatistics& group : series.groups) group.alike.reset();
  const std::string none = report::sweep_meaning(of);
  CHECK_FALSE(has(none, "times as much"));
  CHECK(has(none, "not compared along rate_hz: some runs have no result"));
  CHECK(has(none, "random values"));
  plots = report::sweep_plots(of.axes[0], "mu");
  CHECK(has(plots[0].drawing.script, "'trajectory, unlike runs'"));
  CHECK(has(plots[0].caption, "unlike runs: some have no result"));
}

TEST_CASE("a stated sd that is far from the rms error is named with its factor, where chance does not do that") {
  validate::SweepSummary of = summary();
  CHECK_FALSE(has(report::sweep_meaning(of), "Stated standard deviations"));
  validate::ErrorStatistics& lines = of.overall[0].groups[0].statistics;
  validate::ErrorStatistics& fit = of.overall[1].groups[0].statistics;
  lines.sd = lines.rms / 3.0;
  fit.sd = 2.5 * fit.rms;
  const std::string meaning = report::sweep_meaning(of);
  CHECK(has(meaning, "more than 2 times smaller than the rms error: µ with phase-diagram (3 times)."));
  CHECK(has(meaning, "And larger than the rms error: µ with trajectory (2.5 times)."));
  fit.sd = 1.9 * fit.rms;
  lines.runs = lines.answered = 6;  // of which the rms error is known to 29 % (one standard error)
  CHECK_FALSE(has(report::sweep_meaning(of), "Stated standard deviations"));
}

TEST_CASE("over a key with one value there is no plot and no heading") {
  validate::SweepSummary of = summary();
  CHECK(has(report::sweep_report(of).html, "Over rate_hz"));
  const auto keep_one = [](std::vector<validate::Series>& all) {
    for (validate::Series& series : all) series.groups.resize(1);
  };
  keep_one(of.axes[0].series);
  for (std::vector<validate::Series>& all : of.axes[0].of_configurations) keep_one(all);
  CHECK(report::sweep_plots(of.axes[0], "mu", of.configurations).empty());
  CHECK_FALSE(has(report::sweep_report(of).html, "Over rate_hz"));
}

TEST_CASE("bars of several estimators at one value stand side by side, and coverage within its axis") {
  validate::SweepSummary of = summary();
  of.axes[0].of_configurations.clear();
  for (validate::Series& series : of.axes[0].series) {
    for (validate::GroupStatistics& group : series.groups) group.statistics.coverage = 1.0;
  }
  const report::Plot plot = report::sweep_plots(of.axes[0], "mu").back();
  REQUIRE(plot.description == "Coverage of µ against rate_hz");
  const std::vector<double>&a = plot.drawing.data[0].rows[0], &b = plot.drawing.data[1].rows[0];
  CHECK(a[0] == b[0]);
  CHECK(a.back() < 50.0);
  CHECK(b.back() > 50.0);
  // Wilson's interval of 400 out of 400: from 1 / (1 + z^2 / 400) to 1, z the normal quantile of 0.975.
  CHECK(std::abs(a[7] - 100.0 / (1.0 + 1.959963984540054 * 1.959963984540054 / 400.0)) < 1e-9);
  CHECK(std::abs(a[8] - 100.0) < 1e-9);
}

TEST_CASE("a sweep of two configurations has a table and an error plot of each, named after its quantity") {
  const validate::SweepSummary of = summary();
  const report::Page page = report::sweep_report(of);
  CHECK(has(page.html, "Each configuration"));
  CHECK(page.html.find("What this means") < page.html.find("All runs"));
  const std::vector<report::Plot> plots = report::sweep_plots(of.axes[0], "mu", of.configurations);
  REQUIRE(plots.size() == 4);
  const std::vector<std::string> names = report::plot_file_names(plots);
  CHECK(names[0] == "01-error-of-mu-against-rate-hz-turning");
  CHECK(names[1] == "02-error-of-mu-against-rate-hz-straight");
  CHECK(names[2] == "03-bias-of-mu-against-rate-hz");
  CHECK(plots[0].drawing.data[0].rows[0][1] == 0.8 * 6e-4);
  CHECK(plots[1].drawing.data[0].rows[0][1] == 1.6 * 6e-4);
}

TEST_CASE("a sweep's page has its meaning, one plot a key and one table open, and all else folded") {
  const std::string html = report::sweep_report(summary()).html;
  const std::size_t folds = html.find("<details");
  const std::string open = html.substr(0, folds);
  CHECK(has(open, "smallest rms error"));
  CHECK(has(open, "<figure>"));
  CHECK(open.find("<figure>") == open.rfind("<figure>"));
  CHECK(open.find("<table") != std::string::npos);
  CHECK(open.find("<table") == open.rfind("<table"));
  CHECK(folds < html.find("Over rate_hz"));
  CHECK(folds < html.find("Each configuration"));
}

TEST_CASE("the legend of many lines has a place of its own above the plot") {
  validate::SweepSummary of = summary();
  of.axes[0].of_configurations.clear();
  const report::Plot few = report::sweep_plots(of.axes[0], "mu").front();
  for (const char* rule : {"gcv", "cv-correlated", "rsc", "plug-in", "ebbs", "best-possible", "h=0.01 s", "h=0.02 s"}) {
    validate::Series series = of.axes[0].series[0];
    series.estimator = std::string("phase-diagram ") + rule;
    of.axes[0].series.push_back(series);
  }
  const report::Plot plot = report::sweep_plots(of.axes[0], "mu").front();
  CHECK(has(plot.drawing.script, "title 'cv-correlated'"));
  CHECK(has(plot.caption, "lines of the phase diagram"));
  // What is left below the legend is as much as with two lines.
  const auto below = [](const report::Plot& of_axis) {
    const std::size_t at = of_axis.drawing.script.find("set tmargin at screen ");
    REQUIRE(at != std::string::npos);
    return std::stod(of_axis.drawing.script.substr(at + 22)) * of_axis.drawing.size.height;
  };
  CHECK(std::abs(below(plot) - below(few)) < 1.0);
  CHECK(plot.drawing.size.height > few.drawing.size.height);
}

TEST_CASE("the question of mu and mass is answered in words, with its standard errors") {
  validate::MassStudy study;
  validate::MassRow row;
  row.configuration = "level";
  row.truth = 0.0071;
  row.bandwidth_s = 0.1;
  row.masses = {{0.335, 0.00965, 3e-5, 0.9986}, {0.535, 0.00812, 4e-5, 0.9990}};
  study.rows = {row};
  validate::FallAnswer answer;
  answer.published = {"level", 0.0075, 0.0051, 0.9996, "Table 2"};
  answer.widest = row;
  study.answers = {answer};
  std::string text = report::mass_study_section(study);
  CHECK(has(text, "In Table 2, µ falls from 0.0075 to 0.0051, by 0.0024"));
  CHECK(has(text, "h = 0.1 s gives 0.001530 ± 0.000050, with R² = 0.9986"));
  CHECK(has(text, "all of these lines are less straight"));
  study.answers[0].whole = validate::FallAt{0.126, 0.0024, 0.0, 0.9971};
  study.answers[0].at_r2 = validate::FallAt{0.07, 0.0007, 0.0, 0.9996};
  text = report::mass_study_section(study);
  CHECK(has(text, "produces all of it at h = 0.13 s, where the lines have R² = 0.9971"));
  CHECK(has(text, "R² of 0.99960 smoothing can produce 0.00070, 29 % of the fall, with h = 0.07 s"));
}

TEST_CASE(
    "failed runs are counted by kind of reason on screen, page and in the file, and the kinds that are not shown") {
  validate::SweepSummary of = summary();
  of.failed = 22;
  of.failures.kinds = {{12, false, false, "no root between 0.3333 and 7"},
                       {6, false, true, "camera.frame_rate_hz = 0.06667: too fast"},
                       {1, true, true, "camera.frame_rate_hz = 50: no light"},
                       {1, true, false, "no marker"}};
  of.failures.other_kinds = of.failures.other_runs = 2;
  const std::string text = report::sweep_text(of), json = report::sweep_json(of), html = report::sweep_report(of).html;
  for (const char* line :
       {"12 runs, one of them: no root between 0.3333 and 7",
        "6 runs, one of them with camera.frame_rate_hz = 0.06667: too fast",
        "1 run with camera.frame_rate_hz = 50: no light", "1 run: no marker", "and 2 more kinds (2 runs)"}) {
    INFO(line);
    CHECK(has(text, std::string("\n  ") + line + "\n"));
    CHECK(has(json, std::string("\"") + line + "\""));
    CHECK(has(html, line));
  }
  of.failures.other_kinds = of.failures.other_runs = 1;
  CHECK(has(report::sweep_text(of), "  and 1 more kind (1 run)\n"));
}

TEST_CASE("a sweep whose own runs are done does not say that none failed where an estimator of the user's own did") {
  validate::SweepSummary of = summary();
  of.runs = of.planned = 6;
  of.failed = 0;
  CHECK(has(report::sweep_text(of), "6 of 6 runs, 0 failed\n"));
  of.outside = fit::OutsideTally{"nan", "mine {folder} {out}", 6, {}, 0.0, 0.0};
  of.outside->failures[0] = {6, "exit status 1: skipped: no pynumdiff"};
  const std::string text = report::sweep_text(of);
  CHECK_FALSE(has(text, "0 failed"));
  CHECK(has(text,
            "6 of 6 runs\nnan: 6 of 6 runs failed (6 ended with an exit status other than 0, the first: exit status "
            "1: skipped: no pynumdiff)"));
  CHECK(has(report::sweep_report(of).html, "not made or not analysed"));
}
