/// A table of fitted lines a = a0 - (K/m) v, as a paper prints it, instead of clips.
///
/// The nominal model gives, for a line of mass m, set-up g and direction s,
///
///     ln(k) = ln(K/m),     a0 = gravity sin(alpha_g) - s mu gravity cos(alpha_g)
///
/// and each effect adds its own term to one or both. A table states no errors: those of ln(k) and of a0 are unknown and
/// are what the lines scatter, so that few lines carry little. Of n lines with p0 nominal parameters, p terms that
/// leave RSS of the nominal model's RSS_0 have the Bayes factor, for unknown scatter and terms as large as one line
/// tells (Zellner's g-prior with g = n; Liang et al. 2008),
///
///     (1 + n)^((n - p0 - p) / 2) / (1 + n RSS / RSS_0)^((n - p0) / 2)
///
/// for each kind of data. Predictions of a line by the other lines are the held-out gap.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "diagnose/diagnosis.h"

namespace glidelab::diagnose {

struct TableLine {
  double mass_kg = 0.0;
  double incline_deg = 0.0;
  int direction = 0;
  double a0_m_s2 = 0.0;
  double k_over_m_1_s = 0.0;
};

/// Columns mass_kg,incline_deg,direction,a0_m_s2,k_over_m_1_s,r2; others are ignored. InputError for what is out of
/// range.
std::vector<TableLine> read_lines(const std::filesystem::path& file);

/// InputError for fewer than six lines.
Diagnosis diagnose_lines(const std::vector<TableLine>& lines, double gravity_m_s2);

}  // namespace glidelab::diagnose
