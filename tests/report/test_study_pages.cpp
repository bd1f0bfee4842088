/// The pages of require and coverage: units, digits and names as a reader meets them.
#include <regex>
#include <string>

#include "report/coverage/coverage_report.h"
#include "report/diagnosis/plan_report.h"
#include "report/html/html.h"
#include "report/requirement/requirement_plot.h"
#include "report/requirement/requirement_report.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A page's HTML with plain spaces for those that do not break.
std::string plainly_spaced(const report::Page& page) {
  return std::regex_replace(page.html, std::regex("\xC2\xA0"), " ");
}

validate::Requirement one_camera(const std::string& quantity, double target, double bound) {
  validate::Requirement requirement;
  requirement.name = "cameras";
  requirement.confirm = validate::Confirm::tracks;
  requirement.runs = 4;
  requirement.targets = {{quantity, validate::Target::Measure::sd, target}};
  validate::Candidate candidate;
  candidate.name = "webcam";
  candidate.verdict = validate::Verdict::reached;
  candidate.judged_by = validate::Confirm::tracks;
  candidate.pixels_s = 1e7;
  candidate.frame_rate_hz = 30.0;
  candidate.noise_m = 2.46e-5;
  candidate.mode = {640, 480, 0.002, {validate::CodecSetting::Kind::mjpeg, 70.0}};
  candidate.results = {{bound, 1.1 * bound, 0.3 * bound, 200, 3, "trajectory", 0.9 * bound, 1.5 * bound}};
  requirement.candidates = {candidate};
  return requirement;
}

validate::CoverageRow row(const std::string& estimator, const std::string& quantity, double sd, double stated_sd) {
  validate::CoverageRow of;
  of.configuration = "m1";
  of.estimator = estimator;
  of.quantity = quantity;
  of.determined = of.covered = 200;
  of.sd = sd;
  of.stated_sd = stated_sd;
  of.coverage = 0.95;
  of.low95 = 0.91;
  of.high95 = 0.97;
  return of;
}

}  // namespace

TEST_CASE("require says its target, and its columns in the thousandths, millionths … in which the target has digits") {
  const std::string mu = report::requirement_text(one_camera("mu", 0.0005, 1.8e-5));
  CHECK(has(mu, "rms error of µ at most 0.0005 on the worst configuration"));
  CHECK(has(mu, "rms error of µ (10⁻⁶)\n"));
  CHECK(has(mu, "(10⁻⁶)"));
  CHECK(has(mu, "19.8 ± 5.4"));
  const std::string page = report::requirement_report(one_camera("mu", 0.0005, 1.8e-5)).html;
  CHECK(has(page, ">3 of 200</td>"));
  CHECK(has(page, ">27</td>"));       // 1.5 of the bound: the upper limit
  CHECK(has(mu, "--confirm clips"));  // tracks judged: what they leave out, and what to do
  const std::string k = report::requirement_text(one_camera("k_over_m_1_s", 0.002, 0.00038));
  CHECK(has(k, "rms error of K/m (10⁻³ 1/s)\n"));
  CHECK(has(k, "(10⁻³ 1/s)"));
  const std::string alpha = report::requirement_text(one_camera("alpha_deg", 1.0, 0.5));
  CHECK(has(alpha, "rms error of α (°)\n"));
  CHECK(has(alpha, "(°)"));
  validate::Requirement rendered = one_camera("mu", 0.0005, 1.8e-5);
  rendered.confirm = validate::Confirm::clips;
  CHECK_FALSE(has(report::requirement_text(rendered), "--confirm clips"));
  // What the bound forbids was not run, and images would not help.
  validate::Requirement impossible = one_camera("mu", 1e-6, 1.8e-5);
  impossible.candidates.front().verdict = validate::Verdict::impossible;
  impossible.candidates.front().results = {{1.8e-5, {}, 0.0, 0, 0, ""}};
  CHECK(has(report::requirement_text(impossible), "Judged by the bound alone, without a run"));
  CHECK_FALSE(has(report::requirement_text(impossible), "--confirm clips"));
}

TEST_CASE("the numbers in the plot of require are those of its tables, the cheapest camera first") {
  validate::Requirement requirement = one_camera("mu", 0.0005, 1.8e-5);
  requirement.candidates.push_back(requirement.candidates.front());
  requirement.candidates.back().name = "phone";
  requirement.candidates.back().verdict = validate::Verdict::missed;
  requirement.candidates.back().results.front().found = 0.002;
  const report::Page page = report::requirement_report(requirement);
  CHECK(has(page.html, "<td>1</td><td>webcam</td>"));
  CHECK(has(page.html, "<td>2</td><td>phone</td>"));
  const std::string& plotted = page.files.at("plots/01-accuracy-reached-against-cost.csv");
  // One standard deviation of 0.3 bounds at 1.1 bounds, as a ratio: exp(3/11) = 1.3135.
  CHECK(has(plotted, "# met\n10,1.98e-05,1,1.507"));
  CHECK(has(plotted, "e-05,2.600"));
  CHECK(has(plotted, "# missed\n10,0.002,2,"));
  CHECK(has(page.html, "1 of 2 reaches it; 1 does not."));
}

