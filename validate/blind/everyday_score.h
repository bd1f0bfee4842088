/// Diagnoses of everyday cases compared with the truth: the main cause, both of two, imperfections alone, a cause
/// outside the list; shares, recovered quantities and stated probabilities.
///
/// A decision method either claims a cause or does not (a diagnosis claims one if its verdict is `effect`), and names
/// ids in order: for a diagnosis those of `explained`, or of `effects` if that is empty. A name is right if it is the
/// cause's id, of the same class (blind_class), or the same law on that design (EverydayTruth::equals); it is "in the
/// set" also if the diagnosis says that the data cannot distinguish the name from it.
///
/// For a diagnosis with a claim, the probability of its first name counts, together with the names that cannot be
/// distinguished from it. For imperfections alone `none` and `unknown` are both right, and their sum counts. For a
/// cause outside the list, `unknown` is right.
///
/// A probability is that of a verdict, before the truth is known. So honest probabilities are right as often as stated
/// over all cases, and over those with one verdict (`by_verdict`), but not within one class of truths: a name that is
/// wrong because the cause is outside the list counts with its full probability in that class, and there are then too
/// many right ones in the others. For few cases even honest probabilities have an error, `by_chance`.
///
/// It is compared with plain forward selection by held-out residuals, from the same `ranking`: the effect with the
/// smallest gap of held-out clips, then the one that lowers it most in addition to the first, if by more than two
/// standard errors. It claims if the excess g² - 1 falls to a half or less. It states no probability: each of its names
/// counts as certain.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "validate/blind/blind_score.h"

namespace glidelab::validate {

struct EverydayName {
  std::string id;
  std::vector<std::string> equivalent_to;
  double probability = 1.0;
  std::optional<double> share;
};

/// The answer of one decision method to a case.
struct EverydaySaying {
  bool failed = false;
  bool claims = false;
  std::vector<EverydayName> names;
};

EverydaySaying said_by_diagnosis(const BlindVerdict& verdict);
EverydaySaying said_by_forward_selection(const BlindVerdict& verdict);

/// RMS and mean of errors.
struct ErrorSum {
  std::size_t of = 0;
  double squares = 0.0, sum = 0.0;
  void add(double error);
  double rms() const;  ///< 0 of none
  double mean() const;
};

/// By class ("one", "two", "dirt", "outside") and strength ("moderate", "strong").
using SharesByCase = std::map<std::string, std::map<std::string, BlindShare>>;
/// Sum over all entries, of some classes or of all.
BlindShare sum_of(const SharesByCase& shares, const std::vector<std::string>& classes = {});

struct EverydayMethod {
  DecisionMethod by = DecisionMethod::diagnosis;
  SharesByCase main_first;   ///< one, two: claimed, and the main cause comes first
  SharesByCase main_in_set;  ///< the same, or the first cannot be told from it
  SharesByCase both;         ///< two: claimed, and both are among the names
  SharesByCase false_claim;  ///< imperfections alone: claimed a cause with half of the excess
  SharesByCase wrong_name;   ///< outside: claimed, a name above kSureName
  ErrorSum share_error;      ///< one, two: of the causes that it names, claimed minus true
  ErrorSum any_share_error;  ///< of all causes; a cause that is not named counts as claimed 0
};

struct EverydayCalibration {
  std::size_t of = 0;
  double stated = 0.0, right = 0.0;  ///< means
  double error = 0.0;                ///< expected, over ten bins of the probability
  double by_chance = 0.0;            ///< its mean if each verdict were right with the stated probability
};

/// An outside estimator's answers to one quantity that has a true value.
struct EverydayAnswers {
  BlindShare answered;  ///< of the true values
  BlindShare covered;   ///< of the answers: the 95 % interval contains the true value
  ErrorSum error;       ///< of the answers, in the quantity's unit
};

struct EverydayScore {
  std::vector<EverydayMethod> methods;  ///< the diagnosis, then forward selection
  SharesByCase main_helps;              ///< one, two: the main cause is the first of the names, claimed or not
  SharesByCase unknown;                 ///< outside, imperfections alone: the verdict is `unknown`
  BlindShare fair_claim;  ///< of the false claims for imperfections alone: an acceptable name for what makes half of
                          ///< their excess or more
  std::map<std::string, std::map<std::string, BlindShare>> covered;       ///< by class and quantity, of those stated
  std::map<std::string, std::map<std::string, EverydayAnswers>> answers;  ///< by class and quantity
  std::map<std::string, EverydayCalibration> calibration;                 ///< by class, and "all"
  std::map<std::string, EverydayCalibration> by_verdict;                  ///< the same by the verdict's word
  ErrorSum remainder_error;                                               ///< one, two, if the diagnosis has one
  std::map<std::string, std::size_t> cases, failed;                       ///< by class
  std::size_t timed = 0;
  double mean_s = 0.0, most_s = 0.0;  ///< of a diagnosis
};

/// std::logic_error for a case that is not an everyday one.
EverydayScore score_everyday(const std::vector<BlindOutcome>& outcomes);

}  // namespace glidelab::validate
