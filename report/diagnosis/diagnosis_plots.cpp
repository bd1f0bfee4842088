#include "report/diagnosis/diagnosis_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "report/analysis/camera_plots.h"
#include "report/diagnosis/words/diagnosis_words.h"
#include "report/diagnosis/words/verdict_words.h"
#include "report/html/gnuplot.h"
#include "report/html/plot.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

constexpr std::size_t kBars = 8, kFewestBars = 3;  // explanations in the chart
constexpr double kNoBar = 5e-4;                    // a probability too small for a visible bar
constexpr std::size_t kLongName = 66;              // characters that fit in a bar plot at the usual text size
constexpr std::size_t kCurves = 3;                 // number of most likely curves that fill the gap
constexpr std::size_t kPoints = 800;               // per clip
constexpr std::size_t kInFull = 8;    // clips for which every residual is drawn; for k times as many, one in k
constexpr std::size_t kOneDigit = 9;  // columns whose numbers have one digit
constexpr const char *kToTheRight = "to the right", *kDownwards = "downwards";
constexpr int kMarks = 6;  // steps of an axis whose labels do not overlap
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// Room around the points except at the left: time begins at 0, and room there would make the axis begin before 0.
constexpr const char* kFromStart = "set offsets 0, graph 0.02, graph 0.06, graph 0.06\n";

