#include "validate/challenge/challenge_score.h"

#include <cmath>
#include <random>

#include "base/errors.h"
#include "core/result/estimate.h"
#include "tests/catch.h"

using namespace glidelab;
using namespace glidelab::validate;

namespace {

constexpr std::size_t kCases = 24;

std::vector<std::vector<ChallengeConfiguration>> truths() {
  std::vector<std::vector<ChallengeConfiguration>> all(kCases);
  for (auto& one : all) {
    ChallengeConfiguration of;
    of.clips = {"up"};
    of.k_over_m_1_s = 2.0;
    one.push_back(of);
  }
  return all;
}

/// Errors of standard deviation `sd`, stated as `stated`; every `silent`-th case has no answer.
ChallengeEntrant entrant(const std::string& name, double sd, double stated, std::size_t silent, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> deviate(0.0, sd);
  ChallengeEntrant made;
  made.name = name;
  for (std::size_t c = 0; c < kCases; ++c) {
    core::AnalysisResults results;
    results.configurations.resize(1);
    results.configurations[0].clips = {"up"};
    const double value = 2.0 + deviate(engine);
    const bool no_answer = silent > 0 && c % silent == 0;
    results.configurations[0].k_over_m_1_s = no_answer ? core::undetermined(core::unknown::Told{"silent"})
                                                       : core::determined(core::estimate(value, stated, INFINITY));
    made.cases.push_back(results);
    made.runs.emplace_back();
  }
  return made;
}

const ChallengeRow& row_of(const ChallengeScore& score, std::size_t entrant) {
  return score.quantities.at(0).rows.at(entrant);
}

}  // namespace

TEST_CASE("the interval score is the interval's width where it holds the truth, and 40 times what it misses by more") {
  CHECK(interval_score(1.0, 3.0, 2.0) == 2.0);
  CHECK(interval_score(1.0, 3.0, 1.0) == 2.0);
  CHECK(interval_score(1.0, 3.0, 0.5) == Approx(2.0 + 40.0 * 0.5).epsilon(1e-12));
  CHECK(interval_score(1.0, 3.0, 3.25) == Approx(2.0 + 40.0 * 0.25).epsilon(1e-12));
}

TEST_CASE("no other normal interval has a lower mean interval score than the right one") {
  // Of a standard normal truth and the interval ±h: 2 h + 80 (phi(h) - h (1 - Phi(h))), least at h = 1.96.
  const auto mean_of = [](double h) {
    double sum = 0.0;
    constexpr int kSteps = 4000;  // of a midpoint rule over ±8; its error is far below the differences
    for (int i = 0; i < kSteps; ++i) {
      const double x = -8.0 + 16.0 * (i + 0.5) / kSteps;
      sum += interval_score(-h, h, x) * std::exp(-0.5 * x * x) / std::sqrt(2.0 * M_PI) * 16.0 / kSteps;
    }
    return sum;
  };
  const double h = 1.96, tail = 0.5 * std::erfc(h / std::sqrt(2.0));
  CHECK(std::abs(mean_of(h) - (2.0 * h + 80.0 * (std::exp(-0.5 * h * h) / std::sqrt(2.0 * M_PI) - h * tail))) < 1e-3);
  for (const double other : {1.0, 1.8, 2.1, 3.0}) CHECK(mean_of(h) < mean_of(other));
}

TEST_CASE("entrants that differ are ranked, those that do not share a rank, and silence is worse than any answer") {
  Challenge challenge;
  challenge.cases = kCases;
  const ChallengeScore score = score_challenge(challenge, truths(),
                                               {entrant("sharp", 0.01, 0.01, 0, 1), entrant("twin", 0.01, 0.01, 0, 2),
                                                entrant("blunt", 0.2, 0.2, 0, 3), entrant("silent", 1e-6, 1e-6, 1, 4)});
  REQUIRE(score.quantities.size() == 1);
  CHECK(row_of(score, 0).rank == 1);
  CHECK(row_of(score, 1).rank == 1);
  CHECK(row_of(score, 2).rank == 3);
  CHECK(row_of(score, 3).rank == 4);
  CHECK(row_of(score, 3).answers == 0);
  CHECK_FALSE(row_of(score, 3).rms_error);
  CHECK(row_of(score, 0).true_values == kCases);
  // A root mean square of 24 normal errors is known to 15 %; four of these.
  REQUIRE(row_of(score, 2).rms_error);
  CHECK(std::abs(row_of(score, 2).rms_error->value / 0.2 - 1.0) < 0.6);
  CHECK(row_of(score, 2).rms_error->low95 < row_of(score, 2).rms_error->value);
  CHECK(row_of(score, 2).rms_error->high95 > row_of(score, 2).rms_error->value);
}

TEST_CASE("entrants that are equally good are told apart no more often than the level says") {
  Challenge challenge;
  challenge.cases = kCases;
  int apart = 0;
  constexpr int kDraws = 200;
  for (int i = 0; i < kDraws; ++i) {
    const auto seed = static_cast<std::uint64_t>(3 * i);
    const ChallengeScore score =
        score_challenge(challenge, truths(),
                        {entrant("a", 0.1, 0.1, 0, seed + 1), entrant("b", 0.1, 0.1, 0, seed + 2),
                         entrant("c", 0.1, 0.1, 0, seed + 3)});
    for (const ChallengeRow& row : score.quantities[0].rows) {
      if (row.rank > 1) {
        ++apart;
        break;
      }
    }
  }
  // More than 20 of 200 with probability 0.05 at most: once in 500 times.
  CHECK(apart <= 20);
}

TEST_CASE("two entrants of one name, and a truth of other cases, are refused") {
  Challenge challenge;
  challenge.cases = kCases;
  CHECK_THROWS_AS(score_challenge(challenge, truths(), {entrant("a", 0.1, 0.1, 0, 1), entrant("a", 0.1, 0.1, 0, 2)}),
                  base::InputError);
  challenge.cases = kCases + 1;
  CHECK_THROWS_AS(score_challenge(challenge, truths(), {entrant("a", 0.1, 0.1, 0, 1)}), base::InputError);
}
