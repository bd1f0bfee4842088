#include "render/film/marker_view.h"

#include <fmt/format.h>

#include "base/files/file_io.h"
#include "tests/catch.h"
#include "tests/one_glider.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

/// A camera 2 m before a track, whose image is `width_px` / 480 · 2 m wide.
render::Scenario seen_with(int width_px) {
  const tests::TempDir dir;
  base::write_file(dir / "s.toml", fmt::format(R"(format = 1
name = "view"
[camera]
width_px = {}
height_px = 240
frame_rate_hz = 100.0
exposure_s = 0.001
focal_px = [480.0, 480.0]
position_m = [0.0, 0.05, 2.0]
[marker]
diameter_m = 0.04
)",
                                               width_px) +
                                       tests::one_glider(0.0, 1e-6, 0.0, {{"m1", -0.6, 0.5, 2.4}}));
  return render::read_scenario(dir / "s.toml");
}

}  // namespace

TEST_CASE("a camera that sees the whole motion loses no frame, a narrower one those beyond its edges") {
  const std::vector<render::ClipView> whole = render::views_of(seen_with(640));
  REQUIRE(whole.size() == 1);
  CHECK(whole[0].outside == 0);
  CHECK(whole[0].seen_m == whole[0].moved_m);
  // Level, without friction and next to no drag: 0.5 m/s from -0.6 m on, 2.4 s: 1.2 m.
  CHECK(whole[0].moved_m == Approx(1.2).epsilon(0.02));
  // 240 px are 1 m in a plane 2 m off, 0.5 % less where the marker stands before it: frames of 5 mm, of which the ones
  // beyond ±0.5 m are lost.
  const std::vector<render::ClipView> part = render::views_of(seen_with(240));
  CHECK(part[0].frames == whole[0].frames);
  CHECK(part[0].seen_m == Approx(1.0).margin(0.03));
  CHECK(static_cast<double>(part[0].outside) == Approx((1.2 - part[0].seen_m) / 0.005).margin(2.5));
  CHECK_THAT(render::sentence(part[0]),
             Contains("m1: the marker leaves the image in") && Contains("of the 1.19 m that it moves"));
}
