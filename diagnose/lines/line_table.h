/// A table of fitted lines a = a0 - (K/m) v, as printed in a paper, in place of clips.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/errors.h"
#include "core/experiment/experiment.h"

namespace glidelab::diagnose {

struct TableLine {
  double mass_kg = 0.0;
  double incline_deg = 0.0;
  int direction = 0;  ///< sign of v in the fitted range
  double a0_m_s2 = 0.0;
  double k_over_m_1_s = 0.0;
  double a0_digit_m_s2 = 0.0, k_digit_1_s = 0.0;  ///< what the last digit in the table is worth; 0: not rounded
};

inline constexpr std::size_t kFewestLines = 6;

/// Columns mass_kg,incline_deg,direction,a0_m_s2,k_over_m_1_s,r2; others are ignored. InputError for what is out of
/// range and for fewer than kFewestLines.
std::vector<TableLine> read_lines(const std::filesystem::path& file);

/// An experiment folder; or a table of lines that lies in no folder, a CSV file: an experiment named after the file, of
/// its lines alone, with the default gravity. InputError as read_experiment(); what is in the table is not looked at.
core::Experiment read_recording(const std::filesystem::path& path, core::OutsideFiles outside);

/// The issue of a table with too few lines.
base::Issue too_few_lines(const std::string& file, std::size_t lines);

/// The values of a member among the lines, ascending, each once.
std::vector<double> different(const std::vector<TableLine>& lines, double TableLine::*member);

}  // namespace glidelab::diagnose
