#include "report/analysis/analysis_report.h"
#include "report/analysis/doubts.h"

#include <limits>
#include <sstream>

#include "base/text/wrapped_text.h"
#include "core/result/estimate.h"
#include "report/blind/blind_report.h"
#include "report/characterize/camera_report.h"
#include "report/check/check_report.h"
#include "report/diagnosis/diagnosis_report.h"
#include "report/diagnosis/plan_report.h"
#include "report/diagnosis/words/verdict_words.h"
#include "report/text/display_text.h"
#include "report/validation/validation_report.h"
#include "tests/catch.h"
#include "tests/report/made_results.h"

using namespace glidelab;

namespace {

bool any_has(const std::vector<std::string>& texts, const std::string& part) {
  for (const std::string& text : texts) {
    if (text.find(part) != std::string::npos) return true;
  }
  return false;
}

/// One clip whose lines the noise explains: their random part is as good as known.
core::AnalysisResults one_clip() {
  core::AnalysisResults results;
  results.clips = {tests::made_clip("up", 2.7, 0.8, 0.65)};
  for (core::LineFit& line : results.clips[0].segments) line.parts.degrees = std::numeric_limits<double>::infinity();
  core::ConfigurationResult configuration;
  configuration.mass_kg = 0.335;
  configuration.incline_deg = 4.3;
  configuration.group = "slope";
  configuration.k_over_m_1_s = tests::known(2.7, 0.006);
  configuration.mu = tests::known(0.0071, 0.0002);
  configuration.lines = results.clips[0].segments;
  results.configurations = {configuration};
  return results;
}

}  // namespace

TEST_CASE("where the law serves, nothing is doubted and no next step is named") {
  CHECK(report::doubts_about(one_clip()).empty());
  CHECK(report::analysis_text(one_clip()).find("glidelab diagnose") == std::string::npos);
}

TEST_CASE("a drag or a friction below zero by more than chance is doubted, by less is not") {
  core::AnalysisResults results = one_clip();
  results.configurations[0].k_over_m_1_s = tests::known(-0.367, 0.055);
  CHECK(any_has(report::doubts_about(results), "K/m = -0.367 ± 0.055 is below zero"));
  CHECK(report::meaning_of(results).find("takes it 63 %") == std::string::npos);
  results.configurations[0].k_over_m_1_s = tests::known(-0.367, 0.355);
  CHECK(report::doubts_about(results).empty());
  results.configurations[0].mu = tests::known(-0.010, 0.002);
  CHECK(any_has(report::doubts_about(results), "µ = -0.0100 ± 0.0020 is below zero"));
  // Of two clips, whose standard deviation has one degree of freedom: 12.7 of them on either side.
  results.configurations[0].mu = core::determined(core::estimate(-0.010, 0.002, 1.0));
  CHECK(report::doubts_about(results).empty());
  CHECK(report::meaning_of(results).find("cannot be distinguished from zero (µ = -0.0100 ± 0.0020)") !=
        std::string::npos);
}

TEST_CASE("of speeds alone the next step is no command that takes none") {
  core::AnalysisResults results = one_clip();
  results.configurations[0].k_over_m_1_s = tests::known(-0.367, 0.055);
  CHECK(any_has(report::doubts_about(results), "glidelab check"));
  results.clips[0].speed_noise_m_s = 0.01;
  CHECK_FALSE(any_has(report::doubts_about(results), "glidelab check"));
  CHECK(any_has(report::doubts_about(results), "needs positions"));
}

TEST_CASE("a clip that swings is doubted before anything else") {
  core::AnalysisResults results = one_clip();
  core::ClipResult& clip = results.clips[0];
  results.configurations[0].clips = {clip.name};
  clip.notes = {
      core::NoRun{"the motion turns 4 times, and its acceleration depends on position: this is an oscillation, "
                  "not a run along an incline",
                  "the law contains no spring"}};
  results.configurations[0].k_over_m_1_s = tests::known(-0.367, 0.055);
  const std::vector<std::string> doubts = report::doubts_about(results);
  REQUIRE(doubts.size() >= 2);
  CHECK(doubts.front().starts_with("up: the motion turns"));
  CHECK(any_has(doubts, "this is an oscillation, not a run along an incline"));
}

