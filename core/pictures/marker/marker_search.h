/// Candidates for the marker in an image: spots of its size that are brighter than their surroundings.
#pragma once

#include <opencv2/core.hpp>

#include <optional>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/pictures/frames/frame_source.h"
#include "core/pictures/marker/marker_fit.h"

namespace glidelab::core {

/// How the marker differs from the rest of the image.
enum class SignalKind {
  bright,    ///< the grey value
  dark,      ///< its inverse, for a colour without a hue that is darker than a quarter of full scale
  colored,   ///< likeness to the hue of the marker
  any_shape  ///< the grey value of an object that need not look like a disc
};
SignalKind signal_kind(const MarkerSetup& marker);

/// Whether the signal alone tells the marker from everything else, so that it need not look like a disc.
constexpr bool may_have_any_shape(SignalKind kind) {
  return kind == SignalKind::colored || kind == SignalKind::any_shape;
}

/// The lowest contrast of a marker, in units of the signal: a sixth of the likeness of its own colour, or 0 for a grey
/// value (there the noise decides).
double least_contrast(SignalKind kind);

/// The frame as a channel in which the marker is bright. With the colourfulness of a pixel the vector of its distance
/// from grey, the likeness to a colour is the component along the marker's colourfulness, less half of the component
/// across it, relative to the marker's own. It is linear in the codes, so that a pixel that is half covered counts
/// half. Empty if a hue is sought in a frame without colours.
std::optional<Signal> signal_of(const Frame& frame, const MarkerSetup& marker, SignalKind kind);

struct Blob {
  cv::Point2d centre;     ///< to about a quarter of the radius
  double contrast = 0.0;  ///< of its inside to what lies around it, in units of the signal
};

struct BlobSearch {
  double radius_px = 0.0;
  cv::Rect region;            ///< where the centre of a blob may be
  int bright_neighbours = 1;  ///< how many of the eight patches around it (0 to 3) may be as bright
  double least_contrast = 0.0;
  std::size_t most = 40;  ///< the number of blobs, those of highest contrast
};

/// Compares the mean of a box inside the expected disc with the means of eight boxes around it. Blobs are the local
/// maxima of its excess over the (bright_neighbours + 1)-th brightest of them, down to five standard deviations of the
/// noise of that difference and to 4 % of the highest contrast. The highest contrast comes first. If a least contrast
/// is given, only those parts of a large image are searched in which pixels differ by as much within the surroundings
/// of a blob.
std::vector<Blob> find_blobs(const Signal& signal, const BlobSearch& search);

}  // namespace glidelab::core
