#include "report/analysis/result_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/text/csv.h"
#include "core/result/quantity.h"
#include "core/result/results.h"
#include "report/analysis/doubts.h"
#include "report/analysis/left_out_clips.h"
#include "report/analysis/motion_plots.h"
#include "report/analysis/note_words.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

/// A row for one frame of the clip, at t_s. Table and clip must outlive it.
class MotionRow {
 public:
  MotionRow(base::CsvWriter& table, const core::ClipResult& clip, double t_s) : table_(table), clip_(clip), t_s_(t_s) {}
  /// NumericalError if the number is not finite; it names the clip and the time.
  void put(std::optional<double> value) {
    if (!value) {
      table_.empty();
    } else if (std::isfinite(*value)) {
      table_.number(*value);
    } else {
      throw base::NumericalError(
          fmt::format("clip \"{}\": the smoothed motion at t = {} s is not finite", clip_.name, t_s_));
    }
  }

 private:
  base::CsvWriter& table_;
  const core::ClipResult& clip_;
  double t_s_;
};

/// a on the clip's own line; empty if there is none, and for a clip with a known force.
std::optional<double> own_line_at(const core::ClipResult& clip, double v_m_s) {
  const core::LineFit* const line = clip.forced ? nullptr : line_of(clip.segments, v_m_s);
  return line == nullptr ? std::nullopt : std::optional(line_at(*line, v_m_s));
}

}  // namespace

std::string phase_csv(const core::ClipResult& clip) {
  base::CsvWriter table("t_s,x_m,v_m_s,a_m_s2,used,sd_v_m_s,sd_a_m_s2,measured_x_m,reason");
  for (const core::MotionPoint& point : clip.motion) {
    if (!point.smoothed) continue;
    MotionRow row(table, clip, point.t_s);
    row.put(point.t_s);
    row.put(clip.speed_noise_m_s ? std::nullopt : std::optional(point.x_m));
    for (const double value : {point.v_m_s, point.a_m_s2}) row.put(value);
    row.put(point.left_out == core::LeftOut::used ? 1.0 : 0.0);
    for (const double value : {point.sd_v_m_s, point.sd_a_m_s2}) row.put(value);
    row.put(point.measured_m);
    table.text(core::describe(point.left_out));
    table.end_row();
  }
  return table.str();
}

std::string motion_csv(const core::ClipResult& clip) {
  base::CsvWriter table(
      "t_s,measured_x_m,x_m,sd_x_m,residual_x_m,v_m_s,sd_v_m_s,a_m_s2,sd_a_m_s2,line_a_m_s2,residual_a_m_s2,reason");
  for (const core::MotionPoint& point : clip.motion) {
    MotionRow row(table, clip, point.t_s);
    const auto smoothed = [&](double value) { return point.smoothed ? std::optional(value) : std::nullopt; };
    row.put(point.t_s);
    row.put(point.measured_m);
    row.put(clip.speed_noise_m_s ? std::nullopt : smoothed(point.x_m));
    row.put(clip.speed_noise_m_s ? std::nullopt : smoothed(point.sd_x_m));
    row.put(point.measured_m ? smoothed(*point.measured_m - point.x_m) : std::nullopt);
    row.put(smoothed(point.v_m_s));
    row.put(smoothed(point.sd_v_m_s));
    row.put(smoothed(point.a_m_s2));
    row.put(smoothed(point.sd_a_m_s2));
    const std::optional<double> line = point.smoothed ? own_line_at(clip, point.v_m_s) : std::nullopt;
    row.put(line);
    row.put(line ? std::optional(point.a_m_s2 - *line) : std::nullopt);
    table.text(core::describe(point.left_out));
    table.end_row();
  }
  return table.str();
}

std::vector<std::string> motion_file_names(const core::AnalysisResults& results) {
  std::vector<std::string> names = phase_file_names(results);
  for (std::string& name : names) name.replace(0, std::string("phase").size(), "motion");
  return names;
}