Plot probabilities(const diagnose::Diagnosis& diagnosis) {
  std::vector<std::pair<double, std::string>> bars = {{diagnosis.none, effect_name("none")},
                                                      {diagnosis.unknown, effect_name("unknown")}};
  for (const auto& ranked : diagnosis.ranking) {
    bars.emplace_back(ranked.probability, explanation_name(ranked.explanation));
  }
  std::stable_sort(bars.begin(), bars.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  if (bars.size() > kBars) bars.resize(kBars);
  while (bars.size() > kFewestBars && bars.back().first < kNoBar) bars.pop_back();
  PlotData data{"bars", {}, {"row", "probability"}};
  std::string script(kFrame);
  script += "unset key\nunset ytics\nset border 1\nset offsets 0,0,0,0\nset xrange [0:1]\nset xlabel 'probability'\n";
  for (std::size_t i = 0; i < bars.size(); ++i) {
    // The name is above its bar: next to it, three effects in one name would leave no room for the bars.
    const std::string name = bars[i].second + ": " + probability_text(bars[i].first);
    script += fmt::format("set label {} at 0, {} left{}\n", gnuplot_quoted(name), 0.26 - static_cast<double>(i),
                          name.size() > kLongName ? " font ',11'" : "");
    data.rows.push_back({-static_cast<double>(i), bars[i].first});
  }
  script += fmt::format("set yrange [{}:0.6]\n", -static_cast<double>(bars.size()) + 0.5);
  script += fmt::format(
      "set style fill solid 0.85 noborder\nplot $bars using (0.5*$2):($1-0.15):(0.5*$2):(0.15) with boxxyerror lc rgb "
      "'{}'\n",
      kColors[0]);
  return {Drawing{script, std::vector{data}, {620, 90 + 38 * static_cast<int>(bars.size())}},
          "Probability of each explanation, given these data: the named effects act, and nothing else",
          "Bar chart of the probabilities of the explanations"};
}

/// `of_lines`: the held-out data are published lines, whose own scatter represents the noise. `one`: for one model
/// only.
Plot clip_gaps(const diagnose::GapSizes& gap, bool of_lines, bool one) {
  constexpr double kLogAbove = 8.0, kLeft = 0.5;  // times the noise: above the first the axis is logarithmic; the
                                                  // second is its left end
  PlotData data{"gaps", {}, {"row", "gap before / noise", "gap after / noise"}};
  double most = 2.0, least = kLeft;
  for (std::size_t c = 0; c < gap.held_out.size(); ++c) {
    data.rows.push_back({-static_cast<double>(c), gap.before_by_clip[c], gap.after_by_clip[c]});
    most = std::max({most, gap.before_by_clip[c], gap.after_by_clip[c]});
    for (const double size : {gap.before_by_clip[c], gap.after_by_clip[c]}) {
      if (size > 0.0) least = std::min(least, 0.8 * size);
    }
  }
  std::string script(kFrame);
  script += fmt::format("set offsets 0,0,0,0\nset xlabel '{}'\n",
                        of_lines ? "deviation from the prediction of the others / own scatter"
                                 : "residuals of the held-out clip / noise");
  script += chart_labels(gap.held_out) +
            fmt::format("set yrange [{}:0.6]\n", -static_cast<double>(gap.held_out.size()) + 0.4);
  script += most > kLogAbove ? fmt::format("set logscale x\nset xrange [{}:{}]\n", least, 1.5 * most)
                             : fmt::format("set xrange [0:{}]\n", 1.1 * most);
  script += fmt::format(
      "set arrow from 1, graph 0 to 1, graph 1 nohead lw 1.5 lc rgb '{}'\n"
      "plot $gaps using 2:1 with points pt 6 ps 1.1 lw 2 lc rgb '{}' title '{}'",
      kGrey, kColors[1], one ? kNominalModel : "before");
  if (!one) script += fmt::format(", $gaps using 3:1 with points pt 7 ps 0.9 lc rgb '{}' title 'after'", kColors[0]);
  script += "\n";
  return {Drawing{script, std::vector{data}, {620, std::max(260, static_cast<int>(90 + 24 * gap.held_out.size()))}},
          of_lines ? "How far each line lies from its prediction by the others: 1 (grey line) is the lines' own scatter"
                   : "The gap of each clip when it is left out of the fit: 1 (grey line) is the noise alone",
          one ? "Dots for each clip's gap" : "Dots for each clip's gap before and after"};
}

/// `alternatives` is the number of curves shown, each of which fills the gap on its own.
Plot curve_plot(const diagnose::GapCurve& curve, std::size_t alternatives) {
  PlotData data{"curve",
                {},
                {axis_of(curve.variable), fmt::format("{} ({})", to_text(curve.what), curve.unit),
                 fmt::format("standard deviation ({})", curve.unit)}};
  for (std::size_t i = 0; i < curve.at.size(); ++i) data.rows.push_back({curve.at[i], curve.size[i], curve.sd[i]});
  std::string script(kFrame);
  script +=
      fmt::format("set xlabel '{}'\nset ylabel '{}  ({})'\n", axis_of(curve.variable), to_text(curve.what), curve.unit);
  if (const auto [low, high] = std::minmax_element(curve.at.begin(), curve.at.end()); low != high && *low < *high) {
    script += even_tics("x", *low, *high, kMarks);
  }
  script += fmt::format(
      "plot $curve using 1:($2-2*$3):($2+2*$3) with filledcurves fillcolor rgb '{}' fillstyle transparent solid 0.25 "
      "title 'two standard deviations', $curve using 1:2 with lines lw 2 lc rgb '{}' title 'likeliest', 0 with lines "
      "lw 1 lc rgb '{}' notitle\n",
      kColors[0], kColors[0], kGrey);
  return {Drawing{script, std::vector{data}},
          fmt::format("{} {} as a function of {} that would explain the gap, with two standard deviations{}",
                      alternatives > 1 ? "A smooth" : "The smooth", to_text(curve.what), axis_of(curve.variable),
                      alternatives > 1 ? fmt::format(": each of these {} curves would do so alone", alternatives)
                                       : std::string()),
          fmt::format("Curve of the {} against {}", to_text(curve.what), axis_of(curve.variable))};
}

Plot residual_plot(const diagnose::Diagnosis& diagnosis, diagnose::GapVariable variable) {
  const std::vector<diagnose::ResidualCurve>& curves = diagnosis.residuals;
  const std::string axis = axis_of(variable);
  PlotData before{"before", {}, {axis, "measured - model before (mm)"}};
  PlotData after{"after", {}, {axis, "measured - model after (mm)"}};
  const bool one = one_model(diagnosis);
  double from = std::numeric_limits<double>::infinity(), to = -from;
  const std::size_t share = std::max<std::size_t>(1, curves.size() / kInFull);
  for (const diagnose::ResidualCurve& curve : curves) {
    const std::vector<double>& at = along(curve, variable);
    for (std::size_t p = 0; p < at.size(); p += share) {
      before.rows.push_back({at[p], 1000.0 * curve.before_m[p]});
      after.rows.push_back({at[p], 1000.0 * curve.after_m[p]});
      from = std::min(from, at[p]);
      to = std::max(to, at[p]);
    }
  }
  // If nothing changes, both are at the same position: the larger ones stay visible around the smaller.
  std::string script(kFrame);
  if (variable == diagnose::GapVariable::time) script += kFromStart;
  if (to > from) script += even_tics("x", from, to, kMarks);
  script += fmt::format("set xlabel '{}'\nset ylabel 'measured − model  (mm)'\n", axis);
  script += fmt::format(
      "plot $before using 1:2 with points pt 7 ps 0.35 lc rgb '{0}' notitle, keyentry with points pt 7 ps 0.8 lc rgb "
      "'{0}' title '{1}'",
      kColors[1], one ? kNominalModel : "before");
  if (!one) {
    script += fmt::format(
        ", $after using 1:2 with points pt 7 ps 0.15 lc rgb '{0}' notitle, keyentry with points pt 7 ps 0.8 lc rgb "
        "'{0}' title 'after'",
        kColors[0]);
  }
  script += "\n";
  return {
      Drawing{script, std::vector{never_empty(before), never_empty(after)}},
      fmt::format("Residuals of all clips against {}{}",
                  variable == diagnose::GapVariable::position ? "position"
                  : variable == diagnose::GapVariable::speed  ? "speed"
                                                              : "time",
                  diagnosis.verdict == diagnose::Verdict::unknown ? "; after: with the likeliest free-form curve" : ""),
      one ? "Residuals" : "Residuals before and after"};
}

Plot lengthening_plot(const diagnose::ImageCurve& curve) {
  PlotData data{"seen",
                {},
                {"speed in the image (px/s)", "lengthening (px²)", "standard deviation (px²)",
                 "for the exposure found (px²)", "for the exposure stated (px²)"}};
  for (std::size_t p = 0; p < curve.at.size(); ++p) {
    data.rows.push_back(
        {curve.at[p], curve.value[p], curve.sd[p], curve.fitted[p], curve.expected.empty() ? kNan : curve.expected[p]});
  }
  std::string script(kFrame);
  script +=
      "set key top left\nset xlabel 'speed of the marker in the image  (px/s)'\nset ylabel 'lengthening of its image "
      " (px²)'\n";
  script += fmt::format(
      "plot $seen using 1:2:3 with yerrorbars pt 7 ps 0.5 lc rgb '{}' title 'seen', $seen using 1:4 with "
      "lines lw 2 lc rgb '{}' title 'for the exposure found'",
      kColors[0], kColors[0]);
  if (!curve.expected.empty()) {
    script += fmt::format(", $seen using 1:5 with lines lw 2 dt 2 lc rgb '{}' title 'for the exposure stated'", kGrey);
  }
  return {Drawing{script + "\n", std::vector{data}},
          "Lengthening of the marker's image with its speed: a long exposure smears it",
          "Lengthening of the marker's image against its speed"};
}

/// One quantity of the images over time: a block of rows for each clip that has it.
struct OverTime {
  PlotData data;
  std::vector<std::string> clips;
};

OverTime over_time(const std::vector<diagnose::ImageCurve>& curves, const std::string& what, PlotData data,
                   double scale) {
  OverTime of{std::move(data), {}};
  for (const diagnose::ImageCurve& curve : curves) {
    if (curve.what != what || curve.at.empty()) continue;
    if (!of.data.rows.empty()) of.data.rows.emplace_back();  // the next clip begins a new block
    const std::size_t step = std::max<std::size_t>(1, curve.at.size() / kPoints);
    for (std::size_t p = 0; p < curve.at.size(); p += step) {
      of.data.rows.push_back({curve.at[p], scale * curve.value[p]});
    }
    of.clips.push_back(curve.clip);
  }
  return of;
}

/// A line for each clip in its colour, with its name in the legend; if there are more clips than colours, all are grey.
std::string lines_of(const OverTime& of, int dashes, bool names) {
  const bool told_apart = of.clips.size() <= kColors.size();
  std::string text;
  for (std::size_t i = 0; i < of.clips.size(); ++i) {
    const std::string title = told_apart ? of.clips[i] : fmt::format("{} clips", of.clips.size());
    text += fmt::format(
        "{0}${1} using 1:2 every :::{2}::{2} with lines lw 1 dt {3} lc rgb '{4}' {5}", i > 0 ? ", " : "", of.data.name,
        i, dashes, told_apart ? color(i) : std::string(kGrey),
        names && (told_apart || i == 0) ? "title " + gnuplot_quoted(shortened(title)) + " noenhanced" : "notitle");
  }
  return text;
}

/// Names side by side in the legend, as many as fit its width: those of the clips, and others.
std::string key_of(const OverTime& of, const std::vector<std::string>& others = {}) {
  constexpr std::size_t kShort = 10, kMiddling = 20;
  std::size_t longest = 0;
  for (const auto* names : {&of.clips, &others}) {
    for (const std::string& name : *names) longest = std::max(longest, name.size());
  }
  return fmt::format("set key maxcols {} width 1\n", longest <= kShort ? 3 : longest <= kMiddling ? 2 : 1);
}

}  // namespace

