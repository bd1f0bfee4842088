/// Leaves out the frames of a clip that show the image of the frame before (core/math/frame_repeats.h).
#pragma once

#include "core/analysis/seen_clip.h"

namespace glidelab::core {

/// A codec may leave a slow marker where it was for a frame, so steps of less than a pixel tell nothing. Of a film that
/// a converter brought to a higher rate, all times become those of the camera, up to one frame earlier. A note counts
/// the repeats, in place of the one that counts images that are equal bit by bit. Nothing happens where the times of
/// the frames are not even.
void leave_out_repeats(SeenClip& seen);

}  // namespace glidelab::core
