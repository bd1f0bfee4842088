#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>
#include "report/analysis/note_words.h"
#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("every kind of note of an analysis has words, with its data in the units that people read") {
  using By = core::MarkerConcealed::By;
  using What = core::MarkerMeasuredBy::What;
  core::InclineContradiction one_way{{10.0, {}, "the plumb line"}, 4.712, 0.013};
  one_way.bound = -1;
  const core::InclineContradiction small{{5.0, 0.02, "incline_deg"}, 5.2015, 0.0041};
  core::InclineContradiction beyond{{4.3, 0.3, "incline_deg"}};
  beyond.beyond_gravity = 12.34;
  beyond.gravity_m_s2 = 9.80665;
  const std::vector<std::pair<core::Note, std::string>> notes = {
      {core::FilesSkipped{1}, "one file in the folder of frames is not an image"},
      {core::FilesSkipped{3}, "3 files in the folder of frames are not images"},
      {core::ContainerOfOtherRate{29.97, 200.0, true},
       "states 29.97 frames per second, experiment.toml 200; the rate in experiment.toml is used"},
      {core::ContainerOfOtherRate{29.97, 200.0, false}, "200; the container's time stamps are used, as requested"},
      {core::LastFramesUnstamped{}, "no time stamp"},
      {core::IrregularStamps{2, 37, 0.02, 0.06, true},
       "2 of 37 steps differ from the median step of 20 ms, the longest is 60 ms (frames may be missing"},
      {core::IrregularStamps{2, 37, 0.02, 0.06, false}, "the longest is 60 ms"},
      {core::RepeatedFrames{3, 40}, "3 of 40 frames are identical to the frame before"},
      {core::RepeatsLeftOut{30, 150, false, 60.0},
       "30 of 150 frames repeat the one before and are left out: a converter added them, and the camera's 60 Hz"},
      {core::RepeatsLeftOut{9, 150, true, 0.0}, "they fill in for lost frames, so the other times are right"},
      {core::RepeatsLeftOut{9, 150, false, 0.0}, "the others may be late by a frame"},
      {core::InterlacedFilm{25.0}, "ffmpeg -vf bwdif) and state frame_rate_hz = 50"},
      {core::EvenStamps{0.001, 1.0 / 240.0, 1e-7}, "multiples of 1 ms, and frames evenly spaced by 4.16667 ms"},
      {core::SheetTaken{"Run 1"}, "the table is taken from sheet \"Run 1\""},
      {core::ColumnsTaken{"x (m)", "t (s)", "Run #1"}, "x is \"x (m)\", its time \"t (s)\", Run #1"},
      {core::ColumnsTaken{"x (m)", "t (s)", ""}, "its time \"t (s)\""},
      {core::UnitAssumed{"t", "seconds"}, "\"t\" states no unit and is taken as seconds"},
      {core::HeightTaken{"y (m)"}, "x is \"y (m)\", a height"},
      {core::ForceUnused{"F (N)"}, "\"F (N)\" is not used"},
      {core::MotionAlongY{0.9, 0.012}, "y covers 0.9 m and x only 0.012 m"},
      {core::SlantedPath{12.34, 1.0236, false},
       "an angle of 12.3° with the x axis; positions are taken along the path, from x and y, and distances are 1.02 "
       "times those along x"},
      {core::SlantedPath{12.34, 1.0236, false},
       "this is the inclination (--incline 12.3, or -12.3 where x increases uphill)"},
      {core::SlantedPath{12.34, 1.0236, true}, "with the y axis"},
      {core::SlantedPath{12.34, 1.0236, true}, "(--incline 77.7, or -77.7 where x increases uphill)"},
      {core::CountedAlongMotion{}, "its sign is reversed"},
      {core::RowsIncomplete{1}, "one row within the table lacks a time or x"},
      {core::TimesRepeated{1, 0.4}, "one row repeats the time of the row above, 0.4 s, and is left out"},
      {core::TimesRepeated{3, 0.4}, "3 rows repeat the time of the row above, the first at 0.4 s"},
      {core::ValuesHeld{105, 121, 7}, "a new value only every 7 rows or so"},
      {core::RowsIncomplete{4}, "4 rows within the table lack a time or x"},
      {core::UnlikelyLeftOut{"likelihood", 1, 0.6}, "1 row with a \"likelihood\" below 0.6 is left out"},
      {core::ImageUnitsTaken{60.0, 412.5, false},
       "the times are frame numbers, at 60 frames a second; x is in pixels, 412.5 of them to a metre; no lens"},
      {core::ImageUnitsTaken{0.0, 412.5, true}, "x is in pixels, 412.5 of them to a metre, taken as exact"},
      {core::ImageUnitsTaken{60.0, 0.0, true}, "the times are frame numbers, at 60 frames a second"},
      {core::PositionsUnseen{11, -0.0, 0.048}, "11 positions that are all 0 m, from 0.048 s on, are left out"},
      {core::PositionsScattered{30, 12}, "42 positions at the start (30) and the end (12) are left out"},
      {core::PositionsScattered{0, 12}, "12 positions at the end are left out"},
      {core::PositionsAstray{1, 0.0, 0.3}, "1 position at 0 s is left out: the path jumps to it by up to 0.3 m"},
      {core::PositionsAstray{5, 0.8, 0.4}, "5 positions from 0.8 s on are left out"},
      {core::ColumnsGuessed{"column 1", "column 2", false},
       "\"column 2\" is taken as the time, because it alone increases throughout, and \"column 1\" as x"},
      {core::ColumnsGuessed{"column 2", "column 1", true},
       "\"column 1\" is taken as the time, which another column could be as well, and \"column 2\" as x"},
      {core::OtherAxisUnused{"y (m)", 12.3, 0.004}, "\"y (m)\" is not used: this column was requested alone"},
      {core::PathBends{0.024, 5.04}, "leaves its line by 0.024 m, and its direction changes by 5.0°"},
      {core::RoundedTimes{0.01, 1.0 / 30.0}, "multiples of 0.01 s and taken as even, 0.03333 s apart"},
      {core::NoLengthUnit{}, "no unit of length"},
      {core::PointMassTaken{"cart", "+X", false, true}, "x is the X of point mass \"cart\""},
      {core::PointMassTaken{"cart", "+X", false, false}, "positive towards +X: it moves most along X"},
      {core::PointMassTaken{"ball", "-Y", true, false}, "x is the Y of point mass \"ball\""},
      {core::PointMassTaken{"ball", "-Y", true, false}, "positive towards -Y: it moves most along Y"},
      {core::MassMovesAslant{20.0, 0.0603, false}, "20 degrees with X, so x is 6.0 % short"},
      {core::MassMovesAslant{20.0, 0.0603, true}, "20 degrees with Y"},
      {core::PositionsOutsideClip{1}, "one position that is not among the steps"},
      {core::PositionsOutsideClip{2}, "2 positions that are not among the steps"},
      {core::PositionsFilledIn{1}, "one position that Tracker filled in"},
      {core::PositionsFilledIn{5}, "5 positions that Tracker filled in"},
      {core::AssumedStatements{1.0, true}, "a mass of 1 kg and an inclination of 0° are assumed"},
      {core::AssumedStatements{1.0, false},
       "a mass of 1 kg is assumed, because neither the file nor an option states it (--mass)"},
      {core::AssumedStatements{{}, true},
       "an inclination of 0° is assumed, because neither the file nor an option states it (--incline)"},
      {core::MuFromIncline{20.0, 0.1}, "µ rests on the stated inclination, 20"},
      {small, "incline_deg says 5.000 ± 0.020°: an angle or its uncertainty, a length"},
      {core::GravityAssumed{9.80665, 0.015},
       "gravity of 9.80665 m/s²; their ± includes 0.015 m/s² (0.15 %). State its value at your place"},
      {core::AssumedMass{}, "1 kg is assumed"},
      {core::MayBeAFall{26, 5.61},
       "A hand seems to hold the body in 26 positions, yet it accelerates at 5.6 m/s² there"},
      {core::OutlyingView{"view-2.png", 2.0, true},
       "view-2.png departs from the fitted camera by 2 px and is left out"},
      {core::OutlyingView{"view-2.png", 2.0, false}, "kept, because fewer"},
      {core::NoPatternInSight{{"a.png", "b.png"}}, "in a.png, b.png"},
      {core::UnrefinedCorners{1}, "one corner"},
      {core::UnrefinedCorners{7}, "7 corners"},
      {core::CornersErrTogether{0.31, 0.02}, "share an error of 0.31 px (each has 0.02 px"},
      {core::UncertainFocalLength{812.3, 41.0}, "(812.3 px, sd 41 px)"},
      {core::FisheyePreferred{0.1, 0.1, 2}, "to 0.1 px with Brown-Conrady, which needs 2 more terms for that"},
      {core::FisheyePreferred{0.1, 0.1, 0}, "corners fit to 0.1 px, to 0.1 px with Brown-Conrady"},
      {core::PlaneViewsDisagree{"level", 1.5, 0.05, 1}, "the plane view of group \"level\" does not agree"},
      {core::PlaneViewsDisagree{"level", 1.5, 0.05, 2}, "the plane views of group \"level\" do not agree"},
      {core::MarkerAtRest{}, "does not move"},
      {core::MarkerConcealed{By::similar, 4}, "in 4 frames the marker cannot be distinguished"},
      {core::MarkerConcealed{By::disturbance, 5}, "in 5 frames the marker is partly hidden"},
      {core::MarkerMeasuredBy{What::centroid}, "centroid of its colour"},
      {core::MarkerMeasuredBy{What::shading}, "shading is fitted"},
      {core::MarkerMeasuredBy{What::own_look}, "by its appearance in the other frames"},
      {core::MarkerMeasuredBy{What::own_centre}, "about which that image is unchanged by half a turn"},
      {core::MarkerOfOtherSize{1.25}, "25 % larger"},
      {core::MarkerOfOtherSize{0.75}, "25 % smaller"},
      {core::MarkerFittedAgain{true, false, 260, 200},
       "sphere that is lit from one side in front of what moves with it: it is found in 260 frames, in 200 before"},
      {core::PixelsAnswerLeft{3, 50},
       "the marker's positions are not corrected for the response of the camera's pixels to an edge: in 3 of 50 "
       "frames"},
      {core::PixelsAnswerLeft{3, 50, true}, "3 of 50 frames, in which the fit with that response fails, are left out"},
      {core::MarkerLost{21, 0, 0, 70},
       "in 21 of 70 frames the marker is not found, though it is not at the edge of the image: the first 21"},
      {core::MarkerLost{0, 2, 4, 70}, "2 between its sightings, the last 4"},
      {core::DarkMarker{}, "darker than its surroundings"},
      {core::DiscMarker{}, "as a disc in the plane of motion, not as a sphere"},
      {core::NotOfStatedSize{"no marker"}, "is not found: no marker"},
      {core::NoRay{12}, "12 sightings"},
      {core::SlantedLine{17.2}, "17 degrees"},
      {core::ExactScale{}, "taken as exact"},
      {core::CodecDragSubtracted{0.12}, "by 0.12 px"},
      {core::FramesMissing{1, {0.5}, true}, "1 frame is missing without a gap in the times (after 0.500 s)"},
      {core::FramesMissing{9, std::vector<double>(7, 0.25), false}, "0.250 s, …): the motion jumps"},
      {core::OutliersLeftOut{3, 203}, "3 of 203 positions"},
      {core::CorrelatedNoise{0.314}, "(0.31)"},
      {core::LineScatters{1, 2.34}, "v > 0: the points scatter 2.3 times"},
      {core::NoiseGrowsWithSpeed{1e-4, 2.5e-4}, "0.10 mm at the slowest, 0.25 mm at the fastest"},
      {core::CoarseRounding{0.01, false}, "rounded to 0.01 m and often repeat: the noise is not random"},
      {core::CoarseRounding{0.01, true}, "ordinary lines take their place"},
      {core::GeneralisedLine{-1, 80}, "v < 0: the line is fitted to 80 positions"},
      {core::NoGeneralisedLine{1}, "v > 0: the generalised least squares did not converge"},
      {core::AgainstLaunch{1, 0.542, 0.3, false}, "motion towards +x before 0.542 s"},
      {core::MassInGrams{335.0, 0.335}, "mass_kg = 335, but 0.335 for the lightest glider"},
      {core::MassInGrams{400.0, {}}, "looks like grams (0.4 kg)"},
      {one_way,
       "the acceleration gives an inclination of at most 4.712 ± 0.013°, but the plumb line says 10°: an angle"},
      {beyond, "12.3 m/s² without friction, is more than gravity_m_s2 = 9.80665; incline_deg says 4.30 ± 0.30°"},
      {core::RobustFit{4, 400}, "robust: 4 of 400 positions"},
      {core::NoRun{"the motion turns 4 times", "select one stretch"}, "the motion turns 4 times; select one stretch"},
      {core::SteadyFall{1}, "the body falls at a constant speed, which is the terminal velocity"},
      {core::SteadyFall{3}, "in all 3 clips the body falls at a constant speed"},
      {core::FitScatters{1.234, 17.0, false}, "scatter 1.23 times"},
      {core::FitScatters{1.03, 5.0, true},
       "the motions fitted together differ from one another by more than their noise explains"}};
  std::vector<bool> seen(std::variant_size_v<core::AnyNote>, false);
  for (const auto& [note, part] : notes) {
    const std::string words = report::note_words(note);
    INFO(words);
    CHECK(words.find(part) != std::string::npos);
    seen[note.index()] = true;
  }
  for (std::size_t kind = 0; kind < seen.size(); ++kind) {
    INFO("kind " << kind);
    CHECK(seen[kind]);
  }
  CHECK(report::notes_words({core::MarkerAtRest{}, core::ExactScale{}}).size() == 2);
}