std::string axis_of(diagnose::GapVariable variable) {
  switch (variable) {
    case diagnose::GapVariable::acceleration:
      return "acceleration a (m/s²)";
    case diagnose::GapVariable::clip:
      return "clip";
    case diagnose::GapVariable::direction:
      return "direction of v";
    case diagnose::GapVariable::set_up:
      return "set-up";
    case diagnose::GapVariable::mass:
      return "mass (kg)";
    case diagnose::GapVariable::time:
      return "time t (s)";
    case diagnose::GapVariable::column:
      return "image column u (px)";
    case diagnose::GapVariable::speed:
      return "velocity v (m/s)";
    case diagnose::GapVariable::row:
      return "image row v (px)";
    case diagnose::GapVariable::position:
      return "position x (m)";
  }
  return {};
}

const std::vector<double>& along(const diagnose::ResidualCurve& curve, diagnose::GapVariable variable) {
  if (variable == diagnose::GapVariable::position) return curve.x_m;
  if (variable == diagnose::GapVariable::speed) return curve.v_m_s;
  if (variable == diagnose::GapVariable::time) return curve.t_s;
  throw std::logic_error(fmt::format("no residuals over {}", to_text(variable)));
}

std::string chart_labels(const std::vector<std::string>& names) {
  std::string tics = "set ytics (";
  for (std::size_t i = 0; i < names.size(); ++i) {
    tics += fmt::format("{}{} {}", i > 0 ? ", " : "", gnuplot_quoted(shortened(names[i])), -static_cast<double>(i));
  }
  return tics + ") scale 0 noenhanced\n";
}

