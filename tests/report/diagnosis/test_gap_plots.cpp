/// The page of a diagnosis: its gap in images, its sizes in handy units.
#include "report/diagnosis/gap_plots.h"

#include <algorithm>
#include <cmath>

#include "report/blind/blind_report.h"
#include "report/diagnosis/diagnosis_json.h"
#include "report/diagnosis/diagnosis_plots.h"
#include "report/diagnosis/diagnosis_report.h"
#include "report/html/html.h"
#include "report/text/display_text.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

diagnose::Diagnosis two_masses() {
  diagnose::Diagnosis of;
  of.verdict = diagnose::Verdict::unknown;
  diagnose::GapSizes gap;
  gap.before = 6.0;
  gap.after = 1.1;
  gap.parameters = {{"alpha_deg", diagnose::Against::stated, "slope", 1.5, 0.2},
                    {"k_n_s_m",
                     diagnose::Against::all_clips,
                     "0.335 kg",
                     -3.0,
                     {},
                     {{"k_n_s_m", 0.91, 0.01}},
                     {{"k_n_s_m", 0.94, 0.005}}}};
  const diagnose::PhaseBin bin{-0.2, -0.1, -0.15, 40, {0.02, 0.001}, {0.0005, 0.001}};
  gap.phase_plane = {{{}, {bin}}, {0.335, {bin}}, {0.535, {bin}}};
  gap.domains = {{diagnose::GapDomainKind::positions, 6.0, 1.1}, {diagnose::GapDomainKind::parameters, 3.0, {}}};
  of.gap = gap;
  of.curves = {
      {diagnose::GapVariable::position, diagnose::GapKind::force, "N", 40.0, {0.0, 0.1}, {0.001, 0.002}, {1e-4, 1e-4}},
      {diagnose::GapVariable::time,
       diagnose::GapKind::displacement,
       "m",
       30.0,
       {0.0, 0.1},
       {0.001, 0.002},
       {1e-4, 1e-4}}};
  of.regions = {{diagnose::GapVariable::position, 0.0, 0.1, 12.0, -0.0036, "m", diagnose::GapKind::displacement, ""}};
  of.residuals = {{"up", {0.0, 1.0}, {0.0, 0.1}, {1.0, 0.9}, {2e-5, -2e-5}, {0.0, 0.0}, {1e-5, 1e-5}}};
  return of;
}

}  // namespace

TEST_CASE("sizes come in the unit that leaves them a readable number") {
  CHECK(report::size_text(-0.0036, 2, "m") == "-3.6 mm");
  CHECK(report::size_text(3.067e-5, 4, "s") == "30.67 µs");
  CHECK(report::size_text(4e-9, 2, "m") == "4 nm");
  CHECK(report::size_text(0.36, 2, "m") == "0.36 m");
  CHECK(report::size_text(0.0, 2, "N") == "0 N");
  CHECK(report::size_text(0.02, 2, "N s/m") == "0.02 N s/m");  // no thousandths of what has no prefix
  CHECK(report::size_text(0.02, 2, "") == "0.02");
  CHECK(report::size_and_sd_text(3.0651e-5, 3.4e-7, "s") == "30.65 ± 0.34 µs");
  CHECK(report::size_and_sd_text(0.0, 2e-3, "N") == "0.0 ± 2.0 mN");
  CHECK(report::parameter_text("line_s", 3.0651e-5, 3.4e-7) == "line = 30.65 ± 0.34 µs");
  CHECK(report::parameter_text("x_mid_m.flat_s", 0.0123, 0.0012) == "x_mid.flat_s = 12.3 ± 1.2 mm");
  CHECK(report::parameter_text("f_hz", 6.00001, 0.00013) == "f = 6.00001 ± 0.00013 Hz");
  CHECK(report::parameter_text("e", 0.0101, 0.0012) == "e = 0.0101 ± 0.0012");
  CHECK(report::parameter_text(diagnose::DiagnosedParameter{"x_t_m", 0.0, 10946.0}) == "x_t not determined");
  CHECK(report::parameter_text(diagnose::DiagnosedParameter{"s", 51.0, 22065.0}) == "s not determined");
  CHECK(report::parameter_text(diagnose::DiagnosedParameter{"s", 0.02, 0.19}) == "s = 0.02 ± 0.19");
  CHECK(report::parameter_text(diagnose::DiagnosedParameter{"k_n_m", 125.0, 33.0}) == "k = 125 ± 33 N/m");
  CHECK(report::parameter_text(diagnose::DiagnosedParameter{"k_n_m", 125.0, 3300.0}) == "k not determined");
  // Known well, and no size: 0 is a place as any other.
  CHECK(report::parameter_text(diagnose::DiagnosedParameter{"x_t_m", 1e-4, 2e-3}) == "x_t = 0.1 ± 2.0 mm");
  CHECK(report::parameter_text("intercept_s2_m_s2", 0.0052, 0.001) == "intercept = 0.0052 ± 0.0010 m/s² for each 1/s²");
}

