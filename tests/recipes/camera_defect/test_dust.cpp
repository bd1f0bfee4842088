#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "render/scenario/scenario_sections.h"
#include "tests/catch.h"
#include "tests/render/made_clip.h"

using namespace glidelab;
using namespace glidelab::render;

namespace {

Scenario filmed_through(const std::string& dust) {
  return render::tests::scenario_of(
      dust +
      "[camera]\nwidth_px = 80\nheight_px = 64\nframe_rate_hz = 100.0\nfocal_px = [100.0, 100.0]\n[sensor]\n"
      "read_noise_e = 0.0\n[[configuration]]\nname = \"m\"\nmass_kg = 0.3\nincline_deg = 0.0\n"
      "[[configuration.clip]]\nname = \"c\"\nlaunched = \"down\"\nx0_m = 0.0\nv0_m_s = 0.5\nduration_s = 0.02\n");
}

std::vector<std::uint8_t> first_frame(const Scenario& scenario) {
  const render::tests::MadeClip clip(scenario);
  std::vector<std::uint8_t> codes;
  clip.each_frame([&](const FrameMotion& frame, ClipRenderer& renderer) {
    if (!codes.empty()) return;
    codes.resize(80 * 64);
    renderer.read(frame, {0, 0, 80, 64}, std::span<std::uint8_t>(codes));
  });
  return codes;
}

}  // namespace

TEST_CASE("behind opaque dust every code is the sensor's offset, and all around it what it is without") {
  const Scenario dusty = filmed_through("[dust]\nx_px = 20.0\ny_px = 12.0\nradius_px = 5.0\npasses = 0.0\n");
  const Scenario clean = filmed_through("");
  const std::vector<std::uint8_t> seen = first_frame(dusty), without = first_frame(clean);
  REQUIRE(seen.size() == without.size());
  int behind = 0, changed = 0;
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 80; ++x) {
      const std::size_t at = static_cast<std::size_t>(y) * 80 + x;
      const bool dark = (x - 20) * (x - 20) + (y - 12) * (y - 12) < 25;
      if (dark) CHECK(seen[at] == clean.sensor.offset_dn);
      if (dark) ++behind;
      if (!dark && seen[at] != without[at]) ++changed;
    }
  }
  CHECK(behind == 69);  // whole numbers x² + y² < 25
  CHECK(changed == 0);
}

TEST_CASE("the truth tells of dust where there is some, and a perfect camera has none") {
  const Scenario dusty = filmed_through("[dust]\nx_px = 20.0\ny_px = 12.0\nradius_px = 5.0\npasses = 0.4\n");
  CHECK(sections_truth(dusty)["dust"]["passes"] == 0.4);
  CHECK_FALSE(sections_truth(ideal_of(dusty)).contains("dust"));
  CHECK(sections_truth(ideal_of(dusty)) == sections_truth(ideal_of(filmed_through(""))));
}
