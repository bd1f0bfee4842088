#include "diagnose/verdict/verdict_details.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <numbers>
#include <utility>
#include <variant>

#include "base/errors.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/verdict/diagnose.h"
#include "diagnose/verdict/settled_motions.h"
#include "diagnose/verdict/verdict.h"
#include "diagnose/weigh/hypotheses.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"
#include "tests/temp_dir.h"

using namespace glidelab;

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

diagnose::Diagnosis diagnosed(const tests::MadeExperiment& made) {
  return diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Two masses with two launches each, on one inclination of 4 degrees.
std::vector<tests::MadeLaunch> inclined_launches() {
  return {{0.335, 4.0, 0.3, -1.1}, {0.335, 4.0, -0.6, 1.2}, {0.535, 4.0, 0.3, -0.9}, {0.535, 4.0, -0.6, 0.7}};
}

void state(core::ClipSetup& setup, double degrees, double sd_degrees) {
  setup.incline_rad = degrees * kDegree;
  setup.incline_sd_rad = sd_degrees * kDegree;
}

}  // namespace

TEST_CASE("readings of one group belong to one set-up as long as they agree, and each counts") {
  tests::MadeExperiment made = tests::made_experiment(inclined_launches(), {}, 1, 3e-5, 60);
  state(made.setups[0], 4.0, 0.05);
  state(made.setups[1], 4.1, 0.05);
  state(made.setups[2], 4.0, 0.05);
  state(made.setups[3], 4.0, 0.2);
  const diagnose::TrackSet one = diagnose::track_set(made.results, made.setups, true);
  REQUIRE(one.groups.size() == 1);
  CHECK(one.groups[0].statements.size() == 3);  // the third clip repeats that of the first

  state(made.setups[1], 6.0, 0.05);
  const diagnose::TrackSet apart = diagnose::track_set(made.results, made.setups, true);
  REQUIRE(apart.groups.size() == 2);
  CHECK(apart.motions[0].group == 0);
  CHECK(apart.motions[1].group == 1);
  REQUIRE(apart.groups[1].statements.size() == 1);
  CHECK(apart.groups[1].statements[0].alpha_rad == 6.0 * kDegree);

  // A group of the same name in another folder is another set-up, with a plumb line of its own.
  state(made.setups[1], 4.1, 0.05);
  made.results.clips[1].experiment = "other";
  core::PlumbResult plumb;
  plumb.group = "inclined";
  plumb.plumb_deg.estimate = {.value = 4.2, .sd = 0.1};
  plumb.experiment = "other";
  made.results.plumbs.push_back(plumb);
  const diagnose::TrackSet folders = diagnose::track_set(made.results, made.setups, true);
  REQUIRE(folders.groups.size() == 2);
  CHECK(folders.groups[0].statements.size() == 2);
  REQUIRE(folders.groups[1].statements.size() == 2);
  CHECK(folders.groups[1].statements[0].against == diagnose::Against::plumb);
  CHECK(folders.groups[1].statements[1].alpha_rad == 4.1 * kDegree);
}

TEST_CASE("the inclination by everything else is the one that a fit without the statement finds") {
  tests::MadeExperiment made = tests::made_experiment(inclined_launches(), {}, 2, 3e-4);
  for (core::ClipSetup& setup : made.setups) state(setup, 4.02, 0.02);
  const diagnose::TrackSet with = diagnose::track_set(made.results, made.setups, true);
  const auto pulls = diagnose::statement_pulls(with, diagnose::fit_nominal(with));
  REQUIRE(pulls.size() == 1);
  for (core::ClipSetup& setup : made.setups) setup.incline_sd_rad.reset();
  const diagnose::TrackSet without = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit fit = diagnose::fit_nominal(without);
  const double sd = std::sqrt(diagnose::common_covariance(fit)(2, 2));
  // Both are the minimum of one chi², to within the stopping rule (a change by a thousandth: 0.03 standard deviations)
  // and the curvature in alpha over 0.02 degrees.
  CHECK(std::abs(pulls[0].else_rad - fit.at.global[2]) < 0.05 * sd);
  CHECK(std::abs(pulls[0].else_sd_rad - sd) < 0.02 * sd);
  REQUIRE(pulls[0].z);
  CHECK(std::abs(*pulls[0].z - (4.02 * kDegree - fit.at.global[2]) / std::hypot(0.02 * kDegree, sd)) < 0.05);
}

