#include "report/diagnosis/words/verdict_words.h"

#include <numbers>
#include <utility>

#include "report/diagnosis/words/diagnosis_words.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

diagnose::Diagnosis with_incline(double before) {
  diagnose::Diagnosis of;
  of.verdict = diagnose::Verdict::unknown;
  of.unknown = 0.99;
  of.gap.emplace();
  of.gap->before = of.gap->after = before;
  of.gap->standard_error = 0.03;
  of.limits.contradicted = {{"inclined", diagnose::Against::stated, 14.0 * kDegree, 0.05 * kDegree, 4.001 * kDegree,
                             0.004 * kDegree, false, 199.4}};
  return of;
}

}  // namespace

TEST_CASE(
    "a diagnosis of positions unusually far apart begins with the unit to check, of one above gravity with the scale") {
  diagnose::Diagnosis of;
  of.verdict = diagnose::Verdict::none;
  of.none = 0.99;
  CHECK_FALSE(contains(report::verdict_words(of), "First"));
  const auto words = [&](const core::Found& found) {
    of.notes = {diagnose::OnlyFalls{}, diagnose::DoubtfulUnit{"cup", found}};
    return report::verdict_words(of);
  };
  CHECK(words(core::found::LongRun{9.0}).starts_with("First check the unit of x"));
  CHECK(contains(words(core::found::LongRun{9.0}),
                 "(cup: x covers 9 m). In another unit, nothing below holds. As far as"));
  CHECK(words(core::found::SlowFrames{1.5}).starts_with("First check the unit of the times"));
  const std::string above = words(core::found::FallAboveGravity{1.1 * 9.80665, 9.80665});
  CHECK(above.starts_with("First measure the scale again"));
  CHECK(contains(above, "10 % above gravity: x is 10 % too long, or the frames are 5 % longer than stated). Drag"));
  const std::string slow = words(core::found::FallsSlowly{{{2.05, 0.13}, 9.80665}});
  CHECK(slow.starts_with("First find out why it falls so slowly (cup: the line of this fall begins with 2.05 ± 0.13"));
  CHECK(contains(slow, "If a liquid bears part of its weight, they hold as well, and drags are too large"));
  CHECK(contains(slow, "far below gravity. The body may have reached its final speed"));
  CHECK(contains(slow, "the times may be those of a slow-motion playback (2.2 times)"));
  const std::string sinks = words(core::found::FallsSlowly{{{0.0205, 0.0013}, 9.80665}});
  CHECK_FALSE(contains(sinks, "slow-motion"));
  CHECK(contains(sinks, "a larger unit than stated (480 times)"));
}

TEST_CASE("a diagnosis of a bent path begins with the path") {
  diagnose::Diagnosis of;
  of.verdict = diagnose::Verdict::none;
  of.none = 0.99;
  of.notes = {diagnose::OfReading{"ball", core::PathBends{0.02, 2.0}}};
  CHECK_FALSE(contains(report::verdict_words(of), "First"));
  of.notes = {diagnose::OfReading{"ball", core::PathBends{0.02, 6.3}}};
  CHECK(
      report::verdict_words(of).starts_with("First find out whether the track is straight: in ball, the direction of "
                                            "the path in x and y changes by 6.3°."));
}

TEST_CASE("what is not ruled out is neither claimed nor called explained") {
  diagnose::Diagnosis open;
  open.verdict = diagnose::Verdict::none;
  open.none = 0.30;
  open.ranking.push_back({{{"late_release"}}, 0.46, 2.9, 4.0, 1, {}});
  const std::string words = report::verdict_words(open);
  CHECK(contains(words, "It is uncertain whether anything is missing"));
  CHECK(contains(words, "“nothing missing” (30 %) cannot be excluded"));
  CHECK(contains(words, "late release (46 %)"));
  open.traces = {"position_rounding"};
  CHECK(report::verdict_words(open).starts_with("It is uncertain whether anything is missing"));
  open.traces.clear();
  CHECK_FALSE(contains(words, "nothing is missing"));
  open.none = 0.35;
  open.ranking.front().probability = 0.26;
  const std::string rather = report::verdict_words(open);
  CHECK(contains(rather,
                 "cannot exclude other causes, but no known effect is as likely as nothing being missing (35 %)"));
  CHECK(contains(rather, "the likeliest is late release (26 %)"));
  open.none = 0.9;
  open.ranking.front().probability = 0.05;
  CHECK(contains(report::verdict_words(open), "nothing is missing"));
}

