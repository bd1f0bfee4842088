/// The verdict in plain words.
#pragma once

#include <string>

#include "diagnose/diagnosis.h"

namespace glidelab::diagnose {

/// A paragraph for somebody who knows the experiment and no statistics.
std::string summary_of(const Diagnosis& diagnosis);

/// "none", "effect" or "unknown", by the probabilities of nothing and of something without a name. Something is claimed
/// only where it is three times as likely as nothing.
std::string verdict_by(double none, double unknown);

}  // namespace glidelab::diagnose
