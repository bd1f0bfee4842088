/// K/m, mu, alpha and the terminal velocity with causes in the model that a person names, as plain data
/// (diagnose/verdict/fit_given_causes.h fits it).
#pragma once

#include <string>
#include <vector>

#include "diagnose/result/diagnosis.h"
#include "diagnose/result/note.h"

namespace glidelab::diagnose {

/// One of these causes with its fitted size.
struct GivenCause {
  std::string id;
  std::vector<DiagnosedParameter> parameters;
};

struct GivenCauses {
  std::vector<GivenCause> causes;  ///< in the order in which they were named
  std::vector<RecoveredConfiguration> recovered;
  /// Of held-out clips (of quarters of a single one), with the nominal model and with the causes; 1 is the floor
  /// (gap/held_out.h).
  double gap_before = 1.0, gap_after = 1.0;
  double standard_error = 0.0;  ///< of a gap at the floor
  bool converged = true;        ///< false: the fit did not reach a minimum
  std::vector<Note> notes;
};

}  // namespace glidelab::diagnose
