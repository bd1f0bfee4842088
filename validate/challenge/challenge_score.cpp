#include "validate/challenge/challenge_score.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>
#include <set>

#include "base/errors.h"
#include "core/result/quantity.h"
#include "validate/random_use.h"
#include "validate/truth/binomial.h"

namespace glidelab::validate {
namespace {

constexpr double kAlpha = 0.05;
constexpr std::size_t kResamples = 2000;

/// An entrant's answer to a quantity that has a true value.
struct Answer {
  double truth = 0.0;
  std::optional<core::Estimate> said;
};

/// For one quantity: answers of each entrant, case by case, in the order of the truth's configurations.
using Answers = std::vector<std::vector<Answer>>;

const core::ConfigurationResult& result_of(const core::AnalysisResults& results,
                                           const ChallengeConfiguration& configuration) {
  const auto found = std::ranges::find_if(results.configurations, [&](const core::ConfigurationResult& one) {
    return std::ranges::find(one.clips, configuration.clips.front()) != one.clips.end();
  });
  if (found == results.configurations.end()) {
    throw base::InputError(base::Issue{"", 0, "truth", "a clip " + configuration.clips.front(),
                                       "the truth of the challenge's experiments"});
  }
  return *found;
}

Answers answers_of(const ChallengeEntrant& entrant, const std::vector<std::vector<ChallengeConfiguration>>& truths,
                   core::Measurand which) {
  Answers answers(truths.size());
  for (std::size_t c = 0; c < truths.size(); ++c) {
    for (const ChallengeConfiguration& of : truths[c]) {
      const std::optional<double> truth = core::value_of(of, which);
      if (!truth) continue;
      answers[c].push_back({*truth, core::value_of(result_of(entrant.cases[c], of), which).estimate});
    }
  }
  return answers;
}

double score_of(const Answer& answer) {
  return interval_score(answer.said->low95, answer.said->high95, answer.truth);
}

/// A mean of the answers by `of`, and its interval: cases are resampled with all their answers.
ScoredMean resampled(const Answers& answers, const std::function<double(const Answer&)>& of,
                     const std::function<double(double)>& shown) {
  std::vector<double> sums, counts;
  for (const std::vector<Answer>& one : answers) {
    double sum = 0.0, count = 0.0;
    for (const Answer& answer : one) {
      if (!answer.said) continue;
      sum += of(answer);
      count += 1.0;
    }
    if (count == 0.0) continue;
    sums.push_back(sum);
    counts.push_back(count);
  }
  const auto total = [](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
  };
  ScoredMean mean;
  mean.value = shown(total(sums) / total(counts));
  std::mt19937_64 engine = random_engine(RandomUse::challenge, 1);
  std::vector<double> means;
  for (std::size_t r = 0; r < kResamples; ++r) {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const std::size_t drawn = engine() % sums.size();
      sum += sums[drawn];
      count += counts[drawn];
    }
    means.push_back(shown(sum / count));
  }
  std::ranges::sort(means);
  mean.low95 = means[static_cast<std::size_t>(0.025 * static_cast<double>(kResamples))];
  mean.high95 = means[static_cast<std::size_t>(0.975 * static_cast<double>(kResamples)) - 1];
  return mean;
}

ChallengeRow row_of(std::size_t entrant, const Answers& answers) {
  ChallengeRow row;
  row.entrant = entrant;
  for (const std::vector<Answer>& one : answers) {
    for (const Answer& answer : one) {
      ++row.true_values;
      if (!answer.said) continue;
      ++row.answers;
      if (answer.said->low95 <= answer.truth && answer.truth <= answer.said->high95) ++row.covered;
    }
  }
  const ProportionInterval answered = proportion_interval(row.answers, row.true_values, 1.0 - kAlpha);
  row.answered_low95 = answered.low;
  row.answered_high95 = answered.high;
  if (row.answers == 0) return row;
  const ProportionInterval coverage = proportion_interval(row.covered, row.answers, 1.0 - kAlpha);
  row.coverage_low95 = coverage.low;
  row.coverage_high95 = coverage.high;
  row.rms_error = resampled(
      answers, [](const Answer& answer) { return std::pow(answer.said->value - answer.truth, 2); },
      [](double mean) { return std::sqrt(mean); });
  row.interval_score = resampled(answers, score_of, [](double mean) { return mean; });
  return row;
}

/// Positive if the first is better in this case, negative if it is worse.
int better(const std::vector<Answer>& one, const std::vector<Answer>& other) {
  int more = 0;
  double lower = 0.0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    more += (one[i].said ? 1 : 0) - (other[i].said ? 1 : 0);
    if (one[i].said && other[i].said) lower += score_of(other[i]) - score_of(one[i]);
  }
  if (more != 0) return more;
  return lower > 0.0 ? 1 : lower < 0.0 ? -1 : 0;
}

