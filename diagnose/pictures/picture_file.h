/// Findings about the file: was the clip lossily compressed, and is that visible; are frames missing or repeated?
///
/// Blocks: steps between pixels at the edges of 8 x 8 blocks against those of the other seven columns. Memory: a
/// resting pixel's change over two frames against that over one, 1 where noise is new in every frame; light or a scene
/// that changes makes it differ from 1 as well, so that it counts only where both rest. (What flickers by less than 1 %
/// where pixels remember is no light: picture_light.h.) A file that says itself that it is compressed with loss
/// withholds nothing: it is named for what it does to the positions (joined_evidence.h).
#pragma once

#include "diagnose/pictures/picture_finding.h"

namespace glidelab::diagnose {

/// Log evidence that pixels at rest remember what they were: a codec's predicted images do.
double memory_log_evidence(const std::vector<FilmedClip>& clips);

/// After add_flicker and add_sway, whose findings it reads.
void add_codec(const std::vector<FilmedClip>& clips, PictureEvidence& evidence);
void add_missing(const std::vector<FilmedClip>& clips, PictureEvidence& evidence);

}  // namespace glidelab::diagnose
