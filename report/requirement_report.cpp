#include "report/requirement_report.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "report/gnuplot.h"
#include "report/html.h"
#include "report/json_numbers.h"
#include "report/number_text.h"
#include "report/plot_style.h"
#include "report/quantity_names.h"
#include "report/text_table.h"

namespace glidelab::report {
namespace {

using validate::Candidate;
using validate::Requirement;
using validate::Target;
using validate::Verdict;

bool reached(const Candidate& candidate) {
  return candidate.verdict == Verdict::reached || candidate.verdict == Verdict::by_bound;
}

std::string target_name(const Target& target, const std::string& factor = {}) {
  std::string unit = unit_of(target.quantity);
  if (!factor.empty()) unit = factor + (unit.empty() ? "" : " " + unit);
  const char* measure = target.measure == Target::Measure::sd        ? "rms error"
                        : target.measure == Target::Measure::error95 ? "95 % error"
                                                                     : "bias";
  return fmt::format("{} of {}{}", measure, symbol_of(target.quantity), unit.empty() ? "" : fmt::format(" ({})", unit));
}

/// In tables a target's values stand in thousandths, millionths, … of its unit: columns of zeros hide which is smaller.
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

/// " (10⁻³ 1/s)", for the column beside.
std::string same_unit(const Target& target) {
  const std::string name = target_name(target, scale_of(target).factor);
  const std::size_t unit = name.find(" (");
  return unit == std::string::npos ? "" : name.substr(unit);
}

std::string bound_text(const std::optional<double>& bound, double scale) {
  return bound && std::isfinite(*bound) ? number_text(*bound / scale, 2) : "–";
}

/// "rms error of µ at most 0.0005, 95 % error of α (°) at most 0.01".
std::string targets_text(const Requirement& requirement) {
  std::string text;
  for (const Target& target : requirement.targets) {
    text += fmt::format("{}{} at most {}", text.empty() ? "" : ", ", target_name(target), number_text(target.value, 4));
  }
  return text;
}

std::string order_text(const Requirement& requirement) {
  return requirement.by_price ? "the cheapest" : "the fewest pixels a second (not all have a price)";
}

/// "3 of 200"; nothing where none was run.
std::string beyond_text(const validate::TargetResult& result) {
  return result.runs == 0 ? "–" : fmt::format("{} of {}", result.beyond, result.runs);
}

/// What no track knows is said where tracks judged.
std::string next_step(const Requirement& requirement) {
  if (requirement.confirm == validate::Confirm::clips) return {};
  return fmt::format(
      "{}: a lens, a codec, a rolling shutter and the calibration are not in it. With --confirm clips those that are "
      "near the target are rendered as well.",
      requirement.confirm == validate::Confirm::none ? "Nothing was run, the bound alone judged"
                                                     : "Tracks judged, no pictures");
}

std::string found_text(const validate::TargetResult& result, double scale) {
  if (!result.found || !std::isfinite(*result.found)) return result.found ? "no answer" : "–";
  return value_and_sd_text(*result.found / scale, result.found_sd / scale);
}

std::string cost_text(const Requirement& requirement, const Candidate& candidate) {
  if (!candidate.price_class.empty()) return candidate.price_class;
  return requirement.by_price ? "–" : fmt::format("{} Mpx/s", number_text(candidate.pixels_s * 1e-6, 3));
}

std::string limit_text(const Candidate& candidate) {
  std::string text;
  for (const validate::Limit& limit : candidate.limits) {
    if (limit.gain < 1.05) break;
    text += fmt::format("{}{} {:.{}f}x", text.empty() ? "" : "; ", limit.name, limit.gain, limit.gain < 10.0 ? 1 : 0);
  }
  return text;
}

double cost_of(const Requirement& requirement, const Candidate& candidate) {
  return requirement.by_price ? *candidate.price : candidate.pixels_s * 1e-6;
}

void add_results(std::vector<std::string>& cells, const Requirement& requirement, const Candidate& candidate) {
  for (std::size_t t = 0; t < candidate.results.size(); ++t) {
    const double scale = scale_of(requirement.targets[t]).size;
    cells.push_back(bound_text(candidate.results[t].bound, scale));
    cells.push_back(found_text(candidate.results[t], scale));
    cells.push_back(beyond_text(candidate.results[t]));
  }
}

/// What the plot and the front are about: the first target, by runs where there are some, else by its bound.
double reach_of(const Candidate& candidate) {
  if (candidate.verdict == Verdict::refused || candidate.results.empty())
    return std::numeric_limits<double>::quiet_NaN();
  const validate::TargetResult& result = candidate.results.front();
  const double value = result.found.value_or(result.bound.value_or(std::numeric_limits<double>::quiet_NaN()));
  return std::isfinite(value) ? value : std::numeric_limits<double>::quiet_NaN();
}

Plot front_plot(const Requirement& requirement) {
  const Target& target = requirement.targets.front();
  PlotData met{"met", {}}, missed{"missed", {}}, front{"front", {}};
  double best = std::numeric_limits<double>::infinity();
  double number = 0.0;
  for (const Candidate& candidate : requirement.candidates) {  // the cheapest first
    ++number;
    const double value = reach_of(candidate), cost = cost_of(requirement, candidate);
    if (!std::isfinite(value)) continue;
    (reached(candidate) ? met : missed).rows.push_back({cost, value, number});
    if (value < best) {
      if (!front.rows.empty()) front.rows.push_back({cost, best});
      front.rows.push_back({cost, value});
      best = value;
    }
  }
  std::vector<PlotData> data;
  std::string script = std::string(kFrame) + "set logscale xy\nset format x '%g'\nset format y '%g'\n";
  script +=
      fmt::format("set xlabel {}\nset ylabel {}\n",
                  gnuplot_quoted(requirement.by_price ? "price, middle of its class (EUR)" : "million pixels a second"),
                  gnuplot_quoted(target_name(target)));
  script +=
      fmt::format("set offsets 0,0,0,0\nplot {:.9g} with lines dt 2 lc rgb '#555555' title 'target'", target.value);
  const auto add = [&](const PlotData& block, const std::string& how) {
    if (block.rows.empty()) return;
    script += fmt::format(", ${} using 1:2 {}", block.name, how);
    if (block.rows.front().size() > 2) {
      script += fmt::format(", ${} using 1:2:(sprintf('%d', $3)) with labels offset 1.1,0.5 notitle", block.name);
    }
    data.push_back(block);
  };
  add(front, fmt::format("with lines lw 1.5 lc rgb '{}' title 'Pareto front'", kColors[4]));
  add(met, fmt::format("with points pt 7 ps 0.8 lc rgb '{}' title 'reaches all targets'", kColors[2]));
  add(missed, fmt::format("with points pt 6 ps 0.8 lc rgb '{}' title 'does not'", kColors[1]));
  return {Drawing{script, data, {620, 420}},
          "What each camera, by its number in the tables, reaches over what it costs; the line joins those that no "
          "cheaper one beats",
          "Reached accuracy over cost"};
}

}  // namespace

Page requirement_report(const Requirement& requirement) {
  Html body = fmt::format("<h1>{}</h1>\n<p>What reaches {} on the worst configuration; {} first.</p>\n",
                          escape(requirement.name), escape(targets_text(requirement)), order_text(requirement));
  const std::string next = next_step(requirement);
  if (!next.empty()) body += fmt::format("<p class=\"note\">{}</p>\n", escape(next));
  std::vector<std::string> header = {"no.", "camera", "cost", "verdict", "frames/s", "position noise (µm)"};
  for (const Target& target : requirement.targets) {
    header.push_back("bound: " + escape(target_name(target, scale_of(target).factor)));
    header.push_back("by runs" + escape(same_unit(target)));
    header.push_back("runs beyond the target");
  }
  HtmlTable good(header, 4);
  header.insert(header.begin() + 4, "what limits it");
  HtmlTable others(header, 5);
  for (const Candidate& candidate : requirement.candidates) {
    const auto number = &candidate - requirement.candidates.data() + 1;
    std::vector<std::string> row = {std::to_string(number),
                                    escape(candidate.name),
                                    escape(cost_text(requirement, candidate)),
                                    escape(describe(candidate)),
                                    number_text(candidate.frame_rate_hz, 4),
                                    std::isfinite(candidate.noise_m) ? number_text(candidate.noise_m * 1e6, 3) : "–"};
    add_results(row, requirement, candidate);
    if (reached(candidate)) {
      good.row(row);
    } else {
      row.insert(row.begin() + 4, escape(candidate.why.empty() ? limit_text(candidate) : candidate.why));
      others.row(row);
    }
  }
  body += good.empty() ? "<p class=\"note bad\">None reaches it.</p>\n" : "<h2>These do</h2>\n" + good.str();
  body += figures({front_plot(requirement)});
  if (!others.empty()) body += "<h2>The others</h2>\n" + others.str();
  body += fmt::format(
      "<p class=\"soft\">The bound is that of Cramér and Rao for the motion seen at this rate with this noise of a "
      "position, which is itself the bound of the marker's centre for the camera's light and noise. {} \"What limits "
      "it\" says how many times smaller the bound of the hardest target (\"by runs\": the error) is with one "
      "limitation "
      "thought away. A lens, a codec, a rolling shutter and the calibration are in rendered runs only (--confirm "
      "clips).</p>\n",
      requirement.confirm == validate::Confirm::none ? std::string("Nothing was run.")
      : requirement.confirm == validate::Confirm::clips
          ? fmt::format("Where it allows the target, runs judge, by the better estimator: {} rendered ones where a "
                        "verdict says so, else {} tracks with that noise.",
                        requirement.runs, requirement.track_runs)
          : fmt::format("Where it allows the target, {} runs of tracks with that noise judge, by the better estimator.",
                        requirement.track_runs));
  body += fmt::format(
      "<p class=\"soft\">An rms error has the bias in it; a 95 % error is what 95 % of the runs stay within. ± is one "
      "standard deviation, found by drawing the runs anew {} times (bias: that of the errors over the root of their "
      "number); where it spans the target, nothing is decided. \"Runs beyond the target\" err by more than its value: "
      "few and far ones are frames lost without a trace, not noise.</p>\n",
      validate::kResamples);
  return page(requirement.name, body);
}

std::string requirement_text(const Requirement& requirement) {
  std::vector<std::vector<std::string>> rows = {{"camera", "cost", "verdict", "frames/s", "noise (µm)"}};
  for (const Target& target : requirement.targets) {
    rows.front().push_back("bound: " + target_name(target, scale_of(target).factor));
    rows.front().push_back("by runs" + same_unit(target));
    rows.front().push_back("runs beyond");
  }
  std::string below;
  for (const Candidate& candidate : requirement.candidates) {
    rows.push_back({candidate.name, cost_text(requirement, candidate), describe(candidate),
                    number_text(candidate.frame_rate_hz, 4),
                    std::isfinite(candidate.noise_m) ? number_text(candidate.noise_m * 1e6, 3) : "–"});
    add_results(rows.back(), requirement, candidate);
    if (reached(candidate)) continue;
    const std::string limits = candidate.why.empty() ? limit_text(candidate) : candidate.why;
    if (!limits.empty()) below += fmt::format("{}: {}\n", candidate.name, limits);
  }
  std::string text = fmt::format("What reaches {} on the worst configuration; {} first.\n\n", targets_text(requirement),
                                 order_text(requirement)) +
                     text_table(rows, 3);
  if (!below.empty()) text += "\nWhat limits the others (how many times smaller the bound is without it)\n" + below;
  const std::string next = next_step(requirement);
  if (!next.empty()) text += "\n" + next + "\n";
  return text;
}

std::string requirement_json(const Requirement& requirement) {
  Json document;
  document["format"] = 1;
  document["name"] = requirement.name;
  document["order"] = requirement.by_price ? "price" : "pixels_s";
  for (const Target& target : requirement.targets) {
    document["targets"].push_back(target.name());
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
    object["verdict"] = describe(candidate);
    if (!candidate.why.empty()) object["why_refused"] = candidate.why;
    if (!candidate.price_class.empty()) object["price_class"] = candidate.price_class;
    put(object, "price_eur", candidate.price, "no price");
    put(object, "pixels_s", candidate.pixels_s);
    put(object, "frame_rate_hz", candidate.frame_rate_hz);
    put(object, "noise_m", candidate.noise_m);
    for (std::size_t t = 0; t < candidate.results.size(); ++t) {
      const validate::TargetResult& result = candidate.results[t];
      Json of;
      of["target"] = requirement.targets[t].name();
      put(of, "bound", result.bound, "the motion does not determine it");
      put(of, "found", result.found, "not run");
      if (result.found) {
        put(of, "found_sd", result.found_sd);
        of["runs"] = result.runs;
        of["runs_beyond_target"] = result.beyond;
      }
      if (!result.estimator.empty()) of["estimator"] = result.estimator;
      object["targets"].push_back(std::move(of));
    }
    for (const validate::Limit& limit : candidate.limits) {
      object["limits"].push_back({{"without", limit.name}, {"bound_smaller_by", limit.gain}});
    }
    document["candidates"].push_back(std::move(object));
  }
  return json_text(document);
}

}  // namespace glidelab::report
