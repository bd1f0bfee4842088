/// The verdict on a table of published lines in plain words.
#pragma once

#include <string>

#include "diagnose/result/diagnosis.h"

namespace glidelab::report {

/// The result for a table of lines in plain words: a paragraph for a reader who knows the experiment but no statistics.
/// `diagnosis.lines` must be set.
std::string line_words(const diagnose::Diagnosis& diagnosis);

/// "a separate µ for each mass", for each form; empty if an explanation has none.
std::string forms_words(const diagnose::LineCandidate& candidate);

/// Why an explanation was not weighed: "force would have to be -3.1 mN, and it cannot be below zero".
std::string impossible_words(const diagnose::ImpossibleSize& size);

}  // namespace glidelab::report
