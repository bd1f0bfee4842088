/// Findings about light: does it flicker, is it brighter on one side?
///
/// Flicker: a wave in the brightness of the fixed scene (in four bands of rows where these are exposed one
/// after the other), against 0.2 % (1 % in a file with loss, said or seen). Gradient: ln(brightness) of the marker = a
/// + g s + q s² over its place s in metres from the middle of the image, against the 10 % a metre that any lamp makes.
#pragma once

#include "diagnose/pictures/picture_finding.h"

namespace glidelab::diagnose {

void add_flicker(const std::vector<FilmedClip>& clips, PictureEvidence& evidence);
void add_gradient(const std::vector<FilmedClip>& clips, PictureEvidence& evidence);

}  // namespace glidelab::diagnose
