/// What a certificate finds (validate/study/certify/certificate.h), in words.
#pragma once

#include <string>
#include <vector>

#include "validate/study/certify/certificate.h"

namespace glidelab::report {

/// "94".
std::string whole_percent(double share);

/// "94 % (90 to 97 %)".
std::string percent_text(double share, double low, double high);

/// How much smaller an error became: "94 % (90 to 97 %)"; where it more than doubled, rise_text().
std::string fall_text(const validate::RunFall& fall);

/// How much larger: "15 % (10 to 20 %) larger", "240 times larger (20 to 2900)".
std::string rise_text(const validate::RunFall& fall);

/// Whether the change makes the errors of this quantity larger, by more than chance and by a tenth or more.
bool makes_worse(const validate::QuantityFall& one);

/// One limitation of a recording. Text.
struct LimitWords {
  std::string limit;   ///< "noise", "calibration", "few clips"
  std::string change;  ///< what its twins have instead: "half the noise of each pixel"
  std::string advice;  ///< what the user can do, without a full stop: "Use a larger marker"
};
LimitWords limit_words(const validate::ChangedTwin& changed, const validate::Certificate& certificate);

/// "4 clips", "1 clip with 11 motions": of the recording.
std::string clip_words(const validate::Certificate& certificate);

/// What the twins lack, with the reason in brackets: "track bow (…)". Text.
std::string lack_words(const validate::NotInTwins& lack);

/// "The recording has what its twins lack: …"; empty if nothing is missing. Text.
std::string all_lacks(const validate::Certificate& certificate);

/// "No twin has a value of µ and α: …", for each quantity without any; empty if there is none. Text.
std::string all_unanswered(const validate::Certificate& certificate);

/// Why no twin has an estimate of the quantity. Text.
std::string unanswered_words(const validate::CertifiedQuantity& quantity);

/// How the twins were made. Text.
std::string twin_words(const validate::Certificate& certificate);

/// "0.335 kg, 4°", for each of the setups; with the name in the twin's scenario if another one reads the same.
std::vector<std::string> setup_names(const validate::Certificate& certificate);

}  // namespace glidelab::report
