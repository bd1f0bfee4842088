/// Candidates for the marker in an image: spots brighter than their surroundings and of its size.
#pragma once

#include <opencv2/core.hpp>

#include <optional>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/pictures/frames/frame_source.h"
#include "core/pictures/marker/marker.h"

namespace glidelab::core {

/// How the marker differs from the rest of the image.
enum class SignalKind {
  bright,    ///< the grey value
  dark,      ///< its inverse: a colour without a hue that is darker than a quarter of full scale
  colored,   ///< likeness to the marker's hue
  any_shape  ///< the grey value, of something that need not look like a disc
};
SignalKind signal_kind(const MarkerSetup& marker);

/// Whether the signal alone tells the marker from what else there is, so that it need not look like a disc.
constexpr bool may_have_any_shape(SignalKind kind) {
  return kind == SignalKind::colored || kind == SignalKind::any_shape;
}

/// The least contrast of a marker: a sixth of the likeness of its own colour, and next to nothing for a grey value
/// (there the noise decides).
double least_contrast(SignalKind kind);

/// The frame as a channel in which the marker is bright. Likeness to a colour is the pixel's colourfulness (its
/// distance from grey) along the marker's, less half of what is across it, over the marker's own; linear in the light,
/// so that a pixel that is half marker counts half. Nothing where a hue is asked of a frame without colours.
std::optional<Signal> signal_of(const Frame& frame, const MarkerSetup& marker, SignalKind kind);

struct Blob {
  cv::Point2d centre;     ///< to about a quarter of the radius
  double contrast = 0.0;  ///< of its inside against what lies around it, in units of the signal
};

struct BlobSearch {
  double radius_px = 0.0;
  cv::Rect region;            ///< where its centre may be
  int bright_neighbours = 1;  ///< of the eight patches around it (0 to 3), how many may be as bright as it is
  double least_contrast = 0.0;
  std::size_t most = 40;  ///< the ones of the highest contrast
};

/// The mean of a box inside the expected disc against the means of eight boxes around it: local maxima of its excess
/// above the (bright_neighbours + 1)-th brightest of them, down to five standard deviations of the noise. Highest
/// contrast first. Where a contrast is asked for, only those parts of a large image are looked at in which pixels
/// differ by as much within a blob's surroundings.
std::vector<Blob> find_blobs(const Signal& signal, const BlobSearch& search);

}  // namespace glidelab::core
