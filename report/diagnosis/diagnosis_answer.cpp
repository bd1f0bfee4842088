#include "report/diagnosis/diagnosis_answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "base/text/number_text.h"
#include "report/diagnosis/diagnosis_plots.h"
#include "report/diagnosis/words/cause_words.h"
#include "report/diagnosis/words/verdict_words.h"
#include "report/html/gnuplot.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

// The waterfall.
constexpr double kAll = 100.0;         // percent of the excess
constexpr double kThick = 0.15;        // half of a bar's thickness, with rows 1 apart
constexpr double kNameAbove = 0.24;    // of a row: its name, above the bar
constexpr double kBelow = 0.14;        // of a bar's middle under its row, to make room for the name
constexpr double kLeastWhisker = 0.3;  // percent; a shorter one is a dot on its bar
constexpr double kRoom = 3.0;          // percent, at both ends
constexpr int kWidth = 520, kRowPoints = 54, kFramePoints = 84;  // narrow: readable on a telephone
constexpr std::size_t kLongLine = 54;                            // characters per line at the usual size

struct Row {
  std::string name;
  WaterfallBar bar;
  std::string_view hue;
};

std::vector<Row> rows_of(const diagnose::Diagnosis& diagnosis) {
  std::vector<Row> rows;
  std::string before = is_measured_without_drag(diagnosis) ? "fall without drag" : "nominal model";
  if (diagnosis.gap) before += ": " + over_noise_text(diagnosis.gap->before);
  rows.push_back({before, {0.0, kAll, kAll, kAll}, kColors[1]});
  const std::vector<WaterfallBar> bars = waterfall_bars(diagnosis.explained);
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const diagnose::ExplainedCause& cause = diagnosis.explained[i];
    rows.push_back({fmt::format("{}: {}", effect_name(cause.id), share_text(cause.share, cause.share_interval95)),
                    bars[i], kColors[2]});
  }
  const double left = bars.back().to;
  const double gap = diagnosis.remainder ? diagnosis.remainder->gap : diagnosis.explained.back().gap_after;
  rows.push_back({fmt::format("remainder: {}, {}", share_text(left / kAll), over_noise_text(gap)),
                  {0.0, left, left, left},
                  kColors[0]});
  return rows;
}

}  // namespace

std::vector<WaterfallBar> waterfall_bars(const std::vector<diagnose::ExplainedCause>& explained) {
  std::vector<WaterfallBar> bars;
  double at = kAll;
  for (const diagnose::ExplainedCause& cause : explained) {
    WaterfallBar bar{at, at - kAll * cause.share, 0.0, 0.0};
    bar.low = cause.share_interval95 ? at - kAll * cause.share_interval95->high : bar.to;
    bar.high = cause.share_interval95 ? at - kAll * cause.share_interval95->low : bar.to;
    bars.push_back(bar);
    at = bar.to;
  }
  return bars;
}

std::vector<Plot> waterfall_plots(const diagnose::Diagnosis& diagnosis) {
  if (diagnosis.explained.empty()) return {};
  const std::vector<Row> rows = rows_of(diagnosis);
  PlotData bars{"bars", {}, {"from (% of the excess)", "to (%)", "row", "low (%)", "high (%)", "colour"}};
  PlotData errors{"intervals", {}, {"end of the bar (% of the excess)", "row", "low (%)", "high (%)"}};
  double least = 0.0, most = kAll;
  std::string script(kFrame);
  script += "unset key\nunset ytics\nset border 1\nset offsets 0,0,0,0\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const WaterfallBar& bar = rows[i].bar;
    const double row = -static_cast<double>(i), middle = row - kBelow;
    bars.rows.push_back({bar.from, bar.to, middle, bar.low, bar.high, static_cast<double>(i)});
    if (bar.high - bar.low > kLeastWhisker) errors.rows.push_back({bar.to, middle, bar.low, bar.high});
    least = std::min({least, bar.to, bar.low});
    most = std::max({most, bar.high});
    script += fmt::format("set object rectangle from {},{} to {},{} fc rgb '{}' fs solid 0.85 noborder\n",
                          std::min(bar.from, bar.to), middle - kThick, std::max(bar.from, bar.to), middle + kThick,
                          rows[i].hue);
    script += fmt::format("set label {} at 0.8, {} left front noenhanced{}\n", gnuplot_quoted(rows[i].name),
                          row + kNameAbove, rows[i].name.size() > kLongLine ? " font ',12'" : "");
    if (i + 1 < rows.size()) {
      script += fmt::format("set arrow from {0},{1} to {0},{2} nohead back lw 1 dt 3 lc rgb '#888888'\n", bar.to,
                            middle - kThick, middle - 1.0 + kThick);
    }
  }
  script += fmt::format(
      "set xrange [{}:{}]\nset yrange [{}:0.5]\nset xlabel 'excess of the squared gap  (% of the initial one; 0 is "
      "the noise floor)'\nset arrow from 0, graph 0 to 0, graph 1 nohead back lw 1.5 lc rgb '{}'\n",
      least - kRoom, most + kRoom, 0.5 - static_cast<double>(rows.size()), kGrey);
  script += "plot $bars using 2:3 with points pt 7 ps 0 notitle";
  if (!errors.rows.empty()) {
    script +=
        fmt::format(", $intervals using 1:2:3:4 with xerrorbars pt 7 ps 0.4 lw 1.6 lc rgb '{}' notitle", kColors[6]);
  }
  script += "\n";
  std::vector<PlotData> data = {bars};
  if (!errors.rows.empty()) data.push_back(errors);
  const char* const held_out = diagnosis.lines ? "lines" : "clips";
  return {{Drawing{script, std::move(data), {kWidth, kFramePoints + kRowPoints * static_cast<int>(rows.size())}},
           fmt::format(
               "How much of the gap of held-out {0} each cause explains, one added after the other, and what is left. "
               "The excess is the squared gap minus 1, its value for noise alone; whiskers are "
               "95 % intervals over {0}",
               held_out),
           "Waterfall of the gap: before, each cause, what is left"}};
}

