#include "report/diagnosis/line_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "base/text/number_text.h"
#include "report/diagnosis/diagnosis_answer.h"
#include "report/diagnosis/diagnosis_plots.h"
#include "report/diagnosis/words/diagnosis_words.h"
#include "report/diagnosis/words/line_words.h"
#include "report/diagnosis/words/verdict_words.h"
#include "report/html/gnuplot.h"
#include "report/html/plot.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

constexpr double kMilli = 1e3;

Plot friction_plot(const diagnose::LineComparison& lines, bool over_mass) {
  const auto across = [&](double mass_kg, double k_over_m_1_s) {
    return over_mass ? 1.0 / mass_kg : k_over_m_1_s * k_over_m_1_s;
  };
  const char* const across_name = over_mass ? "1 / mass (1/kg)" : "(K/m)² (1/s²)";
  std::vector<PlotData> data;
  std::string plots;
  for (const diagnose::LineCurve& curve : lines.curves) {
    PlotData block{fmt::format("curve{}", data.size()), {}, {across_name, "friction left (mm/s²)"}};
    for (std::size_t i = 0; i < curve.mass_kg.size(); ++i) {
      block.rows.push_back({across(curve.mass_kg[i], curve.k_over_m_1_s[i]), kMilli * curve.friction_m_s2[i]});
    }
    plots += fmt::format("{}${} using 1:2 with lines lw 2 dt {} lc rgb '{}' title {}", plots.empty() ? "" : ", ",
                         block.name, data.size() + 1, color(data.size()), gnuplot_quoted(effect_name(curve.id)));
    data.push_back(std::move(block));
  }
  std::map<std::pair<double, int>, PlotData> groups;
  for (const diagnose::LineOff& off : lines.off) {
    PlotData& group = groups[{off.incline_deg, off.direction}];
    group.rows.push_back(
        {across(off.mass_kg, off.k_over_m_1_s), kMilli * off.friction_m_s2, kMilli * lines.intercept_sd_m_s2});
  }
  std::size_t n = 0;
  for (auto& [key, group] : groups) {
    group.name = fmt::format("lines{}", n);
    group.columns = {across_name, "friction left (mm/s²)", "standard deviation (mm/s²)"};
    plots += fmt::format("{}${} using 1:2:3 with yerrorbars pt {} ps 0.9 lc rgb '{}' title {}",
                         plots.empty() ? "" : ", ", group.name, key.second > 0 ? 7 : 6, color(2 + n / 2),
                         gnuplot_quoted(fmt::format("{:.3g}°, v {} 0", key.first, key.second > 0 ? ">" : "<")));
    data.push_back(std::move(group));
    ++n;
  }
  std::string script(kFrame);
  script += fmt::format(
      "set key font ',12' noenhanced\nset xlabel '{}'\n"
      "set ylabel 'friction left  (mm/s²)'\nset xzeroaxis lw 1 lc rgb '{}'\nplot {}\n",
      over_mass ? "1 / mass  (1/kg)" : "(K/m)²  (1/s²)", kGrey, plots);
  return {
      Drawing{script, std::move(data), {520, 470}},
      fmt::format(
          "What the nominal model leaves of the intercepts, as friction, against {}: {}. The error bars are the lines' "
          "own scatter",
          over_mass ? "1/m" : "(K/m)²",
          over_mass ? "a load-independent force gives a straight line here"
                    : "the bias from smoothing gives a straight line here"),
      over_mass ? "Friction left against 1/m" : "Friction left against (K/m)²"};
}

}  // namespace

std::vector<Plot> line_plots(const diagnose::LineComparison& lines) {
  if (lines.curves.empty()) return {};
  return {friction_plot(lines, true), friction_plot(lines, false)};
}

