#include "report/blind/blind_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/text/number_text.h"
#include "report/blind/blind_run.h"
#include "report/blind/everyday_report.h"
#include "report/html/gnuplot.h"
#include "report/html/html.h"
#include "report/html/plot.h"
#include "report/text/display_text.h"
#include "report/text/json_numbers.h"

namespace glidelab::report {
namespace {

using validate::BlindShare;

BlindShare all_of(const std::map<std::string, BlindShare>& shares) {
  BlindShare sum;
  for (const auto& [key, share] : shares) {
    sum.of += share.of;
    sum.yes += share.yes;
  }
  return sum;
}

/// "in 96 % (122 of 127; 95 %: 91 to 99 %)"
std::string with_interval(const BlindShare& share) {
  const validate::ProportionInterval interval = share.interval95();
  return fmt::format("in {:.0f} % ({} of {}; 95 %: {:.0f} to {:.0f} %)", 100.0 * share.share(), share.yes, share.of,
                     100.0 * interval.low, 100.0 * interval.high);
}

/// The mean excess of the stated probability over the fraction that is right.
double over_stated(const validate::BlindScore& score) {
  double sum = 0.0, cases = 0.0;
  for (const validate::ReliabilityBin& bin : score.reliability) {
    const auto of = static_cast<double>(bin.right.of);
    sum += of * (bin.stated - bin.right.share());
    cases += of;
  }
  return cases > 0.0 ? sum / cases : 0.0;
}

}  // namespace

BlindShare share_of(const std::map<std::string, BlindShare>& shares, const std::string& key) {
  const auto found = shares.find(key);
  return found == shares.end() ? BlindShare{} : found->second;
}

std::string blind_percent(const BlindShare& share) {
  if (share.of == 0) return "–";
  return fmt::format("{:.0f} % ({} of {})", 100.0 * share.share(), share.yes, share.of);
}

std::vector<BlindTarget> blind_targets(const validate::BlindScore& score) {
  const auto& single = score.methods.front().single;
  return {
      {"one strong effect: named first", share_of(single, "strong"), 0.95, false},
      {"one moderate effect: named first", share_of(single, "moderate"), 0.80, false},
      {"one effect, moderate or strong: among those named",
       {share_of(score.in_set, "strong").of + share_of(score.in_set, "moderate").of,
        share_of(score.in_set, "strong").yes + share_of(score.in_set, "moderate").yes},
       0.97,
       false},
      {"nothing wrong: a verdict other than none", score.false_alarm, 0.05, true},
      {"not on the list, strong: unknown, or its nearest equivalent on the list", share_of(score.recognised, "strong"),
       0.85, false},
      {"not on the list, all: unknown, or its nearest equivalent on the list", all_of(score.recognised), 0.85, false},
      {"not on the list: a name with probability over 0.8", score.wrong_name, 0.03, true},
      {"two effects: both named", score.methods.front().pair, 0.75, false},
      {"gap shrinks by 0.95 or more of what a fit of the true effect reaches", score.shrunk, 0.95, false}};
}

bool is_met(const BlindTarget& target) {
  return target.at_most ? target.share.share() <= target.wanted : target.share.share() >= target.wanted;
}

std::string wanted_text(const BlindTarget& target) {
  return fmt::format("{} {:.0f} %", target.at_most ? "at most" : "at least", 100.0 * target.wanted);
}

std::string blind_meaning(const validate::BlindScore& score) {
  const auto& single = score.methods.front().single;
  std::string text;
  const auto add = [&](const BlindShare& share, const char* when, const char* what) {
    if (share.of > 0) text += fmt::format("<li>{}: {} {}.</li>\n", when, what, with_interval(share));
  };
  add(share_of(single, "strong"), "One strong effect",
      "its name, or that of an effect that is the same on such data, comes first");
  add(share_of(single, "moderate"), "One moderate effect", "its name comes first");
  add(score.methods.front().pair, "Two effects at once", "both are named");
  add(score.false_alarm, "Nothing wrong", "the verdict is other than none");
  add(all_of(score.recognised), "A cause that is not on the list",
      "it is called unknown, or by its nearest equivalent on the list");
  add(score.wrong_name, "A cause that is not on the list", "some name gets a probability over 0.8");
  text = meaning_section("<p>How far a verdict on an experiment like these can be trusted:</p>\n<ul>\n" + text +
                         "</ul>\n");
  const bool calibrated = score.calibration_error < kWantedCalibration;
  text += fmt::format("<p>A stated probability is off by {} on average: it can{} be taken at face value{}.",
                      base::number_text(score.calibration_error, 2), calibrated ? "" : "not",
                      calibrated                 ? ""
                      : over_stated(score) > 0.0 ? ": it is overconfident"
                                                 : ": it is underconfident");
  std::string missed = calibrated ? "" : "the expected calibration error";
  std::size_t weighed = 1;  // including that of the calibration
  for (const BlindTarget& target : blind_targets(score)) {
    if (target.share.of == 0) continue;
    ++weighed;
    if (!is_met(target)) missed += (missed.empty() ? "" : "; ") + escape(target.what);
  }
  if (weighed == 1) return text + " No case is relevant to the targets.</p>\n";
  return text + (missed.empty()
                     ? fmt::format(" All {} targets to which these cases are relevant are met.</p>\n", weighed)
                     : fmt::format(" Missed: {}.</p>\n", missed));
}

namespace {

using validate::BlindShare;

std::string percent_only(const BlindShare& share) {
  return share.of == 0 ? "–" : fmt::format("{:.0f} %", 100.0 * share.share());
}

/// The kinds of case, in the order of the methods' table and plot.
std::array<BlindShare, 6> kinds_of(const validate::BlindMethod& method) {
  return {method.none,
          share_of(method.single, "weak"),
          share_of(method.single, "moderate"),
          share_of(method.single, "strong"),
          method.pair,
          method.outside};
}

std::vector<std::string> percents_of(const validate::BlindMethod& method) {
  std::vector<std::string> cells;
  for (const BlindShare& share : kinds_of(method)) cells.push_back(percent_only(share));
  return cells;
}

std::string wanted_calibration_text() {
  return fmt::format("below {}", kWantedCalibration);
}

/// An effect's name for people; "unknown", "none" and "two effects" stay, which are headings of this page.
std::string case_name(const std::string& word) {
  return diagnose::verdict_of_id(word) ? word : effect_name(word);
}

std::string said_text(const std::map<std::string, std::size_t>& times_said) {
  std::vector<std::pair<std::string, std::size_t>> said(times_said.begin(), times_said.end());
  std::stable_sort(said.begin(), said.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (const auto& [word, times] : said)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", case_name(word), times);
  return text;
}

Json share_json(const BlindShare& share) {
  return {{"of", share.of}, {"yes", share.yes}};
}

Json shares_json(const std::map<std::string, BlindShare>& shares) {
  Json object = Json::object();
  for (const auto& [key, share] : shares) object[key] = share_json(share);
  return object;
}

Json outcome_json(const validate::BlindOutcome& outcome) {
  Json one{{"case", outcome.index}, {"kind", validate::word(outcome.kind)}, {"clips", outcome.clips}};
  one["truth"] = Json::array();
  for (const auto& cause : outcome.causes) {
    Json object{{"id", cause.id}};
    put(object, "log_likelihood_gain", cause.gain);
    object["parameters"] = cause.parameters;
    one["truth"].push_back(std::move(object));
  }
  one["verdict"] = validate::verdict_word(outcome.verdict);
  if (!outcome.verdict.why.empty()) one["why"] = outcome.verdict.why;
  one["named"] = Json::array();
  for (const auto& effect : outcome.verdict.effects) {
    one["named"].push_back(
        {{"id", effect.id}, {"probability", effect.probability}, {"equivalent_to", effect.equivalent_to}});
  }
  put(one, "none", outcome.verdict.none);
  put(one, "unknown", outcome.verdict.unknown);
  if (outcome.left_out) {
    one["left_out"] = {{"verdict", validate::verdict_word(*outcome.left_out)}, {"named", Json::array()}};
    for (const auto& effect : outcome.left_out->effects) {
      one["left_out"]["named"].push_back({{"id", effect.id}, {"probability", effect.probability}});
    }
  }
  return one;
}

Plot reliability_plot(const validate::BlindScore& score) {
  PlotData data{"bins", {}, {"probability stated", "share right", "95 % from", "95 % to"}};
  for (const validate::ReliabilityBin& bin : score.reliability) {
    if (bin.right.of == 0) continue;
    const validate::ProportionInterval interval = bin.right.interval95();
    data.rows.push_back({bin.stated, bin.right.share(), interval.low, interval.high});
  }
  const std::string script = std::string(kFrame) +
                             "unset offsets\nset xrange [0:1.03]\nset yrange [0:1.03]\n"
                             "set xlabel 'probability that was stated'\nset ylabel 'share that was right'\n" +
                             fmt::format(
                                 "plot x with lines lw 1.5 lc rgb '{}' title 'as stated', $bins using 1:2:3:4 with "
                                 "yerrorbars pt 7 ps 0.9 lw 1.5 lc rgb '{}' title 'cases'\n",
                                 kGrey, kColors[0]);
  const std::vector<PlotData> all = {data};
  return {Drawing{script, all},
          fmt::format("Stated probability of the verdict, and how often it was right, with 95 % intervals; expected "
                      "calibration error {}",
                      base::number_text(score.calibration_error, 2)),
          "Reliability diagram"};
}

Plot methods_plot(const validate::BlindScore& score) {
  std::vector<PlotData> data;
  std::string script =
      std::string(kFrame) +
      "unset offsets\nset style fill solid 0.85 noborder\nset boxwidth 0.19\nset yrange [0:105]\n"
      "set xrange [0.4:6.6]\nset ylabel 'right  (%)'\nset key outside top center horizontal maxcols 2 samplen 1\n"
      "set xtics font ',12' ('none' 1, 'weak' 2, 'moderate' 3, 'strong' 4, 'two' 5, 'outside' 6)\nplot ";
  const double middle = 0.5 * (static_cast<double>(score.methods.size()) - 1.0);
  for (std::size_t m = 0; m < score.methods.size(); ++m) {
    const auto& method = score.methods[m];
    PlotData rows{
        fmt::format("m{}", m), {}, {"kind of case (place)", fmt::format("right by {} (%)", method_name(method.by))}};
    const std::array<BlindShare, 6> shares = kinds_of(method);
    for (std::size_t s = 0; s < shares.size(); ++s) {
      rows.rows.push_back(
          {static_cast<double>(s) + 1.0 + 0.2 * (static_cast<double>(m) - middle), 100.0 * shares[s].share()});
    }
    script += fmt::format("{}$m{} using 1:2 with boxes lc rgb '{}' title {}", m == 0 ? "" : ", ", m, color(m),
                          gnuplot_quoted(method_name(method.by)));
    data.push_back(std::move(rows));
  }
  return {Drawing{script, data, {480, 400}}, "How often each method of deciding is right, by kind of case",
          fmt::format("Share of right answers of {} methods", score.methods.size())};
}

std::string methods_table(const validate::BlindScore& score) {
  HtmlTable table({"", "nothing there", "one, weak", "moderate", "strong", "two effects", "outside"});
  for (const validate::BlindMethod& method : score.methods) {
    std::vector<std::string> row = percents_of(method);
    row.insert(row.begin(), escape(method_name(method.by)));
    table.row(row);
  }
  return table.str();
}

std::string cases_table(const BlindRun& run) {
  HtmlTable table({"case", "truth", "gain", "verdict", "probability", "indistinguishable from"}, 6);
  table.stack_when_narrow(2);
  for (const validate::BlindOutcome& outcome : run.outcomes) {
    std::string truth = outcome.causes.empty() ? "none" : "", gain, said = validate::verdict_word(outcome.verdict), p,
                same;
    for (const auto& cause : outcome.causes) {
      truth += (truth.empty() ? "" : " + ") + escape(effect_name(cause.id));
      gain += (gain.empty() ? "" : ", ") + base::number_text(cause.gain, 2);
    }
    if (outcome.verdict.verdict == diagnose::Verdict::none) p = base::digits_text(outcome.verdict.none, 2);
    if (outcome.verdict.verdict == diagnose::Verdict::unknown) p = base::digits_text(outcome.verdict.unknown, 2);
    if (!outcome.verdict.effects.empty()) said.clear();
    for (const auto& effect : outcome.verdict.effects) {
      said += (said.empty() ? "" : " + ") + escape(effect_name(effect.id));
      p += (p.empty() ? "" : ", ") + base::digits_text(effect.probability, 2);
      for (const std::string& id : effect.equivalent_to) same += (same.empty() ? "" : ", ") + escape(effect_name(id));
    }
    table.row({fmt::format("{}", outcome.index), truth, gain, said, p, same});
  }
  return table.str();
}

}  // namespace

namespace {

/// "One strong effect is named first in 100 % (33 of 33); 8 of 9 targets are met."
std::string blind_answer(const validate::BlindScore& score) {
  std::size_t bearing = 1, met = score.calibration_error < kWantedCalibration ? 1 : 0;
  for (const BlindTarget& target : blind_targets(score)) {
    bearing += target.share.of > 0 ? 1 : 0;
    met += target.share.of > 0 && is_met(target) ? 1 : 0;
  }
  const BlindShare strong = share_of(score.methods.front().single, "strong");
  if (strong.of == 0) return fmt::format("{} of {} targets are met.", met, bearing);
  return fmt::format("One strong effect is named first in {}; {} of {} targets are met.", blind_percent(strong), met,
                     bearing);
}

}  // namespace

std::string blind_json(const BlindRun& run) {
  if (run.everyday) return everyday_json(run);
  const validate::BlindScore& score = run.score;
  Json document;
  document["format"] = 1;
  document["seed"] = run.seed;
  if (run.images) document["pictures"] = true;
  document["cases"] = run.outcomes.size();
  document["failed"] = score.failed;
  document["targets"] = Json::array();
  for (const BlindTarget& target : blind_targets(score)) {
    Json one = share_json(target.share);
    one["what"] = target.what;
    one[target.at_most ? "at_most" : "at_least"] = target.wanted;
    if (target.share.of > 0) one["met"] = is_met(target);
    document["targets"].push_back(std::move(one));
  }
  put(document, "expected_calibration_error", score.calibration_error);
  document["methods"] = Json::array();
  for (const auto& method : score.methods) {
    document["methods"].push_back({{"name", method_name(method.by)},
                                   {"none", share_json(method.none)},
                                   {"single", shares_json(method.single)},
                                   {"pair", share_json(method.pair)},
                                   {"outside", share_json(method.outside)}});
  }
  document["exact_name_first"] = shares_json(score.exact);
  document["in_named_set"] = shares_json(score.in_set);
  document["outside_unknown"] = shares_json(score.recognised);
  document["outside_variable_named"] = share_json(score.where);
  document["outside_variable_first"] = share_json(score.where_first);
  document["left_out"] = Json::object();
  for (const auto& [verdict, share] : score.left_out) document["left_out"][without_words(verdict)] = share_json(share);
  document["left_out_variable_first"] = share_json(score.left_out_where);
  document["reliability"] = Json::array();
  for (const auto& bin : score.reliability) {
    Json one = share_json(bin.right);
    one["from"] = bin.from;
    one["to"] = bin.to;
    put(one, "stated", bin.stated);
    document["reliability"].push_back(std::move(one));
  }
  document["confusion"] = Json::object();
  for (const auto& [truth, said] : confusion_words(score)) document["confusion"][truth] = said;
  document["outcomes"] = Json::array();
  for (const auto& outcome : run.outcomes) document["outcomes"].push_back(outcome_json(outcome));
  return json_text(document);
}

std::string blind_text(const BlindRun& run) {
  if (run.everyday) return everyday_text(run);
  const validate::BlindScore& score = run.score;
  std::vector<std::vector<std::string>> rows = {
      {"of " + std::to_string(run.outcomes.size()) + " blind cases", "found", "wanted"}};
  for (const BlindTarget& target : blind_targets(score))
    rows.push_back({target.what, blind_percent(target.share), wanted_text(target)});
  rows.push_back(
      {"expected calibration error", base::number_text(score.calibration_error, 2), wanted_calibration_text()});
  for (const auto& [verdict, share] : score.left_out)
    rows.push_back({"without the true effect on the list: " + without_words(verdict), blind_percent(share), ""});
  std::string text = blind_answer(score) + "\n\n" + text_table(rows, 1) + "\n";
  rows = {{"right", "none", "weak", "moderate", "strong", "two", "outside"}};
  for (const auto& method : score.methods) {
    rows.push_back(percents_of(method));
    rows.back().insert(rows.back().begin(), method_name(method.by));
  }
  text += text_table(rows, 1) + "\n";
  rows = {{"truth", "first name"}};
  for (const auto& [truth, said] : confusion_words(score)) rows.push_back({case_name(truth), said_text(said)});
  text += text_table(rows, 2);
  if (score.failed > 0) text += fmt::format("\n{} cases could not be diagnosed; they count as wrong.\n", score.failed);
  return text;
}

Page blind_page(const BlindRun& run) {
  if (run.everyday) return everyday_page(run);
  const validate::BlindScore& score = run.score;
  const char* const question = "How often is the diagnosis right?";
  Html body = question_heading(
      fmt::format("blind cases: {} {}, seed {}", run.outcomes.size(), run.images ? "films" : "tracks", run.seed),
      question);
  body += blind_meaning(score);
  body +=
      "<p class=\"soft\">The experiments were made by a generator that shares no model with the diagnosis. Each was "
      "diagnosed by a separate process that saw only the experiment folder.</p>\n";
  HtmlTable targets({"what", "found", "wanted"});
  targets.stack_when_narrow(1);
  for (const BlindTarget& target : blind_targets(score)) {
    const std::string how = target.share.of == 0 ? "" : is_met(target) ? ": met" : ": missed";
    targets.row({escape(target.what), blind_percent(target.share), wanted_text(target) + how});
  }
  targets.row({"expected calibration error", base::number_text(score.calibration_error, 2),
               wanted_calibration_text() + (score.calibration_error < kWantedCalibration ? ": met" : ": missed")});
  body += "<h2>Results against the targets</h2>\n" + targets.str();
  if (score.failed > 0) {
    body += fmt::format("<p class=\"note\">{} cases could not be diagnosed; they count as wrong.</p>\n", score.failed);
  }
  body += figures({methods_plot(score), reliability_plot(score)});
  body += "<h2>Compared with simpler methods</h2>\n" + methods_table(score);
  if (!score.left_out.empty()) {
    HtmlTable left({"verdict without the true effect on the list", "cases"});
    for (const auto& [verdict, share] : score.left_out)
      left.row({escape(without_words(verdict)), blind_percent(share)});
    left.row({"of those called unknown: the first region lies over a variable of the effect",
              blind_percent(score.left_out_where)});
    body += "<h2>Leave one effect out</h2>\n" + left.str();
  }
  HtmlTable confusion({"truth", "named first (times)"}, 2);
  for (const auto& [truth, said] : confusion_words(score))
    confusion.row({escape(case_name(truth)), escape(said_text(said))});
  body += folded("What was named for each cause", confusion.str());
  std::string cases = cases_table(run);
  cases +=
      "<p class=\"soft\">A case's gain is the log likelihood by which the true model beats the nominal one, fitted to "
      "the same positions: weak below 15, moderate up to 50, strong above. ";
  cases +=
      run.images
          ? "For an effect that moves no position, it is half the square of its size over what images may show when "
            "nothing is wrong. A wrong scale and a wrong frame rate count as one. Where the file itself says that "
            "it is lossily compressed, compression is no secret: naming it makes a verdict neither better nor "
            "worse.</p>\n"
          : "On tracks, a wrong scale and a wrong frame rate count as one, and so do a shaking camera and a shaking "
            "table.</p>\n";
  body += folded("All cases", cases);
  return page(question, body);
}

}  // namespace glidelab::report
