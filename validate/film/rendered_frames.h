/// Frames that come from the renderer, in memory, where the analysis expects a file's: the same codes.
#pragma once

#include <cstdint>
#include <memory>

#include "core/pictures/frames/open_frames.h"
#include "render/film/clip_set.h"
#include "validate/film/canvas_pool.h"

namespace glidelab::validate {

/// The frames of one clip of the set. With colour wanted they are grey in all three channels, as a grey file gives
/// them. InputError for a lossy codec, whose file holds other codes. Frames are drawn on canvases of the pool.
std::unique_ptr<core::FrameSource> rendered_frames(std::shared_ptr<const render::ClipSet> set, std::size_t clip,
                                                   std::uint64_t seed, bool with_color = false,
                                                   std::shared_ptr<CanvasPool> pool = std::make_shared<CanvasPool>());

/// The same for an analysis (core/analysis/analyze.h): a clip's frames by the name of its file in the experiment
/// folder.
core::FrameOpener rendered_opener(std::shared_ptr<const render::ClipSet> set, std::uint64_t seed,
                                  std::shared_ptr<CanvasPool> pool = std::make_shared<CanvasPool>());

}  // namespace glidelab::validate
