#include "report/challenge/challenge_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/text/number_text.h"
#include "base/text/readable_text.h"
#include "report/html/gnuplot.h"
#include "report/html/html.h"
#include "report/html/plot.h"
#include "report/text/display_text.h"
#include "report/text/json_numbers.h"
#include "report/text/outside_text.h"

namespace glidelab::report {
namespace {

using validate::ChallengeDuel;
using validate::ChallengeQuantity;
using validate::ChallengeRow;
using validate::ChallengeScore;

constexpr const char* kNoAnswer = "–";

/// Sorted by rank, those without an answer last; entrants with equal rank stay in the given order.
std::vector<ChallengeRow> ranked(const ChallengeQuantity& of) {
  std::vector<ChallengeRow> rows = of.rows;
  std::ranges::stable_sort(rows, {}, [](const ChallengeRow& row) { return std::pair(row.answers == 0, row.rank); });
  return rows;
}

/// Too few cases may not tell an entrant that never answers from the others; it has no rank all the same.
std::string rank_text(const ChallengeRow& row) {
  return row.answers == 0 ? "no answer" : fmt::format("{}", row.rank);
}

std::string mean_text(const std::optional<validate::ScoredMean>& mean) {
  if (!mean) return kNoAnswer;
  return fmt::format("{} ({} to {})", base::number_text(mean->value, 2), base::number_text(mean->low95, 2),
                     base::number_text(mean->high95, 2));
}

std::string part_text(std::size_t some, std::size_t all, double low, double high) {
  if (all == 0) return kNoAnswer;
  return fmt::format("{:.0f} % ({:.0f} to {:.0f})", 100.0 * static_cast<double>(some) / static_cast<double>(all),
                     100.0 * low, 100.0 * high);
}

/// A number's interval on a line of its own: eight columns fit a page.
std::string with_small_interval(const std::string& cell) {
  const std::size_t bracket = cell.find(" (");
  const bool interval = bracket != std::string::npos && cell.find(" to ", bracket) != std::string::npos;
  if (!interval) return escape(cell);
  return escape(cell.substr(0, bracket)) + "<br><small>" + escape(cell.substr(bracket + 1)) + "</small>";
}

const std::vector<std::string> kHeader = {"quantity",    "rank",     "entrant",        "answers (%)",
                                          "error (rms)", "coverage", "interval score", "seconds a case"};

std::vector<std::vector<std::string>> rows_of(const ChallengeScore& score) {
  std::vector<std::vector<std::string>> rows;
  for (const ChallengeQuantity& of : score.quantities) {
    bool first = true;
    for (const ChallengeRow& row : ranked(of)) {
      const bool timed = score.timed[row.entrant];
      rows.push_back(
          {first ? heading_of(of.quantity) : "", rank_text(row), score.entrants[row.entrant].name,
           part_text(row.answers, row.true_values, row.answered_low95, row.answered_high95), mean_text(row.rms_error),
           part_text(row.covered, row.answers, row.coverage_low95, row.coverage_high95), mean_text(row.interval_score),
           timed ? base::number_text(score.entrants[row.entrant].seconds, 2) : kNoAnswer});
      first = false;
    }
  }
  return rows;
}

/// The entrants with the first rank, with quantities grouped by winners: "Best in K/m and α: a. 8 cases do not tell
/// a and b, the best of 3, apart in µ."
std::string answer_of(const ChallengeScore& score) {
  std::vector<std::pair<std::vector<std::string>, std::vector<std::string>>> by_winners;  // winners, quantities
  for (const ChallengeQuantity& of : score.quantities) {
    std::vector<std::string> winners;
    for (const ChallengeRow& row : ranked(of)) {
      if (row.rank == 1 && row.answers > 0) winners.push_back(score.entrants[row.entrant].name);
    }
    auto found = std::ranges::find(by_winners, winners, [](const auto& one) { return one.first; });
    if (found == by_winners.end()) found = by_winners.insert(by_winners.end(), {winners, {}});
    found->second.push_back(symbol_of(of.quantity));
  }
  std::vector<std::string> sentences;
  for (const auto& [winners, quantities] : by_winners) {
    const std::string in = list_of(quantities);
    if (winners.empty()) {
      sentences.push_back(fmt::format("No entrant determines {}.", in));
    } else if (winners.size() == 1) {
      sentences.push_back(fmt::format("Best in {}: {}.", in, winners.front()));
    } else {
      sentences.push_back(fmt::format("{} cases do not tell {}{} apart in {}.", score.challenge.cases, list_of(winners),
                                      winners.size() < score.entrants.size()
                                          ? fmt::format(", the best of {},", score.entrants.size())
                                          : std::string(),
                                      in));
    }
  }
  return fmt::format("{}", fmt::join(sentences, " "));
}

/// "K/m: a is better than b in 18 of 20 cases (p = 0.0004).": the significant comparisons.
std::vector<std::string> sentences_of(const ChallengeScore& score) {
  std::vector<std::string> sentences;
  for (const ChallengeQuantity& of : score.quantities) {
    std::size_t apart = 0;
    const auto answering = static_cast<std::size_t>(
        std::ranges::count_if(of.rows, [](const ChallengeRow& row) { return row.answers > 0; }));
    std::vector<std::string> silent;
    for (const ChallengeRow& row : of.rows) {
      if (row.answers == 0 && answering > 0) silent.push_back(score.entrants[row.entrant].name);
    }
    if (!silent.empty()) {
      sentences.push_back(fmt::format("{}: no answer from {}.", symbol_of(of.quantity), list_of(silent)));
    }
    for (const ChallengeDuel& duel : of.duels) {
      if (!(duel.p < validate::kRankLevel)) continue;
      ++apart;
      const bool one = duel.wins > duel.losses;
      sentences.push_back(fmt::format("{}: {} is better than {} in {} of {} cases (p = {:.1g}).",
                                      symbol_of(of.quantity), score.entrants[one ? duel.one : duel.other].name,
                                      score.entrants[one ? duel.other : duel.one].name,
                                      std::max(duel.wins, duel.losses), duel.wins + duel.losses, duel.p));
    }
    if (apart == 0 && answering > 1) {
      const char* const which = silent.empty() ? "" : " that answer";
      sentences.push_back(fmt::format("{}: {} cases do not tell {} apart.", symbol_of(of.quantity),
                                      score.challenge.cases,
                                      answering == 2 ? fmt::format("the two entrants{}", which)
                                                     : fmt::format("any two of the {} entrants{}", answering, which)));
    }
  }
  return sentences;
}

constexpr const char* kHow =
    "Two entrants are compared case by case: more answers are better, then the lower interval score (width of the 95 % "
    "interval, plus 40 times the distance of the truth outside it). A rank counts the entrants that are better by the "
    "sign test at 5 %, corrected for all pairs (Holm): entrants that cannot be told apart share a rank; one without "
    "any "
    "answer has none. 95 % intervals are in brackets.";

std::string title_of(const ChallengeScore& score) {
  return fmt::format("Challenge {}, version {}, {} cases", word(score.challenge.level), score.challenge.version,
                     score.challenge.cases);
}

Json mean_json(const validate::ScoredMean& mean) {
  return {{"value", mean.value}, {"interval95", {mean.low95, mean.high95}}};
}

Json row_json(const ChallengeScore& score, const ChallengeRow& row) {
  Json object{{"entrant", score.entrants[row.entrant].name},
              {"rank", row.answers == 0 ? Json(nullptr) : Json(row.rank)},
              {"true_values", row.true_values},
              {"answers", row.answers},
              {"answered_interval95", {row.answered_low95, row.answered_high95}},
              {"covered", row.covered},
              {"coverage_interval95", {row.coverage_low95, row.coverage_high95}}};
  object["rms_error"] = row.rms_error ? mean_json(*row.rms_error) : Json(nullptr);
  object["interval_score"] = row.interval_score ? mean_json(*row.interval_score) : Json(nullptr);
  if (!row.rms_error) object["why"] = {{"rms_error", "no answer"}, {"interval_score", "no answer"}};
  if (row.answers == 0) object["why"]["rank"] = "no answer";
  return object;
}

/// Interval scores of all entrants for each quantity, over the lowest for that quantity.
std::vector<Plot> score_plot(const ChallengeScore& score) {
  PlotData data{"scores", {}, {"interval score relative to the lowest", "row", "low", "high"}};
  std::string tics;
  double row_number = 0.0;
  for (const ChallengeQuantity& of : score.quantities) {
    double lowest = 0.0;
    for (const ChallengeRow& row : of.rows) {
      if (!row.interval_score || !(row.interval_score->value > 0.0)) continue;
      lowest = lowest > 0.0 ? std::min(lowest, row.interval_score->value) : row.interval_score->value;
    }
    for (const ChallengeRow& row : ranked(of)) {
      if (!row.interval_score || !(row.interval_score->low95 > 0.0)) continue;
      row_number += 1.0;
      data.rows.push_back({row.interval_score->value / lowest, row_number, row.interval_score->low95 / lowest,
                           row.interval_score->high95 / lowest});
      tics += fmt::format(
          "{}{} {}", tics.empty() ? "" : ", ",
          gnuplot_quoted(fmt::format("{}  {}", symbol_of(of.quantity), shortened(score.entrants[row.entrant].name))),
          row_number);
    }
  }
  if (data.rows.empty()) return {};
  const std::string script =
      std::string(kFrame) + fmt::format(
                                "unset offsets\nset logscale x\nset format x '%g'\nset yrange [{:.4g}:0.3]\n"
                                "set ytics ({})\nunset key\nset xlabel 'interval score relative to the lowest'\n"
                                "plot $scores using 1:2:3:4 with xerrorbars pt 7 ps 0.7 lw 1.5 lc rgb '{}'\n",
                                row_number + 0.7, tics, color(0));
  const int height = 120 + 18 * std::max(6, static_cast<int>(row_number));
  return {{Drawing{script, {data}, {720, height}},
           "Interval score of each entrant relative to the lowest one of the quantity, with 95 % intervals; lower is "
           "better",
           "Interval scores of the entrants"}};
}

}  // namespace

std::string challenge_json(const ChallengeScore& score) {
  Json document;
  document["format"] = 1;
  document["challenge"] = {{"version", score.challenge.version},
                           {"level", word(score.challenge.level)},
                           {"cases", score.challenge.cases},
                           {"truth_sha256", score.challenge.truth_sha256}};
  document["entrants"] = Json::array();
  for (const fit::OutsideTally& entrant : score.entrants) document["entrants"].push_back(outside_json(entrant));
  document["quantities"] = Json::array();
  for (const ChallengeQuantity& of : score.quantities) {
    Json object{{"quantity", of.quantity}, {"entrants", Json::array()}, {"pairs", Json::array()}};
    for (const ChallengeRow& row : of.rows) object["entrants"].push_back(row_json(score, row));
    for (const ChallengeDuel& duel : of.duels) {
      object["pairs"].push_back({{"one", score.entrants[duel.one].name},
                                 {"other", score.entrants[duel.other].name},
                                 {"wins", duel.wins},
                                 {"losses", duel.losses},
                                 {"ties", duel.ties},
                                 {"p_value", duel.p}});
    }
    document["quantities"].push_back(std::move(object));
  }
  return json_text(document);
}

std::string challenge_text(const ChallengeScore& score) {
  std::vector<std::vector<std::string>> rows = rows_of(score);
  rows.insert(rows.begin(), kHeader);
  std::string text =
      base::printable_text(answer_of(score)) + "\n\n" + title_of(score) + "\n\n" + text_table(rows, 3) + "\n";
  for (const std::string& sentence : sentences_of(score)) text += base::printable_text(sentence) + "\n";
  text += "\n";
  for (const fit::OutsideTally& entrant : score.entrants) text += outside_text(entrant) + "\n";
  return text + "\n" + kHow + "\n";
}

Page challenge_page(const ChallengeScore& score) {
  const char* const question = "Which estimator is best?";
  Html body = question_heading(title_of(score), question);
  body += fmt::format("<p><b>{}</b></p>\n", escape(answer_of(score)));
  body += figures(score_plot(score));
  HtmlTable table(kHeader, 3);
  for (const std::vector<std::string>& row : rows_of(score)) {
    std::vector<std::string> cells;
    for (const std::string& cell : row) cells.push_back(with_small_interval(cell));
    table.row(cells);
  }
  body += "<h2 id=\"table\">Errors, coverage, sharpness</h2>\n" + table.str();
  body +=
      "<p class=\"soft\">95 % intervals are in brackets. The interval score is the width of a 95 % interval, plus 40 "
      "times the distance of the truth outside it: lower is better.</p>\n";
  Html pairs;
  for (const std::string& sentence : sentences_of(score)) pairs += fmt::format("<p>{}</p>\n", escape(sentence));
  pairs += fmt::format("<p class=\"soft\">{}</p>\n", escape(kHow));
  body += folded("Who is better than whom", pairs);
  Html runs;
  for (const fit::OutsideTally& entrant : score.entrants) {
    runs += fmt::format("<p>{}.</p>\n", escape(outside_text(entrant)));
  }
  runs += fmt::format("<p class=\"soft\">SHA-256 of the truth: {}</p>\n", escape(score.challenge.truth_sha256));
  body += folded("Runs", runs);
  return page(question, body);
}

}  // namespace glidelab::report