TEST_CASE("a body at rest puts no law in doubt: nothing moves, and no next step but another recording") {
  core::AnalysisResults results = one_clip();
  results.configurations[0].clips = {results.clips[0].name};
  results.clips[0].notes = {core::NoRun{"nothing moves: all positions are the same", "record a body that moves", true}};
  results.configurations[0].lines.clear();
  CHECK(report::nothing_moves(results));
  CHECK(report::doubts_about(results).empty());
  for (core::Quantity* const quantity : {&results.configurations[0].k_over_m_1_s, &results.configurations[0].mu,
                                         &results.configurations[0].alpha_deg, &results.configurations[0].v_lim_m_s}) {
    *quantity = core::undetermined(core::unknown::NoDownhillMotion{});
  }
  const std::string text = report::analysis_text(results);
  CHECK(text.starts_with("Nothing moves in this recording"));
  CHECK(text.find("nothing moves: all positions are the same; record a body that moves") != std::string::npos);
  for (const char* const wrong : {"*", "±", "does not fit", "diagnose"}) CHECK(text.find(wrong) == std::string::npos);
  CHECK(report::meaning_of(results).find("Nothing moves") != std::string::npos);
  results.clips.push_back(results.clips[0]);
  results.clips[1].notes.clear();
  CHECK_FALSE(report::nothing_moves(results));
}

TEST_CASE("a downhill line that begins above gravity is doubted: no slope and no friction can cause it") {
  core::AnalysisResults results = one_clip();
  results.gravity_m_s2 = 9.80665;
  // A coffee filter near its terminal velocity v, where its drag grows with v²: a = 2 g (1 - v'/v), twice gravity.
  core::LineFit line;
  line.direction = 1;
  line.a0_m_s2 = core::estimate(19.6, 0.5, 10.0);
  results.configurations[0].lines = {line};
  CHECK(
      any_has(report::doubts_about(results), "the line's intercept at v = 0 is 19.60 ± 0.50 m/s², more than gravity"));
  CHECK(any_has(report::doubts_about(results), "glidelab diagnose"));
  const auto quiet = [&](double a0_m_s2, double sd_m_s2, int direction) {
    results.configurations[0].lines[0].direction = direction;
    results.configurations[0].lines[0].a0_m_s2 = core::estimate(a0_m_s2, sd_m_s2, 10.0);
    return report::doubts_about(results).empty();
  };
  CHECK(quiet(9.83, 0.001, 1));        // local gravity, a length that is 0.3 % off
  CHECK(quiet(12.0, 1.0, 1));          // within its uncertainty
  CHECK_FALSE(quiet(12.28, 0.72, 1));  // 2.9 standard deviations, of the line and of lengths and gravity together
  CHECK(quiet(19.6, 0.5, -1));         // uphill friction adds to the slope
}

TEST_CASE("a line above gravity with x in centimetres is said to be that, and one without a drag is no drag's") {
  core::AnalysisResults results = one_clip();
  results.gravity_m_s2 = 9.80665;
  core::LineFit line;
  line.direction = 1;
  line.a0_m_s2 = core::estimate(50.1, 3.6, 10.0);
  line.k_over_m_1_s = core::estimate(-0.004, 0.050, 10.0);
  results.configurations[0].lines = {line};
  CHECK(any_has(report::doubts_about(results), "no drag explains that: check the units"));
  CHECK_FALSE(any_has(report::doubts_about(results), "K/m is too large"));
  results.configurations[0].clips = {results.clips[0].name};
  results.clips[0].sightings.clear();
  results.clips[0].motion.resize(2);
  results.clips[0].motion[0].measured_m = 1.0;
  results.clips[0].motion[1].measured_m = 168.8;
  CHECK(any_has(report::doubts_about(results), "x covers 167.8, which looks like centimetres (1.68 m)"));
}