TEST_CASE("a lens is worded by its terms and by the tests that kept or dropped them") {
  core::LensTerms lens;
  lens.kept = {"k1", "k2"};
  lens.tests = {{"k3", 1.234, 9.0}, {"p1, p2", 12300.0, 11.83}};
  CHECK(report::lens_words(lens) ==
        "distortion: k1, k2 (χ² of each term tested, and the threshold to keep it: k3: 1.23 of 9; p1, p2: 12300 of "
        "11.8)");
  CHECK(report::lens_words({false, {}, {{"k1", 2.0, 9.0}}}).starts_with("distortion: none ("));
  CHECK(report::lens_words({true, {"k1"}, {}}) == "fisheye: k1");
  CHECK(report::lens_words({true, {}, {}}) == "fisheye: no terms");
}

using namespace glidelab;

TEST_CASE("every way to choose a bandwidth or a strength has words, with its numbers in the units that people read") {
  namespace by = core::chosen_by;
  using Edge = by::Rule::Edge;
  const std::vector<std::pair<core::StrengthChoice, std::string>> choices = {
      {std::monostate{}, ""},
      {by::User{}, "given"},
      {by::LinesRule{0.0412}, "least mean squared error of the lines (41.2 ms)"},
      {by::LinesRule{0.0412, by::LinesRule::Raised{0.01234, 0.0021}},
       "least mean squared error of the lines (41.2 ms), widened so that the points are less noisy (the noise of a is "
       "1.2 % of its "
       "spread; the lines are biased by 0.21 %)"},
      {by::FirstSmoothing{}, "that of the first smoothing: no bandwidth gives a line"},
      {by::FirstSmoothing{"gcv"}, "that of the first smoothing: the motion is too short for the rule gcv"},
      {by::Rule{"a rule's words"}, "a rule's words"},
      {by::Rule{"from {:.1f} to {:.3g}", {1.25, 2.0 / 3.0}, Edge::none, false}, "from 1.2 to 0.667"},
      {by::Rule{"{:.1f} ms for x", {30.0}, Edge::narrowest, true},
       "30.0 ms for x (the narrowest tried), converted for a"},
      {by::Rule{"{:.1f} ms", {30.0}, Edge::widest, false}, "30.0 ms (the widest tried)"},
      {by::Rule{"{:.1f} ms", {30.0}, Edge::only, false}, "30.0 ms (the only one tried)"},
      {by::Truth{}, "the least error of a(t), by the truth"},
      {by::Likelihood{}, "maximum marginal likelihood"},
      {by::CrossValidation{}, "minimum generalised cross-validation"},
      {by::Nothing{}, "no part of the motion is long enough to be smoothed"}};
  std::vector<bool> seen(std::variant_size_v<core::StrengthChoice>, false);
  for (const auto& [choice, words] : choices) {
    CHECK(report::strength_words(choice) == words);
    seen[choice.index()] = true;
  }
  for (std::size_t kind = 0; kind < seen.size(); ++kind) {
    INFO("kind " << kind);
    CHECK(seen[kind]);
  }
}

TEST_CASE("an inclination of the other sign is told as x that is positive uphill, and no angle is blamed") {
  core::InclineContradiction turned{{4.0, {}, "incline_deg"}, -4.308, 0.004};
  turned.gravity_m_s2 = 9.80665;
  turned.gross = true;
  CHECK(report::note_words(core::Note{turned}) ==
        "the acceleration gives an inclination of -4.3080 ± 0.0040°, but incline_deg says 4°: x seems to be positive "
        "uphill, and has to rise downhill (glidelab check says more)");
}
