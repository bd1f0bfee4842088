#include "report/check/check_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "base/text/number_text.h"
#include "report/analysis/note_words.h"
#include "report/check/finding_words.h"
#include "report/html/html.h"
#include "report/html/plot.h"
#include "report/text/display_text.h"
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
    json["model"] = lens_words(pattern.calibration->lens);
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
  put(json, "way_m", clip.distance_m);
  put(json, "top_speed_m_s", clip.top_speed_m_s);
  put(json, "position_noise_m", clip.position_noise_m, "too few points");
  json["notes"] = notes_words(clip.notes);
  if (!clip.images) return json;
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
  if (clip.light) {
    json["least_contrast"] = clip.light->least_contrast;
    json["light_pull_px"] = clip.light->pull_px;
    json["light_pull_change_px"] = clip.light->pull_change_px;
  }
  put(json, "pixel_noise", clip.pixel_noise);
  put(json, "block_steps", clip.block_steps);
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
  for (const WordedFinding& finding : worded(check.findings)) {
    json["findings"].push_back({{"severity", name_of(finding.severity)},
                                {"about", finding.about},
                                {"found", finding.headline()},
                                {"advice", finding.advice},
                                {"follow", finding.follow}});
  }
  if (check.pattern) json["pattern"] = pattern_json(*check.pattern);
  json["clips"] = Json::array();
  for (const core::ClipCheck& clip : check.clips) json["clips"].push_back(clip_json(clip));
  return json_text(json);
}

