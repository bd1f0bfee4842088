/// What the images of one clip show, in pixels: the search for the marker, and the scene behind it.
#pragma once

#include <opencv2/core.hpp>

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "base/long_work.h"
#include "core/analysis/seen_clip.h"
#include "core/experiment/experiment.h"
#include "core/pictures/camera/restitution.h"
#include "core/pictures/frames/frame_source.h"
#include "core/pictures/marker/marker_track.h"
#include "core/result/analysis_note.h"
#include "core/result/image_record.h"

namespace glidelab::core {

/// The method by which a marker with a hue is measured, before it may be fitted as a lit body.
MarkerMethod measured_by(const SeenClip& clip);

/// The method by which a marker with a hue is measured in most frames of the clips; empty if it is one in all of them.
/// The centroid of a hue and the disc that is fitted to it differ by an offset, so that clips have to agree.
std::optional<MarkerMethod> common_method(const std::vector<SeenClip>& clips);

/// The same for a marker that was measured by its hue alone and as a lit body: takes the body if there is one in every
/// clip and if it is the steadier on average over their frames, else the hue.
void measure_alike(std::vector<SeenClip>& clips);

/// Counts frames over all clips for the progress; clips may be processed concurrently.
class FrameCounter {
 public:
  FrameCounter(const base::Progress& progress, std::size_t clips) : progress_(progress), clips_(clips) {}
  /// Reports the progress over all clips, this clip's share having grown by `share`.
  void add(double share);

 private:
  const base::Progress& progress_;
  std::size_t clips_;
  std::atomic<double> done_ = 0.0;
};

/// How far the search for the marker goes.
enum class MarkerSearch {
  thorough,  ///< as a disc, as a sphere that is lit from one side, by its own look
  disc       ///< the first of these alone, which takes less time where there is no marker
};

/// Reads the clip once or twice: a marker without a stated colour is searched for as a bright disc and, if a bright one
/// is hardly seen but a dark one well, as a dark disc. With `look_at_scene` there is a ImageRecord. InputError for
/// images that cannot be used, NoMarker (marker_track.h) if there is no marker. `by`: the method for a marker with a
/// hue.
SeenClip see_clip(const Experiment& experiment, const ClipSetup& clip, const CameraAndPlanes& setting,
                  const FrameOpener& open, bool look_at_scene, FrameCounter& counter,
                  MarkerSearch search = MarkerSearch::thorough, MarkerMethod by = MarkerMethod::undecided);

}  // namespace glidelab::core