TEST_CASE("a stated inclination that the motion contradicts is reported first, with both angles") {
  tests::MadeExperiment made = tests::made_experiment(inclined_launches(), {}, 3);
  for (core::ClipSetup& setup : made.setups) state(setup, 14.0, 0.05);
  const auto diagnosis = diagnosed(made);
  CHECK(diagnosis.verdict == diagnose::Verdict::unknown);
  REQUIRE(diagnosis.limits.contradicted.size() == 1);
  const diagnose::ContradictedIncline& incline = diagnosis.limits.contradicted.front();
  CHECK(incline.group == "inclined");
  CHECK(incline.against == diagnose::Against::stated);
  CHECK(std::abs(incline.stated_rad - 14.0 * kDegree) < 1e-12);
  CHECK(std::abs(incline.stated_sd_rad - 0.05 * kDegree) < 1e-12);
  CHECK(incline.motion_sd_rad < 0.01 * kDegree);
  CHECK(std::abs(incline.motion_rad - 4.0 * kDegree) < 5.0 * incline.motion_sd_rad);
  CHECK(only_statements_fail(diagnosis));
  CHECK(std::count_if(diagnosis.notes.begin(), diagnosis.notes.end(), [](const diagnose::Note& note) {
          return std::holds_alternative<diagnose::ContradictedIncline>(note);
        }) == 1);
  CHECK(std::get<diagnose::Routine>(diagnosis.next) == diagnose::Routine::measure_inclination);
}

TEST_CASE(
    "an inclination without its uncertainty that the accelerations contradict is reported, whatever the verdict") {
  const auto readings = [](const diagnose::Diagnosis& of) {
    return std::count_if(of.notes.begin(), of.notes.end(), [](const diagnose::Note& note) {
      return std::holds_alternative<diagnose::ContradictedReading>(note);
    });
  };
  tests::MadeExperiment made = tests::made_experiment(
      {{0.335, 4.0, -0.6, 1.2}, {0.335, 4.0, 0.5, -1.1}, {0.335, 4.0, -0.6, 1.0}, {0.335, 4.0, 0.4, -1.0}}, {}, 4);
  for (core::ClipSetup& setup : made.setups) setup.incline_sd_rad.reset();
  core::ConfigurationResult found;  // as a table of lines would have it
  found.mass_kg = 0.335;
  found.incline_deg = 4.0;
  found.alpha_deg.estimate = core::Estimate{4.01, 0.03};
  made.results.configurations = {found};
  CHECK(readings(diagnosed(made)) == 0);
  made.results.configurations[0].incline_deg = 1.0;
  const diagnose::Diagnosis diagnosis = diagnosed(made);
  CHECK(readings(diagnosis) == 1);
  made.results.configurations[0].incline_assumed = true;  // nobody has read it
  CHECK(readings(diagnosed(made)) == 0);
  CHECK(diagnosis.verdict == diagnose::Verdict::none);
}