TEST_CASE("a cell of the residual map is a standard normal deviate of its positions together") {
  // Four positions of one sign, one standard deviation each: 4/sqrt(4) = 2; of both signs 0; two clips, two rows.
  diagnose::ResidualCurve up{"up",
                             {0.0, 0.1, 0.2, 0.3},
                             {},
                             {},
                             {1e-5, 1e-5, 1e-5, 1e-5},
                             {1e-5, -1e-5, 1e-5, -1e-5},
                             {1e-5, 1e-5, 1e-5, 1e-5}};
  diagnose::ResidualCurve again = up;  // the clip's next motion
  for (double& t : again.t_s) t += 0.7;
  again.before_m = {-3e-5, -3e-5, -3e-5, -3e-5};
  diagnose::ResidualCurve down = up;
  down.clip = "down";
  const auto map = report::residual_map({up, again, down}, diagnose::GapVariable::time, 2);
  CHECK(map.clips == std::vector<std::string>{"up", "down"});
  CHECK(map.low == 0.0);
  CHECK(map.high == 1.0);
  CHECK(map.before[0][0] == Approx(2.0));
  CHECK(map.before[0][1] == Approx(-6.0));
  CHECK(map.after[0][0] == Approx(0.0).margin(1e-12));
  CHECK(map.before[1][0] == Approx(2.0));
  CHECK(std::isnan(map.before[1][1]));
}

TEST_CASE("a diagnosis' page shows the gap by domain, the phase plane, and curves that are alternatives") {
  const auto diagnosis = two_masses();
  const auto domains = report::domain_plots(diagnosis);
  REQUIRE(domains.size() == 1);
  const auto& after = domains.front().drawing.data.at(1).rows;
  CHECK(after.at(0).at(3) == Approx(1.1));
  CHECK(std::isnan(after.at(1).at(3)));  // what cannot be said has no bar
  const auto phase = report::phase_gap_plots(diagnosis);
  REQUIRE(phase.size() == 2);
  CHECK(phase.front().drawing.data.front().rows.front().at(2) == Approx(1.96 * 0.001).epsilon(1e-4));
  CHECK(phase.back().drawing.data.size() == 2);
  CHECK(has(report::where_plots(diagnosis).front().caption, "each of these 2 curves would do so alone"));
  diagnose::Diagnosis one = diagnosis;
  one.curves.pop_back();
  CHECK_FALSE(has(report::where_plots(one).front().caption, "any one"));
  const std::string page = report::diagnosis_report("two masses", diagnosis).html;
  CHECK(has(page, "−3.6\u00a0mm"));
  CHECK(has(page, "How large the gap is"));
  CHECK(has(page, "Map of the residuals by clip"));
  // In a dark page black is nothing and the light colours are far: by numbers, not by colours.
  CHECK(has(page, "noise allows (0: none; 5 and −5: as many standard deviations or more)"));
  diagnose::Diagnosis lines;
  lines.gap = diagnose::GapSizes{};
  CHECK(report::domain_plots(lines).empty());
  CHECK(report::phase_gap_plots(lines).empty());
  CHECK(report::residual_maps(lines).empty());
}

TEST_CASE("where nothing is missing a page shows the nominal model once, not the same twice as before and after") {
  diagnose::Diagnosis none = two_masses();
  none.verdict = diagnose::Verdict::none;
  none.gap->before = none.gap->after = 1.1;
  none.gap->held_out = {"up"};
  none.gap->before_by_clip = none.gap->after_by_clip = {1.1};
  const std::string page = report::diagnosis_report("none", none).html;
  CHECK(has(page, "<b>1.1</b><span>gap of held-out clips"));
  CHECK(has(page, "<th>held out</th><th class=\"n\">gap</th>"));
  CHECK(has(page, "<td>up</td><td class=\"n\">1.10</td></tr>"));
  CHECK(report::residual_maps(none).size() == 1);
  for (const auto& plots : {report::domain_plots(none), report::phase_gap_plots(none), report::where_plots(none),
                            report::verdict_plots(none)}) {
    for (const report::Plot& plot : plots) CHECK_FALSE(has(plot.drawing.script, "'after'"));
  }
  diagnose::Diagnosis unknown = two_masses();
  CHECK(report::residual_maps(unknown).size() == 2);
  CHECK(has(report::domain_plots(unknown).front().drawing.script, "'after'"));
}

TEST_CASE("a logarithmic axis of gaps begins below the smallest of them") {
  diagnose::Diagnosis of = two_masses();
  of.gap->held_out = {"up", "down"};
  of.gap->before_by_clip = {20.0, 30.0};
  of.gap->after_by_clip = {0.25, 1.0};
  CHECK(has(report::verdict_plots(of).back().drawing.script, "set xrange [0.2:45]"));
  of.gap->domains = {{diagnose::GapDomainKind::positions, 30.0, 0.25}};
  CHECK(has(report::domain_plots(of).front().drawing.script, "set xrange [0.2:45]"));
  CHECK(report::domain_plots(of).front().drawing.data.at(1).rows.at(0).at(3) == Approx(0.25));
}

