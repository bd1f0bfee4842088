/// The verdict in plain words.
#pragma once

#include <string>

#include "diagnose/diagnosis.h"

namespace glidelab::diagnose {

/// A paragraph for somebody who knows the experiment and no statistics.
std::string summary_of(const Diagnosis& diagnosis);

}  // namespace glidelab::diagnose
