#include "report/sweep/mass_study_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/text/number_text.h"
#include "report/html/html.h"

namespace glidelab::report {
namespace {

using base::r2_text;
using validate::FallAnswer;
using validate::MassRow;

std::string fall_text(double fall, double se) {
  return se > 0.0 ? base::value_and_sd_text(fall, se) : base::digits_text(fall, 2);
}

/// Two values with the decimals of the one that has more.
std::pair<std::string, std::string> with_equal_decimals(double one, double other) {
  const auto decimals = [](double value) {
    const std::string text = base::number_text(value, 4);
    return text.size() - std::min(text.find('.'), text.size() - 1) - 1;
  };
  const std::size_t most = std::max(decimals(one), decimals(other));
  return {fmt::format("{:.{}f}", one, most), fmt::format("{:.{}f}", other, most)};
}

std::string answer_text(const FallAnswer& answer) {
  const double published = answer.published.mu_lightest - answer.published.mu_heaviest;
  const MassRow& widest = answer.widest;
  const auto [from, to] = with_equal_decimals(answer.published.mu_lightest, answer.published.mu_heaviest);
  std::string text =
      fmt::format("<p><b>{}{}:</b> {} has µ fall from {} to {}, by {}. ", escape(answer.published.configuration),
                  answer.others.empty() ? "" : ", " + escape(answer.others), escape(answer.published.source), from, to,
                  base::digits_text(published, 2));
  if (answer.whole) {
    text += fmt::format("Smoothing alone produces all of it at h = {} s, where the lines have R² = {}. ",
                        base::number_text(answer.whole->bandwidth_s, 2), base::r2_text(answer.whole->r2));
  } else {
    text += fmt::format("No bandwidth in this sweep produces that: h = {} s gives {}, with R² = {}. ",
                        base::number_text(widest.bandwidth_s, 2), fall_text(widest.fall(), widest.fall_se()),
                        base::r2_text(widest.r2()));
  }
  if (answer.at_r2) {
    text += fmt::format("At the published R² of {} smoothing can produce {}, {:.0f} % of the fall, with h = {} s.",
                        base::r2_text(answer.published.r2), fall_text(answer.at_r2->fall, answer.at_r2->fall_se),
                        100.0 * answer.at_r2->fall / published, base::number_text(answer.at_r2->bandwidth_s, 2));
  } else {
    text +=
        fmt::format("No bandwidth in this sweep has the published R² of {}: {}.", base::r2_text(answer.published.r2),
                    widest.r2() < answer.published.r2 ? "all of these lines are less straight" : "all are straighter");
  }
  return text + "</p>\n";
}

}  // namespace

std::string mass_study_section(const validate::MassStudy& study) {
  if (study.rows.empty()) return {};
  std::string html = "<h2 id=\"masses\">Does µ fall with mass, or does smoothing produce the fall?</h2>\n";
  for (const FallAnswer& answer : study.answers) html += answer_text(answer);
  std::vector<std::string> header = {"bandwidth h (s)"};
  for (const validate::MassPoint& point : study.rows.front().masses) {
    header.push_back(fmt::format("µ of {} kg", base::number_text(point.mass_kg, 4)));
  }
  header.insert(header.end(), {"fall of µ", "least R²"});
  HtmlTable table(header, 1);
  std::string before;
  for (const MassRow& row : study.rows) {
    if (row.masses.size() + 3 != header.size()) continue;  // a mass without an answer at this bandwidth
    const std::string of = fmt::format("{}{}: true µ {} for every mass", row.configuration,
                                       row.others.empty() ? "" : ", " + row.others, base::number_text(row.truth, 4));
    if (of != before) table.heading(escape(of));
    before = of;
    std::vector<std::string> cells = {base::number_text(row.bandwidth_s, 4)};
    for (const validate::MassPoint& point : row.masses) {
      cells.push_back(point.se > 0.0 ? base::value_and_sd_text(point.mu, point.se) : base::digits_text(point.mu, 4));
    }
    cells.insert(cells.end(), {fall_text(row.fall(), row.fall_se()), base::r2_text(row.r2())});
    table.row(cells);
  }
  return html + table.str() +
         "<p class=\"soft\">Lines through every smoothed point, kernels over ends and reversals included. The fall is "
         "µ of the lightest glider less that of the heaviest; ± is one standard error over the runs, and missing where "
         "the positions are exact, because then nothing is random. R² is the least of a run's lines, the mean over its "
         "runs. Between two bandwidths that were run the fall and the logarithm of 1 − R² are taken to lie on "
         "straight lines.</p>\n";
}

}  // namespace glidelab::report
