#include "report/diagnosis/words/diagnosis_words.h"

#include <vector>

#include "tests/catch.h"

using diagnose::Explanation;
using namespace glidelab;

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("every kind of note is a sentence, and names what it is of") {
  const std::vector<std::pair<diagnose::Note, std::string>> notes = {
      {diagnose::NoFreeMotion{"up_1", 12}, "Clip up_1"},
      {diagnose::ThinnedPositions{36000, 2, false}, "Of 36000 positions, every second is used"},
      {diagnose::ThinnedPositions{36000, 3, true}, "36000 positions with a recorded force, every third"},
      {diagnose::CutAtTurns{40, 2}, "turns the motion 40 times"},
      {diagnose::SomePieces{90, 60}, "Of 90 pieces"},
      {diagnose::HandLeftOut{17}, "17 frames"},
      {diagnose::HandExplained{18, "end_stop"},
       "18 frames in which a hand or an end stop seems to act are included: soft bumper"},
      {diagnose::SetAside{1000, 0.21}, "21 %"},
      {diagnose::PiecesHeldOut{}, "piece"},
      {diagnose::QuartersHeldOut{}, "quarters"},
      {diagnose::LastingErrors{0.61, 0.2}, "0.61 from one frame to the next, 0.20 to the fourth"},
      {diagnose::StatementsDisagree{"flat", diagnose::Against::plumb, diagnose::Against::stated, 7.04},
       "the stated inclination and that by the plumb line"},
      {diagnose::NoInclination{{"level", "inclined"}}, "Set-ups \"level\", \"inclined\" have neither"},
      {diagnose::NoInclination{{"level"}}, "Set-up \"level\" has neither"},
      {diagnose::SplitSetUps{{"flat"}}, "Clips of set-up \"flat\""},
      {diagnose::OppositeLaunch{"up_1", true}, "launched up"},
      {diagnose::DoubtfulUnit{"cup", core::found::LongRun{9.0}}, "In clip cup, x covers 9 m: check the unit of x"},
      {diagnose::NegativeLoss{diagnose::NegativeLoss::Of::drag, -0.279, 0.004},
       "The fitted drag is below zero (-0.2790 ± 0.0040 N"},
      {diagnose::ContradictedIncline{"flat", diagnose::Against::plumb, 0.1, 0.001, 0.2, 0.001, true, 70.0},
       "by the plumb line"},
      {diagnose::ContradictedReading{0.3, {{0.0, {}, "incline_deg"}, 2.0, 0.1}},
       "With 0.3 kg the acceleration gives an inclination of 2.00 ± 0.10°, but incline_deg says 0°"},
      {diagnose::BeyondGravity{4.0, 12.7, 9.81}, "12.7 m/s², more than gravity"},
      {diagnose::MeanIncline{4.0, 3.9, 0.3}, "stated at 4° corresponds to an inclination of 3.900°"},
      {diagnose::TableOfLines{12}, "The table of 12 lines"},
      {diagnose::OnlyFalls{}, "not determined"},
      {diagnose::ForceReversed{0.0123},
       "First check the sign of force_n: with the recorded force reversed, the nominal "
       "model leaves 1.2 % of the chi²"},
      {diagnose::SuspectedFall{{26, 5.61}}, "at 5.6 m/s²"},
      {diagnose::OfReading{"bead", core::PositionsUnseen{11, 0.0, 0.048}}, "bead: 11 positions that are all 0 m"},
      {diagnose::OneOrigin{}, "one origin"},
      {diagnose::NoMassStated{}, "each kilogram of the true mass"},
      {diagnose::FallsThroughAir{}, "without any drag"},
      {diagnose::FallsThroughAir{7.0}, "alone also prefer it to a viscous drag"},
      {diagnose::FallsThroughAir{1.0}, "do not tell it from a viscous drag"},
      {diagnose::FallsThroughAir{-4.0}, "prefer a viscous drag: the name rests"},
      {diagnose::FallsThroughAir{{}, {{4.85, 11.2}}}, "of 4.85 in place of 11.2: air cannot brake like that."},
      {diagnose::FallsThroughAir{{}, {{3.2, 1.1}}}, "would leave a gap of 3.2 in place of 1.1."},
      {diagnose::OfCamera{{"lens_distortion"}},
       "If a motion sensor measured these positions, lens distortion cannot act: "
       "say so (--recorded-by sensor, or recorded_by in experiment.toml)."},
      {diagnose::OfCamera{{"lens_distortion", "perspective_error"}},
       "lens distortion and pattern off the plane cannot act"},
      {diagnose::SensorPositions{}, "A motion sensor measured the positions"},
      {diagnose::SensorPositions{"Position, Ch 1 (m)"}, "\"Position, Ch 1 (m)\" is how a motion sensor's program"},
      {diagnose::ImpossibleSizes{{"track_bow"}, {{diagnose::NegativeLoss::Of::friction, -0.536, 0.012}}, {"track_bow"}},
       "The likeliest explanation, bowed track, cannot be right and is not named: with it, µ = -0.536 ± 0.012 would "
       "drive the glider and the size of bowed track is at the limit of the range searched."},
      {diagnose::BuoyancyLooksAlike{0.9, true},
       "here as in a fluid with 0.9 of the density of the body, and drags are then 0.1 times those given."},
      {diagnose::BuoyancyLooksAlike{0.163}, "0.16 of the density of the body"},
      {diagnose::FitsCutOff{{{{"tether"}, false}, {{"lens_distortion"}, true}}},
       "The fits of tightening cable and lens distortion + an unnamed cause stopped at the limit on steps, before a "
       "minimum; these explanations may account for more"}};
  std::vector<bool> seen(std::variant_size_v<diagnose::AnyNote>, false);
  for (const auto& [note, part] : notes) {
    const std::string words = report::note_words(note);
    INFO(words);
    CHECK(contains(words, part));
    CHECK(words.ends_with("."));
    seen[note.index()] = true;
  }
  for (std::size_t kind = 0; kind < seen.size(); ++kind) {
    INFO("kind " << kind);
    CHECK(seen[kind]);
  }
}

TEST_CASE("an explanation has the id that files have had: effects joined by plus signs, what has no name last") {
  CHECK(report::explanation_id({}) == "none");
  CHECK(report::explanation_id({{}, true}) == "unknown");
  CHECK(report::explanation_id({{"tether"}}) == "tether");
  CHECK(report::explanation_id({{"scale_error", "tether"}}) == "scale_error + tether");
  CHECK(report::explanation_id({{"scale_error"}, true}) == "scale_error + unknown");
}

TEST_CASE("an explanation of several effects has the short name of each, with its id beside them") {
  const Explanation both{{"quadratic_drag", "tether"}, true};
  CHECK(report::explanation_name(both) == "quadratic drag + tightening cable + an unnamed cause");
  CHECK(report::explanation_html({{"tether"}}) == "tightening cable <small><code>tether</code></small>");
  CHECK(report::explanation_html({{"<b>"}}) == "&lt;b&gt;");
}

TEST_CASE("a probability for a person is never 0 % or 100 %") {
  CHECK(report::percent(0.874) == "87 %");
  CHECK(report::percent(0.9951) == "more than 99 %");
  CHECK(report::percent(0.0049) == "less than 1 %");
}
