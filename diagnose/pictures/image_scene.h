/// Findings about the filmed scene: its light and its sway.
#pragma once

#include "diagnose/pictures/image_search.h"

namespace glidelab::diagnose {

/// Whether the light flickers: a wave in the brightness of the fixed scene (in four bands of rows if these are exposed
/// one after the other), compared with 0.2 % (1 % in a file with lossy compression, stated or seen).
void add_flicker(const std::vector<FilmedClip>& clips, ImageEvidence& evidence);
/// Whether the light is brighter on one side: ln(brightness) of the marker = a + g s + q s² over its position s in
/// metres from the middle of the image, compared with the 10 % a metre of any lamp.
void add_gradient(const std::vector<FilmedClip>& clips, ImageEvidence& evidence);

/// Whether the camera moves: whether the fixed scene sways or drifts in the image, or stays in place. Patches are
/// trusted to 0.02 px. A wave is searched for in both directions of all clips. A drift is the range of the means of
/// eight parts of a clip beyond that of noise alone; its speed along the motion, by which speeds are wrong, is the
/// slope of a straight line through a clip.
void add_sway(const std::vector<FilmedClip>& clips, ImageEvidence& evidence);

/// Log likelihood ratio of the fixed scene's motion: for a camera that sways by this (along the motion, in metres), and
/// for a camera at rest; 0 if nothing in the scene would show it.
double camera_sway_support(const std::vector<FilmedClip>& clips, double amplitude_m, double f_hz);

}  // namespace glidelab::diagnose
