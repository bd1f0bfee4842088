/// Findings about how the camera recorded: compression, missing frames, exposure, line time.
#pragma once

#include <vector>

#include "diagnose/pictures/image_search.h"

namespace glidelab::diagnose {

/// Log evidence that static pixels keep their earlier values, as those of a codec's predicted images do.
double memory_log_evidence(const std::vector<FilmedClip>& clips);

/// Whether the clip was lossily compressed, and whether that is visible. To be called after add_flicker and add_sway,
/// whose findings it reads.
///
/// Blocks: steps between pixels at the edges of 8 x 8 blocks are compared with those of the other seven columns.
/// Memory: the change of a resting pixel over two frames over that over one, which is 1 if the noise is new in every
/// frame. A change of the light or the scene makes it differ from 1 as well, so it counts only if both are at rest. (A
/// flicker of less than 1 % whose pixels keep their values is not that of the light: image_scene.h.) If a file itself
/// says that it is lossily compressed, nothing is hidden: compression is named for its effect on the positions
/// (joined_evidence.h).
void add_codec(const std::vector<FilmedClip>& clips, ImageEvidence& evidence);
/// Whether frames are missing or repeated.
void add_missing(const std::vector<FilmedClip>& clips, ImageEvidence& evidence);

struct ShapeFit {
  bool known = false;
  double exposure_s = 0.0, exposure_sd_s = 0.0;
  double line_s = 0.0, line_sd_s = 0.0;  ///< positive if the top row is first
  /// T² of the lengthening up to half of the highest v², and of its further growth beyond that.
  struct SquaredExposure {
    double s2 = 0.0, sd_s2 = 0.0;
  };
  SquaredExposure slower, faster;
  double difference_sd_s2 = 0.0;    ///< of slower minus faster
  double single_frame_sd_s2 = 0.0;  ///< of T² from one of the fast frames alone
  double fastest_px_s = 0.0;
  double radius_px = 0.0;
  std::vector<ImageCurve> curves;  ///< lengthening as a function of speed
};

/// Exposure and line time from the shape of the marker's image.
///
/// An exposure T smears the image of a marker that moves at w px/s over L = |w| T. Rows that are exposed one after the
/// other shear it. With second moments m (of its brightness for the difference, of its outline for the mixed one), the
/// speed's components w and `line` the time from one row to the next,
///
///     m_uu - m_vv = p(u) + (w_u² - w_v²) T²/12 - 2 line w_v m_vv
///     m_uv        = q(u) + w_u w_v T²/12 + line w_u m_vv
///
/// p and q are cubic polynomials of the position in the image, one pair for each view. They allow for perspective and
/// lens, which do not depend on the speed. T is found by trying exposures, everything else by least squares. Outliers
/// beyond seven median deviations are left out, and variances are multiplied by the correlation length of the
/// residuals.
///
/// `slower` and `faster` take the place of T² in a fit of their own: the smear of an exposure grows with v² all along,
/// one that comes with the motion, or only with a fast one, does not.
ShapeFit fit_marker_shape(const std::vector<FilmedClip>& clips);

/// T² that slower and faster frames agree on: that of the fit, or, where the halves differ by more than two standard
/// deviations, whichever of the three is closest to the stated one.
double agreed_squared_exposure(const ShapeFit& fit, double stated_s);

/// Standard deviation of T² due to a codec's own blur, 0 without loss. A codec lays light where it predicts it: what it
/// leaves in one frame at some speed it may leave in every frame at that speed, so that frames do not average it out.
double codec_squared_exposure_sd(const ShapeFit& fit, const std::vector<FilmedClip>& clips);

}  // namespace glidelab::diagnose
