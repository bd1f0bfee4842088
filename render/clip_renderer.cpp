#include "render/clip_renderer.h"

#include <algorithm>
#include <cmath>

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
      readout_(scenario.sensor, scenario.recording.exposure_s, seed, scenario.camera.width_px,
               scenario.camera.height_px),
      stream_(stream) {
  // At the reference point, which the camera looks at; half a pixel there.
  const double depth =
      (scenario.camera.X_WC.inverse() * marker_position_W(scenario, configuration.body.incline_rad, 0.0)).z();
  longest_step_m_ = 0.5 * std::max(depth, 0.1) / scenario.camera.focal_px.maxCoeff();
}

const FloatPicture& ClipRenderer::expected(const FrameMotion& frame) {
  return expected(frame, {0, 0, background_e_.width, background_e_.height});
}

const FloatPicture& ClipRenderer::expected(const FrameMotion& frame, const PixelRect& within) {
  for (int y = changed_.y; y < changed_.y + changed_.height; ++y) {
    const std::span<const float> from = background_e_.row(y, changed_.x, changed_.width);
    std::copy(from.begin(), from.end(), expected_e_.row(y, changed_.x, changed_.width).begin());
  }
  const MovingBody body = glider(scenario_, scene_, configuration_.body, frame.middle.x_m);
  const MovingLayer layer = layer_of(frame, body, within);
  put_over(layer, static_cast<float>(white_e_), expected_e_);
  changed_ = layer.rect;
  return expected_e_;
}

MovingLayer ClipRenderer::layer_of(const FrameMotion& frame, const MovingBody& body, const PixelRect& within) {
  if (frame.path.empty()) return paint(scenario_.camera, rays_, body, frame.x_m, within);
  const Recording& recording = scenario_.recording;
  Looks looks;
  looks.views.emplace_back(scenario_.camera.X_WC.inverse());
  looks.first_x_m = frame.path.least_x_m();
  looks.last_x_m = frame.path.largest_x_m();
  looks.of_row = [&](int row) -> std::span<const Instant> {
    const double start_s = frame.start_s + recording.shutter.delay_s(row);
    const double middle_v_m_s = frame.path.v_m_s(start_s + 0.5 * recording.exposure_s);
    const double length_m = std::abs(middle_v_m_s) * recording.exposure_s;
    const std::size_t n = exposure_instants(length_m, longest_step_m_);
    instants_.clear();
    const double share = 1.0 / static_cast<double>(n);
    for (std::size_t k = 0; k < n; ++k) {
      const double t_s = start_s + exposure_instant(k, n) * recording.exposure_s;
      instants_.push_back({0, frame.path.x_m(t_s), share});
    }
    return instants_;
  };
  return paint(scenario_.camera, rays_, body, looks, within);
}

void ClipRenderer::read(const FrameMotion& frame, const PixelRect& rect, std::span<std::uint8_t> codes) {
  readout_.read(expected(frame, readout_.seen_by(rect)), stream_, static_cast<std::uint32_t>(frame.frame), rect, codes);
}
void ClipRenderer::read(const FrameMotion& frame, const PixelRect& rect, std::span<std::uint16_t> codes) {
  readout_.read(expected(frame, readout_.seen_by(rect)), stream_, static_cast<std::uint32_t>(frame.frame), rect, codes);
}

}  // namespace glidelab::render
