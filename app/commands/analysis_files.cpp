#include "app/commands/analysis_files.h"

#include "base/files/file_io.h"
#include "core/track/bare_track.h"
#include "report/analysis/result_files.h"
#include "report/text/display_text.h"

namespace glidelab::app {
namespace {

constexpr int kVideos = 2;  // more would make the page heavy

}  // namespace

void write_analysis_files(const core::AnalysisResults& results, const std::filesystem::path& dir) {
  base::write_file(dir / "results.json", report::results_json(results));
  const std::vector<std::string> names = report::phase_file_names(results);
  const std::vector<std::string> motions = report::motion_file_names(results);
  for (std::size_t c = 0; c < results.clips.size(); ++c) {
    base::write_file(dir / names[c], report::phase_csv(results.clips[c]));
    base::write_file(dir / motions[c], report::motion_csv(results.clips[c]));
  }
}

std::vector<core::Preview> previews_of(const std::vector<std::filesystem::path>& folders,
                                       const core::AnalysisResults& results, const base::Progress& progress,
                                       const core::TrackFileOptions& bare) {
  std::vector<core::Preview> previews;
  int videos = 0;
  for (const std::filesystem::path& folder : folders) {
    const core::Experiment experiment = core::read_tracks(folder, bare);
    for (const core::ClipSetup& setup : experiment.clips) {
      if (!setup.file.empty())
        progress("preparing images", static_cast<double>(previews.size()) / static_cast<double>(results.clips.size()));
      core::PreviewOptions options;
      options.video = !setup.file.empty() && videos < kVideos;
      if (options.video) ++videos;
      if (!options.video) options.frames = 1;
      previews.push_back(core::make_preview(experiment, setup, results.clips.at(previews.size()), options));
    }
  }
  return previews;
}

}  // namespace glidelab::app