namespace {

constexpr double kShown = 0.01;  // probability above which an explanation always has a row

std::string line_tiles(const diagnose::Diagnosis& diagnosis) {
  const diagnose::LineComparison& lines = *diagnosis.lines;
  std::string text = "<div class=\"tiles\">";
  if (diagnosis.verdict != diagnose::Verdict::effect) {
    text += tile(std::string(diagnose::verdict_id(diagnosis.verdict)), "verdict");
  } else if (!lines.either_of.empty()) {
    text += tile(probability_text(lines.either_probability),
                 fmt::format("either of: {}", fmt::join(effect_names(lines.either_of), ", ")));
  } else {
    for (const auto& effect : diagnosis.effects)
      text += tile(probability_text(effect.probability), effect_name(effect.id));
  }
  return text + common_tiles(diagnosis, "gap of lines predicted by the others (1: their own scatter)") + "</div>\n";
}

std::string name_of(const diagnose::LineCandidate& candidate) {
  const std::string id = explanation_id(candidate.explanation);
  return candidate.forms.empty() ? id : fmt::format("{}: {}", id, forms_words(candidate));
}

std::string sizes_text(const diagnose::LineCandidate& candidate) {
  std::string text;
  for (const diagnose::LineSize& size : candidate.sizes) {
    text += (text.empty() ? "" : ", ") + parameter_text(size.key, size.value, size.sd);
  }
  return text.empty() ? "–" : text;
}

std::string line_region_table(const diagnose::Diagnosis& diagnosis) {
  HtmlTable table({"lines", "direction", "what", "off the nominal model", "off / sd"}, 3);
  for (const diagnose::GapRegion& region : diagnosis.regions) {
    const std::string which = region.variable == diagnose::GapVariable::set_up
                                  ? fmt::format("all at {:.3g}°", region.from)
                                  : fmt::format("all of {:.0f} g", 1e3 * region.from);
    table.row(
        {escape(which),
         region.direction == 0  ? "both"
         : region.direction > 0 ? "v &gt; 0"
                                : "v &lt; 0",
         escape(to_text(region.what)),
         escape(fmt::format("{} {}", base::value_and_sd_text(region.size, region.size_sd.value_or(0.0)), region.unit)),
         base::number_text(region.excess, 2)});
  }
  return table.empty() ? "" : table.str();
}

std::string gap_table(const diagnose::GapSizes& gap) {
  HtmlTable table({"line", "before", "after"});
  for (std::size_t i = 0; i < gap.held_out.size(); ++i) {
    table.row({escape(gap.held_out[i]), base::digits_text(gap.before_by_clip[i], 3),
               base::digits_text(gap.after_by_clip[i], 3)});
  }
  table.row({"all", base::digits_text(gap.before, 3), base::digits_text(gap.after, 3)});
  std::string text = table.str();
  text += fmt::format(
      "<p class=\"soft\">Each line predicted by the others: rms deviation of its intercept and slope, over the lines' "
      "own scatter. At the floor it is 1 ± {}. 95 % over lines: {} before, {} after.{}</p>\n",
      base::number_text(gap.standard_error, 2), interval_text(gap.interval95.before),
      interval_text(gap.interval95.after),
      gap.shrink ? fmt::format(" It {} of its distance from the floor.", shrink_text(gap)) : std::string());
  return text;
}

/// The weighed candidates that are shown: the likely ones, and the most likely form of each single effect.
std::vector<const diagnose::LineCandidate*> shown_candidates(const diagnose::LineComparison& lines) {
  std::vector<const diagnose::LineCandidate*> shown;
  for (const diagnose::LineCandidate& candidate : lines.candidates) {
    if (candidate.left_out) continue;
    const bool again = std::any_of(shown.begin(), shown.end(),
                                   [&](const auto* one) { return one->explanation == candidate.explanation; });
    const bool single = candidate.explanation.effects.size() < 2 && !again;
    if (single || candidate.probability >= kShown) shown.push_back(&candidate);
  }
  return shown;
}

std::string candidate_table(const diagnose::LineComparison& lines) {
  const auto rows = line_rows(lines);
  const std::vector<const diagnose::LineCandidate*> shown = shown_candidates(lines);
  HtmlTable table(rows.front(), 2);
  for (std::size_t r = 1; r < rows.size(); ++r) {
    const diagnose::LineCandidate& candidate = *shown[r - 1];
    std::vector<std::string> cells = {explanation_html(candidate.explanation)};
    if (!candidate.forms.empty()) cells.front() += ": " + escape(forms_words(candidate));
    for (std::size_t c = 1; c < rows[r].size(); ++c) cells.push_back(symbols_html(rows[r][c]));
    table.row(cells);
  }
  std::string text = table.str();
  for (const diagnose::LineCandidate& candidate : lines.candidates) {
    if (!candidate.left_out || candidate.explanation.effects.size() > 1) continue;  // for a pair, for the same reason
    text += fmt::format("<p class=\"soft\">Not weighed: {} ({}).</p>\n", explanation_html(candidate.explanation),
                        escape(impossible_words(*candidate.left_out)));
  }
  return text;
}

constexpr const char* kLineMethod =
    "<h2>Method</h2>\n<p>In the nominal model every line has the slope −K/m with one K, and the intercept "
    "g sin α − sign(v) µ g cos α with one µ and one α for each set-up. Each effect that lines can show is added to it, "
    "alone and in pairs. A µ or a K of its own may go with each mass, with each set-up, or with each mass in each "
    "set-up. A table states no errors: they are fitted with each explanation, and the evidence is the Bayes factor for "
    "an unknown scatter (Zellner and Siow). Chi² and the gap are relative to the lines' own scatter, which involves no "
    "friction: that of the mean intercept over both directions, and of the slopes within each mass.</p>\n";

}  // namespace

