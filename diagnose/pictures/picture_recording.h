/// picture_recording: Findings about how the camera recorded: compression, missing frames, exposure, line time.
///
/// Findings about the file: was the clip lossily compressed, and is that visible; are frames missing or repeated?
///
/// Blocks: steps between pixels at the edges of 8 x 8 blocks against those of the other seven columns. Memory: a
/// resting pixel's change over two frames against that over one, 1 where noise is new in every frame; light or a scene
/// that changes makes it differ from 1 as well, so that it counts only where both rest. (What flickers by less than 1 %
/// where pixels remember is no light: picture_scene.h.) A file that says itself that it is compressed with loss
/// withholds nothing: it is named for what it does to the positions (joined_evidence.h).
///
/// Exposure and line time from the shape of the marker's image.
///
/// An exposure T smears the image of a marker that moves at w px/s over L = |w| T; rows that are exposed one after the
/// other shear it. With second moments m (of its brightness for the difference, of its outline for the mixed one), the
/// speed's components w and `line` the time from one row to the next,
///
///     m_uu - m_vv = p(u) + (w_u² - w_v²) T²/12 - 2 line w_v m_vv
///     m_uv        = q(u) + w_u w_v T²/12 + line w_u m_vv
///
/// p, q cubic in the place in the image, one pair for each view: perspective and lens, which do not go with the
/// speed. T is found by trying exposures, all else by least squares; outliers beyond seven median deviations are left
/// out, and variances are multiplied by how long residuals last.
#pragma once

#include <vector>

#include "diagnose/pictures/picture_search.h"

namespace glidelab::diagnose {

/// Log evidence that pixels at rest remember what they were: a codec's predicted images do.
double memory_log_evidence(const std::vector<FilmedClip>& clips);

/// After add_flicker and add_sway, whose findings it reads.
void add_codec(const std::vector<FilmedClip>& clips, PictureEvidence& evidence);
void add_missing(const std::vector<FilmedClip>& clips, PictureEvidence& evidence);

struct ShapeFit {
  bool known = false;
  double exposure_s = 0.0, exposure_sd_s = 0.0;
  double line_s = 0.0, line_sd_s = 0.0;  ///< top row first
  double fastest_px_s = 0.0;
  double radius_px = 0.0;
  std::vector<PictureCurve> curves;  ///< lengthening over speed
};

ShapeFit fit_marker_shape(const std::vector<FilmedClip>& clips);

}  // namespace glidelab::diagnose
