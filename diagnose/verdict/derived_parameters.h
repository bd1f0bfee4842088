/// Parameters that the list of effects states for an effect but that no fit has as such.
///
///     track_bow          x_mid_m: middle of the range of x of all clips of a set-up
///     damping_gradient   x_mid_m: the same; with one K(x) for set-ups at several places, where K is K itself,
///                        x_mid + w (x_mid of all - x_mid) with the fitted share w
///     camera_motion      amplitude_px = amplitude_m times the pixels of a metre along the motion
///
/// Where there are several set-ups, x_mid_m has a key for each, "x_mid_m.NAME".
#pragma once

#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/pictures/picture_evidence.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// `known` are the effect's parameters so far; a key that stands there already is left as it is. For tracks, whose
/// camera nobody knows, and for cameras whose pixels differ in size by more than 5 %, no pixels are stated.
std::vector<DiagnosedParameter> derived_parameters(const TrackSet& set, const MotionFit& fit, std::size_t effect,
                                                   const PictureEvidence& pictures,
                                                   const std::vector<DiagnosedParameter>& known);

}  // namespace glidelab::diagnose
