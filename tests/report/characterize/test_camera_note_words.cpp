#include "report/characterize/camera_note_words.h"

#include <cstddef>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tests/catch.h"

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
