/// Words of a diagnosis: its explanations as ids (for files and terminals) and as names (for readers), its notes
/// (diagnose/result/note.h) as sentences.
#pragma once

#include <string>
#include <vector>

#include "diagnose/result/diagnosis.h"
#include "diagnose/result/note.h"

namespace glidelab::report {

/// "none", "scale_error", "scale_error + tether", "unknown", "scale_error + unknown".
std::string explanation_id(const diagnose::Explanation& explanation);

/// The same in the short names of effects: "wrong scale + an unnamed cause".
std::string explanation_name(const diagnose::Explanation& explanation);

/// The name, with the id in small type next to it. HTML.
std::string explanation_html(const diagnose::Explanation& explanation);

/// A probability for the reader: "87 %", "more than 99 %" from 0.995 on, "less than 1 %" below 0.005.
std::string percent(double probability);

/// The effects that a sentence tells as not to be told apart, the effect itself among them: not those that are less
/// than a twentieth as likely as the likeliest, or whose probability prints as "less than 1 %". Empty if it stands
/// alone.
std::vector<diagnose::AlikeEffect> told_alike(const diagnose::DiagnosedEffect& effect);

std::string note_words(const diagnose::Note& note);

std::vector<std::string> notes_words(const std::vector<diagnose::Note>& notes);

/// Removes the standard deviation of the motion's angle (sets it to 0) if it is that of the nominal model and something
/// is missing: such an angle may be off by many standard deviations.
diagnose::ContradictedIncline as_told(diagnose::ContradictedIncline of, const diagnose::Diagnosis& diagnosis);

/// The diagnosis' notes, with angles as_told().
std::vector<std::string> notes_words(const diagnose::Diagnosis& diagnosis);

}  // namespace glidelab::report
