/// Result files of an analysis for other programs: results.json, and tables of each clip's smoothed motion.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result/results.h"
#include "report/text/json_numbers.h"

namespace glidelab::report {

/// `motion-<clip>.csv`: the smoothed motion of one clip and its residuals, one row for every frame.
///
///     t_s,measured_x_m,x_m,sd_x_m,residual_x_m,v_m_s,sd_v_m_s,a_m_s2,sd_a_m_s2,line_a_m_s2,residual_a_m_s2,reason
///
/// residual_x_m = measured_x_m - x_m. line_a_m_s2 = a0 - (K/m) v by the clip's own line for the sign of v, and
/// residual_a_m_s2 = a_m_s2 - line_a_m_s2; both are empty if there is no line, and for a clip with a known force, whose
/// line is for a - F/m. Fields without a value are empty; `reason` says why a frame is not used for a line; it is
/// "used" if the frame is.
///
/// NumericalError if a value is not finite.
std::string motion_csv(const core::ClipResult& clip);

/// `motion-<clip>.csv` for each clip, as in phase_file_names().
std::vector<std::string> motion_file_names(const core::AnalysisResults& results);

/// `phase-<clip>.csv`: the smoothed motion of one clip, one row for each frame that has smoothed values.
///
///     t_s,x_m,v_m_s,a_m_s2,used,sd_v_m_s,sd_a_m_s2,measured_x_m,reason
///
/// The first seven columns are numbers in every row; `used` is 1 if the point is used in the fit of a line, and 0 if it
/// is not, for the reason in the last column. `measured_x_m` is empty if no marker was found. Frames that were not
/// smoothed (before the start, at rest, …) have no row; "left_out" of results.json lists them.
///
/// NumericalError if a value is not finite.
std::string phase_csv(const core::ClipResult& clip);

/// The text of results.json: the results of an analysis, in a format for other programs. It depends only on the
/// results.
///
/// A quantity that the data do not determine is null, and the object "why" next to it gives the reason. Beyond the
/// required format, clips contain their stretches, omitted points, notes and the name of their CSV; configurations
/// contain their group and lines; if there are several folders, the calibration of each is in "calibrations". `with` is
/// the result of a fit with causes in the model (report/diagnosis/given_causes_report.h); if it is null, there was
/// none, and the object is omitted.
std::string results_json(const core::AnalysisResults& results, const Json& with = nullptr);

/// Writes results.json, `phase-<clip>.csv` and `motion-<clip>.csv` into the folder.
void write_analysis_files(const core::AnalysisResults& results, const std::filesystem::path& dir,
                          const Json& with = nullptr);

/// "fisheye" or "brown-conrady": a fisheye's distortion has four terms, k1 to k4; the other has five.
std::string lens_of(const core::CalibrationResult& calibration);

}  // namespace glidelab::report
