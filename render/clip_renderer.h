/// Frames of one clip, one after the other, as the sensor reads them out: for a file, or for a consumer in memory.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "render/clip_motion.h"
#include "render/moving_painter.h"
#include "render/readout.h"
#include "render/scene.h"

namespace glidelab::render {

class ClipRenderer {
 public:
  /// `background_e` is what stands still, in electrons; it and `rays` are shared and outlive this. `stream` keys the
  /// noise (one number a clip).
  ClipRenderer(const Scenario& scenario, const sim::ConfigurationSetup& configuration, const StaticScene& scene,
               const RayTable& rays, const FloatPicture& background_e, std::uint64_t seed, std::uint32_t stream);

  /// Expected electrons of a frame. Valid until the next call; outside `within` they are those of no frame.
  const FloatPicture& expected(const FrameMotion& frame, const PixelRect& within);
  const FloatPicture& expected(const FrameMotion& frame);

  /// Codes of the frame's pixels within `rect`, and no work for others: the same codes as in a whole frame.
  void read(const FrameMotion& frame, const PixelRect& rect, std::span<std::uint8_t> codes);
  void read(const FrameMotion& frame, const PixelRect& rect, std::span<std::uint16_t> codes);

  /// The steps in which the exposure is to be cut: half a pixel of the marker's way.
  double longest_step_m() const { return longest_step_m_; }
  /// What the frames must tell of their motion.
  MotionDetail detail() const { return MotionDetail::parts; }

 private:
  MovingLayer layer_of(const FrameMotion& frame, const MovingBody& body, const PixelRect& within);
  const Scenario& scenario_;
  const sim::ConfigurationSetup& configuration_;
  const StaticScene& scene_;
  const RayTable& rays_;
  const FloatPicture& background_e_;
  FloatPicture expected_e_;
  PixelRect changed_;
  double white_e_ = 0.0;
  double longest_step_m_ = 0.0;
  std::vector<Instant> instants_;
  Readout readout_;
  std::uint32_t stream_ = 0;
};

}  // namespace glidelab::render
