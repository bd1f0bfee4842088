#include "report/analysis/sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "base/text/number_text.h"
#include "report/analysis/camera_plots.h"
#include "report/analysis/doubts.h"
#include "report/analysis/motion_plots.h"
#include "report/analysis/note_words.h"
#include "report/analysis/result_files.h"
#include "report/html/html.h"
#include "report/text/display_text.h"
#include "report/text/why_words.h"

namespace glidelab::report {
namespace {

/// "2.7791 ± 0.0062", or a dash that shows the reason as a tooltip. HTML.
std::string quantity_html(const core::Quantity& quantity, std::string_view unit) {
  if (!quantity.estimate) return fmt::format("<span title=\"{}\">–</span>", escape(why_words(quantity.why)));
  return base::value_and_sd_text(quantity.estimate->value, quantity.estimate->sd) + unit_suffix(unit);
}

std::string notes_html(const std::vector<std::string>& notes) {
  if (notes.empty()) return {};
  std::string text = "<div class=\"note\"><ul>";
  for (const std::string& note : notes) text += fmt::format("<li>{}</li>", escape(note));
  return text + "</ul></div>\n";
}

/// R² with the number of points of the line.
std::string r2_of(const std::vector<core::LineFit>& lines, int direction) {
  const core::LineFit* line = line_of(lines, direction);
  return line == nullptr ? "–" : fmt::format("{}<br><small>{} points</small>", base::r2_text(line->r2), line->points);
}

std::string clip_anchor(std::size_t index) {
  return fmt::format("clip-{}", index + 1);
}

std::string left_out_table(const core::ClipResult& clip) {
  constexpr std::size_t kMostRows = 40;  // for recordings with many bounces; results.json has all of them
  if (clip.left_out.empty()) return {};
  HtmlTable table({"left out because", "from (s)", "to (s)", "frames"});
  for (std::size_t i = 0; i < std::min(kMostRows, clip.left_out.size()); ++i) {
    const core::LeftOutInterval& interval = clip.left_out[i];
    table.row({escape(core::describe(interval.reason)), fmt::format("{:.3f}", interval.from_s),
               fmt::format("{:.3f}", interval.to_s), fmt::format("{}", interval.frames)});
  }
  std::string text = table.str();
  if (clip.left_out.size() > kMostRows) {
    text += fmt::format("<p class=\"soft\">… and {} more; results.json lists them all.</p>\n",
                        clip.left_out.size() - kMostRows);
  }
  return text;
}

std::string images(const core::ClipResult& clip, const core::Preview& preview) {
  std::string text;
  if (!preview.mp4.empty()) {
    const std::string caption =
        preview.slow_motion > 1.05   ? fmt::format("The clip, slowed down by a factor of {:.3g}", preview.slow_motion)
        : preview.slow_motion < 0.95 ? fmt::format("The clip, sped up by a factor of {:.3g}", 1.0 / preview.slow_motion)
                                     : std::string("The clip");
    text += fmt::format(
        "<figure><video controls muted loop playsinline preload=\"metadata\" src=\"{}\"></video>"
        "<figcaption>{}, with the marker as it was found</figcaption></figure>\n",
        data_uri("video/mp4", preview.mp4), caption);
  }
  for (const core::PreviewFrame& frame : preview.frames) {
    text += fmt::format(
        "<figure><img alt=\"frame {0} of clip {1}\" src=\"{2}\"><figcaption>Frame {0}, t = {3:.3f} s</figcaption>"
        "</figure>\n",
        frame.frame + 1, escape(clip.name), data_uri("image/jpeg", frame.jpeg), frame.t_s);
  }
  if (!text.empty()) text = fmt::format("<div class=\"figures\">\n{}</div>\n", text);
  if (preview.no_video) {
    const auto& bytes = preview.no_video->bytes;
    text += fmt::format("<p class=\"soft\">No video: {}.</p>\n",
                        bytes ? fmt::format("it would take {:.1f} MB", static_cast<double>(*bytes) * 1e-6)
                              : "no H.264 encoder is installed");
  }
  return text;
}

/// The noise with its standard deviation, s / sqrt(2 n) for n residuals of white noise.
std::string noise_text(double noise_mm, std::size_t points) {
  return points > 0 ? base::value_and_sd_text(noise_mm, noise_mm / std::sqrt(2.0 * static_cast<double>(points)))
                    : base::number_text(noise_mm, 3);
}

/// How the clip was smoothed, and how strongly.
std::string smoothing_text(const core::ClipResult& clip) {
  if (!clip.strength) {
    const std::string method = strength_words(clip.bandwidth_method);
    return fmt::format("Bandwidth {} ms{}{}", base::number_text(clip.bandwidth_s * 1e3, 3), method.empty() ? "" : ", ",
                       escape(method));
  }
  const core::SmoothingStrength& strength = *clip.strength;
  std::string text = fmt::format("Smoother {}: smoothing time {} ms, by {}", escape(strength.smoother),
                                 base::number_text(strength.time_s * 1e3, 3), escape(strength_words(strength.method)));
  if (!strength.breaks_s.empty()) {
    text +=
        fmt::format("; a may jump at {} turn{}", strength.breaks_s.size(), strength.breaks_s.size() == 1 ? "" : "s");
    if (strength.jump_sd_m_s2 && std::isfinite(*strength.jump_sd_m_s2)) {
      text += fmt::format(" (standard deviation {} m/s²)", base::number_text(*strength.jump_sd_m_s2, 2));
    }
  }
  if (strength.simultaneous_a) {
    text += fmt::format("; a(t) lies within ± {} of its standard deviations at all frames together (95 %)",
                        base::number_text(*strength.simultaneous_a, 2));
  }
  return text;
}

Html clip_html(const core::ClipResult& clip, std::size_t index, const std::string& phase_file,
               const std::string& motion_file, const core::Preview* preview) {
  Html text = fmt::format("<h3 id=\"{}\">{}</h3>\n", clip_anchor(index), escape(clip.name));
  std::size_t used = 0;
  for (const core::MotionPoint& point : clip.motion) {
    if (point.smoothed && point.left_out == core::LeftOut::used) ++used;
  }
  text += fmt::format(
      "<p>{} at {} Hz, {} points used. {} noise {} mm{}. {}. "
      "Numbers: <code>{}</code>; every frame{}: <code>{}</code>.</p>\n",
      clip.sightings.empty() ? fmt::format("{} {}", clip.frames, clip.speed_noise_m_s ? "speeds" : "positions")
                             : fmt::format("{} frames, the marker found in {},", clip.frames, clip.detected),
      base::number_text(clip.frame_rate_hz, 5), used, clip.speed_noise_m_s ? "Speed" : "Position",
      noise_text(clip.speed_noise_m_s.value_or(clip.position_noise_m) * 1e3, used), clip.speed_noise_m_s ? "/s" : "",
      smoothing_text(clip), escape(phase_file), clip.speed_noise_m_s ? "" : ", with residuals", escape(motion_file));
  text += notes_html(notes_words(clip.notes));
  if (preview != nullptr) text += images(clip, *preview);
  text += figures(motion_plots(clip));
  text += left_out_table(clip);
  return text;
}

std::string lines_section(const core::AnalysisResults& results) {
  HtmlTable table({"clip", "v", "points", "K/m (1/s)", "a<sub>0</sub> (m/s²)", "R²", "speeds (m/s)"}, 2);
  for (const core::ClipResult& clip : results.clips) {
    for (const core::LineFit& line : clip.segments) {
      table.row({escape(clip.name), line.direction < 0 ? "v &lt; 0" : "v &gt; 0", fmt::format("{}", line.points),
                 base::value_and_sd_text(line.k_over_m_1_s.value, line.k_over_m_1_s.sd),
                 base::value_and_sd_text(line.a0_m_s2.value, line.a0_m_s2.sd), base::r2_text(line.r2),
                 fmt::format("{:.3f} … {:.3f}", line.from_v_m_s, line.to_v_m_s)});
    }
  }
  std::string text = "<h2 id=\"lines\">Fitted lines, a = a<sub>0</sub> − (K/m) v</h2>\n";
  return text + (table.empty() ? "<p>No line could be fitted.</p>\n" : table.str());
}

Html clips_section(const core::AnalysisResults& results, const std::vector<core::Preview>& previews,
                   const base::Progress& progress) {
  const std::vector<std::string> phase_files = phase_file_names(results), motion_files = motion_file_names(results);
  Html text = "<h2 id=\"clips\">Clips</h2>\n<nav><ul>\n";
  for (std::size_t c = 0; c < results.clips.size(); ++c) {
    text += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", clip_anchor(c), escape(results.clips[c].name));
  }
  text += "</ul></nav>\n<p class=\"soft\">In the plots, blue is what the fits use; grey was left out.</p>\n";
  for (std::size_t c = 0; c < results.clips.size(); ++c) {
    progress("writing the report", static_cast<double>(c) / static_cast<double>(results.clips.size()));
    text += clip_html(results.clips[c], c, phase_files[c], motion_files[c], previews.empty() ? nullptr : &previews[c]);
  }
  return text;
}

std::string as_sentence(std::string text) {
  if (!text.empty()) text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return escape(text);
}

Html camera_section(const core::AnalysisResults& results) {
  if (results.calibrations.empty() && results.plumbs.empty()) return {};
  Html text = "<h2 id=\"camera\">Camera and plumb line</h2>\n";
  std::vector<Plot> plots;
  for (const core::CalibrationResult& calibration : results.calibrations) {
    text += fmt::format(
        "<p>{}: calibrated from {} views, corners reprojected to {} px (rms). In the plane of motion the pattern's "
        "corners are reproduced to {} mm (rms).</p>\n",
        escape(calibration.experiment), calibration.views_used, base::number_text(calibration.rms_px, 2),
        base::number_text(calibration.restitution_rms_m * 1e3, 2));
    text += fmt::format(
        "<p>In the image the corners of the plane view are {} px (rms) from where the camera model puts them; their "
        "noise explains {} px. {}.</p>\n",
        base::number_text(calibration.plane_rms_px, 2), base::number_text(calibration.plane_expected_px, 2),
        as_sentence(lens_words(calibration.lens)));
    HtmlTable table({"parameter", "value"});
    const std::vector<double>& m = calibration.camera_matrix;
    const auto sd_of = [&](std::size_t k) { return k < calibration.sd.size() ? calibration.sd[k] : 0.0; };
    if (m.size() == 9) {
      constexpr std::array<const char*, 4> kNames = {"focal length f<sub>x</sub> (px)", "f<sub>y</sub> (px)",
                                                     "principal point c<sub>x</sub> (px)", "c<sub>y</sub> (px)"};
      constexpr std::array<std::size_t, 4> kPlaces = {0, 4, 2, 5};
      for (std::size_t i = 0; i < kNames.size(); ++i) {
        table.row({kNames[i], base::value_and_sd_text(m[kPlaces[i]], sd_of(i))});
      }
    }
    table.row({"lens", lens_of(calibration)});
    const std::array<const char*, 5> names =
        lens_of(calibration) == "fisheye"
            ? std::array<const char*, 5>{"k<sub>1</sub>", "k<sub>2</sub>", "k<sub>3</sub>", "k<sub>4</sub>", ""}
            : std::array<const char*, 5>{"k<sub>1</sub>", "k<sub>2</sub>", "p<sub>1</sub>", "p<sub>2</sub>",
                                         "k<sub>3</sub>"};
    for (std::size_t i = 0; i < std::min(names.size(), calibration.distortion.size()); ++i) {
      const bool fixed = calibration.distortion[i] == 0.0;
      table.row({names[i], fixed ? "0 (left out)" : base::value_and_sd_text(calibration.distortion[i], sd_of(4 + i))});
    }
    if (!table.empty()) text += table.str();
    for (Plot& plot :
         calibration_plots(calibration.rests, results.calibrations.size() > 1 ? calibration.experiment : "")) {
      plots.push_back(std::move(plot));
    }
    text += notes_html(notes_words(calibration.notes));
  }
  for (Plot& plot : pixel_phase_plot(phase_points(results), false)) plots.push_back(std::move(plot));
  text += figures(plots);
  if (!results.plumbs.empty()) {
    HtmlTable table({"group", "inclination against the plumb line"});
    for (const core::PlumbResult& plumb : results.plumbs) {
      std::string cell = quantity_html(plumb.plumb_deg, "°");
      if (!plumb.plumb_deg.estimate) cell += fmt::format(" {}", escape(why_words(plumb.plumb_deg.why)));
      table.row({escape(plumb.group), cell});
    }
    text += table.str();
  }
  return text;
}

std::string method_section() {
  return "<h2 id=\"method\">How these numbers are found</h2>\n"
         "<p>The marker's positions x(t) are smoothed by a cubic that is fitted around every instant with a Gaussian "
         "weight (its width is the bandwidth); the cubic's coefficients are x, v and a there. For a glider under "
         "gravity, a linear viscous drag K v and Coulomb friction, a(v) is one line for v &lt; 0 and another for "
         "v &gt; 0, both of slope −K/m. Half the sum of their values at v = 0 is g sin α, half their difference is "
         "µ g cos α, and the line for v &gt; 0 meets a = 0 at the terminal velocity. Points where the kernel would "
         "reach across a reversal or past an end of the free motion are left out.</p>\n";
}

/// The values from the lines as fitted, and the correction for the kernel's bias; empty if none was subtracted.
std::string corrections_html(const core::AnalysisResults& results) {
  HtmlTable table({"configuration", "quantity", "uncorrected", "correction", "recovered"}, 2);
  for (const core::ConfigurationResult& c : results.configurations) {
    for (const auto& [name, quantity] : quantities_of(c)) {
      if (!quantity->estimate || !quantity->smoothing_correction) continue;
      const double sd = quantity->estimate->sd, correction = *quantity->smoothing_correction;
      table.row({escape(configuration_name(results, c)), escape(with_unit(name.symbol, name.unit)),
                 base::value_text(quantity->estimate->value - correction, sd), base::error_text(correction, sd),
                 base::value_and_sd_text(quantity->estimate->value, sd)});
    }
  }
  if (table.empty()) return {};
  return "<details class=\"part\"><summary>Bias from smoothing, and its correction</summary>\n" + table.str() +
         "<p class=\"soft\">Smoothing biases the fitted lines. The law that was found is put through the same "
         "smoothing and the same fit without noise, and the excess is subtracted. The lines themselves, their slopes "
         "and R² are not corrected.</p></details>\n";
}

}  // namespace

std::vector<std::string> undetermined_words(const core::ConfigurationResult& configuration) {
  std::vector<std::pair<std::string, std::vector<std::string>>> reasons;  // and the quantities that each explains
  for (const auto& [name, quantity] : quantities_of(configuration)) {
    if (quantity->estimate) continue;
    const std::string why = why_words(quantity->why);
    auto found = std::ranges::find(reasons, why, [](const auto& one) { return one.first; });
    if (found == reasons.end()) found = reasons.insert(found, {why, {}});
    found->second.emplace_back(name.symbol);
  }
  std::vector<std::string> words;
  for (const auto& [why, names] : reasons) {
    words.push_back(fmt::format("{} {} not determined: {}", list_of(names), names.size() == 1 ? "is" : "are", why));
  }
  return words;
}

std::string recovered_section(const core::AnalysisResults& results) {
  const bool in_doubt = !doubts_about(results).empty();
  const std::string mark = in_doubt ? " *" : "";
  HtmlTable table({"mass", "stated α", "group", "K/m (1/s)" + mark, "µ" + mark, "α (°)" + mark,
                   "terminal velocity (m/s)" + mark, "R² (v&nbsp;&lt;&nbsp;0)", "R² (v&nbsp;&gt;&nbsp;0)"});
  table.stack_when_narrow(1);
  std::string reasons;
  for (const core::ConfigurationResult& c : results.configurations) {
    table.row({fmt::format("{:.6g} kg", c.mass_kg), fmt::format("{:.4g}°", c.incline_deg), escape(c.group),
               quantity_html(c.k_over_m_1_s, ""), quantity_html(c.mu, ""), quantity_html(c.alpha_deg, ""),
               quantity_html(c.v_lim_m_s, ""), r2_of(c.lines, -1), r2_of(c.lines, 1)});
    for (const std::string& words : undetermined_words(c)) {
      reasons += fmt::format("<li>{}: {}</li>\n", escape(configuration_name(results, c)), escape(words));
    }
  }
  std::string text = "<h2 id=\"recovered\">Recovered values</h2>\n" + table.str();
  if (in_doubt) text += fmt::format("<p class=\"note\">* {}</p>\n", kIfItHeld);
  std::vector<std::string> notes;
  for (const core::ConfigurationResult& c : results.configurations) {
    for (const core::Note& note : c.notes)
      notes.push_back(fmt::format("{}: {}", configuration_name(results, c), note_words(note)));
  }
  text += "<p class=\"soft\">± is one standard deviation. α is the inclination as the motion itself shows it.</p>\n";
  text += notes_html(notes) + corrections_html(results);
  if (!reasons.empty()) text += "<ul class=\"soft\">\n" + reasons + "</ul>\n";
  return text;
}

Html phase_section(const core::AnalysisResults& results) {
  Html text = "<h2 id=\"phase\">Phase diagrams</h2>\n";
  const std::vector<PhaseGroup> groups = phase_groups(results);
  for (const PhaseGroup& group : groups) {
    const std::vector<Plot> plots = phase_plots(results, group);
    text += fmt::format("<h3>Track inclined {:.4g}° (as stated)</h3>\n", group.incline_deg);
    text += plots.empty() ? "<p>No point of these clips could be used.</p>\n" : figures(plots);
  }
  return text;
}

Html details_sections(const core::AnalysisResults& results, const std::vector<core::Preview>& previews,
                      const base::Progress& progress) {
  return lines_section(results) + camera_section(results) + clips_section(results, previews, progress) +
         method_section();
}

}  // namespace glidelab::report
