/// The clips of a scenario, to be drawn by any caller: what they share is made once.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "render/film/clip_renderer.h"

namespace glidelab::render {

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
};

/// Drawn on up to `jobs` threads. `drawn`, where there is one, is called for every set-up that is done, perhaps from
/// several threads at once.
std::shared_ptr<const Stage> set_stage(const Scenario& scenario, int jobs, const std::function<void()>& drawn = {});

/// Not to be moved or copied: renderers refer to it.
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
  /// As in the clips (render/camera/mount.h).
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