TEST_CASE("effects that look the same are named as one set, an effect that stands alone by itself") {
  diagnose::Diagnosis of;
  of.verdict = diagnose::Verdict::effect;
  of.effects = {{"scale_error", diagnose::Stage::optics, "a wrong length scale", 0.30, {}, {}, 0.30, {}}};
  CHECK(report::verdict_words(of).starts_with("The data show a wrong length scale (scale_error, 30 %)."));
  of.effects.front().joint_probability = 0.98;
  of.effects.front().alike = {{"direction_asymmetry", "an uneven friction", 0.49},
                              {"scale_error", "a wrong length scale", 0.30},
                              {"frame_rate_error", "a wrong frame rate", {}}};
  CHECK(report::verdict_words(of).starts_with(
      "The data show one of these three (98 % together), but cannot tell which: an uneven friction "
      "(direction_asymmetry, 49 %), a wrong length scale (scale_error, 30 %), or a wrong frame rate "
      "(frame_rate_error)."));
  // Many that may be it are no list that anybody reads.
  diagnose::Diagnosis many = of;
  for (int k = 0; k < 6; ++k) many.effects.front().alike.push_back({"tether", "a cable", 0.03});
  const std::string words = report::verdict_words(many);
  CHECK(contains(words, "one of these nine (98 % together)"));
  CHECK(contains(words, "a cable (tether, 3 %), or one of four others."));
  // Of 83 %, 82 % leave no doubt which.
  of.effects.front().probability = 0.82;
  of.effects.front().joint_probability = 0.83;
  CHECK(report::verdict_words(of).starts_with(
      "The data show a wrong length scale (scale_error, 82 %; 83 % together with what these data cannot distinguish "
      "from it)."));
}

TEST_CASE("a stated inclination that the motion contradicts is said first, with both angles") {
  const diagnose::Diagnosis at_floor = with_incline(1.02);
  CHECK(report::verdict_words(at_floor).starts_with(
      "The inclination of set-up \"inclined\" is 14.00 ± 0.05° as stated, and the motion gives 4.001 ± 0.004° by the "
      "nominal model (199 standard deviations apart). The nominal model explains the motion to within its noise"));
  // Where the motion itself is not explained, that comes first and the statement last.
  const std::string off = report::verdict_words(with_incline(5.0));
  CHECK(off.starts_with("Something is missing"));
  CHECK(contains(off, "as stated, and the motion gives 4.00° by the nominal model, which leaves out what is missing."));
}

TEST_CASE("a contradicted statement heads names that resolve it, where the nominal model follows the motion") {
  diagnose::Diagnosis of = with_incline(1.02);
  of.verdict = diagnose::Verdict::effect;
  of.unknown = 0.0;
  of.limits.resolved = std::exchange(of.limits.contradicted, {});
  of.effects = {{"rotational_inertia", diagnose::Stage::dynamics, "added inertia", 0.94, {}, {}, 0.94, {}}};
  CHECK(report::verdict_words(of).starts_with("The inclination of set-up \"inclined\" is 14.00 ± 0.05° as stated"));
  CHECK(contains(report::verdict_words(of), "may only make up for it. The data show added inertia"));
  of.gap->before = 5.0;  // the names explain a gap
  CHECK(report::verdict_words(of).starts_with("The data show added inertia"));
}

