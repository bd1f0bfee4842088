#include "render/clip_renderer.h"

#include <algorithm>

namespace glidelab::render {

ClipRenderer::ClipRenderer(const Scenario& scenario, const sim::ConfigurationSetup& configuration,
                           const StaticScene& scene, const RayTable& rays, const FloatPicture& background_e,
                           std::uint64_t seed, std::uint32_t stream)
    : scenario_(scenario),
      configuration_(configuration),
      scene_(scene),
      rays_(rays),
      background_e_(background_e),
      expected_e_(background_e),
      white_e_(electrons_of_white(scenario)),
      key_{seed, stream, 0} {
  // At the reference point, which the camera looks at; half a pixel there.
  const double depth =
      (scenario.camera.X_WC.inverse() * marker_position_W(scenario, configuration.body.incline_rad, 0.0)).z();
  longest_step_m_ = 0.5 * std::max(depth, 0.1) / scenario.camera.focal_px.maxCoeff();
}

const FloatPicture& ClipRenderer::expected(const FrameMotion& frame) {
  for (int y = changed_.y; y < changed_.y + changed_.height; ++y) {
    const std::span<const float> from = background_e_.row(y, changed_.x, changed_.width);
    std::copy(from.begin(), from.end(), expected_e_.row(y, changed_.x, changed_.width).begin());
  }
  const MovingBody body = glider(scenario_, scene_, configuration_.body, frame.middle.x_m);
  const MovingLayer layer = paint(scenario_.camera, rays_, body, frame.x_m);
  put_over(layer, static_cast<float>(white_e_), expected_e_);
  changed_ = layer.rect;
  return expected_e_;
}

void ClipRenderer::read(const FrameMotion& frame, const PixelRect& rect, std::span<std::uint8_t> codes) {
  key_.frame = static_cast<std::uint32_t>(frame.frame);
  read_out(scenario_.sensor, expected(frame), key_, rect, codes);
}
void ClipRenderer::read(const FrameMotion& frame, const PixelRect& rect, std::span<std::uint16_t> codes) {
  key_.frame = static_cast<std::uint32_t>(frame.frame);
  read_out(scenario_.sensor, expected(frame), key_, rect, codes);
}

}  // namespace glidelab::render