TEST_CASE("standard deviations off have no sign at zero, and no tenths beyond a hundred") {
  diagnose::Diagnosis of = two_masses();
  of.gap->parameters[0].z_before = -0.04;
  of.gap->parameters[1].z_before = 1105.9;
  const std::string page = report::diagnosis_report("z", of).html;
  CHECK(has(page, "<td class=\"n\">0.0</td>"));
  CHECK(has(page, "<td class=\"n\">+1110</td>"));
}

TEST_CASE("the table of a gap's places gives the largest size with its own deviation and where it is") {
  diagnose::Diagnosis of = two_masses();
  of.regions.front().size_sd = 2e-4;
  of.regions.front().at = 0.0712;
  const std::string page = report::diagnosis_report("places", of).html;
  CHECK(has(page, "−3.60\u00a0±\u00a00.20\u00a0mm</td><td class=\"n\">0.0712</td><td class=\"n\">12</td>"));
  CHECK(has(report::diagnosis_json(of), "\"at\": 0.0712"));
}

TEST_CASE("a tile says that its effect may act with others, and the chart prints what each explanation alone has") {
  diagnose::Diagnosis of;
  of.verdict = diagnose::Verdict::effect;
  diagnose::DiagnosedEffect effect{};
  effect.id = "tether";
  effect.probability = effect.joint_probability = 0.998;
  of.effects = {effect};
  of.ranking.resize(2);
  of.ranking[0].explanation.effects = {"tether"};
  of.ranking[0].probability = 0.99;
  of.ranking[1].explanation.effects = {"rolling_shutter", "tether"};
  of.ranking[1].probability = 0.008;
  CHECK(has(report::diagnosis_report("tile", of).html, "0.998</b><span>tightening cable, alone or with another"));
  const report::Plot chart = report::verdict_plots(of).front();
  CHECK(has(chart.drawing.script, "tightening cable: 0.990"));
  CHECK(has(chart.caption, "nothing else"));
  of.ranking.pop_back();
  CHECK_FALSE(has(report::diagnosis_report("tile", of).html, "alone or with another"));
}

TEST_CASE("what the scene does over time has a colour and a name for each clip, and what goes right and down is told") {
  diagnose::Diagnosis of;
  for (const std::string clip : {"up_1", "do'wn"}) {
    for (const char* what : {"brightness", "drift across", "drift down"}) {
      of.image_curves.push_back({what, clip, {0.0, 0.1}, {0.0, 0.01}, {0.001, 0.001}, {}, {}});
    }
  }
  const auto plots = report::image_plots(of);
  REQUIRE(plots.size() == 2);
  for (const report::Plot& plot : plots) {
    // As many names side by side as the plot has room for; "to the right" is longer than the clips' names.
    CHECK(has(plot.drawing.script, &plot == &plots.front() ? "maxcols 3" : "maxcols 2"));
    CHECK(has(plot.drawing.script, "every :::0::0 with lines lw 1 dt 1 lc rgb '#0072b2' title 'up_1' noenhanced"));
    CHECK(has(plot.drawing.script, "every :::1::1 with lines lw 1 dt 1 lc rgb '#d55e00' title 'do’wn' noenhanced"));
  }
  CHECK(plots.front().drawing.data.front().rows.size() == 5);  // two clips of two points, and a line between them
  CHECK(has(plots.back().drawing.script, "title 'to the right'"));
  CHECK(has(plots.back().drawing.script, "dt 3 lc rgb '#000000' title 'downwards'"));
  CHECK_FALSE(report::page("scene", report::figures(plots)).html.empty());  // gnuplot draws them
}

TEST_CASE("the chart of the blind cases has every kind that its table has") {
  report::BlindRun run;
  run.score.methods.resize(1);
  run.score.methods.front().by = validate::DecisionMethod::diagnosis;
  run.score.methods.front().single["weak"] = {4, 1};
  const report::Page page = report::blind_page(run);
  const auto plotted = std::ranges::find_if(
      page.files, [](const auto& file) { return file.first.ends_with(".csv") && has(file.first, "methods"); });
  REQUIRE(plotted != page.files.end());
  CHECK(has(plotted->second, "\n2,25"));  // the second kind, a share of one in four, by the one method there is
}

TEST_CASE("diagnosis.json has the gap of the phase plane with its band, of each part of the data, and of each domain") {
  const std::string text = report::diagnosis_json(two_masses());
  CHECK(has(text, "\"phase_plane\""));
  CHECK(has(text, "\"interval95\""));
  CHECK(has(text, "\"alone\""));
  CHECK(has(text, "\"domains\""));
  CHECK(has(text, "\"z_after\": null"));
  CHECK_FALSE(has(text, "nan"));
}