TEST_CASE("an angle of the nominal model has no standard deviation where something is missing, in notes neither") {
  diagnose::Diagnosis of = with_incline(5.0);
  of.limits.contradicted.push_back(of.limits.contradicted.front());
  of.limits.contradicted.back().group = "second";
  of.notes = {of.limits.contradicted.front(), of.limits.contradicted.back()};
  CHECK(contains(report::verdict_words(of), "The motion also contradicts what is stated of 1 more set-up."));
  CHECK_FALSE(contains(report::verdict_words(of), "second"));
  for (const std::string& note : report::notes_words(of)) CHECK_FALSE(contains(note, "4.001"));
  of.verdict = diagnose::Verdict::none;
  for (const std::string& note : report::notes_words(of)) CHECK(contains(note, "4.001 ± 0.004°"));
  of.verdict = diagnose::Verdict::effect;
  of.limits.contradicted.front().named = true;  // with the effects in the model it is an answer
  CHECK(contains(report::note_words(report::as_told(of.limits.contradicted.front(), of)), "4.001 ± 0.004°"));
}

TEST_CASE("a drag or friction below zero is told before the verdict that rests on it alone") {
  diagnose::Diagnosis of = with_incline(1.0);
  of.limits = {};
  of.limits.driving = {{diagnose::NegativeLoss::Of::friction, -0.0114, 0.0003}};
  CHECK(report::verdict_words(of).starts_with("The fitted friction is below zero (-0.01140 ± 0.00030)"));
}

TEST_CASE("where much of the motion is set aside, the summary begins with it") {
  diagnose::Diagnosis of;
  of.none = 0.9;
  of.limits.set_aside = diagnose::SetAside{1000, 0.21};
  CHECK(report::verdict_words(of).starts_with("Of the 1000 positions of the motion, 21 % are excluded"));
  CHECK(contains(report::verdict_words(of), "nothing is missing"));
}

TEST_CASE("a third of the motion set aside leaves the question open, with what to state") {
  diagnose::Diagnosis of = with_incline(1.0);
  of.limits = {};
  of.limits.set_aside = diagnose::SetAside{101, 0.49};
  of.unknown = 1.0;
  const std::string words = report::verdict_words(of);
  CHECK(contains(words, "49 % are excluded"));
  CHECK(contains(words, "start_s"));
  CHECK(contains(words, "Whether anything is missing is not known"));
  CHECK_FALSE(contains(words, "holds for the rest"));
  CHECK_FALSE(contains(words, "none of the known effects"));
}

TEST_CASE("only a gap that noise alone makes by chance is within the noise") {
  diagnose::Diagnosis of;
  of.verdict = diagnose::Verdict::none;
  of.gap.emplace();
  of.gap->standard_error = 0.12;
  for (const double probability : {0.34, 0.8}) {
    of.none = probability;
    of.ranking = {{{{"eddy_rolloff"}}, 0.2, 1.0, 1.0, 1, {}}};
    of.gap->before = of.gap->after = 1.1;
    CHECK(contains(report::verdict_words(of), "to within their noise"));
    of.gap->before = of.gap->after = 1.49;
    CHECK_FALSE(contains(report::verdict_words(of), "to within their noise"));
    CHECK(contains(report::verdict_words(of), "hat the nominal model leaves of the"));
    CHECK(contains(report::verdict_words(of), "is more than their noise, but not clearly"));
  }
  of.traces = {"position_rounding"};
  CHECK_FALSE(contains(report::verdict_words(of), "Nothing that matters is missing"));
  of.gap->before = of.gap->after = 1.1;
  CHECK(contains(report::verdict_words(of), "Nothing that matters is missing"));
}