namespace {

Json line_json(const core::LineFit& line) {
  Json object;
  object["direction"] = line.direction;
  object["points"] = line.points;
  put(object, "k_over_m_1_s", line.k_over_m_1_s);
  put(object, "a0_m_s2", line.a0_m_s2);
  put(object, "covariance_k_over_m_a0", line.covariance);
  put(object, "r2", line.r2);
  object["v_range_m_s"] = {line.from_v_m_s, line.to_v_m_s};
  return object;
}

Json lines_json(const std::vector<core::LineFit>& lines) {
  Json list = Json::array();
  for (const core::LineFit& line : lines) list.push_back(line_json(line));
  return list;
}

Json strength_json(const core::SmoothingStrength& strength) {
  Json object;
  object["smoother"] = strength.smoother;
  object["method"] = strength_words(strength.method);
  if (strength.order > 0) {
    object["order"] = strength.order;
    put(object, "rate_1_s", strength.rate_1_s);
  }
  put(object, "time_s", strength.time_s);
  put(object, "noise_sd_m", strength.noise_sd_m);
  if (strength.jump_sd_m_s2) {
    if (std::isinf(*strength.jump_sd_m_s2)) {
      put(object, "jump_sd_m_s2", std::nullopt, "any jump of a is allowed at a break");
    } else {
      put(object, "jump_sd_m_s2", *strength.jump_sd_m_s2);
    }
  }
  object["breaks_s"] = Json::array();
  for (const double at : strength.breaks_s) object["breaks_s"].push_back(at);
  put(object, "parameters", strength.parameters);
  if (strength.simultaneous_a) put(object, "simultaneous_a", *strength.simultaneous_a);
  return object;
}

Json clip_json(const core::ClipResult& clip, const std::string& phase_file) {
  Json object;
  object["name"] = clip.name;
  object["experiment"] = clip.experiment;
  object["frames"] = clip.frames;
  object["detected"] = clip.detected;
  put(object, "frame_rate_hz", clip.frame_rate_hz);
  put(object, "bandwidth_s", clip.bandwidth_s);
  object["bandwidth_method"] = strength_words(clip.bandwidth_method);
  if (clip.strength) object["smoothing"] = strength_json(*clip.strength);
  if (clip.speed_noise_m_s) {
    put(object, "position_noise_m", std::nullopt, "speeds were measured, and no positions");
    put(object, "speed_noise_m_s", *clip.speed_noise_m_s);
  } else {
    put(object, "position_noise_m", clip.position_noise_m);
  }
  if (clip.rounding_m) put(object, "rounding_m", *clip.rounding_m);
  if (!clip.lost_frames.empty()) {
    object["lost_frames"] = Json::array();
    for (const core::LostFrames& gap : clip.lost_frames) {
      object["lost_frames"].push_back({{"after_s", gap.after_s}, {"count", gap.count}});
    }
  }
  object["segments"] = lines_json(clip.segments);
  put(object, "v_lim_m_s", clip.v_lim_m_s);
  object["stretches"] = Json::array();
  for (const core::Stretch& stretch : clip.stretches) {
    object["stretches"].push_back({{"from_s", stretch.from_s},
                                   {"to_s", stretch.to_s},
                                   {"direction", stretch.direction},
                                   {"points", stretch.points}});
  }
  object["left_out"] = Json::array();
  for (const core::LeftOutInterval& interval : clip.left_out) {
    object["left_out"].push_back({{"from_s", interval.from_s},
                                  {"to_s", interval.to_s},
                                  {"frames", interval.frames},
                                  {"reason", core::describe(interval.reason)}});
  }
  object["notes"] = notes_words(clip.notes);
  object["phase_file"] = phase_file;
  return object;
}

Json configuration_json(const core::ConfigurationResult& configuration) {
  Json object;
  object["mass_kg"] = configuration.mass_kg;
  object["incline_deg"] = configuration.incline_deg;
  object["group"] = configuration.group;
  object["clips"] = configuration.clips;
  for (const core::QuantityName& quantity : core::kQuantities) {
    put(object, std::string(quantity.key).c_str(), core::value_of(configuration, quantity.which));
  }
  object["lines"] = lines_json(configuration.lines);
  object["notes"] = notes_words(configuration.notes);
  return object;
}

Json calibration_json(const core::CalibrationResult& calibration) {
  Json object;
  object["experiment"] = calibration.experiment;
  put(object, "rms_px", calibration.rms_px);
  object["camera_matrix"] = calibration.camera_matrix;
  object["lens"] = lens_of(calibration);
  object["distortion"] = calibration.distortion;
  object["sd"] = calibration.sd;
  object["model"] = lens_words(calibration.lens);
  put(object, "restitution_rms_m", calibration.restitution_rms_m);
  put(object, "plane_rms_px", calibration.plane_rms_px);
  put(object, "plane_expected_px", calibration.plane_expected_px);
  object["views_used"] = calibration.views_used;
  object["notes"] = notes_words(calibration.notes);
  return object;
}

/// For one set-up its angle; for several, each under its name, as the format requires.
Json inclination_json(const core::AnalysisResults& results) {
  std::vector<std::string> groups;
  for (const core::ConfigurationResult& configuration : results.configurations) {
    if (std::find(groups.begin(), groups.end(), configuration.group) == groups.end()) {
      groups.push_back(configuration.group);
    }
  }
  Json object;
  Json by_group = Json::object();
  for (const core::PlumbResult& plumb : results.plumbs) {
    std::string name = plumb.group;
    for (int n = 2; by_group.contains(name); ++n) name = fmt::format("{} ({})", plumb.group, n);
    put(by_group[name], "plumb_deg", plumb.plumb_deg);
  }
  if (results.plumbs.empty()) {
    put(object, "plumb_deg", std::nullopt, "there is no view of a plumb line");
  } else if (results.plumbs.size() == 1 && groups.size() <= 1) {
    put(object, "plumb_deg", results.plumbs.front().plumb_deg);
  } else {
    put(object, "plumb_deg", std::nullopt, "there are several groups; see \"groups\"");
  }
  if (!by_group.empty()) object["groups"] = std::move(by_group);
  return object;
}

}  // namespace