namespace {

std::string region_size(const diagnose::GapRegion& region) {
  const NamedUnit of = name_and_unit(region.unit);
  const std::string& unit = of.unit.empty() ? region.unit : of.unit;
  return region.size_sd ? size_and_sd_text(region.size, *region.size_sd, unit) : size_text(region.size, 2, unit);
}

/// A table of texts; the first row is its header, and the first cell of each row heads it on a narrow screen.
std::string html_of(const std::vector<std::vector<std::string>>& rows) {
  const auto cells = [](const std::vector<std::string>& row) {
    std::vector<std::string> html;
    for (const std::string& cell : row) html.push_back(escape(cell));
    return html;
  };
  HtmlTable table(cells(rows.front()));
  if (rows.front().size() > 3) table.stack_when_narrow(1);
  for (std::size_t r = 1; r < rows.size(); ++r) table.row(cells(rows[r]));
  return table.str();
}

std::string paragraph(const std::string& words, const char* kind = "") {
  return words.empty() ? "" : fmt::format("<p{}>{}</p>\n", kind, escape(words));
}

std::string recovered_section(const diagnose::Diagnosis& diagnosis) {
  if (diagnosis.recovered.empty()) return {};
  std::string text = "<h2>K/m, µ, α and terminal velocity</h2>\n";
  for (const RecoveredTable& table : recovered_tables(diagnosis)) {
    text += paragraph(fmt::format("For each configuration, {}.{}", with_words(table.with),
                                  diagnosis.remainder ? " The standard deviations include the remainder and the spread "
                                                        "among the other likely explanations."
                                                      : ""));
    text += html_of(table.rows);
    for (const std::string& why : table.why) text += paragraph(why + ".", " class=\"soft\"");
  }
  return text;
}

constexpr std::size_t kPlacesTold = 4;

/// If no cause is named, the curve that would fill the gap over the most important variable.
std::vector<Plot> likeliest_curve(const diagnose::Diagnosis& diagnosis,
                                  const std::vector<diagnose::GapRegion>& regions) {
  if (diagnosis.verdict != diagnose::Verdict::unknown || regions.empty()) return {};
  for (const diagnose::GapCurve& curve : diagnosis.curves) {
    if (curve.variable != regions.front().variable || curve.what != regions.front().what) continue;
    diagnose::Diagnosis alone;
    alone.curves = {curve};
    return where_plots(alone);
  }
  return {};
}

Html rest_section(const diagnose::Diagnosis& diagnosis) {
  std::string words;
  std::vector<diagnose::GapRegion> regions;
  const bool any_left = diagnosis.remainder && !leaves_nothing(*diagnosis.remainder);
  if (any_left) {
    words = paragraph(remainder_words(*diagnosis.remainder));
    regions = diagnosis.remainder->regions;
  } else if (!diagnosis.remainder && diagnosis.verdict == diagnose::Verdict::unknown) {
    regions = diagnosis.regions;
  }
  if (regions.size() > kPlacesTold) regions.resize(kPlacesTold);
  words += region_table(regions) + paragraph(levels_words(diagnosis));
  if (words.empty()) return {};
  const char* const heading = any_left              ? "Where the rest lies"
                              : diagnosis.remainder ? "Where the nominal model holds"
                                                    : "Where the gap lies";
  return fmt::format("<h2>{}</h2>\n", heading) + words + figures(likeliest_curve(diagnosis, regions));
}

}  // namespace

std::string member_section(const diagnose::Diagnosis& diagnosis) {
  std::string text;
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    const auto rows = member_rows(effect);
    if (rows.empty() || rows.size() < 3) continue;  // with only one there is no difference
    text += fmt::format("<h3>{}</h3>\n", effect_html(effect.id)) + html_of(rows);
  }
  return text.empty() ? text : "<h2>What differs</h2>\n" + text;
}

std::string region_table(const std::vector<diagnose::GapRegion>& regions) {
  HtmlTable table({"over", "what", "from", "to", "largest", "at", "size / sd, where clearest"}, 2);
  for (const diagnose::GapRegion& region : regions) {
    const bool named = region.variable == diagnose::GapVariable::set_up;  // a set-up has a number unknown to the reader
    const std::string over = named ? "one of the set-ups" : axis_of(region.variable);
    table.row({escape(over + (region.clip.empty() ? "" : " of " + region.clip)), escape(to_text(region.what)),
               named ? "–" : base::number_text(region.from, 3), named ? "–" : base::number_text(region.to, 3),
               region.lacking ? "not known" : escape(region_size(region)),
               region.at && !region.lacking ? base::number_text(*region.at, 3) : "–",
               base::number_text(region.excess, 2)});
  }
  return table.empty() ? "" : table.str();
}

Html answer_sections(const diagnose::Diagnosis& diagnosis) {
  Html html;
  const std::vector<Plot> waterfall = waterfall_plots(diagnosis);
  if (!waterfall.empty()) html += "<h2>What explains the gap</h2>\n" + figures(waterfall);
  html += member_section(diagnosis) + recovered_section(diagnosis);
  html += rest_section(diagnosis);
  html += next_step_note(diagnosis);
  return html;
}

}  // namespace glidelab::report
