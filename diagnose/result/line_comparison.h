/// What a diagnosis says about a table of lines beyond what it says about motions, as plain data for report/.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "diagnose/result/explanation.h"

namespace glidelab::diagnose {

struct LineSize {
  std::string key;  ///< with its unit
  double value = 0.0;
  double sd = 0.0;  ///< from the residuals of the explanation
};

/// A size that a fit needs but that is physically impossible.
struct ImpossibleSize {
  std::string key;  ///< with its unit
  double value = 0.0;
  std::optional<double> largest;  ///< largest possible size; none if the value is negative and must not be
};

/// Lines with their own mu, or K: one for each mass, for each set-up, or for each mass on each set-up.
enum class LinesOver { mass, set_up, mass_and_set_up };

/// How configuration_friction or configuration_drag divides the lines.
struct LineForm {
  std::string id;
  LinesOver over = LinesOver::mass;
};

/// One explanation of the lines.
struct LineCandidate {
  Explanation explanation;
  std::vector<LineForm> forms;  ///< of the effects that have one; the same effects in other forms are other candidates
  double probability = 0.0;
  double log_evidence_gain = 0.0;
  double log_likelihood_gain = 0.0;
  std::size_t terms = 0;                   ///< in addition to those of the nominal model
  std::vector<LineSize> sizes;             ///< of the effects; for an effect with a form, the spread over its parts
  std::optional<double> chi2, gap;         ///< over the lines' own scatter, if that is known
  std::optional<ImpossibleSize> left_out;  ///< why it was not weighed, if it was not
};

/// The residuals of the nominal model for one line.
struct LineOff {
  double mass_kg = 0.0, incline_deg = 0.0;
  int direction = 0;
  double k_over_m_1_s = 0.0;
  double friction_m_s2 = 0.0;  ///< -direction times the residual of the intercept
  double log_k = 0.0;
};

/// The friction that an explanation adds to the nominal model's, divided by the mass.
struct LineCurve {
  std::string id;
  std::vector<double> mass_kg, k_over_m_1_s, friction_m_s2;
};

struct LineComparison {
  std::size_t lines = 0;
  double intercept_sd_m_s2 = 0.0, slope_sd = 0.0;  ///< the lines' own scatter; 0 if nothing is repeated
  std::size_t scatter_freedom = 0;
  std::optional<double> chi2_before;      ///< of the nominal model, if the scatter is known
  std::vector<std::string> either_of;     ///< effects that share the evidence; empty if one stands out
  double either_probability = 0.0;        ///< that one or several of them act, and nothing else
  std::vector<LineCandidate> candidates;  ///< the likeliest first, the ones that were not weighed last
  std::vector<LineOff> off;
  std::vector<LineCurve> curves;
};

}  // namespace glidelab::diagnose