TEST_CASE("a fall whose line begins far below gravity is doubted, with the factors that would explain it") {
  core::AnalysisResults results = one_clip();
  results.gravity_m_s2 = 9.8;
  core::LineFit line;
  line.direction = 1;
  line.a0_m_s2 = core::estimate(0.6125, 0.010, 10.0);  // g/16: times that are four times too long
  results.configurations[0].lines = {line};
  CHECK(report::doubts_about(results).empty());  // on a slope of 4.3 degrees
  results.configurations[0].incline_deg = 90.0;
  CHECK(any_has(report::doubts_about(results), "slow-motion playback (4 times)"));
  CHECK(any_has(report::doubts_about(results), "in a larger unit than stated (16 times)"));
  results.configurations[0].notes.emplace_back(core::SteadyFall{1});  // at its terminal velocity all the time
  CHECK(report::doubts_about(results).empty());
}

TEST_CASE("points far off their line are told with the clip and the next step, on the page and in the terminal") {
  core::AnalysisResults results = one_clip();
  results.clips[0].segments[1].parts.degrees = 7.0;
  results.clips[0].segments[1].parts.scatter = 38.4;
  CHECK(any_has(report::doubts_about(results), "up, v > 0: the points lie 38 times as far from their line"));
  CHECK(any_has(report::doubts_about(results), "Next: glidelab check"));
  CHECK(report::analysis_text(results).find("38 times") != std::string::npos);
  CHECK(report::meaning_of(results).find("v &gt; 0: the points lie 38 times") != std::string::npos);
  results.clips[0].segments[1].parts.scatter = 1.4;
  CHECK(report::doubts_about(results).empty());
}

TEST_CASE("the page of an analysis begins with the numbers, then says that the law fits and what they mean") {
  core::AnalysisResults results = one_clip();
  const std::string page = report::analysis_report("fits", results, {}).html;
  const std::size_t fits = page.find("show no clear departure from the law");
  const std::size_t words = page.find("takes it 63\u00a0% of the way to its final speed in 0.37\u00a0s");
  REQUIRE(fits != std::string::npos);
  REQUIRE(words != std::string::npos);  // 1 / 2.7
  CHECK(fits < words);
  CHECK(page.find("class=\"tile\"") < fits);
  // Of many configurations the table has the values, and the words are folded.
  results.configurations.resize(3, results.configurations.front());
  const std::string many = report::analysis_report("fits", results, {}).html;
  CHECK(many.find("over 3 configurations") < many.find("show no clear departure from the law"));
  CHECK(many.find("<summary>In words</summary>") != std::string::npos);
  // Not next to a sentence that says otherwise.
  core::AnalysisResults bent = one_clip();
  for (core::LineFit& line : bent.configurations[0].lines) line.r2 = 0.5;
  const std::string doubtful = report::analysis_report("bent", bent, {}).html;
  CHECK(doubtful.find("Not every a(v) is a clear straight line") != std::string::npos);
  CHECK(doubtful.find("no clear departure from the law") == std::string::npos);
  // Where nothing is determined, or nothing but zero, nothing fits.
  results.configurations.resize(1);
  results.configurations[0].k_over_m_1_s = tests::known(-0.1, 9.8);
  results.configurations[0].mu = {};
  CHECK(report::meaning_of(results).find("no clear departure from the law") == std::string::npos);
  results.configurations[0].k_over_m_1_s = results.configurations[0].mu = {};
  CHECK(report::meaning_of(results).find("no clear departure from the law") == std::string::npos);
}

