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

#include "diagnose/pictures/picture_finding.h"

namespace glidelab::diagnose {

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
