/// Names, titles, notes and reasons that come from files are text on every page, whatever is written in them.
#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "base/files/file_io.h"
#include "report/analysis/analysis_report.h"
#include "report/blind/blind_report.h"
#include "report/blind/everyday_report.h"
#include "report/certificate/certificate_report.h"
#include "report/challenge/challenge_report.h"
#include "report/characterize/camera_report.h"
#include "report/check/check_report.h"
#include "report/coverage/coverage_report.h"
#include "report/diagnosis/diagnosis_report.h"
#include "report/diagnosis/line_report.h"
#include "report/diagnosis/plan_report.h"
#include "report/requirement/requirement_report.h"
#include "report/sweep/sweep_report.h"
#include "report/validation/validation_report.h"
#include "test_paths.h"
#include "tests/catch.h"
#include "tests/report/made_results.h"
#include "tests/report/text_of_pages.h"

using namespace glidelab;
using tests::check_is_text;
using tests::has;
using tests::kEvil;

namespace {

/// Every note that holds a text of a file.
std::vector<core::Note> evil_notes() {
  core::InclineContradiction contradiction;
  contradiction.stated.by = kEvil;
  return {core::SheetTaken{kEvil},
          core::ColumnsTaken{kEvil, kEvil, kEvil},
          core::UnitAssumed{kEvil, "metres"},
          core::HeightTaken{kEvil},
          core::ForceUnused{kEvil},
          core::PointMassTaken{kEvil, "+X"},
          core::OutlyingView{kEvil, 1.0, true},
          core::NoPatternInSight{{kEvil, kEvil}},
          core::PlaneViewsDisagree{kEvil, 1.0, 0.1, 2},
          core::NotOfStatedSize{kEvil},
          contradiction};
}

core::AnalysisResults evil_results() {
  core::AnalysisResults results = tests::made_results();
  for (core::ClipResult& clip : results.clips) {
    clip.name = clip.experiment = kEvil;
    clip.bandwidth_method = core::chosen_by::FirstSmoothing{kEvil};
    clip.notes = evil_notes();
  }
  for (core::ConfigurationResult& configuration : results.configurations) {
    configuration.group = kEvil;
    configuration.clips = {kEvil};
    configuration.mu = {std::nullopt, core::WhyUnknown{core::unknown::Told{kEvil}}};
    configuration.notes = evil_notes();
  }
  core::CalibrationResult& calibration = results.calibrations[0];
  calibration.experiment = kEvil;
  calibration.lens.kept = {kEvil};
  calibration.notes = evil_notes();
  calibration.rests = {800, 600, {{100.0, 100.0, 0.01, 0.02, 0.01, 9}, {500.0, 300.0, 0.01, 0.02, 0.01, 9}}, 0.01, 1.2};
  results.calibrations.push_back(calibration);  // of two folders each is named beside its plot
  core::PlumbResult plumb;
  plumb.group = plumb.experiment = kEvil;
  plumb.plumb_deg.why = core::WhyUnknown{core::unknown::NoLine{}, {{kEvil, core::AgainstLaunch{1, 0.5}}}};
  results.plumbs.push_back(plumb);
  results.estimator = kEvil;
  return results;
}

std::vector<core::Preview> evil_previews() {
  const core::Preview preview{{{0, 0.0, "jpeg"}}, "", 1.0, {}};
  return {preview, preview};
}

diagnose::Diagnosis evil_diagnosis() {
  diagnose::Diagnosis of;
  of.verdict = diagnose::Verdict::effect;
  of.points = 100;
  of.effects = {{kEvil,
                 diagnose::Stage::optics,
                 kEvil,
                 0.9,
                 {kEvil},
                 {{kEvil, 1.0, 0.1}, {"codec", 0.0, 0.0, kEvil}},
                 0.95,
                 {{kEvil, kEvil, 0.5}}}};
  of.ranking = {{{{kEvil}}, 0.9, 10.0, 12.0, 1, 1.0, {}},
                {{{kEvil}}, 0.0, 0.0, 0.0, 1, {}, diagnose::ImpossibleSize{kEvil, -1.0, {}}}};
  of.none = 0.05;
  of.unknown = 0.05;
  of.stage = diagnose::Stage::optics;
  of.next = diagnose::RecordForEffect{kEvil, diagnose::Alternative{{{kEvil}}, {{kEvil}}}};
  of.regions = {
      {diagnose::GapVariable::time, 0.0, 1.0, 5.0, 1e-3, kEvil, diagnose::GapKind::force, kEvil, {}, 1e-4, 0, 0.5}};
  of.effects.front().parameters.push_back({"mu." + kEvil, 1.0, 0.1});
  of.effects.front().parameters.push_back({"mu.2" + kEvil, 1.0, 0.1});
  of.explained = {{kEvil, 0.9, diagnose::GapInterval{0.8, 0.95}, 1.2}};
  of.remainder = diagnose::GapRemainder{0.1, 1.2, 1e-3, 1e-3, 0.01, of.regions};
  of.traces = {kEvil};
  const core::Quantity unknown{{}, core::WhyUnknown{core::unknown::Told{kEvil}}};
  of.recovered = {{kEvil, 0.3, 4.0, false, {kEvil}, unknown, unknown, unknown, unknown},
                  {"other", 0.3, 4.0, false, {kEvil}, unknown, unknown, unknown, unknown}};
  of.limits.contradicted = {{kEvil, diagnose::Against::plumb, 0.2, 0.01, 0.1, 0.01, false, 7.0}};
  of.notes = {diagnose::NoFreeMotion{kEvil, 12},
              diagnose::StatementsDisagree{kEvil, diagnose::Against::plumb, diagnose::Against::stated, 7.0},
              diagnose::NoInclination{{kEvil, kEvil}},
              diagnose::SplitSetUps{{kEvil}},
              diagnose::OppositeLaunch{kEvil, true},
              diagnose::DoubtfulUnit{kEvil, core::found::LongRun{9.0}},
              diagnose::ContradictedReading{0.3, {}},
              of.limits.contradicted.front()};
  of.images = {{kEvil,
                diagnose::Stage::optics,
                true,
                3.0,
                false,
                {{kEvil, 1.0, 0.1}},
                diagnose::image::Compression{true, kEvil, 0.1, {}}}};
  of.image_curves = {{"brightness", kEvil, {0.0, 1.0}, {0.0, 0.01}, {}, {}, {}}};
  of.residuals = {{kEvil,
                   {0.0, 1.0, 2.0},
                   {0.0, 1.0, 2.0},
                   {1.0, 1.0, 1.0},
                   {1e-3, 0.0, 1e-3},
                   {0.0, 0.0, 0.0},
                   {1e-5, 1e-5, 1e-5}}};
  of.calibrations = {{kEvil, evil_results().calibrations[0].rests}, {kEvil, evil_results().calibrations[0].rests}};
  of.isolability = {{kEvil, kEvil}, {1.0, 1.0}, {{1.0, 0.5}, {0.5, 1.0}}};
  of.twin_lacks = {{kEvil, kEvil}};
  diagnose::GapSizes gap;
  gap.before = 5.0;
  gap.after = 1.0;
  gap.held_out = {kEvil, kEvil};
  gap.before_by_clip = {5.0, 4.0};
  gap.after_by_clip = {1.0, 1.1};
  gap.interval95.too_few = 1;
  gap.parameters = {
      {kEvil, diagnose::Against::plumb, kEvil, 4.0, 0.3, diagnose::DiagnosedParameter{kEvil, 1.0, 0.1}, {}}};
  gap.domains = {{diagnose::GapDomainKind::positions, 5.0, 1.0}};
  of.gap = gap;
  return of;
}

}  // namespace

