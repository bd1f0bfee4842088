/// Findings about the filmed scene: its light and its sway.
#pragma once

#include "diagnose/pictures/picture_search.h"

namespace glidelab::diagnose {

/// Whether the light flickers: a wave in the brightness of the fixed scene (in four bands of rows where these are
/// exposed one after the other), against 0.2 % (1 % in a file with loss, said or seen).
void add_flicker(const std::vector<FilmedClip>& clips, PictureEvidence& evidence);
/// Whether the light is brighter on one side: ln(brightness) of the marker = a + g s + q s² over its place s in metres
/// from the middle of the image, against the 10 % a metre that any lamp makes.
void add_gradient(const std::vector<FilmedClip>& clips, PictureEvidence& evidence);

/// Whether the camera moves: whether the fixed scene sways or drifts in the image, or stays in place. Patches are
/// trusted to 0.02 px. A wave is looked for in both directions of all clips. A drift is the range of the means of eight
/// parts of a clip beyond what noise alone gives.
void add_sway(const std::vector<FilmedClip>& clips, PictureEvidence& evidence);

/// Log likelihood of the fixed scene's motion under a camera that sways by this (along the motion, in metres) over that
/// under a camera at rest; 0 where nothing in the scene would show it.
double camera_sway_support(const std::vector<FilmedClip>& clips, double amplitude_m, double f_hz);

}  // namespace glidelab::diagnose
