/// The findings of a check (core/check/finding.h) as sentences.
#pragma once

#include <string>
#include <vector>

#include "core/check/finding.h"

namespace glidelab::report {

/// What was found, and what to do about it; no advice if nothing is to be done.
struct FindingWords {
  std::string found, advice;
};
FindingWords finding_words(const core::Found& found);

/// One finding in words, with its consequences.
struct WordedFinding {
  core::Severity severity = core::Severity::note;
  std::string about;   ///< "pattern", "masses", "plumb line", or clips' names
  std::string found;   ///< "the marker is 4.1 px wide"
  std::string advice;  ///< "move closer or use a bigger one"
  std::vector<std::string> follow = {};

  std::string headline() const;  ///< what was found, and how many findings follow from it
};

/// The findings in words; those that read the same are one, about all their subjects.
std::vector<WordedFinding> worded(const std::vector<core::Finding>& findings);

}  // namespace glidelab::report