TEST_CASE("on a terminal an analysis is its answer and a table that fits, a configuration a row") {
  core::AnalysisResults results = one_clip();
  const std::string text = report::analysis_text(results);
  INFO(text);
  CHECK(text.starts_with("K/m = "));
  std::istringstream lines(text.substr(text.find("\n\n")));
  std::string line;
  std::size_t rows = 0;
  while (std::getline(lines, line)) {
    if (!line.starts_with(report::configuration_name(results, results.configurations[0]) + "  ")) continue;
    ++rows;
    CHECK(base::characters_in(line) <= base::kTerminalWidth);
  }
  CHECK(rows >= 1);
}

TEST_CASE("a reason for several missing quantities is told once") {
  core::AnalysisResults results = one_clip();
  const core::WhyUnknown one_way{core::unknown::NotBothLines{true, false}};
  results.configurations[0].mu.estimate.reset();
  results.configurations[0].mu.why = results.configurations[0].alpha_deg.why = one_way;
  results.configurations[0].v_lim_m_s.why = core::WhyUnknown{core::unknown::NoDownhillLine{}};
  const std::string text = report::analysis_text(results);
  CHECK(text.find("µ and α are not determined: no line for v < 0; only motion in both directions separates friction "
                  "from inclination") != std::string::npos);
  CHECK(text.find("terminal velocity is not determined: no line for v > 0") != std::string::npos);
}

TEST_CASE("where the law is in doubt the doubt comes first and the numbers are called no more than what a fit gives") {
  core::AnalysisResults results = one_clip();
  results.configurations[0].mu = tests::known(-0.010, 0.002);
  const std::string doubted = report::meaning_of(results);
  CHECK(doubted.find("does not fit") != std::string::npos);
  CHECK(doubted.find("takes it 63 %") == std::string::npos);
  CHECK(doubted.find("Coulomb friction is") == std::string::npos);
  const std::string page = report::analysis_report("doubted", results, {}).html;
  const std::size_t doubt = page.find("does not fit"), number = page.find("<b>2.7");
  REQUIRE(doubt != std::string::npos);
  REQUIRE(number != std::string::npos);
  CHECK(doubt < number);
  CHECK(page.find("need not be properties") < number);
  CHECK(page.find("does not fit") < page.find("id=\"recovered\""));
  CHECK(report::meaning_of(one_clip()).find("Coulomb friction is µ = 0.0071") != std::string::npos);
  results.configurations[0].mu = tests::known(-0.002, 0.002);
  CHECK(report::meaning_of(results).find("Coulomb friction cannot be distinguished from zero") != std::string::npos);
}

TEST_CASE("where the law does not fit, ± are marked as holding only if it did, on the page and in the terminal") {
  core::AnalysisResults results = one_clip();
  const std::string held = "± would hold only if it did";
  CHECK(report::analysis_text(results).find(held) == std::string::npos);
  CHECK(report::analysis_report("fits", results, {}).html.find(held) == std::string::npos);
  results.configurations[0].scatter = 1.4;  // of the fit of the whole motion; a wrong idea of the noise makes as much
  CHECK(report::doubts_about(results).empty());
  results.configurations[0].scatter = 6.2;
  CHECK(any_has(report::doubts_about(results), "the positions lie 6.2 times as far from the fitted motion"));
  CHECK(report::analysis_text(results).find("K/m (1/s) *") != std::string::npos);
  CHECK(report::analysis_text(results).find(held) != std::string::npos);
  const std::string page = report::analysis_report("fails", results, {}).html;
  CHECK(page.find("K/m (1/s) *") != std::string::npos);
  CHECK(page.find(held, page.find("id=\"recovered\"")) != std::string::npos);
}