TEST_CASE("points of require that lie close together share one label") {
  CHECK(report::ranges_text({1, 2, 3, 7, 9, 10}) == "1-3, 7, 9, 10");
  validate::Requirement requirement = one_camera("mu", 0.0005, 1.8e-5);
  for (const double found : {2.0e-5, 2.1e-5, 9e-3}) {
    requirement.candidates.push_back(requirement.candidates.front());
    requirement.candidates.back().results.front().found = found;
  }
  // 1.98e-5, 2e-5 and 2.1e-5 of a range of 450 times: within its hundredth part.
  const std::string script = report::requirement_plot(requirement).drawing.script;
  CHECK(has(script, "set label '1-3' at"));
  CHECK(has(script, "set label '4' at"));
}

TEST_CASE("a label of require that would stand on the next point takes its number in") {
  validate::Requirement requirement = one_camera("mu", 0.0005, 1.8e-5);
  const validate::Candidate first = requirement.candidates.front();
  // The axis is 1.17 ln 100 = 5.39 long. Points join within 0.07 of it, 0.38, of the first: the second does,
  // the third does not, but it lies 0.3 beside the end of their label.
  requirement.candidates.clear();
  for (const double cost : {10.0, 10.0 * std::exp(0.3), 10.0 * std::exp(0.6), 1000.0}) {
    requirement.candidates.push_back(first);
    requirement.candidates.back().pixels_s = 1e6 * cost;
  }
  const std::string script = report::requirement_plot(requirement).drawing.script;
  CHECK(has(script, "set label '1-3' at"));
  CHECK(has(script, "set label '4' at"));
}

TEST_CASE("a plan says sizes with their units, and what to do about effects that look alike") {
  diagnose::Plan plan;
  plan.clips = 2;
  plan.points = 116;
  plan.noise_m = 2.2e-5;
  plan.effects = {{"quadratic_drag", "a drag that grows", "c_kg_m", 0.0028, true, {"eddy_rolloff"}},
                  {"eddy_rolloff", "a magnetic drag", "v_c_m_s", 20.0, true, {"quadratic_drag"}},
                  {"lens_distortion", "a lens", "k_1_m2", 0.00071, true, {}},
                  {"scale_error", "a wrong scale", "e", 0.28, true, {}},
                  {"load_independent_friction", "a friction", "force_n", 0.0, false, {}}};
  const std::string text = report::plan_text(plan);
  CHECK(has(text, "\nquadratic drag                c = 0.0028 kg/m\n"));
  CHECK(has(text, "\nindistinguishable from:\n  quadratic drag: magnetic drag that falls off\n"));
  CHECK(has(text, "\nquadratic drag: a force "));  // what the letter c is
  CHECK_FALSE(has(text, "eddy_rolloff"));
  CHECK(has(text, "v_c up to 20 m/s"));
  CHECK(has(text, "k = 0.00071 1/m²"));
  CHECK(has(text, "e = 0.28\n"));
  CHECK(has(text, "plan again"));
  // The page begins with the answer; on a phone an effect's size stands below its name and not beyond the edge.
  const std::string page = report::plan_page("plan", plan).html;
  CHECK(has(page, "</h1>\n<h2 id=\"meaning\">What this means</h2>\n<p><b>These motions can show 4 of the 5 effects"));
  CHECK(has(page, "distinguish 2 of those from every other (lens distortion and wrong scale): 2 clips"));
  const std::size_t lens = page.find("lens_distortion"), none = page.find("<b>none</b>");
  CHECK(lens < none);
  CHECK(none < page.find("scale_error"));
  CHECK(page.find("<b>none</b>", page.find("load_independent_friction")) == std::string::npos);  // it is not seen
  CHECK(has(page, "<table class=\"names stack\">"));
  CHECK(page.find(">smallest size that shows</th>") < page.find(">what it is</th>"));
  plan.effects.erase(plan.effects.begin(), plan.effects.begin() + 2);
  CHECK_FALSE(has(report::plan_text(plan), "plan again"));
}

