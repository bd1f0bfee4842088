/// The pixels around the sightings of a clip, kept in limited memory for a second fit: without what a colour mosaic and
/// a tone curve add to an edge (core/pictures/image/edge_response.h), which only all of them together show.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <map>
#include <vector>

#include "core/pictures/marker/marker_fit.h"
#include "core/pictures/marker/marker_path.h"

namespace glidelab::core {

class KeptWindows {
 public:
  /// The default is 128 MiB.
  void limit(std::size_t bytes) { most_bytes_ = bytes; }

  /// The window of a fit that started from `guess`, in place of that of an earlier fit of the same object in this
  /// frame. Nothing is kept if memory does not allow it.
  void keep(const Signal& signal, std::size_t frame, const MarkerGuess& guess, const MarkerFit& fit);

  /// Null if no window was kept.
  const MarkerWindow* around(std::size_t frame, cv::Point2d centre, double radius_px) const;

  /// Whether half of the memory is used, and more than the last call of free_all_but() left.
  bool should_free() const { return bytes_ > most_bytes_ / 2 && bytes_ > free_above_; }

  /// Frees the windows of objects that were given up, sleep, or ended at rest.
  void free_all_but(const std::vector<MarkerPath>& paths);

  std::size_t bytes() const { return bytes_; }

 private:
  struct Kept {
    cv::Point2d centre;
    MarkerWindow window;
  };
  const Kept* nearest(std::size_t frame, cv::Point2d centre, double radius_px) const;

  std::map<std::size_t, std::vector<Kept>> kept_;  ///< by frame
  std::size_t bytes_ = 0, most_bytes_ = std::size_t{1} << 27, free_above_ = 0;
};

/// Corrects the centres for a colour mosaic and a tone curve; everything else stays as the codes gave it. Corrected and
/// uncorrected positions in one clip are worse than either, so sightings whose fit with the response fails are left
/// out, if the path tells more without them: n positions of variance s² tell n / s², and s is the roughness of the
/// path. Otherwise, or if a sighting has no window, none is corrected. A note says so.
void correct_for_pixels(TrackedMarker& tracked, const KeptWindows& windows, bool may_be_curved);

/// Whether `corrected` tells more than `by_codes`, which has all positions.
bool tells_more(const Places& corrected, const Places& by_codes);

}  // namespace glidelab::core
