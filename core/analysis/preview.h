/// A preview of a clip for a report: a few frames with the marker that was found, and a small video of the whole clip.
///
/// The clip is read again, frame by frame, after the analysis; the preview does not enter any result.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/long_work.h"

namespace glidelab::core {

struct AnalysisResults;
struct TrackFileOptions;
struct Experiment;
struct ClipSetup;
struct ClipResult;

struct PreviewFrame {
  std::size_t frame = 0;
  double t_s = 0.0;
  std::string jpeg;  ///< the file's bytes
};

/// Why a requested video is missing.
struct NoVideo {
  std::optional<std::uintmax_t>
      bytes;  ///< it would take so many, too many for a page; empty: there is no H.264 encoder
};

struct Preview {
  std::vector<PreviewFrame> frames;  ///< the marker circled, its path dotted
  std::string mp4;                   ///< H.264, playable in a browser; empty if there is none
  double slow_motion = 1.0;          ///< how many times longer the video takes than the motion
  std::optional<NoVideo> no_video;   ///< empty if there is one, or if none was requested
};

struct PreviewOptions {
  int frames = 3;     ///< spread from the first sighting of the marker to the last
  bool video = true;  ///< at most about 12 s and 1 MB
  int width_px = 400;
};

/// Reads the clip of `setup` again. A clip that is a track has no images: an empty preview. A missing encoder is not an
/// error; `no_video` says so. InputError if the clip cannot be read (any more).
Preview make_preview(const Experiment& experiment, const ClipSetup& setup, const ClipResult& result,
                     const PreviewOptions& options = {});

/// One preview for each clip of the results, which come from these folders in this order. The first two clips with
/// images get a video, the others one frame.
std::vector<Preview> previews_of(const std::vector<std::filesystem::path>& folders, const AnalysisResults& results,
                                 const base::Progress& progress, const TrackFileOptions& bare);

}  // namespace glidelab::core