TEST_CASE("what blind cases mean is told of what was there, with intervals, and what is missed is named") {
  validate::BlindScore score;
  score.methods.resize(1);
  score.methods[0].single["strong"] = {4, 4};
  score.false_alarm = {10, 1};
  score.calibration_error = 0.02;
  const auto has = [&](const char* part) { return report::blind_meaning(score).find(part) != std::string::npos; };
  // Clopper and Pearson, all of n: the lower end is 0.025^(1/n), 0.398 of 4.
  CHECK(has("in 100 % (4 of 4; 95 %: 40 to 100 %)"));
  CHECK(has("can be taken at face value"));
  CHECK(has("Missed: nothing wrong: a verdict other than none"));  // 10 % of at most 5
  CHECK_FALSE(has("moderate"));
  score.false_alarm = {20, 1};
  CHECK(has("All 3 targets"));  // one strong effect, nothing wrong, the calibration
  score.calibration_error = 0.2;
  score.reliability = {{0.8, 1.0, 0.9, {10, 7}}};
  CHECK(has("overconfident"));
  score.reliability[0].stated = 0.5;
  CHECK(has("underconfident"));
  CHECK(has("Missed: the expected calibration error"));  // no other: 5 % of false alarms are allowed
}

namespace {

/// The first paragraph of "What this means", which stands above every other part of the page; empty where it does not.
std::string meaning_on(const report::Page& page) {
  const std::size_t first = page.html.find("<h2");
  const std::string heading = "<h2 id=\"meaning\">What this means</h2>\n<p>";
  if (first == std::string::npos || page.html.compare(first, heading.size(), heading) != 0) return {};
  const std::size_t from = first + heading.size();
  return page.html.substr(from, page.html.find("</p>", from) - from);
}

bool tells(const report::Page& page, const std::string& part) {
  return meaning_on(page).find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a diagnosis of clips or of lines says at the top what its verdict means for the numbers of an analysis") {
  diagnose::Diagnosis of;
  of.none = 0.9;
  of.effects = {{"quadratic_drag", diagnose::Stage::dynamics, "<a drag>", 0.9, {}, {{"force_n", 1.0, 0.1}}, 0.9, {}}};
  of.ranking = {{{{"quadratic_drag"}}, 0.5, 1.0, 1.0, 1, {}}};
  diagnose::Diagnosis lines = of;
  lines.lines.emplace();
  lines.lines->lines = 12;
  lines.lines->candidates = {{{}, {}, 0.9, 0.0, 0.0, 0, {}, {}, {}, {}},
                             {{{"quadratic_drag"}}, {}, 0.05, 1.0, 1.0, 1, {{"force_n", 1.0, 0.1}}, {}, {}, {}}};
  for (diagnose::Diagnosis* diagnosis : {&of, &lines}) {
    diagnosis->verdict = diagnose::Verdict::effect;
    CHECK(tells(report::diagnosis_report("d", *diagnosis), " show &lt;a drag&gt; (quadratic_drag, 90"));
    CHECK(tells(report::diagnosis_report("d", *diagnosis), "glidelab analyze leaves this out"));
    diagnosis->verdict = diagnose::Verdict::none;
    CHECK(tells(report::diagnosis_report("d", *diagnosis), " can show, nothing is missing"));
    CHECK_FALSE(tells(report::diagnosis_report("d", *diagnosis), "An analysis of these data"));
  }
  of.verdict = diagnose::Verdict::unknown;
  CHECK(tells(report::diagnosis_report("d", of), "need not be properties of the track"));
}

TEST_CASE(
    "a plan says at the top what a diagnosis could find, and where it could find nothing that its none is empty") {
  diagnose::Plan plan;
  plan.clips = 2;
  plan.effects = {{"scale_error", "a wrong scale", "e", 0.28, true, {}},
                  {"load_independent_friction", "a friction", "force_n", 0.0, false, {}}};
  CHECK(tells(report::plan_page("p", plan), "smaller ones may still act"));
  plan.effects.front().seen = false;
  CHECK(tells(report::plan_page("p", plan), "would be meaningless"));
}

TEST_CASE("a check says at the top whether to analyse, to record again or to mend, and how well positions are known") {
  core::RecordingCheck check;
  check.clips.resize(2);
  check.clips[0].frames = check.clips[1].frames = 100;
  check.clips[0].seen = 99;
  check.clips[1].seen = 90;
  check.clips[0].position_noise_m = 2.5e-6;
  check.clips[1].position_noise_m = 3.6e-6;
  const auto page = [&] { return report::check_report(check, {}); };
  CHECK(tells(page(), "Usable as it is.</b> Nothing needs to be recorded again"));
  CHECK(page().html.find("</h1>\n<h2 id=\"meaning\">What this means</h2>\n<p><b") != std::string::npos);
  CHECK(tells(page(), "found in 189 of 200 frames of 2 clips"));
  CHECK(tells(page(), "position noise: at most 0.0036\u00a0mm (one standard deviation)"));
  check.findings = {{core::Severity::change, {}, core::found::Dark{0.2}}};
  CHECK(tells(page(), "would make its numbers more precise"));
  check.findings = {{core::Severity::unusable, {}, core::found::Dark{0.0}}};
  check.usable = false;
  CHECK(tells(page(), "fix what “must change”"));
}

TEST_CASE("a rehearsal's page says at the top how many values lie near the truth, above all its tables") {
  validate::Comparison comparison;
  comparison.quantities = {{"m1", 0.335, 4.0, "trajectory", "mu", 0.0071, 0.0072, 0.0001, 0.0001, {}}};
  const report::Page page = report::validation_report("v", tests::made_results(), comparison, {});
  CHECK(tells(page, "lie within two standard deviations"));
  CHECK(page.html.find("lie within two standard deviations") < page.html.find("A rehearsal: simulated"));
}

TEST_CASE("a measured camera's page says at the top how far a pixel wavers, and that some numbers are missing") {
  core::CameraMeasurement camera;
  camera.curve.resize(2);
  camera.curve[1].mean_dn = camera.curve[1].variance_dn2 = camera.saturation_dn = 100.0;
  CHECK(tells(report::camera_report(camera), "These images do not give the gain"));
  camera.gain_dn_per_e.value = 0.5;
  camera.read_noise_e.value = 7.0;
  camera.full_well_e.value = 10000.0;
  CHECK(tells(report::camera_report(camera), "by 7 electrons (3.5 codes)"));
  CHECK(tells(report::camera_report(camera),
              "full at 10000 electrons, where it fluctuates by 1\u00a0%"));  // 1 / sqrt(10^4)
}

TEST_CASE("an analysis leaves an effect out, but puts lost frames right") {
  diagnose::Diagnosis diagnosis;
  diagnosis.verdict = diagnose::Verdict::effect;
  diagnosis.effects.emplace_back().id = "quadratic_drag";
  CHECK(report::diagnosis_meaning(diagnosis).find("leaves this out") != std::string::npos);
  diagnosis.effects[0].id = "dropped_frames";
  CHECK(report::diagnosis_meaning(diagnosis).find("leaves this out") == std::string::npos);
  CHECK(report::diagnosis_meaning(diagnosis).find("corrects the times after them") != std::string::npos);
  diagnosis.effects.emplace_back().id = "quadratic_drag";
  CHECK(report::diagnosis_meaning(diagnosis).find("leaves this out") != std::string::npos);
}

TEST_CASE("where one direction tells friction and slope together, the acceleration at v = 0 is told") {
  core::AnalysisResults results = one_clip();
  core::LineFit line;
  line.direction = 1;
  line.a0_m_s2 = core::estimate(2.005, 0.011, 10.0);
  results.configurations[0].lines = {line};
  results.configurations[0].alpha_deg = tests::known(4.3, 0.01);
  CHECK(report::analysis_text(results).find("acceleration at v = 0") == std::string::npos);  // both are determined
  results.configurations[0].mu = {};
  CHECK(report::analysis_text(results).find("acceleration at v = 0: 2.005 ± 0.011 m/s² (g sin α − µ g cos α, from v > "
                                            "0)") != std::string::npos);
  results.configurations[0].lines[0].direction = -1;
  CHECK(report::analysis_text(results).find("(g sin α + µ g cos α, from v < 0)") != std::string::npos);
}
