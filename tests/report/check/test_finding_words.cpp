#include "report/check/finding_words.h"

#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/result/estimate.h"
#include "tests/catch.h"

using namespace glidelab;
using Catch::Matchers::Contains;
using core::LengthUnit;
namespace found = core::found;

namespace {

struct Row {
  core::Found found;
  std::string says, advises;  ///< parts of the words
};

found::AgainstStatedLaunch against_launch() {
  found::AgainstStatedLaunch of;
  of.motion = {-1, {}, 0.75};
  of.launched = "up";
  of.clip = "down-1";
  return of;
}

}  // namespace

TEST_CASE("every kind of finding of a check has words, with its data in the units that people read") {
  found::AgainstStatedLaunch turned = against_launch(), own = against_launch();
  turned.downhill = "-X";
  turned.against = turned.clips = 2;
  own.stated = found::AgainstStatedLaunch::Stated::in_group;
  const core::InclineContradiction plumb{{4.3, 0.3, "the plumb line"}, 0.42, 0.13};
  const std::vector<Row> rows = {
      {core::Note{core::MarkerAtRest{}}, "does not move in this clip", ""},
      {found::NoCamera{"no corners", 2, 9}, "no corners", "found in 2 of 9 images; retake them"},
      {found::NoPatternIn{{"a.png", "b.png"}}, "no pattern is found in a.png, b.png", "or remove them"},
      {found::FewViews{7}, "uses 7 views", "take about a dozen"},
      {found::CornersOff{0.42}, "corners lie 0.42 px (rms) from", "glue the board"},
      {found::LittleCovered{0.375}, "cover 37.5 % of the image", "near the edges"},
      {found::LittleTilt{12.0}, "tilted by at most 12 degrees", "tilt it by 30"},
      {found::PlaneViewsOff{0.5, 0.02}, "lie 0.5 px (rms) from where the camera places them; their noise explains 0.02",
       "retake the plane view"},
      {found::NotTracked{"no marker", true}, "no marker", "check that the file plays"},
      {found::NotTracked{"no column", false}, "no column", "repair the file"},
      {found::FewPositions{17}, "the track has 17 points", "higher rate"},
      {found::FewPositions{17, 342}, "the track has 17 points; another 342 rows are empty",
       "mark the object in every frame"},
      {found::FewSightings{17}, "seen in only 17 frames", "higher rate"},
      {found::SightingsMissing{80, 100}, "seen in 80 of the 100 frames", "nothing hides it"},
      {found::UnseenAtEnd{true, 53, 264, false}, "first seen in frame 53 of 264", "where the hand lets go"},
      {found::UnseenAtEnd{false, 200, 264, false}, "last seen in frame 200 of 264",
       "end the clip where the glider stops"},
      {found::UnseenAtEnd{false, 200, 264, true}, "last seen in frame 200 of 264", ""},
      {found::SmallMarker{4.1}, "the marker is 4.1 px wide", "move closer"},
      {found::LongExposure{0.004, true}, "exposure of 4 ms; exposure_s is less than half", "read the exposure"},
      {found::LongExposure{0.004, false}, "exposure of 4 ms", "read the exposure"},
      {found::Smeared{1.25, 9.0, 12.0, true}, "at its top speed, 1.25 m/s, the marker is smeared by 9 px; it is 12 px",
       "shorten the exposure"},
      {found::Smeared{1.25, 9.0, 12.0, false}, "smeared by up to 9 px", "state exposure_s"},
      {found::OutsidePattern{0.25}, "25 % of the marker's path", "take views"},
      {found::MarkerSaturated{}, "the marker is saturated", "until it is grey"},
      {found::PixelsSaturated{0.1}, "10 % of the pixels are saturated", "shorten the exposure"},
      {found::Dark{0.2}, "reach only 20 % of", "use more light"},
      {found::LittleContrast{0.12}, "by only 12 % of", "behind it"},
      {found::NoisyContrast{4.5}, "is 4.5 times the noise", "less gain"},
      {found::LitFromOneSide{1.5, 0.4, 500.0, true},
       "1.5 px (3 mm) from its outline's centre, and that changes by "
       "±0.4 px (0.8 mm)",
       "light the track evenly"},
      {found::LitFromOneSide{1.5, 0.1, {}, false},
       "centred 1.5 px from its outline's centre, the same along the path "
       "to within ±0.1 px",
       ""},
      {found::ContrastFalls{0.3}, "falls to 30 % of its largest", "move lamps"},
      {found::ShadowEdge{0.123, 0.35, true, true, "up-1", {{120, 131}, {160, 160}}},
       "a shadow's edge lies at x = 0.123 m: the brightness of the marker falls by 35 % downhill within one diameter "
       "(frames 120 to 131, 160 of up-1)",
       "move the lamp"},
      {found::ShadowEdge{-0.2, 0.2, false, false, "up-1", {{7, 9}}},
       "or that of another surface, lies at x = -0.2 m: the brightness around the marker falls by 20 % uphill", "move"},
      {found::LightFalls{0.14, 2e-5, true, found::LightFalls::Towards::right},
       "the light falls by 14 % per metre to the right in the image: it displaces the centroid of the marker "
       "by 0.02 mm at most",
       ""},
      {found::LightFalls{0.14, 2e-5, false, found::LightFalls::Towards::top},
       "the light around the marker falls by 14 % per metre upwards", ""},
      {found::LightFlickers{0.03, 100.0, 20.0, 1e-5},
       "varies by ±3 % at 100 Hz (it looks like 20 Hz at this frame rate), which displaces the marker by up to 0.01 mm",
       "daylight"},
      {found::Interlaced{25.0}, "the film is interlaced", "frame_rate_hz = 50"},
      {found::StrongCompression{1.2}, "120 % larger at the edges", "higher bit rate"},
      {found::OtherRateInFile{30.0, 60.0, true}, "states 30 frames per second, experiment.toml 60",
       "filmed at 60 frames per second: a wrong rate scales every speed"},
      {found::OtherRateInFile{29.97, 240.0, true}, "the file is played at 29.97 frames per second", ""},
      {found::UnevenStamps{1.5, 7, true}, "by 1.5 frames; 7 steps are irregular", "time = \"container\""},
      {found::UnevenStamps{1.5, 7, false}, "by 1.5 frames", ""},
      {found::Jumps{1}, "jumps once by", "faster disk"},
      {found::Jumps{3}, "jumps 3 times by", "faster disk"},
      {found::FramesRepeated{20, 264, 0}, "20 of 264 frames are identical", "adds no frames"},
      {found::FramesRepeated{0, 264, 30, true},
       "the body stands still for a frame 30 times in mid-motion: frames are repeated (the analysis leaves them out)",
       "adds no frames"},
      {found::FramesRepeated{20, 264, 1}, "stands still for a frame once in mid-motion, and 20 of 264",
       "adds no frames"},
      {found::AssumedForFile{1.0, 0.0}, "its mass is taken as 1 kg and its inclination as 0°",
       "use --mass and --incline to state others"},
      {found::AssumedForFile{1.0, {}}, "its mass is taken as 1 kg", "use --mass to state another"},
      {found::AssumedForFile{{}, 0.0}, "its inclination is taken as 0°", "use --incline to state another"},
      {found::NoPlumbAngle{"no line"}, "no line", ""},
      {found::MassesApart{{{"b", 221.0}}, {"a", 0.318}, 100.0},
       "mass_kg of b (221) is 100 or more times that of a "
       "(0.318)",
       "in kilograms"},
      {found::MarkerSizeOff{16.0, 10.0, 0.6, false}, "16 px wide; diameter_m and square_m predict 10 px: 60 % off",
       "measure diameter_m and square_m again"},
      {found::MarkerSizeOff{16.0, 10.0, 0.6, true}, "diameter_m and [scale] predict", "diameter_m and [scale] again"},
      {found::BeyondTrack{0.9, 0.5, {true, false, true}}, "runs 0.9 m, but length_m in [track] is 0.5 m",
       "check square_m, the unit of x in the tracks (metres)"},
      {found::InclineOff{plumb, {false, true, false}, true},
       "an inclination of 0.42 ± 0.13°, but the plumb line says 4.30 ±",
       "the plumb line, gravity_m_s2, [scale], frame_rate_hz (its square enters)"},
      {turned,
       "in 2 of 2 clips the glider moves opposite to the stated launch, most clearly in down-1: it moves "
       "towards -x only: the launch was towards +x, as launched = \"up\" and downhill = \"-X\" say; that is 75 % of",
       "launched of these clips, or downhill in [track]"},
      {own, "launched = \"up\" and no stated downhill", "launched of this clip, or downhill in [group]"},
      {found::LengthInUnit{"square_m", 40.0, LengthUnit::millimetres}, "square_m = 40 looks like millimetres (0.04 m)",
       "state it in metres: square_m = 0.04"},
      {found::LengthInUnit{"length_m", 150.0, LengthUnit::centimetres}, "looks like centimetres (1.5 m)",
       "length_m = 1.5"},
      {found::ScaleInUnit{0.6, LengthUnit::millimetres}, "0.6 looks like pixels per millimetre (600 per metre)",
       "px_per_m = 600"},
      {found::MassInGrams{335.0}, "mass_kg = 335 looks like grams (0.335 kg)", "0.335"},
      {found::TrackInUnit{92.0, LengthUnit::centimetres}, "x covers 92, which looks like centimetres (0.92 m)",
       "divide the column by 100"},
      {found::InclineInRadians{0.07505, 4.3, 4.31},
       "incline_deg = 0.07505 looks like radians (4.3°, and the motion says "
       "4.31°)",
       "incline_deg = 4.3"},
      {found::WrongFrameRate{120.0, 60.0, 4.3},
       "frame_rate_hz = 120 does not fit the motion: with the file's 60 the "
       "inclination is 4.3°",
       "frame_rate_hz = 60"},
      {found::Oscillation{12}, "turns 12 times", "no spring"},
      {found::BeyondGravity{98.0, 9.8, {LengthUnit::centimetres}, false}, "about 98 m/s², 10 times gravity",
       "x may be in centimetres instead"},
      {found::BeyondGravity{490.0, 9.8, {LengthUnit::centimetres, LengthUnit::millimetres}, false}, "50 times gravity",
       "in centimetres or millimetres instead"},
      {found::BeyondGravity{490.0, 9.8, {LengthUnit::centimetres, LengthUnit::millimetres, LengthUnit::inches}, false},
       "50 times gravity", "in centimetres, millimetres or inches instead"},
      {found::BeyondGravity{32.2, 9.8, {LengthUnit::feet}, true}, "3.3 times gravity",
       "in feet (this would be a free fall)"},
      {found::BeyondGravity{19600.0, 9.8, {}, false}, "times gravity", "in another unit instead"},
      {found::FreeFall{1.0, 4.0}, "this is free fall, but incline_deg is 4", "incline_deg = 90"},
      {found::CurvedPath{0.12}, "curved (sagitta 12 % of its length)", "film a straight track"},
      {found::Counted{1.0}, "changes by exactly 1 from row to row: it counts", "--column"},
      {found::Counted{3.14159265}, "changes by 3.14159 from row to row, a multiple of a quarter turn",
       "along a straight line"},
      {found::LostInNoise{0.83, 2.0}, "scatter by 0.83 m (one standard deviation) over a distance of 2 m",
       "followed the body"},
      {found::AtRest{0.0029}, "nothing moves: the positions scatter by 0.0029 m about one place", "followed it"},
      {found::AtRest{}, "nothing moves: all positions are the same", "a body that moves"},
      {found::FallAboveGravity{1.1 * 9.8, 9.8}, "10 % above gravity: x is 10 % too long, or the frames are 5 % longer",
       "the scale again"},
      {found::LongRun{9.0}, "x covers 9 m", "check the unit of x"},
      {found::Pushed{14.9, 1.83}, "until 1.83 s it speeds up by up to 15 m/s²", "start_s = 1.83"},
      {found::SlowFrames{10.0}, "are 10 s apart", "milliseconds"},
      {found::FallsSlowly{{core::estimate(0.7, 0.01, 20.0), 9.8}}, "begins with 0.700 ± 0.010 m/s² at v = 0",
       "which of these it is"},
      {found::SlowSensor{{105, 121, 7}}, "105 of 121 rows repeat the position of the row above", "rate of the sensor"},
      {found::Gaps{0.4, 0.33}, "40 % of its time lies in gaps of up to 0.33 s", "even rate"},
      {found::Interrupted{101.161, 101.36, 1}, "from 101.161 s to 101.36 s it does not move as before and after",
       "let it run freely"},
      {found::Interrupted{1.204, 1.5, 1}, "from 1.204 s to 1.5 s it does not move as before and after: a blow",
       "start_s and end_s"},
      {found::Interrupted{1.204, 1.5, 2}, "before and after, and once more later: a blow", "start_s and end_s"},
      {found::Interrupted{1.204, 1.5, 4}, "before and after, and 3 times more later: a blow", "start_s and end_s"},
      {found::Smoothed{1e-7}, "to 1e-07 of the distance", "as measured"},
  };
  std::set<std::size_t> kinds;
  for (const Row& row : rows) {
    const report::FindingWords words = report::finding_words(row.found);
    CHECK_THAT(words.found, Contains(row.says));
    CHECK_THAT(words.advice, Contains(row.advises));
    CHECK(words.advice.empty() == row.advises.empty());
    kinds.insert(row.found.index());
  }
  CHECK(kinds.size() == std::variant_size_v<core::AnyFound>);
}

TEST_CASE("findings that read the same are one about all their clips, of which at most six are named") {
  std::vector<core::Finding> findings;
  for (int i = 1; i <= 8; ++i) {
    findings.push_back({core::Severity::change,
                        {core::Subject::Part::clips, {"m" + std::to_string(i)}},
                        core::found::SmallMarker{4.1 + 1e-4 * i}});
  }
  findings.push_back({core::Severity::change, {core::Subject::Part::clips, {"m9"}}, core::found::SmallMarker{5.2}});
  const std::vector<report::WordedFinding> worded = report::worded(findings);
  REQUIRE(worded.size() == 2);
  CHECK(worded[0].about == "m1, m2, m3, m4, m5, m6 and 2 more");
  CHECK(worded[1].about == "m9");
}
