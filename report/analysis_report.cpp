#include "report/analysis_report.h"

#include <fmt/format.h>

#include "report/html.h"
#include "report/meaning.h"
#include "report/sections.h"

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
  body += fmt::format(
      "<div class=\"tiles\"><div class=\"tile\"><b>{}</b><span>configurations</span></div>"
      "<div class=\"tile\"><b>{}</b><span>clips</span></div><div class=\"tile\"><b>{}</b><span>frames</span></div>"
      "<div class=\"tile\"><b>{}</b><span>{}</span></div></div>\n",
      results.configurations.size(), results.clips.size(), frames, detected,
      pictures ? "with the marker found" : "positions");
  body += meaning_of(results);
  body += recovered_section(results);
  body += phase_section(results);
  body += details_sections(results, previews, progress);
  return page(title, body);
}

}  // namespace glidelab::report
