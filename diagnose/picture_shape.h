/// Exposure and line time from the shape of the marker's image.
///
/// An exposure T smears the image of a marker that moves at w px/s over L = |w| T; rows that are exposed one after the
/// other shear it. With second moments m of the outline, S(L) what a smear adds along the motion more than across it
/// (found by smearing a disc and fitting it with the very model that measured the clip; L²/12 for short ones), and the
/// motion's direction phi,
///
///     m_uu - m_vv = p(u) + S(|w| T) cos 2 phi - 2 line w_v m_vv,      m_uv = q(u) + S(|w| T) sin(2 phi)/2 + line w_u
///     m_vv
///
/// p, q cubic in the place in the picture, one pair for each view: perspective and lens, which do not go with the
/// speed.
#pragma once

#include <vector>

#include "diagnose/picture_evidence.h"

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