TEST_CASE("the pages of an analysis and of a rehearsal have every name from a file as text") {
  const core::AnalysisResults results = evil_results();
  check_is_text(report::analysis_report(kEvil, results, evil_previews()));
  validate::Comparison comparison;
  const core::WhyUnknown evil{core::unknown::Told{kEvil}};
  comparison.quantities = {{kEvil, 0.335, 4.0, kEvil, kEvil, 1.0, 1.1, 0.1, 0.1, evil},
                           {kEvil, 0.335, 4.0, kEvil, "mu", 1.0, {}, {}, {}, evil}};
  comparison.lines = {{kEvil, -1, 0.9999}};
  comparison.restitution.points = {{}};
  check_is_text(report::validation_report(kEvil, results, comparison, evil_previews()));
}

TEST_CASE("the page of a check has every name from a file as text") {
  core::RecordingCheck check;
  check.name = kEvil;
  check.usable = false;
  const core::Subject evil{core::Subject::Part::clips, {kEvil}};
  core::found::AgainstStatedLaunch launch;
  launch.launched = launch.clip = kEvil;
  launch.downhill = kEvil;
  launch.against = 2;
  for (core::Found found :
       std::vector<core::Found>{core::found::NoCamera{kEvil, 1, 2}, core::found::NoPatternIn{{kEvil}},
                                core::found::NotTracked{kEvil}, core::found::NoPlumbAngle{kEvil},
                                core::found::MassesApart{{{kEvil, 300.0}}, {kEvil, 0.3}, 100.0}, std::move(launch)}) {
    check.findings.push_back({core::Severity::unusable, evil, std::move(found)});
  }
  for (const core::Note& note : evil_notes()) check.findings.push_back({core::Severity::note, evil, note});
  check.findings[0].follow = check.findings;
  core::PatternCheck pattern;
  pattern.views = {{kEvil, true, 0.1, 3.0, {{100.0, 100.0}}}};
  pattern.without = {kEvil};
  pattern.failure = kEvil;
  pattern.width_px = 800;
  pattern.height_px = 600;
  check.pattern = pattern;
  core::ClipCheck clip;
  clip.name = kEvil;
  clip.notes = evil_notes();
  check.clips = {clip, clip};
  check.clips[1].failure = kEvil;
  check.plumb_failure = kEvil;
  check_is_text(report::check_report(check, evil_previews()));
}

