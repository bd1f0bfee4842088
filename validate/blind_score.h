/// Diagnoses of blind cases held against their truths.
///
/// Two pairs of effects are the same thing on tracks and count as one (effects.md: "cannot be told apart, always"):
/// scale_error and frame_rate_error; camera_motion and base_vibration. Pictures tell the second pair apart. Weak cases
/// gain less than 15 in log likelihood, moderate ones 15 to 50, strong ones more.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "validate/blind_case.h"
#include "validate/blind_verdict.h"

namespace glidelab::validate {

struct BlindOutcome {
  std::size_t index = 0;
  BlindKind kind = BlindKind::none;
  std::vector<BlindCause> causes;
  std::size_t clips = 0;
  BlindVerdict verdict;
  std::optional<BlindVerdict> left_out;  ///< with the true effect taken from the list
  bool filmed = false;
};

/// scale_error and frame_rate_error give one word; so do camera_motion and base_vibration on tracks.
std::string blind_class(const std::string& id, bool filmed);
/// That of the one cause.
std::string true_class(const BlindOutcome& outcome);
/// All that a verdict names, as classes: its effects and their equals.
std::set<std::string> named_by(const BlindOutcome& outcome);
inline constexpr double kSureName = 0.8;  ///< a name with more is a sure one

/// "weak", "moderate", "strong"; of a pair by its weaker cause.
std::string_view strength_word(const BlindOutcome& outcome);

struct BlindShare {
  std::size_t of = 0, yes = 0;
  double share() const { return of == 0 ? 0.0 : static_cast<double>(yes) / static_cast<double>(of); }
};

/// How often one way of deciding is right.
struct BlindMethod {
  std::string name;
  BlindShare none, outside, pair;
  std::map<std::string, BlindShare> single;  ///< by strength
};

struct ReliabilityBin {
  double from = 0.0, to = 0.0;
  double stated = 0.0;  ///< mean
  BlindShare right;
};

/// One line of a table of confusions.
struct ConfusionRow {
  std::string truth;
  std::map<std::string, std::size_t> said;  ///< first name, none, unknown, failed
};

struct BlindScore {
  std::vector<BlindMethod> methods;              ///< the diagnosis first
  std::map<std::string, BlindShare> in_set;      ///< single cases: truth among what is named, by strength
  std::map<std::string, BlindShare> exact;       ///< single cases: the very id first, by strength
  std::map<std::string, BlindShare> recognised;  ///< outside: unknown, by strength
  BlindShare false_alarm;                        ///< none: anything else
  BlindShare wrong_name;                         ///< outside: a name with probability over 0.8
  BlindShare where;                              ///< outside and unknown: the true variable among the regions
  BlindShare where_first;                        ///< outside and unknown: it is that of the first one
  std::vector<ReliabilityBin> reliability;
  double calibration_error = 0.0;        ///< expected: mean |stated - right| over cases
  std::vector<double> shrink_of_oracle;  ///< single, strong: shrink over the true effect's own, each case
  BlindShare shrunk;                     ///< of these: at least 0.95
  std::map<std::string, BlindShare>
      left_out;               ///< unknown, equivalent, none, name, sure name, failed: of those left out
  BlindShare left_out_where;  ///< unknown of those: the first region is in a variable of the effect
  std::vector<ConfusionRow> confusion;
  std::size_t failed = 0;
};

BlindScore score_blind(const std::vector<BlindOutcome>& outcomes);

}  // namespace glidelab::validate
