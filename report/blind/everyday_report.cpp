#include "report/blind/everyday_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "base/text/number_text.h"
#include "core/result/quantity.h"
#include "report/blind/blind_run.h"
#include "report/html/html.h"
#include "report/text/display_text.h"
#include "report/text/json_numbers.h"
#include "report/text/outside_text.h"

namespace glidelab::report {
namespace {

using validate::BlindShare;
using validate::EverydayScore;
using validate::SharesByCase;

using TextRows = std::vector<std::vector<std::string>>;

/// "86 % (43 of 50; 95 %: 73 to 94 %)"; a dash if there are none.
std::string share_and_interval(const BlindShare& share) {
  if (share.of == 0) return "–";
  const validate::ProportionInterval interval = share.interval95();
  return fmt::format("{:.0f} % ({} of {}; 95 %: {:.0f} to {:.0f} %)", 100.0 * share.share(), share.yes, share.of,
                     100.0 * interval.low, 100.0 * interval.high);
}

/// Of one class and one quantity; of all where they are empty.
BlindShare covered_of(const EverydayScore& score, const std::string& of_class, const std::string& quantity) {
  BlindShare sum;
  for (const auto& [kind, by_quantity] : score.covered) {
    if (!of_class.empty() && kind != of_class) continue;
    for (const auto& [key, share] : by_quantity) {
      if (!quantity.empty() && key != quantity) continue;
      sum.of += share.of;
      sum.yes += share.yes;
    }
  }
  return sum;
}

std::string found_text(const EverydayTarget& target) {
  if (!bears(target)) return "–";
  return target.value ? base::number_text(*target.value, 2) : share_and_interval(target.share);
}

std::string limits_text(const EverydayTarget& target) {
  const auto text = [&](double limit) {
    return target.number ? base::number_text(limit, 2) : fmt::format("{:.0f} %", 100.0 * limit);
  };
  if (target.low > 0.0 && target.high < 1.0) return text(target.low) + " to " + text(target.high);
  return target.low > 0.0 ? "at least " + text(target.low) : "at most " + text(target.high);
}

std::string words_of_class(const std::string& kind) {
  if (kind == "one") return "one cause";
  if (kind == "two") return "two causes";
  if (kind == "dirt") return "small imperfections alone";
  if (kind == "outside") return "off the list";
  return "all";
}

std::string calibration_text(const validate::EverydayCalibration& of) {
  return fmt::format("{} (by chance {}; stated {}, right {}, of {})", base::number_text(of.error, 2),
                     base::number_text(of.by_chance, 2), base::number_text(of.stated, 2),
                     base::number_text(of.right, 2), of.of);
}

/// Every share of a table by class and strength, one per row.
void add_rows(const std::string& what, const SharesByCase& shares, const std::string& method, TextRows& rows) {
  for (const auto& [kind, by_strength] : shares) {
    for (const auto& [strength, share] : by_strength) {
      rows.push_back({what, words_of_class(kind), strength, method, share_and_interval(share)});
    }
  }
}

TextRows detail_rows(const EverydayScore& score) {
  TextRows rows;
  for (const auto& method : score.methods)
    add_rows("main cause first", method.main_first, method_name(method.by), rows);
  for (const auto& method : score.methods)
    add_rows("first cannot be told from it", method.main_in_set, method_name(method.by), rows);
  for (const auto& method : score.methods) add_rows("both named", method.both, method_name(method.by), rows);
  for (const auto& method : score.methods)
    add_rows("half of the excess claimed", method.false_claim, method_name(method.by), rows);
  for (const auto& method : score.methods)
    add_rows("a wrong name above 0.8", method.wrong_name, method_name(method.by), rows);
  const std::string first = method_name(score.methods.front().by);
  add_rows("main cause helps most, claimed or not", score.main_helps, first, rows);
  add_rows("the verdict is unknown", score.unknown, first, rows);
  rows.push_back({"claims that name most of the imperfections correctly", "small imperfections alone", "", first,
                  share_and_interval(score.fair_claim)});
  return rows;
}

TextRows number_rows(const EverydayScore& score) {
  TextRows rows;
  for (const auto& method : score.methods) {
    rows.push_back({"share of a named cause, claimed minus true: rms, mean", method_name(method.by),
                    method.share_error.of == 0
                        ? "–"
                        : fmt::format("{}, {} (of {})", base::number_text(method.share_error.rms(), 2),
                                      base::number_text(method.share_error.mean(), 2), method.share_error.of)});
    rows.push_back({"the same of every cause, 0 where it is not named", method_name(method.by),
                    method.any_share_error.of == 0
                        ? "–"
                        : fmt::format("{}, {} (of {})", base::number_text(method.any_share_error.rms(), 2),
                                      base::number_text(method.any_share_error.mean(), 2), method.any_share_error.of)});
  }
  for (const auto& [kind, by_quantity] : score.covered) {
    for (const auto& [key, share] : by_quantity) {
      rows.push_back({"interval of " + core::symbol_of(key) + " contains the true value", words_of_class(kind),
                      share_and_interval(share)});
    }
  }
  for (const auto& [kind, of] : score.calibration) {
    rows.push_back({"expected calibration error", words_of_class(kind), calibration_text(of)});
  }
  for (const auto& [verdict, of] : score.by_verdict) {
    rows.push_back({"expected calibration error", "where the verdict is " + verdict, calibration_text(of)});
  }
  for (const auto& [kind, many] : score.cases) {
    const auto failed = score.failed.find(kind);
    rows.push_back({"cases", words_of_class(kind), std::to_string(many)});
    rows.push_back({"cases not diagnosed", words_of_class(kind),
                    std::to_string(failed == score.failed.end() ? 0 : failed->second)});
  }
  if (score.timed > 0) {
    rows.push_back({"seconds a diagnosis: mean, most", "",
                    fmt::format("{}, {}", base::number_text(score.mean_s, 2), base::number_text(score.most_s, 2))});
  }
  return rows;
}

Json interval_json(const BlindShare& share) {
  Json object{{"of", share.of}, {"yes", share.yes}};
  if (share.of == 0) return object;
  const validate::ProportionInterval interval = share.interval95();
  object["interval95"] = {interval.low, interval.high};
  return object;
}

Json by_case_json(const SharesByCase& shares) {
  Json object = Json::object();
  for (const auto& [kind, by_strength] : shares) {
    for (const auto& [strength, share] : by_strength) object[kind][strength] = interval_json(share);
  }
  return object;
}

Json error_json(const validate::ErrorSum& error) {
  Json object{{"of", error.of}};
  if (error.of > 0) object.update({{"rms", error.rms()}, {"mean", error.mean()}});
  return object;
}

Json calibration_json(const validate::EverydayCalibration& of) {
  return {{"of", of.of}, {"stated", of.stated}, {"right", of.right}, {"error", of.error}, {"by_chance", of.by_chance}};
}

/// The answers of all classes together, by quantity.
std::map<std::string, validate::EverydayAnswers> all_answers(const EverydayScore& score) {
  std::map<std::string, validate::EverydayAnswers> sum;
  for (const auto& [kind, by_quantity] : score.answers) {
    for (const auto& [key, of] : by_quantity) {
      validate::EverydayAnswers& all = sum[key];
      for (const auto& [to, from] : {std::pair(&all.answered, &of.answered), std::pair(&all.covered, &of.covered)}) {
        to->of += from->of;
        to->yes += from->yes;
      }
      all.error.of += of.error.of;
      all.error.squares += of.error.squares;
      all.error.sum += of.error.sum;
    }
  }
  return sum;
}

const std::vector<std::string> kAnswersHeader = {
    "quantity", "class", "answers", "rms error", "95 % intervals that hold", "those of the diagnosis"};

/// "86 % (43 of 50)"; a dash if there are none.
std::string share_alone(const BlindShare& share) {
  return share.of == 0 ? "–" : fmt::format("{:.0f} % ({} of {})", 100.0 * share.share(), share.yes, share.of);
}

using ShareText = std::string (*)(const BlindShare&);

/// A row for a quantity of some class: what the estimator answered, beside what the diagnosis recovered.
std::vector<std::string> answers_row(const std::string& key, const std::string& kind,
                                     const validate::EverydayAnswers& of, const BlindShare& of_diagnosis,
                                     ShareText text_of) {
  const std::string unit = core::unit_of(key);
  return {
      core::symbol_of(key),
      kind,
      fmt::format("{} of {}", of.answered.yes, of.answered.of),
      of.error.of == 0 ? "–" : base::number_text(of.error.rms(), 2) + (unit.empty() || unit == "°" ? "" : " ") + unit,
      text_of(of.covered),
      text_of(of_diagnosis)};
}

TextRows all_answers_rows(const EverydayScore& score, ShareText text_of) {
  const auto all = all_answers(score);
  TextRows rows;
  for (const core::QuantityName& quantity : core::kQuantities) {
    const std::string key(quantity.key);
    if (const auto of = all.find(key); of != all.end()) {
      rows.push_back(answers_row(key, words_of_class("all"), of->second, covered_of(score, "", key), text_of));
    }
  }
  return rows;
}

TextRows answers_rows_by_class(const EverydayScore& score) {
  TextRows rows;
  for (const auto& [kind, by_quantity] : score.answers) {
    for (const core::QuantityName& quantity : core::kQuantities) {
      const std::string key(quantity.key);
      const auto of = by_quantity.find(key);
      if (of == by_quantity.end()) continue;
      rows.push_back(
          answers_row(key, words_of_class(kind), of->second, covered_of(score, kind, key), share_and_interval));
    }
  }
  return rows;
}

Json score_json(const EverydayScore& score) {
  Json everyday = Json::object();
  everyday["methods"] = Json::array();
  for (const auto& method : score.methods) {
    everyday["methods"].push_back({{"name", method_name(method.by)},
                                   {"main_first", by_case_json(method.main_first)},
                                   {"main_in_set", by_case_json(method.main_in_set)},
                                   {"both", by_case_json(method.both)},
                                   {"false_claim", by_case_json(method.false_claim)},
                                   {"wrong_name", by_case_json(method.wrong_name)},
                                   {"share_error", error_json(method.share_error)},
                                   {"any_share_error", error_json(method.any_share_error)}});
  }
  everyday["main_helps_most"] = by_case_json(score.main_helps);
  everyday["unknown"] = by_case_json(score.unknown);
  everyday["fair_claim"] = interval_json(score.fair_claim);
  everyday["remainder_error"] = error_json(score.remainder_error);
  everyday["covered"] = Json::object();
  for (const auto& [kind, by_quantity] : score.covered) {
    for (const auto& [key, share] : by_quantity) everyday["covered"][kind][key] = interval_json(share);
  }
  if (!score.answers.empty()) everyday["answers"] = Json::object();
  for (const auto& [kind, by_quantity] : score.answers) {
    for (const auto& [key, of] : by_quantity) {
      everyday["answers"][kind][key] = {{"answered", interval_json(of.answered)},
                                        {"covered", interval_json(of.covered)},
                                        {"error", error_json(of.error)}};
    }
  }
  everyday["calibration"] = Json::object();
  for (const auto& [kind, of] : score.calibration) everyday["calibration"][kind] = calibration_json(of);
  everyday["calibration_by_verdict"] = Json::object();
  for (const auto& [verdict, of] : score.by_verdict) everyday["calibration_by_verdict"][verdict] = calibration_json(of);
  everyday["cases"] = score.cases;
  everyday["failed"] = score.failed;
  if (score.timed > 0) everyday["seconds"] = {{"of", score.timed}, {"mean", score.mean_s}, {"most", score.most_s}};
  return everyday;
}

Json case_json(const validate::BlindOutcome& outcome) {
  const validate::EverydayTruth& truth = *outcome.everyday;
  Json one{{"case", outcome.index},
           {"kind", validate::word(truth.kind)},
           {"strength", truth.strong ? "strong" : "moderate"},
           {"clips", outcome.clips}};
  put(one, "excess", truth.excess);
  put(one, "remainder", truth.remainder);
  one["truth"] = Json::array();
  for (std::size_t c = 0; c < outcome.causes.size(); ++c) {
    one["truth"].push_back(
        {{"id", outcome.causes[c].id}, {"share", truth.shares[c]}, {"parameters", outcome.causes[c].parameters}});
  }
  one["dirt"] = Json::array();
  for (const auto& imperfection : truth.imperfections) one["dirt"].push_back(imperfection.id);
  one["verdict"] = validate::verdict_word(outcome.verdict);
  if (!outcome.verdict.why.empty()) one["why"] = outcome.verdict.why;
  one["named"] = Json::array();
  for (const auto& name : validate::said_by_diagnosis(outcome.verdict).names) {
    Json named{{"id", name.id}, {"probability", name.probability}, {"equivalent_to", name.equivalent_to}};
    if (name.share) named["share"] = *name.share;
    one["named"].push_back(std::move(named));
  }
  put(one, "gap_before", outcome.verdict.gap_before);
  put(one, "none", outcome.verdict.none);
  put(one, "unknown", outcome.verdict.unknown);
  if (outcome.seconds) put(one, "seconds", *outcome.seconds);
  return one;
}

std::string named_text(const validate::EverydaySaying& saying) {
  std::string text;
  for (const auto& name : saying.names) {
    text += (text.empty() ? "" : " + ") + effect_name(name.id);
    if (name.share) text += fmt::format(" {:.0f} %", 100.0 * *name.share);
  }
  return text;
}

std::string everyday_cases_table(const BlindRun& run) {
  HtmlTable table({"case", "class", "truth", "excess", "verdict", "named", "forward selection"}, 7);
  table.stack_when_narrow(2);
  for (const validate::BlindOutcome& outcome : run.outcomes) {
    const validate::EverydayTruth& truth = *outcome.everyday;
    std::string causes;
    for (std::size_t c = 0; c < outcome.causes.size(); ++c) {
      causes +=
          fmt::format("{}{} {:.0f} %", c == 0 ? "" : " + ", effect_name(outcome.causes[c].id), 100.0 * truth.shares[c]);
    }
    table.row({fmt::format("{}", outcome.index),
               fmt::format("{}, {}", words_of_class(std::string(validate::word(truth.kind))),
                           truth.strong ? "strong" : "moderate"),
               escape(causes), base::number_text(truth.excess, 2), validate::verdict_word(outcome.verdict),
               escape(named_text(validate::said_by_diagnosis(outcome.verdict))),
               escape(named_text(validate::said_by_forward_selection(outcome.verdict)))});
  }
  return table.str();
}

}  // namespace

std::vector<EverydayTarget> everyday_targets(const EverydayScore& score) {
  const validate::EverydayMethod& diagnosis = score.methods.front();
  std::vector<EverydayTarget> targets = {
      {"the main cause is named first", sum_of(diagnosis.main_first), {}, 0.85, 1.0},
      {"two causes: both are named", sum_of(diagnosis.both), {}, 0.70, 1.0},
      {"small imperfections alone: a cause with half of the excess is claimed",
       sum_of(diagnosis.false_claim),
       {},
       0.0,
       0.05},
      {"off the list: a wrong name above 0.8", sum_of(diagnosis.wrong_name), {}, 0.0, 0.03},
      {"recovered intervals contain the true value", covered_of(score, "", ""), {}, 0.90, 0.98}};
  EverydayTarget shares{"rms error of the shares of named causes", {}, {}, 0.0, 0.1, true};
  if (diagnosis.share_error.of > 0) shares.value = diagnosis.share_error.rms();
  targets.push_back(std::move(shares));
  for (const char* kind : {"one", "two", "dirt", "outside"}) {
    EverydayTarget calibration{
        "expected calibration error, " + words_of_class(kind), {}, {}, 0.0, kWantedCalibration, true};
    const auto found = score.calibration.find(kind);
    if (found != score.calibration.end()) calibration.value = found->second.error;
    targets.push_back(std::move(calibration));
  }
  return targets;
}

bool bears(const EverydayTarget& target) {
  return target.value.has_value() || target.share.of > 0;
}

bool is_met(const EverydayTarget& target) {
  const double found = target.value.value_or(target.share.share());
  return found >= target.low && found <= target.high;
}

std::string everyday_json(const BlindRun& run) {
  const EverydayScore& score = *run.everyday;
  Json document;
  document["format"] = 1;
  document["seed"] = run.seed;
  document["cases"] = run.outcomes.size();
  std::size_t failed = 0;
  for (const auto& [kind, many] : score.failed) failed += many;
  document["failed"] = failed;
  document["targets"] = Json::array();
  for (const EverydayTarget& target : everyday_targets(score)) {
    Json one = target.share.of > 0 ? interval_json(target.share) : Json::object();
    one["what"] = target.what;
    if (target.value) put(one, "value", *target.value);
    if (target.low > 0.0) one["at_least"] = target.low;
    if (target.high < 1.0) one["at_most"] = target.high;
    if (bears(target)) one["met"] = is_met(target);
    document["targets"].push_back(std::move(one));
  }
  const auto all = score.calibration.find("all");
  put(document, "expected_calibration_error", all == score.calibration.end() ? 0.0 : all->second.error);
  if (run.outside) document["outside"] = outside_json(*run.outside);
  document["everyday"] = score_json(score);
  document["outcomes"] = Json::array();
  for (const auto& outcome : run.outcomes) document["outcomes"].push_back(case_json(outcome));
  return json_text(document);
}

namespace {

/// "The main cause is named first in 77 % (…); 6 of 10 targets are met."
std::string everyday_answer(const EverydayScore& score) {
  const std::vector<EverydayTarget> targets = everyday_targets(score);
  const auto bearing = std::ranges::count_if(targets, bears);
  const auto met = std::ranges::count_if(targets, [](const auto& of) { return bears(of) && is_met(of); });
  const EverydayTarget& first = targets.front();
  if (!bears(first)) return fmt::format("{} of {} targets are met.", met, bearing);
  return fmt::format("The main cause is named first in {}; {} of {} targets are met.", found_text(first), met, bearing);
}

}  // namespace

std::string everyday_text(const BlindRun& run) {
  const EverydayScore& score = *run.everyday;
  TextRows rows = {{fmt::format("of {} everyday cases", run.outcomes.size()), "found", "wanted"}};
  for (const EverydayTarget& target : everyday_targets(score)) {
    rows.push_back({target.what, found_text(target), limits_text(target)});
  }
  std::string text = everyday_answer(score) + "\n\n" + text_table(rows, 1);
  if (!run.outside) return text;
  if (const std::string failed = outside_failed(*run.outside); !failed.empty()) text = failed + " " + text;
  TextRows answers = {{"quantity", "answers", "rms error", "95 % intervals that hold", "of the diagnosis"}};
  for (auto row : all_answers_rows(score, share_alone)) {
    row.erase(row.begin() + 1);  // the class: all
    answers.push_back(std::move(row));
  }
  return text + "\n" + outside_text(*run.outside) + "\n\n" + text_table(answers, 1);
}

Page everyday_page(const BlindRun& run) {
  const EverydayScore& score = *run.everyday;
  const char* const question = "How often is the diagnosis right about experiments as students record them?";
  Html body = question_heading(fmt::format("blind cases: {} everyday tracks, seed {}", run.outcomes.size(), run.seed),
                               question);
  body += meaning_section(fmt::format("<p><b>{}</b></p>\n", escape(everyday_answer(score))));
  body +=
      "<p class=\"soft\">The experiments were made by a generator that shares no model with the diagnosis, each with "
      "three to five small imperfections besides its causes. Each was diagnosed by a separate process that saw only "
      "the experiment folder.</p>\n";
  HtmlTable targets({"what", "found (95 % interval)", "wanted"});
  targets.stack_when_narrow(1);
  for (const EverydayTarget& target : everyday_targets(score)) {
    const char* how = !bears(target) ? "" : is_met(target) ? ": met" : ": missed";
    targets.row({escape(target.what), escape(found_text(target)), escape(limits_text(target)) + how});
  }
  body += "<h2>Results against the targets</h2>\n" + targets.str();
  if (run.outside) {
    HtmlTable answers(kAnswersHeader, 6);
    answers.stack_when_narrow(1);
    for (const TextRows& rows : {all_answers_rows(score, share_and_interval), answers_rows_by_class(score)}) {
      for (const auto& row : rows) {
        answers.row({escape(row[0]), escape(row[1]), escape(row[2]), escape(row[3]), escape(row[4]), escape(row[5])});
      }
    }
    body += "<h2>An estimator on the same cases</h2>\n<p>" + escape(outside_text(*run.outside)) + "</p>\n" +
            answers.str() +
            "<p class=\"soft\">The estimator saw the same folder as the diagnosis, which may add causes to the law. An "
            "interval of the diagnosis is one of those that it recovers with these causes in the law.</p>\n";
  }
  HtmlTable details({"what", "class", "strength", "by", "cases (95 % interval)"}, 5);
  details.stack_when_narrow(1);
  for (const auto& row : detail_rows(score)) {
    details.row({escape(row[0]), escape(row[1]), escape(row[2]), escape(row[3]), escape(row[4])});
  }
  body += folded("By class and strength", details.str());
  HtmlTable numbers({"what", "of", "found"}, 3);
  numbers.stack_when_narrow(1);
  for (const auto& row : number_rows(score)) numbers.row({escape(row[0]), escape(row[1]), escape(row[2])});
  body += folded("Shares, intervals, probabilities", numbers.str());
  body += folded(
      "All cases",
      everyday_cases_table(run) +
          "<p class=\"soft\">The excess is g² - 1, g the gap of held-out clips without noise: 1.5 to 4 is moderate, "
          "more is strong. A cause's share is the part of it that is removed when the cause is added to the law after "
          "those before it. Forward selection takes the effect with the smallest held-out gap, then the one that "
          "lowers the gap most when added to it, and claims them where they take half of the excess; it states no "
          "probability, so each of its names counts as certain.</p>\n");
  return page(question, body);
}

}  // namespace glidelab::report
