/// Result files of an analysis, as other programs read them: results.json, and tables of each clip's smoothed motion.
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
/// residual_a_m_s2 = a_m_s2 - line_a_m_s2; both are empty if there is no line, and for a clip with a known force,
/// whose line is one of a - F/m. Fields that have no value are empty; `reason` says why a frame is not in a line,
/// "used" where it is.
///
/// NumericalError if a value is not finite.
std::string motion_csv(const core::ClipResult& clip);

/// `motion-<clip>.csv` for each clip, as phase_file_names() has it.
std::vector<std::string> motion_file_names(const core::AnalysisResults& results);

/// `phase-<clip>.csv`: the smoothed motion of one clip, one row for each frame that has smoothed values.
///
///     t_s,x_m,v_m_s,a_m_s2,used,sd_v_m_s,sd_a_m_s2,measured_x_m,reason
///
/// The first seven columns are numbers in every row; `used` is 1 where the point is in a fit of a line and 0 where it
/// is not, for the reason in the last column. `measured_x_m` is empty if no marker was found. Frames that were not
/// smoothed (before the start, at rest, …) have no row; "left_out" of results.json lists them.
///
/// NumericalError if a value is not finite.
std::string phase_csv(const core::ClipResult& clip);

/// The text of results.json: what an analysis found, in the form that other programs read. It depends on the results
/// alone.
///
/// A quantity that the data do not determine is null, and the object "why" beside it says why. Beyond what the form
/// asks for, clips hold their stretches, what was left out, notes and the name of their CSV; configurations their group
/// and lines; every folder's calibration stands in "calibrations" where there are several. `with` is what a fit with
/// causes in the model gives (report/diagnosis/given_causes_report.h); null: there was none, and no such object.
std::string results_json(const core::AnalysisResults& results, const Json& with = nullptr);

/// results.json, `phase-<clip>.csv` and `motion-<clip>.csv` into the folder.
void write_analysis_files(const core::AnalysisResults& results, const std::filesystem::path& dir,
                          const Json& with = nullptr);

/// "fisheye" or "brown-conrady": a fisheye's distortion has four terms, k1 to k4, the other five.
std::string lens_of(const core::CalibrationResult& calibration);

}  // namespace glidelab::report
