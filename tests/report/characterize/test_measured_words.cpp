#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "report/characterize/measured_words.h"
#include "tests/catch.h"

using namespace glidelab;
using Catch::Matchers::Contains;
namespace unmeasured = core::unmeasured;

TEST_CASE("every reason why a camera's number is missing has words, with its limit in their unit") {
  using Shown = unmeasured::NotLinear::Shown;
  const std::string not_linear = ": the codes are not linear in the light";
  const std::vector<std::pair<core::WhyUnmeasured, std::string>> rows = {
      {unmeasured::NoGain{}, "it requires the gain"},
      {unmeasured::DarkLevelCut{0.25}, "25 % of the dark samples are at code 0"},
      {unmeasured::FewPoints{1, true},
       "1 usable point in the diagram; at least 3 are needed: levels above the "
       "quantisation noise and below 70 % of saturation"},
      {unmeasured::FewPoints{2, false}, "2 usable points in the diagram"},
      {unmeasured::FewPoints{2, false}, "(the dark frames show no noise beyond the quantisation)"},
      {unmeasured::PixelsTogether{0.31}, "neighbouring pixels is correlated (0.31)"},
      {unmeasured::FramesTogether{0.4}, "have 40 % of the variance of frames two apart"},
      {unmeasured::NotLinear{Shown::variance_falls}, "the variance does not rise with the mean" + not_linear},
      {unmeasured::NotLinear{Shown::variance_bends, 0.2}, "line over the mean by 20 %" + not_linear},
      {unmeasured::NotLinear{Shown::line_above_dark}, "far above the dark frames' noise" + not_linear},
      {unmeasured::NotLinear{Shown::line_below_zero}, "the dark level below zero" + not_linear},
      {unmeasured::NotLinear{Shown::mean_bends, 0.2}, "line over the exposure by 20 %" + not_linear},
      {unmeasured::UncertainGain{0.4, 0.3}, "it is 0.4 with a standard deviation of 0.3"},
      {unmeasured::BelowQuantisation{}, "hidden by the quantisation: less than 3.2 e-"},
      {unmeasured::NoLargestVariance{}, "no level is brighter"},
      {unmeasured::Knee{0.3}, "the variance is 30 % of the line's"},
      {unmeasured::NotSaturated{}, "more than 3.2 e-, the brightest level"},
      {unmeasured::NoDarkExposures{}, "dark frames at two or more exposures"},
      {unmeasured::NoExposures{}, "with different exposures to the same light"},
      {unmeasured::PatternNotSeen{true}, "noise and quantisation: less than 3.2 e-"},
      {unmeasured::PatternNotSeen{false}, "noise and quantisation: less than 3.2"},
      {unmeasured::NoPattern{}, "fewer than 3 levels show one"},
  };
  std::set<std::size_t> kinds;
  for (const auto& [why, says] : rows) {
    CHECK_THAT(report::why_words({{}, 0.0, {}, why, 3.2}), Contains(says));
    kinds.insert(why.index());
  }
  CHECK(kinds.size() == std::variant_size_v<core::WhyUnmeasured>);
  CHECK(report::why_words({1.0, 0.1}).empty());
}

TEST_CASE("every way to find a camera's number has words of its own") {
  using By = core::HowMeasured::By;
  std::set<std::string> words;
  for (const By by : {By::zero_exposure, By::dark_frames, By::line_at_dark, By::largest_variance, By::largest_code,
                      By::plateau, By::all_levels, By::insignificant}) {
    words.insert(report::how_words({1.0, 0.1, core::HowMeasured{by}}));
  }
  CHECK(words.size() == 8);
  CHECK_FALSE(words.contains(""));
  CHECK(report::how_words({1.0, 0.1, core::HowMeasured{By::one_level, 0.49}}) == "at 49 % of saturation");
  CHECK(report::how_words({1.0, 0.1}).empty());
}

using namespace glidelab;

TEST_CASE("every kind of note on a measured camera is a sentence with its data in per cent") {
  const std::vector<std::pair<core::CameraNote, std::string>> notes = {
      {core::ColourMosaic{}, "colour sensor"},
      {core::BentVariance{0.034}, "by up to 3.4 %"},
      {core::BentMean{0.012}, "by 1.2 %: if a tone curve"},
      {core::CorrelatedPixels{0.0213}, "correlated by 0.021"},
      {core::SuccessiveFramesAlike{0.912}, "91.2 % of the variance"},
      {core::Flicker{0.021, 2, 12}, "by up to 2.1 %, in 2 of 12 levels"},
      {core::CorrelatedDark{0.314}, "correlated by 0.31"},
      {core::ManyOutlyingPixels{}, "More than 1 %"}};
  std::vector<bool> seen(std::variant_size_v<core::CameraNote>, false);
  for (const auto& [note, part] : notes) {
    const std::string words = report::note_words(note);
    INFO(words);
    CHECK(words.find(part) != std::string::npos);
    CHECK(words.ends_with("."));
    seen[note.index()] = true;
  }
  for (std::size_t kind = 0; kind < seen.size(); ++kind) {
    INFO("kind " << kind);
    CHECK(seen[kind]);
  }
}
