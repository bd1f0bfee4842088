/// What images show (diagnose/result/image_fact.h) as sentences.
#pragma once

#include <string>

#include "diagnose/result/image_fact.h"

namespace glidelab::report {

/// "The marker is smeared as by an exposure of 4.1 ± 0.2 ms; 1 ms is stated."
std::string image_words(const diagnose::ImageFact& fact);

}  // namespace glidelab::report