TEST_CASE("the page of a diagnosis has every name from a file as text, for each verdict and with a twin") {
  diagnose::Diagnosis of = evil_diagnosis();
  const validate::TwinMotion twin{kEvil,      {0.0, 1.0}, {0.0, 1e-4}, {1e-5, 1e-5},
                                  {1.0, 0.9}, {0.0, 0.1}, {1.0, 0.9},  {0.0, 0.1}};
  check_is_text(report::diagnosis_report(kEvil, of, {twin}));
  for (const diagnose::Verdict verdict : {diagnose::Verdict::none, diagnose::Verdict::unknown}) {
    of.verdict = verdict;
    check_is_text(report::diagnosis_report(kEvil, of, {}));
  }
}

TEST_CASE("the page of a diagnosed table of lines has every name from a file as text") {
  diagnose::Diagnosis of = evil_diagnosis();
  diagnose::LineComparison lines;
  lines.lines = 2;
  lines.either_of = {kEvil, kEvil};
  lines.candidates = {
      {{{kEvil}}, {}, 0.5, 1.0, 1.0, 1, {{kEvil, 1.0, 0.1}}, 3.0, 1.0, {}},
      {{{kEvil, kEvil}}, {{kEvil, diagnose::LinesOver::mass}}, 0.4, 1.0, 1.0, 1, {{kEvil, 1.0, 0.1}}, 3.0, 1.0, {}},
      {{}, {}, 0.1, 0.0, 0.0, 0, {}, 9.0, 3.0, {}},
      {{{kEvil, kEvil}}, {}, 0.0, 0.0, 0.0, 1, {}, {}, {}, diagnose::ImpossibleSize{kEvil, -1.0, {}}}};
  lines.off = {{0.335, 4.0, 1, 2.7, 0.01, 0.0}, {0.335, 4.0, -1, 2.7, -0.01, 0.0}};
  lines.curves = {{kEvil, {0.335, 0.435}, {2.7, 2.1}, {0.01, 0.01}}};
  of.lines = lines;
  check_is_text(report::line_report(kEvil, of));
  of.lines->either_of.clear();
  check_is_text(report::line_report(kEvil, of));
}

TEST_CASE("the page of a plan has every name from a file as text") {
  diagnose::Plan plan;
  plan.clips = 2;
  plan.points = 100;
  plan.noise_m = 1e-5;
  plan.effects = {{kEvil, kEvil, kEvil, 0.1, true, {kEvil}}, {kEvil, kEvil, kEvil, 0.0, false, {}}};
  plan.notes = {diagnose::NoFreeMotion{kEvil, 12}};
  plan.isolability = evil_diagnosis().isolability;
  check_is_text(report::plan_page(kEvil, plan));
}

