/// Findings about camera motion: does the fixed scene sway or drift in the image, or stay in place?
///
/// Patches are trusted to 0.02 px. A wave is looked for in both directions of all clips; a drift is the range of the
/// means of eight parts of a clip beyond what noise makes of it.
#pragma once

#include "diagnose/pictures/picture_finding.h"

namespace glidelab::diagnose {

void add_sway(const std::vector<FilmedClip>& clips, PictureEvidence& evidence);

/// Log likelihood of the fixed scene's motion under a camera that sways by this (along the motion, in metres) over that
/// under a camera at rest; 0 where nothing in the scene would show it.
double camera_sway_support(const std::vector<FilmedClip>& clips, double amplitude_m, double f_hz);

}  // namespace glidelab::diagnose
