/// Clips as read out by the sensor: the frames of one clip in sequence, and all clips of a scenario.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "render/paint/frame_background.h"
#include "render/paint/moving_painter.h"
#include "render/scenario/clip_motion.h"
#include "render/scenario/scene.h"
#include "render/sensor/readout.h"

namespace glidelab::render {

/// Frames of one clip, one after another, as read out by the sensor: for a file, or for a consumer in memory.
class ClipRenderer {
 public:
  /// `background_e` is the static scene, in electrons; it and `rays` are shared and must outlive this object. `stream`
  /// keys the noise (one number per clip). `fine` is needed for a moving camera, otherwise null.
  ClipRenderer(const Scenario& scenario, const sim::ConfigurationSetup& configuration, const StaticScene& scene,
               const RayTable& rays, const FloatImage& background_e, std::uint64_t seed, std::uint32_t stream,
               const FineImage* fine = nullptr);

  /// Expected electrons of a frame. Valid until the next call; outside `within` they are undefined.
  const FloatImage& expected(const FrameMotion& frame, const PixelRect& within);
  const FloatImage& expected(const FrameMotion& frame);

  /// Codes of the frame's pixels within `rect`, without work for others: the same codes as in a whole frame.
  void read(const FrameMotion& frame, const PixelRect& rect, std::span<std::uint8_t> codes);
  void read(const FrameMotion& frame, const PixelRect& rect, std::span<std::uint16_t> codes);

  /// The steps into which the exposure is divided: half a pixel of the marker's path.
  double longest_step_m() const { return longest_step_m_; }
  /// The detail of motion that the frames must provide.
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
  const FloatImage& background_e_;
  const FineImage* fine_;
  FloatImage expected_e_;
  FloatImage lit_e_;  ///< with the flicker; empty without
  PixelRect changed_;
  double white_e_ = 0.0;
  double longest_step_m_ = 0.0;
  std::vector<FocusSample> samples_;    ///< of the lens; empty if everything is sharp
  std::vector<Instant> instants_;       ///< of one row
  std::vector<Eigen::Affine3d> views_;  ///< of one frame: pose by pose, sample by sample
  std::size_t poses_ = 1;
  Readout readout_;
  std::uint32_t stream_ = 0;
};

/// The static scene, drawn for every set-up of the track. It has no noise and does not depend on the motions: clips of
/// one camera share it, whatever their motions, seed, clock, shutter or codec.
struct Stage {
  struct SetUp {
    StaticScene scene;
    FloatImage background_e;        ///< in electrons
    std::optional<FineImage> fine;  ///< if the camera moves
  };
  RayTable rays;                         ///< of the camera as in the clips
  std::map<std::string, SetUp> set_ups;  ///< by group
  /// The background of the pattern in the stills, in electrons; with the first configuration's track.
  FloatImage behind_stills_e;
  std::optional<RayTable> still_rays;  ///< empty if the clips' camera also took the stills

  const RayTable& rays_of_stills() const { return still_rays ? *still_rays : rays; }
};

/// Drawn on up to `jobs` threads. `drawn`, if given, is called after every finished set-up, perhaps from several
/// threads at once.
std::shared_ptr<const Stage> set_stage(const Scenario& scenario, int jobs, const std::function<void()>& drawn = {});

/// The clips of a scenario, to be drawn by any caller: shared data are made once. Not to be moved or copied: renderers
/// refer to it.
class ClipSet {
 public:
  explicit ClipSet(const Scenario& scenario, int jobs = 1, const std::function<void()>& drawn = {});
  /// Uses a stage that was set for this scenario, or for one that differs only in what does not affect a stage.
  /// std::logic_error if the stage lacks one of the scenario's groups.
  ClipSet(const Scenario& scenario, std::shared_ptr<const Stage> stage);
  ClipSet(const ClipSet&) = delete;
  ClipSet& operator=(const ClipSet&) = delete;

  std::size_t size() const { return clips_.size(); }
  const sim::MotionSetup& motion(std::size_t clip) const { return *clips_.at(clip).motion; }
  const sim::ConfigurationSetup& configuration(std::size_t clip) const { return *clips_.at(clip).configuration; }
  /// Number of frames in the file that render_experiment writes with this seed.
  std::size_t frames(std::size_t clip, std::uint64_t seed) const {
    return clock(clip, seed).frames_of(frame_count(scenario_.recording, motion(clip)));
  }
  FrameClock clock(std::size_t clip, std::uint64_t seed) const;
  /// As in the clips (render/camera/camera.h).
  const Scenario& scenario() const { return scenario_; }
  /// Rays of the camera as in the clips.
  const RayTable& rays() const { return stage_->rays; }

  /// One for each thread; the frames of a clip are the same as in the file that render_experiment writes with this
  /// seed.
  ClipRenderer renderer(std::size_t clip, std::uint64_t seed) const;

 private:
  struct Clip {
    const sim::ConfigurationSetup* configuration;
    const sim::MotionSetup* motion;
    const Stage::SetUp* set_up;
  };

  Scenario scenario_;
  std::shared_ptr<const Stage> stage_;
  std::vector<Clip> clips_;
};

/// The number of clips of a scenario, and of frames in all their files with this seed.
struct ClipCount {
  std::size_t clips = 0;
  std::size_t frames = 0;
};
ClipCount count_clips(const Scenario& scenario, std::uint64_t seed);
/// Number of set-ups of the track.
std::size_t count_set_ups(const Scenario& scenario);

/// One clip's frames in order, in memory, as in its file.
class ClipStream {
 public:
  ClipStream(std::shared_ptr<const ClipSet> set, std::size_t clip, std::uint64_t seed);

  struct Next {
    std::shared_ptr<const FrameMotion> shown;
    std::size_t slot;  ///< of the clock; shown.frame unless repeated
    bool repeated;     ///< the previous image, repeated
    double stamp_s;    ///< the time that a container would state
  };
  /// The next frame; empty at the end.
  std::optional<Next> next();
  /// The codes, within `rect`, of a frame returned by next(), in any order.
  template <typename Code>
  void read(const FrameMotion& shown, const PixelRect& rect, std::span<Code> codes) {
    renderer_.read(shown, rect, codes);
  }

 private:
  std::shared_ptr<const ClipSet> set_;
  ClipRenderer renderer_;
  FrameClock clock_;
  FrameMotions motions_;
  std::shared_ptr<const FrameMotion> shown_;
};

}  // namespace glidelab::render
