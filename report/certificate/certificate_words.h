/// What a certificate finds (validate/study/certify/certificate.h), in words.
#pragma once

#include <string>
#include <vector>

#include "validate/study/certify/certificate.h"

namespace glidelab::report {

/// One limitation of a recording. Text.
struct LimitWords {
  std::string limit;   ///< "noise", "calibration", "few clips"
  std::string change;  ///< what its twins have instead: "half the noise of each pixel"
  std::string advice;  ///< what the user can do, without a full stop: "Use a larger marker"
};
LimitWords limit_words(const validate::ChangedTwin& changed);

/// What the twins lack, with the reason in brackets: "track bow (…)". Text.
std::string lack_words(const validate::NotInTwins& lack);

/// Why no twin has an estimate of the quantity. Text.
std::string unanswered_words(const validate::CertifiedQuantity& quantity);

/// "0.335 kg, 4°", for each of the setups; with the name in the twin's scenario if another one reads the same.
std::vector<std::string> setup_names(const validate::Certificate& certificate);

}  // namespace glidelab::report