TEST_CASE("for positions without noise nothing is claimed below what a sensor could measure, and a drag is named") {
  // Positions as a simulation writes them, to all digits, and to nine decimal places.
  const std::function<double(double, double)> to_the_ninth = [](double x, double) {
    return 1e-9 * std::round(1e9 * x);
  };
  for (const bool rounded : {false, true}) {
    CAPTURE(rounded);
    tests::MadeEffect effect;
    if (rounded) effect.seen = to_the_ninth;
    const auto nominal = diagnosed(tests::made_experiment(tests::made_launches(), effect, 1, 0.0));
    CHECK(nominal.verdict == diagnose::Verdict::none);
    CHECK(nominal.effects.empty());
    effect.force = [](double, double, double v, double) { return -0.1 * v * std::abs(v); };
    const auto drag = diagnosed(tests::made_experiment(tests::made_launches(), effect, 1, 0.0));
    REQUIRE(drag.verdict == diagnose::Verdict::effect);
    CHECK(drag.effects.front().id == "quadratic_drag");
  }
}

TEST_CASE("friction below zero forbids the verdict that nothing is missing") {
  // Downhill only: an inclination that is stated too small is taken for friction that drives, mu' = (mu cos 4 - sin 4 +
  // sin 3)/cos 3 = -0.0114.
  const double mu =
      (0.006 * std::cos(4.0 * kDegree) - std::sin(4.0 * kDegree) + std::sin(3.0 * kDegree)) / std::cos(3.0 * kDegree);
  tests::MadeExperiment made = tests::made_experiment(
      {{0.335, 4.0, -0.6, 1.2}, {0.335, 4.0, -0.6, 0.6}, {0.535, 4.0, -0.6, 1.0}, {0.535, 4.0, -0.6, 0.5}}, {}, 4);
  CHECK(diagnosed(made).verdict == diagnose::Verdict::none);
  for (core::ClipSetup& setup : made.setups) state(setup, 3.0, 0.05);
  const auto diagnosis = diagnosed(made);
  CHECK(diagnosis.verdict == diagnose::Verdict::unknown);
  CHECK(diagnosis.none == 0.0);
  double sum = diagnosis.unknown;
  for (const auto& ranked : diagnosis.ranking) sum += ranked.probability;
  CHECK(std::abs(sum - 1.0) < 1e-9);
  REQUIRE(diagnosis.limits.driving.size() == 1);
  CHECK(diagnosis.limits.driving.front().of == diagnose::NegativeLoss::Of::friction);
  CHECK(std::abs(diagnosis.limits.driving.front().value - mu) < 1e-4);  // to the precision of its error
  CHECK(diagnosis.regions.empty());
  REQUIRE(diagnosis.gap);
  CHECK(diagnosis.gap->before < 1.16);  // as in a nominal experiment: the positions show nothing
  CHECK(diagnosis.gap->after == diagnosis.gap->before);
  CHECK(std::get<diagnose::Routine>(diagnosis.next) == diagnose::Routine::check_statements);
}

TEST_CASE("if a tenth of the motion is set aside, the reader is told how much") {
  const auto made = tests::made_experiment(inclined_launches(), {}, 5, 3e-5, 60);
  diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  CHECK(set.left_out == 0);
  const diagnose::MotionFit fit = diagnose::fit_nominal(set);
  set.moving = 1000;
  set.left_out = 90;
  CHECK_FALSE(diagnose::limits_of(set, fit).set_aside);
  set.left_out = 210;
  REQUIRE(diagnose::limits_of(set, fit).set_aside);
  CHECK(diagnose::limits_of(set, fit).set_aside->positions == 1000);
  CHECK(std::abs(diagnose::limits_of(set, fit).set_aside->part - 0.21) < 1e-12);
  // Outliers count together with what is left out: 0.19 + 0.81 * 0.05 = 0.23.
  set.left_out = 190;
  for (diagnose::TrackedMotion& motion : set.motions) std::fill_n(motion.outlier.begin(), motion.t_s.size() / 20, 1);
  CHECK(std::abs(diagnose::limits_of(set, fit).set_aside.value().part - 0.2305) < 0.001);
}