TEST_CASE("a size far beyond what the accelerations lack is not stated as one") {
  diagnose::Diagnosis diagnosis;
  diagnosis.verdict = diagnose::Verdict::unknown;
  diagnosis.unknown = 0.99;
  diagnosis.regions.push_back(
      {diagnose::GapVariable::speed, 0.0, 0.2, 5.0, 190.0, "N", diagnose::GapKind::force, "", 30.0});
  CHECK(contains(report::verdict_words(diagnosis), "Its size cannot be determined from these data"));
  diagnosis.regions.front().lacking.reset();
  CHECK(contains(report::verdict_words(diagnosis), "force of up to 190 N."));
  diagnosis.regions.front().at = 0.15;
  diagnosis.regions.front().size_sd = 20.0;
  CHECK(contains(report::verdict_words(diagnosis), "force of up to 190 ± 20 N at 0.15 m/s."));
}

TEST_CASE("a table of lines that does not tell two effects apart names both with their sizes, and what is left") {
  diagnose::Diagnosis of;
  of.verdict = diagnose::Verdict::effect;
  of.none = 0.01;
  of.effects = {{"load_independent_friction", diagnose::Stage::dynamics, "a dry friction", 0.37, {}, {}, 0.37, {}}};
  of.ranking = {{{{"load_independent_friction"}}, 0.37, 1.0, 1.0, 1, {}}};
  diagnose::LineComparison lines;
  lines.lines = 12;
  lines.either_of = {"load_independent_friction", "smoothing_bias"};
  lines.either_probability = 0.74;
  lines.candidates = {
      {{{"load_independent_friction"}}, {}, 0.37, 1.0, 1.0, 1, {{"force_n", 0.024, 0.001}}, 3.0, 4.0, {}},
      {{{"smoothing_bias"}}, {}, 0.37, 1.0, 1.0, 1, {{"intercept_s2_m_s2", 0.005, 0.001}}, 3.0, 4.0, {}},
      {{}, {}, 0.01, 0.0, 0.0, 0, {}, 12.0, 6.0, {}}};
  of.lines = lines;
  of.gap.emplace();
  of.gap->before = 6.0;
  of.gap->after = 4.0;
  of.gap->standard_error = 0.3;
  const std::string words = report::verdict_words(of);
  CHECK(
      words.starts_with("These 12 lines show one of two effects (74 % together) that these lines cannot distinguish"));
  CHECK(contains(words, "24.0 ± 1.0 mN"));
  CHECK(contains(words, "Even the best explanation leaves 4.0 times"));
  CHECK_FALSE(contains(words, "pattern of the deviations"));
  of.gap->before = 0.8;
  of.gap->after = 0.4;
  CHECK(contains(report::verdict_words(of),
                 "On average no line is off by more than its scatter: the evidence for a cause is in the pattern of "
                 "the deviations."));
}

TEST_CASE("so few clips have no interval, and the reason counts them") {
  diagnose::GapIntervals intervals;
  CHECK(report::too_few_words(intervals).empty());
  intervals.too_few = 1;
  CHECK(report::too_few_words(intervals).starts_with("1 clip cannot show"));
  intervals.too_few = 2;
  CHECK(report::too_few_words(intervals).starts_with("2 clips cannot show"));
}

TEST_CASE("a camera that the images show to drift is told with the verdict, unless its motion is named") {
  diagnose::Diagnosis of;
  of.none = 0.99;
  diagnose::ImageFinding finding;
  finding.fact = diagnose::image::Sway{diagnose::image::Sway::How::drifts, 2.1, 0.0, 0.0012};
  of.images = {finding};
  CHECK(contains(report::verdict_words(of), "The camera drifts: the images show up to 1.2 mm/s along the track"));
  diagnose::Diagnosis named = of;
  named.effects.emplace_back().equivalent_to = {"camera_motion"};
  CHECK_FALSE(contains(report::verdict_words(named), "The camera drifts"));
  std::get<diagnose::image::Sway>(of.images.front().fact).how = diagnose::image::Sway::How::rests;
  CHECK_FALSE(contains(report::verdict_words(of), "The camera drifts"));
}