namespace {

/// HTML. Of a few pixels it says no more than that they are few.
std::string share_cell(double share) {
  constexpr double kFew = 1e-4;
  return share > 0.0 && share < kFew ? "&lt; 0.01 %" : base::number_text(100.0 * share, 3) + " %";
}

std::string verdict_of(const core::RecordingCheck& check) {
  const std::vector<WordedFinding> findings = worded(check.findings);
  const auto count = [&](core::Severity severity) {
    return std::count_if(findings.begin(), findings.end(),
                         [&](const WordedFinding& finding) { return finding.severity == severity; });
  };
  const auto worst = count(core::Severity::unusable), changes = count(core::Severity::change);
  if (worst > 0) {
    return fmt::format("Not usable as it is: {} problem{} to fix first", worst, worst == 1 ? "" : "s");
  }
  return changes == 0 ? "Usable as it is"
                      : fmt::format("Usable; {} change{} would make it better", changes, changes == 1 ? "" : "s");
}

bool wants_change(const core::RecordingCheck& check) {
  return std::any_of(check.findings.begin(), check.findings.end(),
                     [](const core::Finding& finding) { return finding.severity != core::Severity::note; });
}

std::string word_of(core::Severity severity) {
  switch (severity) {
    case core::Severity::note:
      return "note";
    case core::Severity::change:
      return "improve";
    case core::Severity::unusable:
      return "must change";
  }
  return "";
}

/// The finding, with its consequences folded. HTML.
std::string found_html(const WordedFinding& finding) {
  if (finding.follow.empty()) return escape(finding.headline());
  std::string list;
  for (const std::string& one : finding.follow) list += "<li>" + escape(one) + "</li>";
  return fmt::format("<details><summary>{}</summary><ul>{}</ul></details>", escape(finding.headline()), list);
}

std::string findings_section(const core::RecordingCheck& check) {
  std::string text = "<h2>What was found, and what to do</h2>\n";
  if (check.findings.empty()) return text + "<p>Nothing needs to change.</p>\n";
  HtmlTable table({"", "about", "found", "advice"}, 4);
  for (const WordedFinding& finding : worded(check.findings)) {
    const char* mark = finding.severity == core::Severity::unusable ? "bad" : "soft";
    table.row({fmt::format("<span class=\"{}\">{}</span>", mark, word_of(finding.severity)), escape(finding.about),
               found_html(finding), escape(finding.advice)});
  }
  return text + table.str();
}

/// How much of the clips can be used, and the largest uncertainty of a position.
std::string extent_words(const core::RecordingCheck& check) {
  std::size_t frames = 0, seen = 0;
  std::optional<double> noise;
  for (const core::ClipCheck& clip : check.clips) {
    frames += clip.frames;
    seen += clip.seen;
    if (clip.position_noise_m) noise = std::max(noise.value_or(0.0), *clip.position_noise_m);
  }
  if (frames == 0) return {};
  const bool images = std::ranges::any_of(check.clips, [](const core::ClipCheck& clip) { return clip.images; });
  const std::string clips = fmt::format("{} clip{}", check.clips.size(), check.clips.size() == 1 ? "" : "s");
  std::string text = images ? fmt::format("The marker is found in {} of {} frames of {}", seen, frames, clips)
                            : fmt::format("{} positions in {}", seen, clips);
  if (noise)
    text += fmt::format("; position noise: at most {} mm (one standard deviation)", base::number_text(1e3 * *noise, 2));
  return text + ".";
}

std::string check_meaning(const core::RecordingCheck& check) {
  std::string text;
  if (!check.usable) {
    text =
        "An analysis of this recording would fail, or give misleading numbers: fix what “must change” below "
        "first.";
  } else if (wants_change(check)) {
    text = "The changes marked “improve” below would make its numbers more precise.";
  } else {
    text = "Nothing needs to be recorded again.";
  }
  const std::string extent = extent_words(check);
  return meaning_section(fmt::format("<p><b class=\"{}\">{}.</b> {}{}{}</p>\n",
                                     !check.usable         ? "bad"
                                     : wants_change(check) ? "soft"
                                                           : "good",
                                     verdict_of(check), text, extent.empty() ? "" : " ", extent));
}

PlotData places(const std::string& name, const std::vector<core::PixelPlace>& from) {
  PlotData data{name, {}, {"u (px)", "v (px)"}};
  for (const core::PixelPlace& place : from) data.rows.push_back({place.u_px, place.v_px});
  return data;
}

/// The regions of the image in which the pattern was seen, and the path of the marker.
Plot coverage_plot(const core::RecordingCheck& check) {
  const core::PatternCheck& pattern = *check.pattern;
  std::vector<core::PixelPlace> corners, plane, path;
  for (const core::PatternView& view : pattern.views) {
    std::vector<core::PixelPlace>& to = view.plane ? plane : corners;
    to.insert(to.end(), view.corners.begin(), view.corners.end());
  }
  for (const core::ClipCheck& clip : check.clips) path.insert(path.end(), clip.path.begin(), clip.path.end());
  std::string script =
      std::string(kFrame) + fmt::format(
                                "set xlabel 'u (px)'\nset ylabel 'v (px)'\nset xrange [0:{}]\nset yrange [{}:0]\n"
                                "set size ratio -1\nset offsets 0, 0, 0, 0\nplot ",
                                pattern.width_px, pattern.height_px);
  std::vector<PlotData> data;
  const auto add = [&](const std::string& name, const std::vector<core::PixelPlace>& from, const std::string& how) {
    if (from.empty()) return;
    script += fmt::format("{}${} using 1:2 {}", data.empty() ? "" : ", ", name, how);
    data.push_back(places(name, from));
  };
  add("corners", corners, fmt::format("with points pt 7 ps 0.3 lc rgb '{}' title 'views'", color(4)));
  add("plane", plane, fmt::format("with points pt 7 ps 0.5 lc rgb '{}' title 'plane view'", color(0)));
  add("path", path, fmt::format("with points pt 7 ps 0.4 lc rgb '{}' title 'marker'", color(1)));
  return {Drawing{script, data, {520, 420}},
          "The image: where the pattern was seen, and where the marker runs. The lens is known only where there are "
          "corners.",
          "Corners of the pattern and path of the marker in the image"};
}

Html pattern_section(const core::RecordingCheck& check) {
  if (!check.pattern) return {};
  const core::PatternCheck& pattern = *check.pattern;
  Html text = "<h2>Pattern and camera</h2>\n";
  text +=
      fmt::format("<p>Found in {} of {} images. ", pattern.views.size(), pattern.views.size() + pattern.without.size());
  if (pattern.calibration) {
    text += fmt::format(
        "The camera model fits the corners to {} px (rms), and those of the plane view to {} px. The views cover {} of "
        "the image.",
        base::number_text(pattern.calibration->rms_px, 2), base::number_text(pattern.calibration->plane_rms_px, 2),
        share_cell(pattern.covered));
  }
  text += "</p>\n";
  if (!pattern.views.empty()) text += figures({coverage_plot(check)});
  HtmlTable table({"image", "pattern", "residual (px, rms)", "tilt (°)"}, 2);
  for (const core::PatternView& view : pattern.views) {
    table.row({escape(view.file), view.plane ? "found; plane of motion" : "found",
               pattern.calibration ? base::digits_text(view.rms_px, 2) : "–",
               pattern.calibration ? fmt::format("{:.0f}", view.tilt_deg) : "–"});
  }
  for (const std::string& file : pattern.without) {
    table.row({escape(file), "<span class=\"bad\">not found</span>", "–", "–"});
  }
  text += folded("Each image of the pattern", table.str());
  return text;
}

constexpr const char* kNothing = "–";

/// A column of the clips' table: its head, its text for a clip, and what it means; of a clip to which it does not apply
/// kNothing.
struct ClipColumn {
  const char* title;
  std::string (*text)(const core::ClipCheck&);
  const char* meaning = "";
};

const std::vector<ClipColumn> kClipColumns = {
    {"frames", [](const core::ClipCheck& clip) { return fmt::format("{}", clip.frames); }},
    {"seen in", [](const core::ClipCheck& clip) { return fmt::format("{}", clip.seen); },
     "frames or times with a position"},
    {"frames/s", [](const core::ClipCheck& clip) { return base::number_text(clip.frame_rate_hz, 5); }},
    {"in the file",
     [](const core::ClipCheck& clip) {
       return clip.container_rate_hz ? base::number_text(*clip.container_rate_hz, 5) : std::string(kNothing);
     },
     "the rate that the file states"},
    {"lost / repeated",
     [](const core::ClipCheck& clip) {
       return clip.images || clip.stalls > 0 ? fmt::format("{} / {}", clip.jumps, std::max(clip.repeated, clip.stalls))
                                             : std::string(kNothing);
     },
     "frames missing or repeated, as far as the marker's motion and the images show"},
    {"speed (m/s)", [](const core::ClipCheck& clip) { return base::digits_text(clip.top_speed_m_s, 3); },
     "the highest"},
    {"blur (px)",
     [](const core::ClipCheck& clip) {
       if (!clip.images) return std::string(kNothing);
       return clip.blur_px ? base::digits_text(*clip.blur_px, 2) : "&lt; " + base::number_text(clip.longest_blur_px, 2);
     },
     "the smear at that speed"},
    {"marker (px)",
     [](const core::ClipCheck& clip) {
       return clip.images ? base::digits_text(clip.marker_px, 3) : std::string(kNothing);
     },
     "its diameter"},
    {"contrast",
     [](const core::ClipCheck& clip) { return clip.contrast ? share_cell(*clip.contrast) : std::string(kNothing); },
     "the marker's difference from its surroundings, as a share of the camera's range"},
    {"contrast / noise",
     [](const core::ClipCheck& clip) {
       return clip.contrast && clip.pixel_noise > 0.0 ? base::number_text(*clip.contrast / clip.pixel_noise, 3)
                                                      : std::string(kNothing);
     },
     "the contrast divided by the noise of a pixel"},
    {"white, black",
     [](const core::ClipCheck& clip) {
       return clip.images ? share_cell(clip.saturated) + ", " + share_cell(clip.dark) : std::string(kNothing);
     },
     "pixels at the largest code and at the smallest"},
    {"noise (mm)",
     [](const core::ClipCheck& clip) {
       return clip.position_noise_m ? base::digits_text(1e3 * *clip.position_noise_m, 2) : std::string(kNothing);
     },
     "of a position"},
};

std::string cell_of(const ClipColumn& column, const core::ClipCheck& clip) {
  return clip.failure.empty() ? column.text(clip) : kNothing;
}

std::string clips_section(const core::RecordingCheck& check, const std::vector<core::Preview>& previews) {
  std::vector<const ClipColumn*> columns;  // those that say something about some clip
  for (const ClipColumn& column : kClipColumns) {
    const auto says = [&](const core::ClipCheck& clip) { return cell_of(column, clip) != kNothing; };
    if (std::ranges::any_of(check.clips, says)) columns.push_back(&column);
  }
  std::vector<std::string> header = {"clip"};
  std::string meanings;
  for (const ClipColumn* const column : columns) {
    header.emplace_back(column->title);
    const std::string_view meaning = column->meaning;
    if (!meaning.empty()) meanings += fmt::format("{}“{}”: {}", meanings.empty() ? "" : "; ", column->title, meaning);
  }
  HtmlTable table(header);
  for (const core::ClipCheck& clip : check.clips) {
    std::vector<std::string> cells = {escape(clip.name)};
    for (const ClipColumn* const column : columns) cells.push_back(cell_of(*column, clip));
    table.row(cells);
  }
  std::string text = "<h2>Clips</h2>\n" + table.str();
  if (!meanings.empty()) text += fmt::format("<p class=\"soft\">{}.</p>\n", escape(meanings));
  std::string shown;
  for (std::size_t i = 0; i < previews.size(); ++i) {
    for (const core::PreviewFrame& frame : previews[i].frames) {
      shown += fmt::format(
          "<figure><img alt=\"frame {0} of clip {1}\" src=\"{2}\"><figcaption>{1}, frame {0}: the marker as it was "
          "found, and its path</figcaption></figure>\n",
          frame.frame + 1, escape(check.clips[i].name), data_uri("image/jpeg", frame.jpeg));
    }
  }
  if (!shown.empty()) text += fmt::format("<div class=\"figures\">\n{}</div>\n", shown);
  return text;
}

}  // namespace