TEST_CASE("where a third of the motion is set aside, a rest above its noise does not show that nothing is missing") {
  const auto made = tests::made_experiment(inclined_launches(), {}, 5, 3e-5, 60);
  diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  diagnose::Comparison comparison = diagnose::compare_hypotheses(set, {}, 2);
  set.moving = 1000;
  const auto verdict_with = [&](std::size_t left_out) {
    set.left_out = left_out;
    const diagnose::Diagnosis diagnosis = diagnose::verdict_of(set, comparison, {});
    CHECK(diagnosis.regions.empty());
    return diagnosis.verdict;
  };
  CHECK(verdict_with(320) == diagnose::Verdict::none);
  CHECK(verdict_with(340) == diagnose::Verdict::none);
  for (diagnose::FitMotion& motion : comparison.fits.front().motions) motion.residual *= 1.5;  // a gap of 1.5
  CHECK(verdict_with(320) == diagnose::Verdict::none);
  CHECK(verdict_with(340) == diagnose::Verdict::unknown);
}

TEST_CASE("too little motion is reported clip by clip, with the files") {
  tests::MadeExperiment made = tests::made_experiment({{0.4, 4.0, 0.3, -1.1}}, {}, 1, 3e-5, 10);
  const tests::MadeEffect held = {{}, [](double, double) { return 0.25; }};
  const tests::MadeExperiment still = tests::made_experiment({{0.4, 4.0, 0.3, -1.1}}, held, 1, 0.0);
  made.results.clips.push_back(still.results.clips.front());
  made.results.clips.back().name = "still";
  made.setups.push_back(still.setups.front());
  made.setups.back().track = "still.csv";
  try {
    diagnosed(made);
    FAIL("ten positions show no noise beside five parameters");
  } catch (const base::InputError& error) {
    REQUIRE(error.issues().size() == 2);
    CHECK(error.issues()[0].file == "none.csv");
    CHECK(error.issues()[0].key == "clip \"clip0\"");
    CHECK(error.issues()[0].found == "10 positions of free motion");
    CHECK(error.issues()[1].file == "still.csv");
    CHECK(error.issues()[1].found == "nothing that moves freely");
    CHECK(contains(error.issues()[1].expected, "at least 11"));
  }
}

TEST_CASE("of clips without a free motion no number of positions is asked for") {
  const tests::MadeEffect held = {{}, [](double, double) { return 0.25; }};
  tests::MadeExperiment still = tests::made_experiment({{0.4, 4.0, 0.3, -1.1}}, held, 1, 0.0);
  // A centimetre over the whole clip, one step of it at its middle: neither rest nor a motion.
  for (core::MotionPoint& point : still.results.clips[0].motion) {
    if (point.measured_m && point.t_s > 0.7) *point.measured_m += 0.01;
  }
  CHECK_THROWS_WITH(diagnosed(still), Catch::Contains("nothing that moves freely") && !Catch::Contains("parameters"));
}

TEST_CASE("the middle about which a gradient or a bow is defined is stated for each set-up") {
  // K(x) = 0.93 (1 + 0.1 x) = K (1 + b (x - x_mid)): b = 0.1 / (1 + 0.1 x_mid).
  const tests::MadeEffect gradient = {[](double, double x, double v, double) { return -0.93 * 0.1 * x * v; }, {}};
  const auto made = tests::made_experiment(inclined_launches(), gradient, 6);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  double low = 1e9, high = -1e9;
  for (const diagnose::TrackedMotion& motion : set.motions) {
    for (const double x : motion.x_m) {
      low = std::min(low, x);
      high = std::max(high, x);
    }
  }
  const std::size_t effect = diagnose::effect_index("damping_gradient");
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const auto fit = diagnose::fit_motions(set, {effect}, diagnose::with_effect(set, nominal, effect, {0.05, 0.0}, {}));
  const auto derived = diagnose::derived_parameters(set, fit, effect, {}, {});
  REQUIRE(derived.size() == 1);
  CHECK(derived[0].key == "x_mid_m");
  CHECK(std::abs(derived[0].value - 0.5 * (low + high)) < 1e-12);
  CHECK(derived[0].sd == 0.0);
  const auto b = static_cast<Eigen::Index>(fit.layout->first_of(effect));
  const double sd = std::sqrt(diagnose::common_covariance(fit)(b, b));
  CHECK(sd < 0.01);
  CHECK(std::abs(fit.at.global[b] - 0.1 / (1.0 + 0.1 * derived[0].value)) < 5.0 * sd);

  const auto two = tests::made_experiment(tests::made_launches(), {}, 7, 3e-5, 60);
  const diagnose::TrackSet both = diagnose::track_set(two.results, two.setups, true);
  const std::size_t bow = diagnose::effect_index("track_bow");
  const auto bowed =
      diagnose::linearise_at(both, {bow}, diagnose::with_effect(both, diagnose::fit_nominal(both), bow, {0.0}, {}));
  const auto middles = diagnose::derived_parameters(both, bowed, bow, {}, {});
  REQUIRE(middles.size() == 2);
  for (std::size_t g = 0; g < 2; ++g) {
    CHECK(middles[g].key == "x_mid_m." + both.groups[g].name);
    CHECK(middles[g].value == both.groups[g].x_mid_m);
  }
}

