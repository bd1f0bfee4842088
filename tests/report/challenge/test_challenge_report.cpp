/// The first line of a challenge's score: who is best in what, and where nobody is.
#include "report/challenge/challenge_report.h"

#include "tests/catch.h"

using namespace glidelab;

namespace {

validate::ChallengeQuantity quantity_of(const char* key, const std::vector<std::size_t>& ranks, std::size_t answers) {
  validate::ChallengeQuantity quantity{key, {}, {}};
  for (std::size_t e = 0; e < ranks.size(); ++e) {
    validate::ChallengeRow row;
    row.entrant = e;
    row.true_values = 8;
    row.answers = answers;
    row.rank = ranks[e];
    if (answers > 0) row.rms_error = row.interval_score = validate::ScoredMean{0.01, 0.005, 0.02};
    quantity.rows.push_back(row);
  }
  return quantity;
}

validate::ChallengeScore score_of(std::vector<validate::ChallengeQuantity> quantities) {
  validate::ChallengeScore score;
  score.challenge.cases = 8;
  for (const char* name : {"mine", "lines", "spline"}) {
    fit::OutsideTally entrant;
    entrant.name = name;
    score.entrants.push_back(entrant);
    score.timed.push_back(false);
  }
  score.quantities = std::move(quantities);
  return score;
}

std::string first_line(const validate::ChallengeScore& score) {
  const std::string text = report::challenge_text(score);
  return text.substr(0, text.find('\n'));
}

}  // namespace

TEST_CASE("a challenge's score begins with who is best in what") {
  CHECK(first_line(score_of({quantity_of("k_over_m_1_s", {2, 1, 3}, 8), quantity_of("mu", {3, 1, 2}, 8)})) ==
        "Best in K/m and µ: lines.");
  CHECK(first_line(score_of({quantity_of("k_over_m_1_s", {1, 1, 3}, 8), quantity_of("mu", {1, 2, 2}, 8)})) ==
        "8 cases do not tell mine and lines, the best of 3, apart in K/m. Best in µ: mine.");
  CHECK(first_line(score_of({quantity_of("mu", {1, 1, 1}, 8)})) ==
        "8 cases do not tell mine, lines and spline apart in µ.");
  CHECK(first_line(score_of({quantity_of("alpha_deg", {1, 1, 1}, 0)})) == "No entrant determines α.");
}

TEST_CASE("the page of a challenge's score begins with the same answer, and folds the pairs away") {
  const std::string html = report::challenge_page(score_of({quantity_of("mu", {2, 1, 3}, 8)})).html;
  const std::size_t answer = html.find("Best in µ: lines.");
  REQUIRE(answer != std::string::npos);
  CHECK(answer < html.find("<h2"));
  CHECK(html.find("Which estimator is best?") < answer);
  CHECK(html.find("<details class=\"part\"><summary>Who is better than whom") != std::string::npos);
}

TEST_CASE("an entrant that never answers has no rank, even if too few cases tell it from the others") {
  validate::ChallengeScore score = score_of({quantity_of("mu", {1, 1, 1}, 8)});
  score.quantities[0].rows[0].answers = 0;
  score.quantities[0].duels = {{0, 1, 0, 6, 0, 0.1}};
  const std::string text = report::challenge_text(score);
  INFO(text);
  CHECK(first_line(score) == "8 cases do not tell lines and spline, the best of 3, apart in µ.");
  CHECK(text.find("no answer  mine") != std::string::npos);
  CHECK(report::challenge_json(score).find("\"rank\": null") != std::string::npos);
  CHECK(text.find("mine") > text.find("1          lines"));
  CHECK(text.find("µ: no answer from mine.") != std::string::npos);
  CHECK(text.find("8 cases do not tell the two entrants that answer apart.") != std::string::npos);
}
