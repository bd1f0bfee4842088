/// The verdict in plain words, of clips and of published lines.
#pragma once

#include <string>

#include "diagnose/result/diagnosis.h"

namespace glidelab::report {

/// A paragraph for somebody who knows the experiment and no statistics.
std::string verdict_words(const diagnose::Diagnosis& diagnosis);

/// Why a gap has no interval over clips; empty where clips are not too few.
std::string too_few_words(const diagnose::GapIntervals& intervals);

}  // namespace glidelab::report