std::vector<Plot> verdict_plots(const diagnose::Diagnosis& diagnosis) {
  std::vector<Plot> plots = {probabilities(diagnosis)};
  if (diagnosis.gap && !diagnosis.gap->held_out.empty()) {
    plots.push_back(clip_gaps(*diagnosis.gap, diagnosis.lines.has_value(), one_model(diagnosis)));
  }
  return plots;
}

std::vector<Plot> where_plots(const diagnose::Diagnosis& diagnosis) {
  std::vector<Plot> plots;
  const std::size_t shown = std::min(kCurves, diagnosis.curves.size());
  for (std::size_t c = 0; c < shown; ++c) plots.push_back(curve_plot(diagnosis.curves[c], shown));
  using diagnose::GapVariable;
  for (const GapVariable variable : {GapVariable::speed, GapVariable::position, GapVariable::time}) {
    if (!diagnosis.residuals.empty()) plots.push_back(residual_plot(diagnosis, variable));
  }
  return plots;
}

std::vector<Plot> image_plots(const diagnose::Diagnosis& diagnosis) {
  std::vector<Plot> plots;
  for (const diagnose::CalibrationRests& of : diagnosis.calibrations) {
    for (Plot& plot : calibration_plots(of.rests, diagnosis.calibrations.size() > 1 ? of.experiment : "")) {
      plots.push_back(std::move(plot));
    }
  }
  const std::vector<diagnose::ImageCurve>& curves = diagnosis.image_curves;
  for (const diagnose::ImageCurve& curve : curves) {
    if (curve.what == "lengthening") plots.push_back(lengthening_plot(curve));
    if (curve.what == "noise") plots.push_back(noise_plot(curve));
  }
  const OverTime light = over_time(curves, "brightness", {"light", {}, {"t (s)", "change of brightness (%)"}}, 100.0);
  if (!light.data.rows.empty()) {
    const std::string script = std::string(kFrame) + kFromStart + key_of(light) +
                               "set xlabel 'time t (s)'\nset ylabel 'change of brightness  (%)'\nplot " +
                               lines_of(light, 1, true) + "\n";
    plots.push_back({Drawing{script, std::vector{light.data}},
                     "Brightness of the fixed scene, relative to each clip's first frames; flickering light gives a "
                     "regular wave",
                     "Brightness of the scene over time"});
  }
  const OverTime across = over_time(curves, "drift across", {"across", {}, {"t (s)", "to the right (px)"}}, 1.0);
  const OverTime down = over_time(curves, "drift down", {"down", {}, {"t (s)", "downwards (px)"}}, 1.0);
  if (across.data.rows.empty() || down.data.rows.empty()) return plots;
  const std::string script =
      std::string(kFrame) + kFromStart + key_of(across, {kToTheRight, kDownwards}) +
      "set xlabel 'time t (s)'\nset ylabel 'position of the fixed scene  (px)'\nplot " + lines_of(across, 1, true) +
      ", " + lines_of(down, 3, false) +
      fmt::format(
          ", keyentry with lines lw 1.5 lc rgb '#000000' title '{}', keyentry with lines lw 1.5 dt 3 lc rgb "
          "'#000000' title '{}'\n",
          kToTheRight, kDownwards);
  plots.push_back({Drawing{script, std::vector{across.data, down.data}},
                   "Position of the fixed scene in the image: with a camera at rest it stays at 0, up to noise",
                   "Drift of the scene in the image over time"});
  return plots;
}