std::string lens_of(const core::CalibrationResult& calibration) {
  return calibration.distortion.size() == 4 ? "fisheye" : "brown-conrady";
}

std::string results_json(const core::AnalysisResults& results, const Json& with) {
  Json document;
  document["format"] = 1;
  document["estimator"] = results.estimator;
  const std::vector<std::string> phase_files = phase_file_names(results);
  document["clips"] = Json::array();
  for (std::size_t c = 0; c < results.clips.size(); ++c) {
    document["clips"].push_back(clip_json(results.clips[c], phase_files[c]));
  }
  document["configurations"] = Json::array();
  for (const core::ConfigurationResult& configuration : results.configurations) {
    document["configurations"].push_back(configuration_json(configuration));
  }
  document["calibration"] = nullptr;
  if (!results.calibrations.empty()) document["calibration"] = calibration_json(results.calibrations.front());
  if (results.calibrations.size() > 1) {
    document["calibrations"] = Json::array();
    for (const core::CalibrationResult& calibration : results.calibrations) {
      document["calibrations"].push_back(calibration_json(calibration));
    }
  }
  document["inclination"] = inclination_json(results);
  document["clips_left_out"] = left_out_json(results.left_out);
  document["doubts"] = doubts_about(results);
  if (!with.is_null()) document["with"] = with;
  return json_text(document);
}

void write_analysis_files(const core::AnalysisResults& results, const std::filesystem::path& dir, const Json& with) {
  base::write_file(dir / "results.json", results_json(results, with));
  const std::vector<std::string> names = phase_file_names(results);
  const std::vector<std::string> motions = motion_file_names(results);
  for (std::size_t c = 0; c < results.clips.size(); ++c) {
    base::write_file(dir / names[c], phase_csv(results.clips[c]));
    base::write_file(dir / motions[c], motion_csv(results.clips[c]));
  }
}

}  // namespace glidelab::report
