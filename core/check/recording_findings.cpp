// findings_of() of check_recording.h: of the pattern here, of clips in clip_findings.h, of what is stated in
// statement_findings.h.
#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "core/check/check_recording.h"
#include "core/check/clip_findings.h"
#include "core/check/finding_words.h"
#include "core/check/statement_findings.h"

namespace glidelab::core {
namespace {

// What each limit rests on is in docs/reference/check.md.
constexpr std::size_t kEnoughViews = 8;
constexpr double kFinePatternPx = 0.3, kWorstPatternPx = 1.0;  // rms of the camera's fit, per corner
constexpr double kFinePlanePx = 0.05, kPlaneRatio = 3.0, kWorstPlanePx = 1.0;
constexpr double kCovered = 0.5;  // of the picture's parts
constexpr double kLeastTiltDeg = 20.0;

void judge_pattern(const PatternCheck& pattern, FindingBook book) {
  const std::size_t asked = pattern.views.size() + pattern.without.size();
  if (!pattern.failure.empty()) {
    book.add(Severity::unusable, pattern.failure,
             fmt::format("the pattern was found in {} of {} pictures; take them anew: the whole board in sight, sharp, "
                         "evenly lit, with white around it, and inner_corners as printed",
                         pattern.views.size(), asked));
    return;
  }
  if (!pattern.without.empty()) {
    book.add(Severity::change, "no pattern is seen in " + list_of(pattern.without),
             "take those again with all inner corners in sight and the board evenly lit, or remove them");
  }
  if (!pattern.calibration) return;
  const CalibrationResult& camera = *pattern.calibration;
  if (camera.views_used < kEnoughViews) {
    book.add(Severity::change, fmt::format("the camera rests on {} views", camera.views_used),
             "take a dozen, tilted to all sides, near and far");
  }
  if (camera.rms_px > kFinePatternPx) {
    book.add(
        camera.rms_px > kWorstPatternPx ? Severity::unusable : Severity::change,
        fmt::format("corners lie {:.2g} px (rms) from where the camera's model puts them", camera.rms_px),
        "glue the board to something flat, keep it still and sharp in every picture, and leave zoom and focus alone");
  }
  if (pattern.covered < kCovered) {
    book.add(Severity::change, fmt::format("the views cover {} of the picture", percent(pattern.covered)),
             "hold the board into the picture's edges and corners as well: the lens is known only where it was seen");
  }
  double tilt_deg = 0.0;
  for (const PatternView& view : pattern.views) tilt_deg = std::max(tilt_deg, view.tilt_deg);
  if (tilt_deg < kLeastTiltDeg) {
    book.add(Severity::change, fmt::format("the board is tilted by no more than {:.0f} degrees", tilt_deg),
             "tilt it by 30 to 45 degrees in some views: without that the focal length is hardly known");
  }
  if (camera.plane_rms_px > std::max(kFinePlanePx, kPlaneRatio * camera.plane_expected_px)) {
    book.add(camera.plane_rms_px > kWorstPlanePx ? Severity::unusable : Severity::change,
             fmt::format(
                 "the plane views' corners lie {:.2g} px (rms) from where the camera puts them; their noise explains "
                 "{:.2g} px",
                 camera.plane_rms_px, camera.plane_expected_px),
             "take the plane view with the same focus, zoom and picture size as all others, the board flat and still");
  }
  for (const std::string& note : camera.notes) {
    if (!note.starts_with("no pattern in sight")) book.add(Severity::note, note);  // said above, with advice
  }
}

/// What is the same of several clips is said once.
std::vector<Finding> said_once(std::vector<Finding> findings) {
  std::vector<Finding> once;
  std::vector<std::vector<std::string>> about;
  for (Finding& finding : findings) {
    const auto same = std::find_if(once.begin(), once.end(), [&](const Finding& before) {
      return std::tie(before.severity, before.found, before.advice) ==
             std::tie(finding.severity, finding.found, finding.advice);
    });
    if (same != once.end()) {
      about[static_cast<std::size_t>(same - once.begin())].push_back(finding.about);
      continue;
    }
    about.push_back({finding.about});
    once.push_back(std::move(finding));
  }
  for (std::size_t i = 0; i < once.size(); ++i) once[i].about = list_of(about[i]);
  return once;
}

}  // namespace

std::vector<Finding> findings_of(const Experiment& experiment, const RecordingCheck& check) {
  std::vector<Finding> findings = statement_findings(experiment, check);
  if (check.pattern) judge_pattern(*check.pattern, {findings, "pattern"});
  for (const ClipCheck& clip : check.clips) judge_clip(experiment, clip, {findings, clip.name});
  if (!check.plumb_failure.empty()) findings.push_back({Severity::unusable, "plumb line", check.plumb_failure, {}});
  std::stable_sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
    return static_cast<int>(a.severity) > static_cast<int>(b.severity);
  });
  return said_once(std::move(findings));
}

}  // namespace glidelab::core
