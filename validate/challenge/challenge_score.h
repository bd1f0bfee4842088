/// Entrants of a challenge, scored against its truth and ranked if they differ.
///
/// For each quantity, over all configurations with a true value:
///
///     error      value - truth; root mean square over the answers
///     coverage   answers whose 95 % interval [l, u] holds the truth
///     score      interval score (Gneiting and Raftery, J. Am. Stat. Assoc. 102, 2007, eq. 43) with alpha = 0.05,
///                (u - l) + (2/alpha) (l - x)+ + (2/alpha) (x - u)+, x the truth: narrow intervals that hold it are
///                best, and no other interval than the right one has a lower expectation
///
/// with 95 % intervals: for a proportion by Clopper and Pearson, for a mean by resampling the cases (2000 times, a
/// fixed seed). Two entrants are compared case by case: the better one has more answers or, for equal numbers, the
/// lower mean score over the configurations that both answered. For n cases that are not ties, the number of wins is
/// binomial with 1/2 if they are equally good; the exact two-sided p of all pairs of entrants is corrected by Holm's
/// method. An entrant's rank is one more than the number of those that are better at 5 %: entrants that cannot be
/// distinguished share a rank.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fit/outside/outside_tally.h"
#include "validate/challenge/challenge_folder.h"

namespace glidelab::validate {

inline constexpr double kRankLevel = 0.05;

struct ScoredMean {
  double value = 0.0, low95 = 0.0, high95 = 0.0;
};

/// One entrant's answers to one quantity.
struct ChallengeRow {
  std::size_t entrant = 0;  ///< among ChallengeScore::entrants
  std::size_t true_values = 0, answers = 0, covered = 0;
  double answered_low95 = 0.0, answered_high95 = 1.0;   ///< of the fraction of true values that are answered
  double coverage_low95 = 0.0, coverage_high95 = 1.0;   ///< of the fraction of answers that contain the truth
  std::optional<ScoredMean> rms_error, interval_score;  ///< none without answers
  std::size_t rank = 1;
};

/// Two entrants in one quantity.
struct ChallengeDuel {
  std::size_t one = 0, other = 0;
  std::size_t wins = 0, losses = 0, ties = 0;  ///< cases in which `one` is better, worse, neither
  double p = 1.0;                              ///< corrected for all pairs (Holm)
};

struct ChallengeQuantity {
  std::string quantity;  ///< a key of core::kQuantities
  std::vector<ChallengeRow> rows;
  std::vector<ChallengeDuel> duels;
};

struct ChallengeScore {
  Challenge challenge;
  std::vector<fit::OutsideTally> entrants;
  std::vector<bool> timed;                    ///< of each entrant
  std::vector<ChallengeQuantity> quantities;  ///< those with a true value in some configuration
};

/// (u - l) + 2/alpha times the distance of x outside the interval; alpha = 0.05.
double interval_score(double low, double high, double truth);

/// InputError if truth and entrants do not have the same cases, or if two entrants have the same name.
ChallengeScore score_challenge(const Challenge& challenge,
                               const std::vector<std::vector<ChallengeConfiguration>>& truths,
                               const std::vector<ChallengeEntrant>& entrants);

}  // namespace glidelab::validate
