/// The files and previews of an analysis that `analyze` and `validate` both write.
#pragma once

#include <filesystem>
#include <vector>

#include "base/long_work.h"
#include "core/analysis/preview.h"
#include "core/result/results.h"
#include "core/track/bare_track.h"

namespace glidelab::app {

/// results.json, phase-<clip>.csv and motion-<clip>.csv.
void write_analysis_files(const core::AnalysisResults& results, const std::filesystem::path& dir);

/// One preview for each clip of the results, which come from these folders in this order. The first two clips with
/// images get a video, the others one frame.
std::vector<core::Preview> previews_of(const std::vector<std::filesystem::path>& folders,
                                       const core::AnalysisResults& results, const base::Progress& progress,
                                       const core::TrackFileOptions& bare = {});

}  // namespace glidelab::app