Page check_report(const core::RecordingCheck& check, const std::vector<core::Preview>& previews) {
  Html body = question_heading(check.name, "Is this recording good enough?") + check_meaning(check);
  body += findings_section(check) + pattern_section(check) + clips_section(check, previews);
  return page("Check of " + check.name, body);
}

std::string check_text(const core::RecordingCheck& check) {
  std::string text = verdict_of(check) + ".\n";
  for (const WordedFinding& finding : worded(check.findings)) {
    text += fmt::format("{}: {}: {}{}{}.\n", word_of(finding.severity), finding.about, finding.headline(),
                        finding.advice.empty() ? "" : "; ", finding.advice);
  }
  const bool images = std::ranges::any_of(check.clips, [](const core::ClipCheck& clip) { return clip.images; });
  std::vector<std::string> header = {"clip", "seen", "speed (m/s)"};
  if (images) header.insert(header.end(), {"blur (px)", "marker (px)"});
  header.emplace_back("noise (mm)");
  std::vector<std::vector<std::string>> rows = {header};
  for (const core::ClipCheck& clip : check.clips) {
    std::vector<std::string>& row = rows.emplace_back(header.size(), "-");
    row[0] = clip.name;
    if (!clip.failure.empty()) continue;
    row[1] = fmt::format("{} of {}", clip.seen, clip.frames);
    row[2] = base::number_text(clip.top_speed_m_s, 3);
    if (clip.images) {
      row[3] = clip.blur_px ? base::number_text(*clip.blur_px, 2) : "< " + base::number_text(clip.longest_blur_px, 2);
      row[4] = base::number_text(clip.marker_px, 3);
    }
    if (clip.position_noise_m) row.back() = base::number_text(1e3 * *clip.position_noise_m, 2);
  }
  return text + "\n" + text_table(rows, 1);
}

}  // namespace glidelab::report
