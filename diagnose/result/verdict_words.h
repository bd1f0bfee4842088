/// The verdict in plain words.
#pragma once

#include <string>

#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// A probability for a person: "87 %", "more than 99 %" from 0.995 on, "less than 1 %" below 0.005.
std::string percent(double probability);

/// A paragraph for somebody who knows the experiment and no statistics.
std::string summary_of(const Diagnosis& diagnosis);

/// Whether the usual model follows the positions to their noise, and is unknown's verdict for what is stated alone: an
/// inclination that the motion contradicts, a drag or friction below zero.
bool only_statements_fail(const Diagnosis& diagnosis);

/// "none", "effect" or "unknown", by the probabilities of nothing and of something without a name. Something is claimed
/// only where it is three times as likely as nothing.
std::string verdict_by(double none, double unknown);

}  // namespace glidelab::diagnose