std::vector<Plot> isolability_plots(const diagnose::Isolability& isolability) {
  if (isolability.ids.size() < 2) return {};
  const std::size_t n = isolability.ids.size();
  PlotData data{"cells", {}, {"effect (column)", "effect (row)", "likeness (cosine)"}};
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < n; ++b) {
      data.rows.push_back({static_cast<double>(b), -static_cast<double>(a), isolability.cosine[a][b]});
    }
    data.rows.emplace_back();
  }
  std::string script(kFrame);
  // Names appear once, at the rows, with the numbers of the columns: sixteen vertical names were too small to read.
  std::string rows, columns;
  for (std::size_t i = 0; i < n; ++i) {
    const char* const comma = i > 0 ? ", " : "";
    rows += fmt::format("{}{} {}", comma, gnuplot_quoted(fmt::format("{}  {}", effect_name(isolability.ids[i]), i + 1)),
                        -static_cast<double>(i));
    columns += fmt::format("{}'{}' {}", comma, i + 1, i);
  }
  script += fmt::format(
      "unset key\nunset grid\nset offsets 0,0,0,0\nset ytics ({}) scale 0 noenhanced\nset xtics ({}) scale 0{}\nset "
      "xrange [-0.5:{}]\nset yrange [{}:0.5]\nset cbrange [0:1]\nset palette defined (0 '#ffffff', 0.7 '#9ecae1', 0.95 "
      "'#3182bd', 1 '#08306b')\nset cblabel 'likeness (cosine)'\nset lmargin at screen 0.41\nset rmargin at screen "
      "0.84\n"
      "plot $cells using 1:2:3 with image pixels\n",
      rows, columns, n > kOneDigit ? " font ',11'" : "", static_cast<double>(n) - 0.5, 0.5 - static_cast<double>(n));
  return {
      {Drawing{script, std::vector{data}, {660, 60 + 24 * std::max(6, static_cast<int>(n))}},
       "How alike two effects (a row and a numbered column) are in these clips, with everything else fitted: at 1 they "
       "cannot be told apart, at 0 they can",
       "Similarity of the effects"}};
}

}  // namespace glidelab::report
