/// The whole analysis: experiment folders in, K/m, mu, alpha and v_lim out.
///
///     clips  ─ frame_source ─ marker_track ─ restitution ─ motion_axis ─┐
///     tracks ─ column_table ────────────────────────────────────────────┴─ track_data ─ free_motion ─
///     local_polynomial ─ line_fit (or gls_line) ─ configurations ─ mu_and_alpha
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/long_work.h"
#include "core/motion/analyze_motion.h"
#include "core/pictures/frames/frame_source.h"
#include "core/result/results.h"
#include "core/track/bare_track.h"

namespace glidelab::core {

struct AnalysisOptions {
  std::optional<double> bandwidth_s;  ///< given; otherwise chosen for each clip by choose_bandwidth() of rule_lines.h
  int jobs = 1;                       ///< clips analysed at the same time
  FrameOpener open = open_frames;     ///< where the clips' frames come from
  std::string bandwidth_rule = {};    ///< a name of bandwidth_rule.h instead; empty: choose_bandwidth()
  std::string smoother = "local-polynomial";  ///< a name of core/motion/smoothing/smoother_list.h
  LineMethod lines = LineMethod::ordinary;
  LostFrameTimes lost_frames = LostFrameTimes::put_right;
  bool images = false;         ///< keep what the clips' images show besides the motion (ClipResult::images)
  TrackFileOptions bare = {};  ///< for inputs that are track files
  WithoutMarker without_marker = WithoutMarker::an_error;  ///< in a clip; one with a marker must be left
};

/// Reads and analyses all folders (or track files) together: they share the glider and the track, but not the camera.
/// InputError for any error in a folder; the progress counts frames.
AnalysisResults analyze(const std::vector<std::filesystem::path>& folders, const AnalysisOptions& options,
                        const base::Progress& progress = base::no_progress);

}  // namespace glidelab::core