std::vector<std::vector<std::string>> line_rows(const diagnose::LineComparison& lines) {
  std::vector<std::vector<std::string>> rows = {
      {"explanation", "size", "probability", "chi²", "gap", "ln likelihood", "log evidence"}};
  for (const diagnose::LineCandidate* one : shown_candidates(lines)) {
    const diagnose::LineCandidate& candidate = *one;
    rows.push_back({name_of(candidate), sizes_text(candidate), probability_text(candidate.probability),
                    candidate.chi2 ? base::digits_text(*candidate.chi2, 3) : "–",
                    candidate.gap ? fmt::format("{:.2f}", *candidate.gap) : "–",
                    candidate.explanation.is_nothing() ? "0" : base::gain_text(candidate.log_likelihood_gain),
                    candidate.explanation.is_nothing() ? "0" : base::gain_text(candidate.log_evidence_gain)});
  }
  return rows;
}

Json lines_json(const diagnose::LineComparison& lines) {
  Json object;
  object["count"] = lines.lines;
  const std::optional<double> intercept =
      lines.intercept_sd_m_s2 > 0.0 ? std::optional(lines.intercept_sd_m_s2) : std::nullopt;
  const std::optional<double> slope = lines.slope_sd > 0.0 ? std::optional(lines.slope_sd) : std::nullopt;
  put(object, "intercept_sd_m_s2", intercept, "no set-up has two masses both ways");
  put(object, "slope_sd_relative", slope, "no mass has two lines");
  object["scatter_degrees_of_freedom"] = lines.scatter_freedom;
  object["either_of"] = lines.either_of;
  put(object, "either_probability", lines.either_probability);
  object["candidates"] = Json::array();
  for (const diagnose::LineCandidate& candidate : lines.candidates) {
    Json one;
    one["id"] = explanation_id(candidate.explanation);
    if (!candidate.forms.empty()) one["words"] = forms_words(candidate);
    put(one, "probability", candidate.probability);
    if (candidate.left_out) {
      one["not_weighed"] = impossible_words(*candidate.left_out);
      object["candidates"].push_back(std::move(one));
      continue;
    }
    one["parameters"] = Json::object();
    for (const diagnose::LineSize& size : candidate.sizes) {
      Json value;
      put(value, "value", size.value);
      put(value, "sd", size.sd);
      one["parameters"][size.key] = std::move(value);
    }
    const char* why = "the lines' own scatter is not known";
    put(one, "chi2_before", lines.chi2_before, why);
    put(one, "chi2_after", candidate.chi2, why);
    put(one, "gap_after", candidate.gap, why);
    put(one, "log_likelihood_gain", candidate.log_likelihood_gain);
    put(one, "log_evidence_gain", candidate.log_evidence_gain);
    object["candidates"].push_back(std::move(one));
  }
  return object;
}

Page line_report(const std::string& title, const diagnose::Diagnosis& diagnosis) {
  const diagnose::LineComparison& lines = *diagnosis.lines;
  Html body = question_heading(title, kDiagnosisQuestion) +
              fmt::format("<p class=\"soft\">From {} published lines.</p>\n", lines.lines);
  body += line_tiles(diagnosis);
  body +=
      diagnosis_meaning(diagnosis) + next_step_note(diagnosis) + member_section(diagnosis) + note_paragraphs(diagnosis);
  body += "<h2>The verdict</h2>\n" + candidate_table(lines) + figures(verdict_plots(diagnosis));
  const std::vector<Plot> waterfall = waterfall_plots(diagnosis);
  if (!waterfall.empty()) body += "<h2>What explains the gap</h2>\n" + figures(waterfall);
  const std::vector<Plot> left = line_plots(lines);
  if (!left.empty() || !diagnosis.regions.empty()) {
    body += "<h2>Where the gap lies</h2>\n" + figures(left) + line_region_table(diagnosis);
  }
  std::vector<Plot> alike = isolability_plots(diagnosis.isolability);
  if (!alike.empty()) {
    alike[0].caption =
        "How alike two effects (a row and a numbered column) are in these lines, with the nominal model fitted: at 1 "
        "they cannot be told apart, at 0 they can";
    body += "<h2>What these lines can tell apart</h2>\n" + figures(alike);
  }
  if (diagnosis.gap) body += "<h2>The gap, line by line</h2>\n" + gap_table(*diagnosis.gap);
  return page(title, body + kLineMethod);
}

}  // namespace glidelab::report