TEST_CASE("the first line of coverage is the answer: how often the intervals hold, and which of them do not") {
  validate::Coverage coverage;
  CHECK(report::coverage_answer(coverage).empty());
  coverage.replicates = 200;
  coverage.levels = {0.95};
  coverage.rows = {row("phase-diagram", "mu", 0.0028, 0.0028), row("trajectory", "mu", 0.001, 0.001),
                   row("naive-lines", "mu", 0.0083, 0.0026)};
  for (validate::CoverageRow& one : coverage.rows) one.levels = {{0.95, 190, 0.95, 0.91, 0.98, 1.0}};
  coverage.rows[1].coverage = 0.935;
  coverage.rows[2].coverage = 0.1;
  CHECK(report::coverage_answer(coverage) ==
        "The stated 95 % intervals contain the true value in 93.5 to 95.0 % of 200 replicates, as often as stated, as "
        "far as "
        "this many replicates can tell.");
  CHECK(has(plainly_spaced(report::coverage_page("x", coverage)),
            "<b>The stated 95 % intervals contain the true value in 93.5 to 95.0 % of 200 replicates, as often as "));
  coverage.rows[1].coverage = 0.6;
  coverage.rows[1].levels = {{0.95, 120, 0.6, 0.53, 0.67, 1e-40}};
  const std::string text = report::coverage_text(coverage);
  CHECK(text.substr(0, text.find('\n')) ==
        "The stated 95 % intervals contain the true value in 60.0 to 95.0 % of 200 replicates, less often than stated "
        "for 1 of "
        "2: µ of m1 with the fit of the whole motion.");
  // Below the answer the estimators of one quantity stand together, in lines that fit a terminal.
  CHECK(has(text, "\n\nm1, µ = "));
  CHECK(text.find("\nphase-diagram ") < text.find("\ntrajectory "));
  CHECK(text.find("m1, µ = ") == text.rfind("m1, µ = "));
  const std::string page = plainly_spaced(report::coverage_page("x", coverage));
  CHECK(page.find("in 60.0 to 95.0 %") < page.find("replicates of the scenario's motions as tracks"));
  CHECK(has(page, "in 60.0 to 95.0 % of 200 replicates, less often than stated for 1 of 2.</b>"));
  CHECK(has(page, "<li>µ of m1 with the fit of the whole motion: 60.0 % at 95 %</li>"));
  CHECK(has(page, "60.0 % (p &lt; 0.0001)"));
  CHECK(has(page, "95.0 % (p = 1"));
  const std::size_t folded = page.find("<details");
  CHECK(page.find("<figure>") < page.find("<summary>Every quantity"));  // the plot is open, the numbers are folded
  CHECK(page.find("(p = 1") > folded);
  CHECK(folded != std::string::npos);
}

TEST_CASE("the first line of coverage says how often an outside estimator failed, and names it as such") {
  validate::Coverage coverage;
  coverage.replicates = 200;
  coverage.levels = {0.95};
  coverage.outside = fit::tally_of("mine", "mine {folder} {out}",
                                   {{fit::OutsideFailure::signal, "signal 11 (SIGSEGV)", 1.0},
                                    {fit::OutsideFailure::no_output, "no results.json in {out}", 1.0},
                                    {fit::OutsideFailure::none, "", 1.0}});
  const std::string failed =
      "“mine” failed in 2 of 3 runs: 1 was ended by a signal, the first: signal 11 (SIGSEGV); 1 left no results.json "
      "in "
      "{out}.";
  CHECK(report::coverage_answer(coverage) == failed);  // nothing else to say
  coverage.rows = {row("phase-diagram", "mu", 0.0028, 0.0028), row("mine", "mu", 0.001, 0.001)};
  for (validate::CoverageRow& one : coverage.rows) one.levels = {{0.95, 190, 0.95, 0.91, 0.98, 1.0}};
  coverage.rows[1].levels = {{0.95, 120, 0.6, 0.53, 0.67, 1e-40}};
  const std::string text = report::coverage_text(coverage);
  CHECK(text.starts_with(failed + " The stated 95 % intervals"));
  CHECK(has(text.substr(0, text.find('\n')), "less often than stated for 1 of 2: µ of m1 with “mine”."));
  CHECK(has(text,
            "mine: 2 of 3 runs failed (1 was ended by a signal, the first: signal 11 (SIGSEGV); 1 left no "
            "results.json in {out})"));
  CHECK(has(report::coverage_page("x", coverage).html, failed));
}

TEST_CASE("coverage names what scatters farther than it states, and the naive lines are not asked") {
  validate::Coverage coverage;
  coverage.replicates = 200;
  coverage.noise_sd_m = {2e-5};
  coverage.rows = {row("phase-diagram", "mu", 0.0083, 0.0028), row("phase-diagram", "alpha_deg", 0.47, 0.15),
                   row("trajectory", "k_over_m_1_s", 0.0019, 0.001), row("naive-lines", "mu", 0.0083, 0.0026)};
  const std::string page = report::coverage_page("webcam", coverage).html;
  CHECK(has(page, "for µ (3.0 times), α (3.1 times) of m1 with the lines of the phase diagram. A few"));
  coverage.rows.erase(coverage.rows.begin(), coverage.rows.begin() + 2);
  CHECK_FALSE(has(report::coverage_page("webcam", coverage).html, "scatter more than"));
}
