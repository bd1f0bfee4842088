/// Diagnoses of blind cases, read from their diagnosis.json and compared with the truth.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/result/results.h"
#include "diagnose/result/explanation.h"
#include "fit/outside/outside_tally.h"
#include "validate/blind/blind_sequence.h"
#include "validate/blind/case/blind_case.h"
#include "validate/blind/case/everyday_case.h"
#include "validate/truth/binomial.h"

namespace glidelab::validate {

struct BlindNamed {
  std::string id;
  double probability = 0.0;
  std::vector<std::string> equivalent_to;
  double joint = 0.0;  ///< probability that it or one of its equivalents acts
};

struct BlindRanked {
  std::set<std::string> ids;  ///< its effects, or "unknown"
  double probability = 0.0;
  double log_likelihood_gain = 0.0;
  double parameters = 0.0;
  std::optional<double> gap_after;
};

/// The content of a diagnosis.json; no verdict, and `why`, if the diagnosis failed.
struct BlindVerdict {
  std::optional<diagnose::Verdict> verdict;
  std::string why;
  std::vector<BlindNamed> effects;
  std::vector<BlindRanked> ranking;
  std::vector<std::string> where;  ///< variables of the regions, the largest excess first
  double none = 0.0, unknown = 0.0, points = 0.0;
  double gap_before = 0.0, gap_after = 0.0, gap_error = 0.0;
  BlindSequence sequence;
};

/// In files: the id of the verdict, or "failed".
std::string verdict_word(const BlindVerdict& verdict);

/// InputError if the file is not a diagnosis.
BlindVerdict read_blind_verdict(const std::filesystem::path& diagnosis_json);

/// Removes effects that the folder itself states from the names of a verdict: an explanation that contained them with
/// others counts for the others, one that contained only them counts for none.
void set_aside(const std::vector<std::string>& told, BlindVerdict& verdict);

/// What an outside estimator answered to a case.
struct BlindEstimate {
  core::AnalysisResults results;  ///< all undetermined if it failed
  fit::OutsideRun run;
};

inline constexpr double kSureName = 0.8;  ///< probability above which a name is certain

struct BlindOutcome {
  std::size_t index = 0;
  BlindKind kind = BlindKind::none;
  std::vector<BlindCause> causes;
  std::size_t clips = 0;
  BlindVerdict verdict;
  std::optional<BlindVerdict> left_out;  ///< with the true effect removed from the list
  bool filmed = false;
  std::optional<EverydayTruth> everyday;       ///< of an everyday case
  std::optional<double> seconds;               ///< duration of its diagnosis, if measured
  std::optional<BlindEstimate> estimate = {};  ///< of an everyday case, if an estimator is judged
};

/// The word under which an effect is counted. Two pairs of effects are indistinguishable on tracks and count as one
/// (effects.md, "Which cannot be told apart"): scale_error and frame_rate_error, camera_motion and base_vibration.
/// Images distinguish the second pair.
std::string blind_class(const std::string& id, bool filmed);
/// The class of the single cause.
std::string true_class(const BlindOutcome& outcome);
/// Everything that a verdict names, as classes: its effects and their equivalents.
std::set<std::string> named_by(const BlindOutcome& outcome);

/// "weak" (a gain of less than 15 in log likelihood), "moderate" (15 to 50) or "strong" (more); for a pair that of the
/// weaker cause.
std::string_view strength_word(const BlindOutcome& outcome);

struct BlindShare {
  std::size_t of = 0, yes = 0;
  /// 0 if there are none.
  double share() const { return of == 0 ? 0.0 : static_cast<double>(yes) / static_cast<double>(of); }
  /// Its 95 % interval (Clopper and Pearson); 0 to 1 if there are none.
  ProportionInterval interval95() const { return proportion_interval(yes, of, 0.95); }
};

/// Who or what decides about a case.
enum class DecisionMethod {
  diagnosis,
  best_residual,      ///< the refit that lowers the residuals most
  stepwise_bic,       ///< forward selection by Schwarz's criterion
  picking,            ///< at random
  forward_selection,  ///< by held-out residuals
};

/// How often one decision method is right.
struct BlindMethod {
  DecisionMethod by = DecisionMethod::diagnosis;
  BlindShare none, outside, pair;
  std::map<std::string, BlindShare> single;  ///< by strength
};

struct ReliabilityBin {
  double from = 0.0, to = 0.0;
  double stated = 0.0;  ///< mean
  BlindShare right;
};

/// One line of a confusion matrix.
struct ConfusionRow {
  std::optional<std::string> truth;               ///< the cause's id, or "none"; empty: two effects
  std::map<std::string, std::size_t> said = {};   ///< first name, none, unknown, failed
  std::map<std::size_t, std::size_t> named = {};  ///< of two effects: cases, by how many of the two have been named
};

/// What a diagnosis says of a case of one effect if that effect is not on its list.
enum class VerdictWithout {
  other_name,
  sure_other_name,  ///< with a probability above kSureName
  equivalent,       ///< an effect that the full diagnosis calls equivalent to the truth on these data
  failed,
  none,
  unknown,
};
inline constexpr std::array<VerdictWithout, 6> kVerdictsWithout = {
    VerdictWithout::other_name, VerdictWithout::sure_other_name, VerdictWithout::equivalent, VerdictWithout::failed,
    VerdictWithout::none,       VerdictWithout::unknown};

struct BlindScore {
  std::vector<BlindMethod> methods;              ///< the diagnosis first
  std::map<std::string, BlindShare> in_set;      ///< single cases: truth among the names, by strength
  std::map<std::string, BlindShare> exact;       ///< single cases: the exact id comes first, by strength
  std::map<std::string, BlindShare> recognised;  ///< outside: unknown, or a fair name, by strength
  BlindShare false_alarm;                        ///< none: anything else
  BlindShare wrong_name;                         ///< outside: a sure name (kSureName) that is not fair
  BlindShare where;                              ///< outside and unknown: the true variable among the regions
  BlindShare where_first;                        ///< outside and unknown: the true variable is that of the first region
  std::vector<ReliabilityBin> reliability;       ///< ten of equal width, from 0 to 1
  double calibration_error = 0.0;                ///< expected: mean |stated - right| over cases
  /// Single and strong cases in which the true effect's own fit clearly reduces the gap: the diagnosis closes 95 % of
  /// that.
  BlindShare shrunk;
  std::map<VerdictWithout, BlindShare> left_out;
  BlindShare left_out_where;  ///< of those, unknown: the first region is in a variable of the effect
  std::vector<ConfusionRow> confusion;
  std::size_t failed = 0;
};

/// Every case counts; one that could not be diagnosed counts as wrong, but not in the probabilities.
BlindScore score_blind(const std::vector<BlindOutcome>& outcomes);

/// std::logic_error for a case that was not diagnosed without its effect.
VerdictWithout verdict_without(const BlindOutcome& outcome);

/// The variables in which an effect of the list can show (`where` of a diagnosis.json, "clip" for a region of one
/// clip), as in effects.md; none for an effect that no region can show (an inclination alone, single frames).
std::vector<std::string> variables_of(const std::string& effect);

}  // namespace glidelab::validate
