/// Clips as the sensor reads them out: the frames of one, one after the other, and all clips of a scenario.
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

/// Frames of one clip, one after the other, as the sensor reads them out: for a file, or for a consumer in memory.
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

/// What stands still, drawn for every set-up of the track. It has no noise, and nothing of the motions in it: clips of
/// one camera share it, whatever their motions, seed, clock, shutter or codec.
struct Stage {
  struct SetUp {
    StaticScene scene;
    FloatPicture background_e;        ///< in electrons
    std::optional<FinePicture> fine;  ///< where the camera moves
  };
  RayTable rays;                         ///< of the camera as in the clips
  std::map<std::string, SetUp> set_ups;  ///< by group
  /// What stands behind the pattern in the stills, in electrons; of the first configuration's track.
  FloatPicture behind_stills_e;
  std::optional<RayTable> still_rays;  ///< nothing where the clips' camera took the stills too

  const RayTable& rays_of_stills() const { return still_rays ? *still_rays : rays; }
};

/// Drawn on up to `jobs` threads. `drawn`, where there is one, is called for every set-up that is done, perhaps from
/// several threads at once.
std::shared_ptr<const Stage> set_stage(const Scenario& scenario, int jobs, const std::function<void()>& drawn = {});

/// The clips of a scenario, to be drawn by any caller: what they share is made once. Not to be moved or copied:
/// renderers refer to it.
class ClipSet {
 public:
  explicit ClipSet(const Scenario& scenario, int jobs = 1, const std::function<void()>& drawn = {});
  /// Before a stage that was set for this scenario, or one that differs in what a stage has nothing of.
  /// std::logic_error where the stage lacks one of the scenario's groups.
  ClipSet(const Scenario& scenario, std::shared_ptr<const Stage> stage);
  ClipSet(const ClipSet&) = delete;
  ClipSet& operator=(const ClipSet&) = delete;

  std::size_t size() const { return clips_.size(); }
  const sim::MotionSetup& motion(std::size_t clip) const { return *clips_.at(clip).motion; }
  const sim::ConfigurationSetup& configuration(std::size_t clip) const { return *clips_.at(clip).configuration; }
  /// Of the file that render_experiment writes with this seed.
  std::size_t frames(std::size_t clip, std::uint64_t seed) const {
    return clock(clip, seed).frames_of(frame_count(scenario_.recording, motion(clip)));
  }
  FrameClock clock(std::size_t clip, std::uint64_t seed) const;
  /// As in the clips (render/camera/camera.h).
  const Scenario& scenario() const { return scenario_; }
  /// Of the camera as in the clips.
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

/// How many clips a scenario has, and frames in all their files with this seed.
struct ClipCount {
  std::size_t clips = 0;
  std::size_t frames = 0;
};
ClipCount count_clips(const Scenario& scenario, std::uint64_t seed);
/// Set-ups of the track.
std::size_t count_set_ups(const Scenario& scenario);

/// One clip's frames in order, in memory, as its file has them.
class ClipStream {
 public:
  ClipStream(std::shared_ptr<const ClipSet> set, std::size_t clip, std::uint64_t seed);

  struct Next {
    std::shared_ptr<const FrameMotion> shown;
    std::size_t slot;  ///< of the clock; shown.frame unless repeated
    bool repeated;     ///< the image before, repeated
    double stamp_s;    ///< what a container would say of its time
  };
  /// The next frame, or nothing at the end.
  std::optional<Next> next();
  /// The codes of a frame that next() gave, within `rect`, in any order.
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
