#include "report/analysis/analysis_report.h"

#include <fmt/format.h>

#include "report/analysis/meaning.h"
#include "report/analysis/sections.h"
#include "report/html/html.h"

namespace glidelab::report {

Page analysis_report(const std::string& title, const core::AnalysisResults& results,
                     const std::vector<core::Preview>& previews, const base::Progress& progress) {
  std::size_t frames = 0;
  std::size_t detected = 0;
  bool pictures = false;
  for (const core::ClipResult& clip : results.clips) {
    pictures = pictures || !clip.sightings.empty();
    frames += clip.frames;
    detected += clip.detected;
  }
  Html body = fmt::format("<h1>{}</h1>\n<p class=\"soft\">Analysis by Glidelab, estimator {}.</p>\n", escape(title),
                          escape(results.estimator));
  body += fmt::format("<div class=\"tiles\">{}{}{}{}</div>\n",
                      tile(std::to_string(results.configurations.size()), "configurations"),
                      tile(std::to_string(results.clips.size()), "clips"), tile(std::to_string(frames), "frames"),
                      tile(std::to_string(detected), pictures ? "with the marker found" : "positions"));
  body += meaning_of(results);
  body += recovered_section(results);
  body += phase_section(results);
  body += details_sections(results, previews, progress);
  return page(title, body);
}

}  // namespace glidelab::report