std::vector<ChallengeDuel> duels_of(const std::vector<Answers>& all) {
  std::vector<ChallengeDuel> duels;
  for (std::size_t one = 0; one < all.size(); ++one) {
    for (std::size_t other = one + 1; other < all.size(); ++other) {
      ChallengeDuel duel{one, other};
      for (std::size_t c = 0; c < all[one].size(); ++c) {
        const int sign = better(all[one][c], all[other][c]);
        ++(sign > 0 ? duel.wins : sign < 0 ? duel.losses : duel.ties);
      }
      const std::size_t decided = duel.wins + duel.losses;
      duel.p = decided == 0 ? 1.0 : binomial_p_value(duel.wins, decided, 0.5);
      duels.push_back(duel);
    }
  }
  // Holm: the k-th smallest of n is multiplied by n - k + 1, and is no less than those before it.
  std::vector<ChallengeDuel*> by_p;
  for (ChallengeDuel& duel : duels) by_p.push_back(&duel);
  std::ranges::sort(by_p, {}, &ChallengeDuel::p);
  double before = 0.0;
  for (std::size_t k = 0; k < by_p.size(); ++k) {
    before = std::max(before, std::min(1.0, by_p[k]->p * static_cast<double>(by_p.size() - k)));
    by_p[k]->p = before;
  }
  return duels;
}

void check_alike(const Challenge& challenge, const std::vector<std::vector<ChallengeConfiguration>>& truths,
                 const std::vector<ChallengeEntrant>& entrants) {
  std::set<std::string> names;
  for (const ChallengeEntrant& entrant : entrants) {
    if (!names.insert(entrant.name).second) {
      throw base::InputError(base::Issue{"", 0, "RESULTS", fmt::format("two entrants called {}", entrant.name),
                                         "each name once (--estimator-name, or that of the folder)"});
    }
    if (entrant.cases.size() != truths.size() || truths.size() != challenge.cases) {
      throw base::InputError(base::Issue{"", 0, "truth", fmt::format("{} cases", truths.size()),
                                         fmt::format("the {} of the challenge", challenge.cases)});
    }
  }
}

}  // namespace

double interval_score(double low, double high, double truth) {
  return (high - low) + 2.0 / kAlpha * (std::max(0.0, low - truth) + std::max(0.0, truth - high));
}

ChallengeScore score_challenge(const Challenge& challenge,
                               const std::vector<std::vector<ChallengeConfiguration>>& truths,
                               const std::vector<ChallengeEntrant>& entrants) {
  check_alike(challenge, truths, entrants);
  ChallengeScore score;
  score.challenge = challenge;
  for (const ChallengeEntrant& entrant : entrants) {
    score.entrants.push_back(fit::tally_of(entrant.name, entrant.command, entrant.runs));
    score.timed.push_back(entrant.timed);
  }
  for (const core::QuantityName& quantity : core::kQuantities) {
    std::vector<Answers> all;
    for (const ChallengeEntrant& entrant : entrants) all.push_back(answers_of(entrant, truths, quantity.which));
    const bool any = !all.empty() && std::ranges::any_of(all.front(), [](const auto& one) { return !one.empty(); });
    if (!any) continue;
    ChallengeQuantity of;
    of.quantity = quantity.key;
    for (std::size_t e = 0; e < all.size(); ++e) of.rows.push_back(row_of(e, all[e]));
    of.duels = duels_of(all);
    for (const ChallengeDuel& duel : of.duels) {
      if (duel.p < kRankLevel) ++of.rows[duel.wins > duel.losses ? duel.other : duel.one].rank;
    }
    score.quantities.push_back(std::move(of));
  }
  return score;
}

}  // namespace glidelab::validate