TEST_CASE("the sway of a camera is stated in pixels if they are known and of one size") {
  const auto made = tests::made_experiment(inclined_launches(), {}, 8, 3e-5, 60);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const std::size_t sway = diagnose::effect_index("camera_motion");
  diagnose::MotionFit fit = diagnose::fit_nominal(set);
  fit.layout = std::make_shared<const diagnose::ParameterLayout>(set, std::vector{sway});
  const std::vector<diagnose::DiagnosedParameter> known = {{"amplitude_m", 1e-3, 1e-5}};
  CHECK(diagnose::derived_parameters(set, fit, sway, {}, known).empty());  // tracks
  diagnose::ImageEvidence images;
  images.clips.resize(2);
  for (diagnose::FilmedClip& clip : images.clips) clip.px_per_m = 400.0;
  const auto derived = diagnose::derived_parameters(set, fit, sway, images, known);
  REQUIRE(derived.size() == 1);
  CHECK(derived[0].key == "amplitude_px");
  CHECK(std::abs(derived[0].value - 0.4) < 1e-12);
  CHECK(std::abs(derived[0].sd - 0.004) < 1e-12);
  images.clips.back().px_per_m = 500.0;
  CHECK(diagnose::derived_parameters(set, fit, sway, images, known).empty());
}

TEST_CASE("files of one name in two folders are two recordings, whose positions have one origin only by assumption") {
  const tests::TempDir temp;
  const tests::MadeExperiment made = tests::made_experiment(inclined_launches(), {}, 1, 3e-5, 60);
  const auto write = [&](std::size_t clip, const std::string& folder) {
    std::filesystem::create_directories(temp / folder);
    std::ofstream out(temp / folder / "run1.csv");
    out << "t_s,x_m\n";
    for (const core::MotionPoint& point : made.results.clips[clip].motion) {
      if (point.measured_m) out << fmt::format("{},{}\n", point.t_s, *point.measured_m);
    }
    return temp / folder / "run1.csv";
  };
  const auto notes_of = [](const std::vector<std::filesystem::path>& files) {
    const diagnose::DiagnoseOptions how;
    std::vector<core::ClipSetup> setups;
    for (const auto& file : files) setups.push_back(core::read_tracks(file, how.bare).clips.front());
    return diagnose::whole_motions(diagnose::analyze_for_diagnosis(files, how), setups).notes;
  };
  const auto is_told = [](const std::vector<diagnose::Note>& notes) {
    return std::ranges::any_of(notes,
                               [](const auto& note) { return std::holds_alternative<diagnose::OneOrigin>(note); });
  };
  const auto one = write(0, "a"), other = write(1, "b");
  CHECK(is_told(notes_of({one, other})));
  CHECK_FALSE(is_told(notes_of({one})));
}
