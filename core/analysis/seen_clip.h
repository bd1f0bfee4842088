/// What the images of one clip show, as the search for the marker (see_clip.h) leaves it.
#pragma once

#include <opencv2/core.hpp>

#include <memory>
#include <optional>
#include <vector>

#include "core/pictures/marker/marker_path.h"
#include "core/result/analysis_note.h"
#include "core/result/image_record.h"

namespace glidelab::core {

/// What one clip's images show, in pixels: the marker in every frame, the frames' times, and anything else of note.
struct SeenClip {
  TrackedMarker marker;
  std::vector<double> frame_t_s;        ///< of all frames
  cv::Size size;                        ///< of the images
  std::vector<Note> notes;              ///< about the file; the marker has its own notes
  std::shared_ptr<ImageRecord> images;  ///< if requested
  bool dark_marker = false;             ///< seen as darker than its surroundings, with no stated colour
  std::optional<bool> predicted;        ///< whether a lossy codec predicts images from earlier ones; empty if not known
  /// Of a marker with a hue, measured by that alone and as a lit body: by whichever of the two the marker above is not.
  std::shared_ptr<const TrackedMarker> by_other_means = {};
};

}  // namespace glidelab::core