TEST_CASE("the pages of require and of coverage have every name from a file as text") {
  validate::Requirement requirement;
  requirement.name = kEvil;
  requirement.targets = {{"mu", validate::Target::Measure::sd, 5e-4}};
  for (const validate::Verdict verdict :
       {validate::Verdict::reached, validate::Verdict::missed, validate::Verdict::refused}) {
    validate::Candidate candidate;
    candidate.name = candidate.price_class = candidate.why = kEvil;
    candidate.verdict = verdict;
    candidate.pixels_s = 1e7;
    candidate.results = {{1e-4, 2e-4, 1e-5, 200, 3, kEvil}};
    candidate.limits = {{validate::Limitation::light, 3.0}};
    requirement.candidates.push_back(candidate);
  }
  check_is_text(report::requirement_report(requirement));

  validate::Coverage coverage;
  coverage.replicates = 200;
  coverage.noise_sd_m = {2e-5};
  coverage.levels = {0.95};
  validate::CoverageRow row;
  row.configuration = kEvil;
  row.estimator = "trajectory";
  row.quantity = "mu";
  row.determined = row.covered = 200;
  row.sd = 1e-4;
  row.stated_sd = 1e-5;
  row.levels = {{0.95, 100, 0.5, 0.4, 0.6, 0.0}};
  coverage.rows = {row};
  check_is_text(report::coverage_page(kEvil, coverage));
}

TEST_CASE("the page of a certificate has every name from a file as text") {
  validate::Certificate certificate;
  certificate.runs = 40;
  certificate.clips = 2;
  certificate.estimator = kEvil;
  certificate.together = {110, 120, 0.92, 0.85, 0.96};
  validate::CertifiedQuantity quantity;
  quantity.quantity = "mu";
  quantity.asked = 40;
  quantity.coverage = quantity.wide_coverage = {30, 40, 0.75, 0.6, 0.9};
  quantity.bias_sds = {1.5, 0.1};
  quantity.rms = quantity.stated_sd = 1e-4;
  certificate.quantities = {quantity};
  certificate.setups = {{kEvil, 0.3, 0.1}, {kEvil, 0.3, 0.1}};  // alike: their names tell them apart
  quantity.setup = 1;
  certificate.configurations = {quantity};
  certificate.causes = {kEvil};
  certificate.without = {validate::lacking::Inexpressible{kEvil, kEvil}, validate::lacking::Images{kEvil}};
  certificate.explanations = {{{kEvil}, 0.5, 20, {}}, {{}, 0.5, 20, {}}};
  certificate.changes = {{validate::TwinLimit::cause,
                          {kEvil},
                          40,
                          {{"mu", {0.5, 0.4, 0.6}, true}},
                          validate::RunFall{0.5, 0.4, 0.6},
                          true}};
  check_is_text(report::certificate_page(kEvil, certificate));
}

TEST_CASE("the page of a sweep has every name from a file as text, with its masses") {
  validate::ErrorStatistics statistics;
  statistics.runs = statistics.answered = 400;
  statistics.rms = 1e-3;
  statistics.sd = 1e-4;  // too small, and its intervals too narrow: both are named in words
  statistics.coverage = 0.5;
  const auto series = [&](const std::string& quantity) {
    validate::GroupStatistics other{kEvil, 1.0, statistics};
    other.statistics.rms = 2e-3;
    return validate::Series{quantity, kEvil, {{kEvil, 0.0, statistics}, other}};
  };
  validate::SweepSummary of;
  of.name = kEvil;
  of.runs = of.failed = 400;
  of.planned = 800;
  of.failures.kinds = {{400, true, false, kEvil}};
  of.overall = {series("mu"), series(kEvil)};
  of.accelerations = {{kEvil, kEvil, 10, 0.1, 1.0, 1.2}};
  of.configurations = {{kEvil, {series("mu")}, of.accelerations}, {kEvil, {series("mu")}, of.accelerations}};
  validate::AxisSummary axis;
  axis.name = axis.unit = kEvil;
  axis.words = true;
  axis.labels = {kEvil, kEvil};
  axis.series = {series("mu")};
  axis.of_configurations = {axis.series, axis.series};
  of.axes = {axis};
  validate::MassRow row{kEvil, kEvil, 0.02, 0.0071, {{0.335, 0.0075, 1e-4, 0.999}, {0.535, 0.0071, 1e-4, 0.999}}};
  of.masses = {{row}, {{{kEvil, 0.0075, 0.0051, 0.9996, kEvil}, kEvil, row, {}, {}}}};
  check_is_text(report::sweep_report(of));
}

