#include "render/film/clip_renderer.h"

#include <fmt/format.h>

#include <map>

#include "tests/catch.h"
#include "tests/render/made_clip.h"

using namespace glidelab;
using namespace glidelab::render;
using namespace glidelab::render::tests;

namespace {

std::string text(const std::string& sections, const std::string& camera = "") {
  return fmt::format(
      "{}\n[camera]\nwidth_px = 160\nheight_px = 120\nframe_rate_hz = 100.0\nexposure_s = 0.004\nfocal_px = [200.0, "
      "201.0]\nposition_m = [0.02, 0.05, 2.2]\ndistortion = {{ k1 = -0.1, p1 = 0.001 }}\n{}\n[calibration]\n"
      "inner_corners = [4, 3]\nsquare_m = 0.05\nviews = 3\n[marker]\ndiameter_m = 0.05\n[[configuration]]\nname = "
      "\"m\"\nmass_kg = 0.3\nincline_deg = 0.0\n[[configuration.clip]]\nname = \"c\"\nlaunched = \"down\"\nx0_m = "
      "-0.1\nv0_m_s = 1.5\nduration_s = 0.08\n",
      sections, camera);
}

}  // namespace

TEST_CASE("A region holds the very codes that the whole frame holds there") {
  const std::map<std::string, std::string> cameras = {
      {"plain", text("")},
      {"rolling", text("", "[shutter]\nkind = \"rolling\"\nline_readout_s = 5e-5\n")},
      {"vignetting", text("[vignetting]\ncos4 = true\n")},
      {"focus", text("[focus]\nf_number = 1.4\nfocus_distance_m = 1.0\npixel_pitch_m = 2e-5\n")},
      {"flicker", text("[light]\nflicker_depth = 0.5\nflicker_hz = 120.0\n[[light.reflection]]\nposition_m = [-0.1, "
                       "0.0, 0.0]\nin_front = true\n")},
      {"mount", text("[[mount.motion]]\naxis = \"pan\"\namplitude_deg = 0.5\nfrequency_hz = 40.0\n")},
      {"rolling mount", text("[[mount.motion]]\naxis = \"x\"\namplitude_m = 0.003\nfrequency_hz = 40.0\n",
                             "[shutter]\nkind = \"rolling\"\nline_readout_s = 5e-5\n")},
      {"colour", text("[sensor]\ncolour = \"bayer\"\nprnu = 0.02\n")},
  };
  for (const auto& [name, one] : cameras) {
    const MadeClip clip(scenario_of(one));
    const PixelRect all{0, 0, 160, 120};
    ClipRenderer near = clip.renderer();
    std::vector<std::uint8_t> whole(160 * 120);
    clip.each_frame([&](const FrameMotion& frame, ClipRenderer& renderer) {
      renderer.read(frame, all, std::span<std::uint8_t>(whole));
      const auto marker = marker_in_image(clip.scenario, clip.configuration.body, frame).value();
      // Around the marker, not aligned with anything; and a corner in which the glider is not.
      const int u = static_cast<int>(marker.center_px.x()) - 13;
      const int v = static_cast<int>(marker.center_px.y()) - 9;
      for (const PixelRect& rect : {intersection(all, {u, v, 27, 19}), PixelRect{131, 3, 29, 11}}) {
        std::vector<std::uint8_t> codes(static_cast<std::size_t>(rect.width) * rect.height);
        near.read(frame, rect, std::span<std::uint8_t>(codes));
        int different = 0;
        for (int y = 0; y < rect.height; ++y) {
          for (int x = 0; x < rect.width; ++x) {
            different += codes[static_cast<std::size_t>(y) * rect.width + x] !=
                         whole[static_cast<std::size_t>(rect.y + y) * 160 + rect.x + x];
          }
        }
        CAPTURE(name, frame.frame, rect.x, rect.y);
        CHECK(different == 0);
      }
    });
  }
}
