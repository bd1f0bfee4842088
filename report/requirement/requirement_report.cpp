#include "report/requirement/requirement_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "base/text/number_text.h"
#include "base/text/readable_text.h"
#include "report/html/html.h"
#include "report/requirement/requirement_plot.h"
#include "report/requirement/requirement_words.h"
#include "report/text/display_text.h"
#include "report/text/json_numbers.h"

namespace glidelab::report {
namespace {

using validate::Candidate;
using validate::Requirement;
using validate::Target;
using validate::Verdict;

/// In tables a target's values are given in thousandths, millionths, … of its unit: columns of zeros hide which is
/// smaller.
struct Scale {
  double size = 1.0;
  std::string factor;  ///< "10⁻⁶"; empty for 1
};

Scale scale_of(const Target& target) {
  constexpr std::array<const char*, 4> kFactors = {"", "10⁻³", "10⁻⁶", "10⁻⁹"};
  std::size_t thousands = 0;
  double size = 1.0;
  while (target.value < size && thousands + 1 < kFactors.size()) {
    size /= 1000.0;
    ++thousands;
  }
  return {size, kFactors[thousands]};
}

/// " (10⁻³ 1/s)", for the adjacent column.
std::string same_unit(const Target& target) {
  const std::string name = target_name(target, scale_of(target).factor);
  const std::size_t unit = name.find(" (");
  return unit == std::string::npos ? "" : name.substr(unit);
}

std::string bound_text(const std::optional<double>& bound, double scale) {
  return bound && std::isfinite(*bound) ? base::digits_text(*bound / scale, 2) : "–";
}

/// "rms error of µ at most 0.0005, 95 % error of α (°) at most 0.01".
std::string targets_text(const Requirement& requirement) {
  std::string text;
  for (const Target& target : requirement.targets) {
    text += fmt::format("{}{} at most {}", text.empty() ? "" : ", ", target_name(target),
                        base::number_text(target.value, 4));
  }
  return text;
}

std::string order_text(const Requirement& requirement) {
  return requirement.by_price ? "the cheapest (by the middle of its price range)"
                              : "the fewest pixels a second (not all have a price)";
}

/// "3 of 200"; empty if none was run.
std::string beyond_text(const validate::TargetResult& result) {
  return result.runs == 0 ? "–" : fmt::format("{} of {}", result.beyond, result.runs);
}

bool any_run(const Requirement& requirement) {
  return std::ranges::any_of(requirement.candidates, [](const Candidate& candidate) {
    return std::ranges::any_of(candidate.results, [](const auto& result) { return result.runs > 0; });
  });
}

/// If tracks or the bound judged, says what tracks do not include, and recommends rendering if that could change the
/// result: images can only add to the error.
std::string next_step(const Requirement& requirement) {
  if (requirement.confirm == validate::Confirm::clips) return {};
  const bool ran = any_run(requirement);
  const bool forbidden = std::ranges::all_of(requirement.candidates, [](const Candidate& candidate) {
    return candidate.verdict == Verdict::impossible || candidate.verdict == Verdict::refused;
  });
  return fmt::format(
      "{}: a lens, a codec, a rolling shutter and the calibration are not included.{}",
      ran ? "Judged by tracks, not by images" : "Judged by the bound alone, without a run",
      forbidden ? ""
                : " With `--confirm clips` the candidates are filmed in this order, until one reaches the target.");
}

std::string found_text(const validate::TargetResult& result, double scale) {
  if (!result.found || !std::isfinite(*result.found)) return result.found ? "no result" : "–";
  return base::value_and_sd_text(*result.found / scale, result.found_sd / scale);
}

std::string cost_text(const Requirement& requirement, const Candidate& candidate) {
  if (!candidate.price_class.empty()) return candidate.price_class;
  return requirement.by_price ? "–" : fmt::format("{} Mpx/s", base::number_text(candidate.pixels_s * 1e-6, 3));
}

std::string limit_text(const Candidate& candidate) {
  std::string text;
  for (const validate::Limit& limit : candidate.limits) {
    if (limit.gain < kLeastNamedGain) break;
    text += fmt::format("{}{}: {:.{}f} times", text.empty() ? "" : "; ", limitation_words(limit.what), limit.gain,
                        limit.gain < 10.0 ? 1 : 0);
  }
  return text;
}

/// The upper limit of the error.
std::string limit_cell(const validate::TargetResult& result, double scale) {
  return result.found && std::isfinite(result.high) ? base::digits_text(result.high / scale, 2) : "–";
}

/// "2.1", the position noise; a dash if the camera cannot see the marker.
std::string noise_cell(const Candidate& candidate) {
  return std::isfinite(candidate.noise_m) ? base::number_text(candidate.noise_m * 1e6, 3) : "–";
}

/// "5 of 16 reach it when filmed; 2 may (more runs would decide); 9 do not."
std::string counts_text(const Requirement& requirement) {
  std::size_t reaching = 0, undecided = 0, possible = 0, not_filmed = 0;
  for (const Candidate& candidate : requirement.candidates) {
    reaching += reached(candidate) ? 1 : 0;
    undecided += candidate.verdict == Verdict::undecided ? 1 : 0;
    possible += candidate.verdict == Verdict::unconfirmed && candidate.judged_by == validate::Confirm::none ? 1 : 0;
    not_filmed += candidate.verdict == Verdict::unconfirmed && candidate.judged_by != validate::Confirm::none ? 1 : 0;
  }
  std::string text =
      fmt::format("{} of {} {} it{}", reaching, requirement.candidates.size(), reaching == 1 ? "reaches" : "reach",
                  requirement.confirm == validate::Confirm::clips ? " when filmed" : "");
  if (undecided > 0) text += fmt::format("; {} may (more runs would decide)", undecided);
  if (possible > 0) text += fmt::format("; for {} the bound allows it, but nothing was run", possible);
  if (not_filmed > 0) {
    text += fmt::format("; {} more expensive {} it as tracks and {} not filmed", not_filmed,
                        not_filmed == 1 ? "one reaches" : "ones reach", not_filmed == 1 ? "was" : "were");
  }
  const std::size_t not_at_all = requirement.candidates.size() - reaching - undecided - possible - not_filmed;
  if (not_at_all > 0) text += fmt::format("; {} {} not", not_at_all, not_at_all == 1 ? "does" : "do");
  return text + ".";
}

/// "fit of the whole motion" where this estimator judges all that were judged; otherwise empty, and the table has a
/// column for it.
std::string common_judge(const Requirement& requirement) {
  std::string common;
  for (const Candidate& candidate : requirement.candidates) {
    const bool none =
        std::ranges::all_of(candidate.results, [](const auto& result) { return result.estimator.empty(); });
    const std::string judge = judging_estimators(candidate);
    if (none || judge == common) continue;
    if (!common.empty()) return {};
    common = judge;
  }
  return common;
}

/// Whether the estimators that judge differ from camera to camera.
bool judges_differ(const Requirement& requirement) {
  return common_judge(requirement).empty() &&
         std::ranges::any_of(requirement.candidates, [](const Candidate& candidate) {
           return std::ranges::any_of(candidate.results, [](const auto& result) { return !result.estimator.empty(); });
         });
}

/// "All were judged with the fit of the whole motion."; empty if they differ or nothing was run.
std::string judge_sentence(const Requirement& requirement) {
  const std::string common = common_judge(requirement);
  return common.empty() ? common : fmt::format("All were judged with the {}.", common);
}

/// All of them, the cheapest first: what a choice rests on; the bounds where nothing was run.
std::string candidate_table(const Requirement& requirement) {
  std::vector<std::string> header = {"no.", "camera", "cost", "verdict"};
  const std::size_t first_number = header.size();
  const bool ran = any_run(requirement);
  for (const Target& target : requirement.targets) {
    const std::string name = escape(target_name(target, scale_of(target).factor));
    header.push_back(ran ? name : "bound of the " + name);
    if (ran) header.push_back("upper limit");
  }
  header.insert(header.end(), {"frames/s", "position noise (µm)"});
  HtmlTable table(header, first_number);
  table.stack_when_narrow(2);
  for (std::size_t i = 0; i < requirement.candidates.size(); ++i) {
    const Candidate& candidate = requirement.candidates[i];
    const std::string verdict = escape(candidate_verdict(candidate));
    std::vector<std::string> row = {std::to_string(i + 1), escape(candidate.name),
                                    escape(cost_text(requirement, candidate)),
                                    reached(candidate) ? "<b>" + verdict + "</b>" : verdict};
    for (std::size_t t = 0; t < candidate.results.size(); ++t) {
      const double scale = scale_of(requirement.targets[t]).size;
      row.push_back(ran ? found_text(candidate.results[t], scale) : bound_text(candidate.results[t].bound, scale));
      if (ran) row.push_back(limit_cell(candidate.results[t], scale));
    }
    row.insert(row.end(), {base::number_text(candidate.frame_rate_hz, 4), noise_cell(candidate)});
    table.row(row);
  }
  return table.str();
}

/// What the verdicts rest on: the bound, the runs beyond the target and, where they differ, the estimators that judge.
std::string evidence_table(const Requirement& requirement) {
  const bool judge_column = judges_differ(requirement);
  std::vector<std::string> header = {"no.", "camera"};
  if (judge_column) header.emplace_back("judged by");
  const std::size_t first_number = header.size();
  for (const Target& target : requirement.targets) {
    const std::string of = " of " + escape(symbol_of(target.quantity));
    header.push_back("bound" + of + escape(same_unit(target)));
    header.push_back("runs beyond the target" + of);
  }
  HtmlTable table(header, first_number);
  table.stack_when_narrow(2);
  for (std::size_t i = 0; i < requirement.candidates.size(); ++i) {
    const Candidate& candidate = requirement.candidates[i];
    std::vector<std::string> row = {std::to_string(i + 1), escape(candidate.name)};
    if (judge_column) row.push_back(escape(judging_estimators(candidate)));
    for (std::size_t t = 0; t < candidate.results.size(); ++t) {
      row.push_back(bound_text(candidate.results[t].bound, scale_of(requirement.targets[t]).size));
      row.push_back(beyond_text(candidate.results[t]));
    }
    table.row(row);
  }
  return table.str();
}

/// Runs in which an estimator gave no answer: they count as infinitely far off, and the other one judges then.
std::string unanswered_list(const Requirement& requirement) {
  std::string items;
  for (const Candidate& candidate : requirement.candidates) {
    const std::string words = unanswered_words(requirement, candidate);
    if (!words.empty()) items += fmt::format("<li><b>{}</b>: {}</li>\n", escape(candidate.name), escape(words));
  }
  return items.empty() ? items : "<h3>Runs without an answer</h3>\n<ul>\n" + items + "</ul>\n";
}

/// What limits the candidates that do not reach the target: text, for which a table has no room.
std::string limits_list(const Requirement& requirement) {
  std::string items;
  for (const Candidate& candidate : requirement.candidates) {
    const std::string limits = candidate.why.empty() ? limit_text(candidate) : candidate.why;
    if (reached(candidate) || limits.empty()) continue;
    items += fmt::format("<li><b>{}</b>: {}</li>\n", escape(candidate.name), escape(limits));
  }
  if (items.empty()) return {};
  return "<h3>What limits the others</h3>\n<p>How many times smaller the bound (“by runs”: the error) would "
         "be without each limitation:</p>\n<ul>\n" +
         items + "</ul>\n";
}

std::string judged_by_text(const Requirement& requirement) {
  if (requirement.confirm == validate::Confirm::none) return "Nothing was run.";
  if (requirement.confirm == validate::Confirm::tracks) {
    return fmt::format(
        "Where the bound allows the target, {} runs of tracks with that noise decide, by the better estimator.",
        requirement.track_runs);
  }
  const std::vector<std::uint64_t> looks = validate::looks(requirement.runs);
  return fmt::format(
      "Where the bound allows the target, rendered runs decide, each with a calibration of its own, by the better "
      "estimator: {} of a camera{}, the cheapest camera first, and {} of the first that reaches the target; what is "
      "more expensive is then judged by tracks alone. All limits at one look have a "
      "confidence of {:.3g} %, so that the looks together err in at most 5 % of all cases. Up to {} runs of tracks "
      "with the predicted noise and the clock are made as well: a camera that misses the target there and reaches it "
      "in fewer than {} rendered runs is undecided.",
      looks.front(),
      looks.size() < 2
          ? std::string()
          : fmt::format(", then {} where these do not decide", fmt::join(looks.begin() + 1, looks.end(), ", ")),
      requirement.runs, 100.0 * validate::confidence_of_look(requirement.runs), requirement.track_runs,
      validate::kRunsForQuantile);
}

/// The meaning of the table's numbers.
std::string how_judged(const Requirement& requirement) {
  std::string text = fmt::format(
      "<p>Errors are those of the worst configuration; {} first. The bound is the Cramér-Rao bound for the motion at "
      "this frame rate and position noise; the noise itself is the bound on the marker's centre for the camera's light "
      "and noise. {} “What limits the others” says how many times smaller the bound of the hardest target (“by runs”: "
      "the error) would be without one limitation. A lens, a codec, a rolling shutter and the calibration enter only "
      "in rendered runs.</p>\n",
      order_text(requirement), judged_by_text(requirement));
  return text +
         fmt::format(
             "<p>95 % of the runs stay within the 95 % error (for fewer than 20 runs: 1.96 times their rms error). A "
             "target is reached if the error's upper limit (“upper limit”) is within it, and missed if the lower limit "
             "is "
             "beyond it. With {} runs or more the limits are two of their errors; with fewer they assume normal "
             "errors, so that few runs decide only what is far from the target. If one of fewer runs is beyond the "
             "target, the upper limit is not below that error, and the target is not reached. “Judged by” names the "
             "estimator with the smaller error; one without an answer in a run counts as infinitely far off there. ± "
             "is one standard deviation, from {} bootstrap resamples of the runs (for fewer than 20: that of normal "
             "errors; for a bias: that of the errors over the root of their number). “Runs beyond the target” counts, "
             "of all runs made, those with a larger error: a few that are far off come from the clock, such as frames "
             "lost without a trace, not from noise.</p>\n",
             validate::kRunsForQuantile, validate::kResamples);
}

constexpr std::size_t kNameWidth = 31, kCostWidth = 12;  // bytes before "…", so that the table fits a terminal

/// Its beginning and "…", where it is longer: up to the last comma before a blank in its second half, or else the last
/// blank.
std::string cut_short(const std::string& text, std::size_t width) {
  if (text.size() <= width) return text;
  const std::string first = base::first_bytes(text, width);
  const std::size_t comma = first.rfind(", "), blank = first.rfind(' ');
  const bool by_comma = comma != std::string::npos && comma >= width / 2;
  const std::size_t end = by_comma ? comma : blank;
  return first.substr(0, end) + "…";  // npos: all of it
}

/// As many characters of each name as a terminal has room for; whole names where two would then be the same.
std::vector<std::string> short_names(const Requirement& requirement) {
  std::vector<std::string> names, whole;
  for (const Candidate& candidate : requirement.candidates) {
    whole.push_back(candidate.name);
    names.push_back(cut_short(candidate.name, kNameWidth));
  }
  std::vector<std::string> sorted = names;
  std::ranges::sort(sorted);
  return std::ranges::adjacent_find(sorted) == sorted.end() ? names : whole;
}

}  // namespace

Page requirement_report(const Requirement& requirement) {
  const std::string question = requirement_question(requirement);
  Html body = question_heading(requirement.name, question);
  body += fmt::format("<p><b>{}</b> {}</p>\n<p>{} {}</p>\n", escape(requirement_answer(requirement)),
                      escape(enough_words(requirement)), escape(counts_text(requirement)),
                      escape(judge_sentence(requirement)));
  const std::string next = next_step(requirement);
  if (!next.empty()) body += fmt::format("<p class=\"note\">{}</p>\n", escape_with_code(next));
  body += figures({requirement_plot(requirement)});
  body += candidate_table(requirement) + unanswered_list(requirement) + limits_list(requirement);
  body += folded("How this was judged", evidence_table(requirement) + how_judged(requirement));
  return page(question, body);
}

std::string requirement_text(const Requirement& requirement) {
  const bool judge_column = judges_differ(requirement);
  std::vector<std::vector<std::string>> rows = {{"camera", "cost", "verdict"}};
  if (judge_column) rows.front().emplace_back("judged by");
  for (const Target& target : requirement.targets) {
    rows.front().push_back(target_name(target, scale_of(target).factor));
  }
  const std::vector<std::string> names = short_names(requirement);
  std::string below, unanswered;
  for (std::size_t i = 0; i < requirement.candidates.size(); ++i) {
    const Candidate& candidate = requirement.candidates[i];
    std::vector<std::string>& row = rows.emplace_back(std::vector<std::string>{
        names[i], cut_short(cost_text(requirement, candidate), kCostWidth), candidate_verdict(candidate)});
    if (judge_column) row.push_back(judging_estimators(candidate));
    for (std::size_t t = 0; t < candidate.results.size(); ++t) {
      row.push_back(found_text(candidate.results[t], scale_of(requirement.targets[t]).size));
    }
    if (const std::string words = unanswered_words(requirement, candidate); !words.empty()) {
      unanswered += fmt::format("{}: {}\n", candidate.name, words);
    }
    if (reached(candidate)) continue;
    const std::string limits = candidate.why.empty() ? limit_text(candidate) : candidate.why;
    if (!limits.empty()) below += fmt::format("{}: {}\n", candidate.name, limits);
  }
  std::string text = requirement_answer(requirement) + "\n";
  if (const std::string enough = enough_words(requirement); !enough.empty()) text += enough + "\n";
  const std::string judge = judge_sentence(requirement);
  text += fmt::format("\n{} on the worst configuration; {} first. {}{}{}\n\n", targets_text(requirement),
                      order_text(requirement), counts_text(requirement), judge.empty() ? "" : " ", judge) +
          text_table(rows, judge_column ? 4 : 3);
  if (!unanswered.empty()) text += "\n" + unanswered;
  if (!below.empty())
    text += "\nWhat limits the others (how many times smaller the bound, “by runs” the error, is without it)\n" + below;
  const std::string next = next_step(requirement);
  if (!next.empty()) text += "\n" + without_code_marks(next) + "\n";
  return text;
}

std::string requirement_json(const Requirement& requirement) {
  Json document;
  document["format"] = 1;
  document["name"] = requirement.name;
  document["answer"] = requirement_answer(requirement);
  if (const std::string enough = enough_words(requirement); !enough.empty()) document["better_than_needed"] = enough;
  document["order"] = requirement.by_price ? "price" : "pixels_s";
  for (const Target& target : requirement.targets) {
    document["targets"].push_back(target_words(target));
    document["measures"].push_back(target.measure == Target::Measure::sd ? "root mean square error, a bias included"
                                   : target.measure == Target::Measure::error95
                                       ? "what 95 % of the runs' errors stay within"
                                       : "size of the mean error");
  }
  document["candidates"] = Json::array();
  for (const Candidate& candidate : requirement.candidates) {
    Json object;
    object["name"] = candidate.name;
    object["reached"] = reached(candidate);
    object["verdict"] = candidate_verdict(candidate);
    if (!candidate.why.empty()) object["why_refused"] = candidate.why;
    if (!candidate.price_class.empty()) object["price_class"] = candidate.price_class;
    put(object, "price_eur", candidate.price, "no price");
    put(object, "pixels_s", candidate.pixels_s);
    put(object, "frame_rate_hz", candidate.frame_rate_hz);
    put(object, "noise_m", candidate.noise_m);
    for (std::size_t t = 0; t < candidate.results.size(); ++t) {
      const validate::TargetResult& result = candidate.results[t];
      Json of;
      of["target"] = target_words(requirement.targets[t]);
      put(of, "bound", result.bound, "the motion does not determine it");
      put(of, "found", result.found, "not run");
      if (result.found) {
        put(of, "found_sd", result.found_sd);
        put(of, "found_low", result.low);
        put(of, "found_high", result.high);
        of["runs"] = result.runs;
        of["runs_beyond_target"] = result.beyond;
      }
      if (result.by_tracks) put(of, "found_by_tracks", *result.by_tracks);
      if (!result.estimator.empty()) of["estimator"] = result.estimator;
      object["targets"].push_back(std::move(of));
    }
    for (const validate::Limit& limit : candidate.limits) {
      object["limits"].push_back({{"without", limitation_words(limit.what)}, {"bound_smaller_by", limit.gain}});
    }
    document["candidates"].push_back(std::move(object));
  }
  return json_text(document);
}

}  // namespace glidelab::report