TEST_CASE("the page of a measured camera has every name from a file as text") {
  core::CameraMeasurement camera;
  camera.folder.name = camera.folder.price_class = kEvil;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.curve = {{kEvil, 0.001, 300.0, 300.0, 125.0, 0.5, 0.0, true},
                  {kEvil, 0.002, 600.0, 600.0, 245.0, 1.0, 0.0, false}};
  camera.saturation_dn = 3600.0;
  check_is_text(report::camera_report(camera));
}

TEST_CASE("the page of blind cases has every name from a file as text") {
  validate::BlindOutcome outcome;
  outcome.kind = validate::BlindKind::single;
  outcome.causes = {{kEvil, 1.0, {}, kEvil, 20.0}};
  outcome.verdict.why = kEvil;
  outcome.verdict.where = {kEvil};
  validate::BlindOutcome named = outcome;
  named.verdict.effects = {{kEvil, 0.9, {kEvil}}};
  report::BlindRun run;
  run.outcomes = {outcome, named};
  run.score.methods = {{validate::DecisionMethod::diagnosis, {1, 1}, {1, 1}, {1, 1}, {}}};
  run.score.left_out = {{validate::VerdictWithout::other_name, {1, 1}}};
  run.score.confusion = {{kEvil, {{kEvil, 1}}}};
  check_is_text(report::blind_page(run));
}

TEST_CASE("the page of a challenge's score has every name from a file as text") {
  validate::ChallengeScore score;
  score.challenge.truth_sha256 = kEvil;
  fit::OutsideTally entrant;
  entrant.name = entrant.command = kEvil;
  entrant.runs = 1;
  for (fit::OutsideTally::Kind& kind : entrant.failures) kind = {1, kEvil};
  score.entrants = {entrant, entrant};
  score.timed = {true, true};
  const validate::ChallengeRow row{0, 1, 1, 1, 0.0, 1.0, 0.0, 1.0, validate::ScoredMean{}, validate::ScoredMean{}, 1};
  score.quantities = {{"mu", {row, row}, {{0, 1, 1, 0, 0, 0.01}}}};
  check_is_text(report::challenge_page(score));
}

TEST_CASE("the page of everyday cases has every name from a file as text") {
  validate::BlindOutcome outcome;
  outcome.causes = {{kEvil, 1.0, {}, kEvil, 20.0}};
  outcome.verdict.why = kEvil;
  outcome.verdict.effects = {{kEvil, 0.9, {kEvil}}};
  outcome.verdict.sequence.explained = {{kEvil, 0.7}};
  outcome.everyday.emplace();
  outcome.everyday->shares = {0.8};
  outcome.everyday->equals = {{kEvil}};
  outcome.everyday->imperfections = {{kEvil, 0.1, kEvil, 0.6, {kEvil}}};
  report::BlindRun run;
  run.outcomes = {outcome};
  run.everyday.emplace();
  validate::EverydayMethod method;
  method.main_first[kEvil][kEvil] = {1, 1};
  run.everyday->methods = {method};
  run.everyday->covered[kEvil][kEvil] = {1, 1};
  run.everyday->calibration[kEvil] = {1, 0.9, 1.0, 0.1};
  run.everyday->cases[kEvil] = 1;
  check_is_text(report::everyday_page(run));
}

TEST_CASE("every page that report can make is among those whose texts are tested here") {
  const std::filesystem::path root = tests::kSourceDir;
  const std::string here = base::read_file(root / "tests/report/html/test_escaping.cpp");
  const std::vector<std::string> pages = tests::pages_of(root / "report");
  for (const std::string& name : pages) {
    INFO(name);
    CHECK(has(here, "report::" + name + "("));
  }
  CHECK(pages.size() >= 11);
}
