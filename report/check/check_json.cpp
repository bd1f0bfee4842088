#include "report/check/check_json.h"

#include "report/text/json_numbers.h"

namespace glidelab::report {
namespace {

Json pattern_json(const core::PatternCheck& pattern) {
  Json json;
  json["found_in"] = pattern.views.size();
  json["not_found_in"] = pattern.without;
  json["picture_px"] = {pattern.width_px, pattern.height_px};
  put(json, "covered", pattern.covered);
  if (pattern.calibration) {
    put(json, "rms_px", pattern.calibration->rms_px);
    put(json, "plane_rms_px", pattern.calibration->plane_rms_px);
    put(json, "plane_expected_px", pattern.calibration->plane_expected_px);
    json["model"] = pattern.calibration->model;
  } else {
    json["failure"] = pattern.failure;
  }
  json["views"] = Json::array();
  for (const core::PatternView& view : pattern.views) {
    Json one;
    one["file"] = view.file;
    one["plane"] = view.plane;
    put(one, "rms_px", view.rms_px);
    put(one, "tilt_deg", view.tilt_deg);
    json["views"].push_back(std::move(one));
  }
  return json;
}

Json clip_json(const core::ClipCheck& clip) {
  Json json;
  json["name"] = clip.name;
  if (!clip.failure.empty()) {
    json["failure"] = clip.failure;
    return json;
  }
  json["frames"] = clip.frames;
  json["seen"] = clip.seen;
  put(json, "frame_rate_hz", clip.frame_rate_hz);
  put(json, "way_m", clip.way_m);
  put(json, "top_speed_m_s", clip.top_speed_m_s);
  put(json, "position_noise_m", clip.position_noise_m, "too few points");
  json["notes"] = clip.notes;
  if (!clip.pictures) return json;
  json["spanned"] = clip.spanned;
  json["first_seen"] = clip.first;
  json["picture_px"] = {clip.width_px, clip.height_px};
  put(json, "container_rate_hz", clip.container_rate_hz, "a folder of frames, or a file that does not say");
  json["repeated_frames"] = clip.repeated;
  json["irregular_steps"] = clip.irregular_steps;
  put(json, "drift_frames", clip.drift_frames);
  json["jumps"] = clip.jumps;
  json["stalls"] = clip.stalls;
  put(json, "saturated", clip.saturated);
  put(json, "dark", clip.dark);
  put(json, "bright_level", clip.bright_level);
  put(json, "marker_px", clip.marker_px);
  put(json, "marker_expected_px", clip.marker_expected_px);
  put(json, "marker_level", clip.marker_level, "not a bright marker");
  put(json, "contrast", clip.contrast, "a marker that is known by its hue");
  put(json, "pixel_noise", clip.pixel_noise);
  put(json, "centre_sd_px", clip.centre_sd_px);
  put(json, "top_speed_px_s", clip.top_speed_px_s);
  put(json, "blur_px", clip.blur_px, "exposure_s is not stated");
  put(json, "longest_blur_px", clip.longest_blur_px);
  if (clip.measured_exposure_s) {
    json["measured_exposure_s"] = *clip.measured_exposure_s;
    json["measured_blur_px"] = *clip.measured_blur_px;
  }
  put(json, "inside_pattern", clip.inside_pattern);
  return json;
}

}  // namespace

std::string name_of(core::Severity severity) {
  switch (severity) {
    case core::Severity::note:
      return "note";
    case core::Severity::change:
      return "change";
    case core::Severity::unusable:
      return "unusable";
  }
  return "";
}

std::string check_json(const core::RecordingCheck& check) {
  Json json;
  json["format"] = 1;
  json["name"] = check.name;
  json["usable"] = check.usable;
  json["findings"] = Json::array();
  for (const core::Finding& finding : check.findings) {
    json["findings"].push_back({{"severity", name_of(finding.severity)},
                                {"about", finding.about},
                                {"found", finding.found},
                                {"advice", finding.advice}});
  }
  if (check.pattern) json["pattern"] = pattern_json(*check.pattern);
  json["clips"] = Json::array();
  for (const core::ClipCheck& clip : check.clips) json["clips"].push_back(clip_json(clip));
  return json_text(json);
}

}  // namespace glidelab::report
