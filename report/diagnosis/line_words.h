/// What a table of lines says, in plain words.
#pragma once

#include <string>

#include "diagnose/result/diagnosis.h"

namespace glidelab::report {

/// A paragraph for somebody who knows the experiment and no statistics. `diagnosis.lines` is there.
std::string line_words(const diagnose::Diagnosis& diagnosis);

/// "a friction of each mass by itself"
std::string unnamed_words(const diagnose::UnnamedInLines& of);

/// Why an explanation was not weighed: "force would have to be -3.1 mN, and it cannot be below zero".
std::string impossible_words(const diagnose::ImpossibleSize& size);

}  // namespace glidelab::report
