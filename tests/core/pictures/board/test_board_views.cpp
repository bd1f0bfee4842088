#include "core/pictures/board/board_views.h"

#include <algorithm>
#include <string>

#include "tests/catch.h"
#include "tests/core/notes.h"

using namespace glidelab;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;

namespace {

core::KeptViews kept_of(const std::vector<double>& errors_px) {
  std::vector<core::BoardView> views(errors_px.size());
  for (std::size_t i = 0; i < views.size(); ++i) views[i].file = "folder/view-" + std::to_string(i) + ".png";
  std::vector<const core::BoardView*> all;
  for (const core::BoardView& view : views) all.push_back(&view);
  core::KeptViews kept = core::without_outliers(all, errors_px);
  CHECK(std::all_of(kept.views.begin(), kept.views.end(),
                    [&](const core::BoardView* view) { return std::find(all.begin(), all.end(), view) != all.end(); }));
  return kept;
}

}  // namespace

TEST_CASE("a view that is off the camera is left out and named, where three others remain") {
  const core::KeptViews kept = kept_of({0.05, 0.06, 2.0, 0.05});
  CHECK(kept.views.size() == 3);
  REQUIRE(kept.notes.size() == 1);
  const auto* const dropped = tests::note_of<core::OutlyingView>(kept.notes);
  REQUIRE(dropped != nullptr);
  CHECK(dropped->file == "view-2.png");
  CHECK(dropped->error_px == 2.0);
  CHECK(dropped->left_out);
}

TEST_CASE("a view that is off a camera of three stays, and its note says so") {
  const core::KeptViews kept = kept_of({0.05, 0.06, 2.0});
  CHECK(kept.views.size() == 3);
  REQUIRE(kept.notes.size() == 1);
  REQUIRE(tests::note_of<core::OutlyingView>(kept.notes) != nullptr);
  CHECK_FALSE(tests::note_of<core::OutlyingView>(kept.notes)->left_out);
}

TEST_CASE("views that are all alike, or all within the corners' noise, are no outliers of each other") {
  CHECK(kept_of({0.9, 1.0, 1.1, 1.2}).notes.empty());
  CHECK(kept_of({0.01, 0.01, 0.01, 0.19}).notes.empty());
}
