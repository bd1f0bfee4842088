/// Frames of one clip, one after the other, as the sensor reads them out: for a file, or for a consumer in memory.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "render/paint/moving_painter.h"
#include "render/paint/shaken_picture.h"
#include "render/scenario/clip_motion.h"
#include "render/scenario/scene.h"
#include "render/sensor/readout.h"

namespace glidelab::render {

class ClipRenderer {
 public:
  /// `background_e` is what stands still, in electrons; it and `rays` are shared and outlive this. `stream` keys the
  /// noise (one number a clip). `fine` is what a camera that moves needs besides, else nothing.
  ClipRenderer(const Scenario& scenario, const sim::ConfigurationSetup& configuration, const StaticScene& scene,
               const RayTable& rays, const FloatPicture& background_e, std::uint64_t seed, std::uint32_t stream,
               const FinePicture* fine = nullptr);

  /// Expected electrons of a frame. Valid until the next call; outside `within` they are those of no frame.
  const FloatPicture& expected(const FrameMotion& frame, const PixelRect& within);
  const FloatPicture& expected(const FrameMotion& frame);

  /// Codes of the frame's pixels within `rect`, and no work for others: the same codes as in a whole frame.
  void read(const FrameMotion& frame, const PixelRect& rect, std::span<std::uint8_t> codes);
  void read(const FrameMotion& frame, const PixelRect& rect, std::span<std::uint16_t> codes);

  /// The steps in which the exposure is to be cut: half a pixel of the marker's path.
  double longest_step_m() const { return longest_step_m_; }
  /// What the frames must tell of their motion.
  MotionDetail detail() const;

 private:
  MovingLayer layer_of(const FrameMotion& frame, const MovingBody& body, const PixelRect& within);
  void instants_of(const FrameMotion& frame, double start_s);
  void add_views(const FrameMotion& frame);
  double pose_time_s(const FrameMotion& frame, std::size_t pose) const;
  void background_of(const FrameMotion& frame, const PixelRect& within);
  void add_reflections(const FrameMotion& frame, bool in_front, const PixelRect& within);

  const Scenario& scenario_;
  const sim::ConfigurationSetup& configuration_;
  const StaticScene& scene_;
  const RayTable& rays_;
  const FloatPicture& background_e_;
  const FinePicture* fine_;
  FloatPicture expected_e_;
  FloatPicture lit_e_;  ///< with the flicker; empty without
  PixelRect changed_;
  double white_e_ = 0.0;
  double longest_step_m_ = 0.0;
  std::vector<FocusSample> samples_;    ///< of the lens; empty where all is sharp
  std::vector<Instant> instants_;       ///< of one row
  std::vector<Eigen::Affine3d> views_;  ///< of one frame: pose by pose, sample by sample
  std::size_t poses_ = 1;
  Readout readout_;
  std::uint32_t stream_ = 0;
};

}  // namespace glidelab::render
