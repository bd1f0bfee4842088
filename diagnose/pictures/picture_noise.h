/// The noise of resting pixels over their brightness (noise_law.h), as a curve for the page.
#pragma once

#include "diagnose/pictures/picture_finding.h"

namespace glidelab::diagnose {

/// One curve `noise` for each view's clips: variance (codes²) over the level (codes), with the law as fitted.
void add_noise(const std::vector<FilmedClip>& clips, PictureEvidence& evidence);

}  // namespace glidelab::diagnose
