#include "report/analysis/motion_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "base/math/distributions.h"
#include "report/html/gnuplot.h"
#include "report/html/plot.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

constexpr std::size_t kLinePoints = 600;   // more than a plot has pixels across
constexpr std::size_t kCloudPoints = 300;  // single frames that were not smoothed

enum class Variable { x, v, a };

double value(const core::MotionPoint& point, Variable variable) {
  switch (variable) {
    case Variable::x:
      return point.x_m;
    case Variable::v:
      return point.v_m_s;
    default:
      return point.a_m_s2;
  }
}

double deviation(const core::MotionPoint& point, Variable variable) {
  switch (variable) {
    case Variable::x:
      return point.sd_x_m;
    case Variable::v:
      return point.sd_v_m_s;
    default:
      return point.sd_a_m_s2;
  }
}

const char* axis_of(Variable variable) {
  return variable == Variable::x ? "x  (m)" : variable == Variable::v ? "v  (m/s)" : "a  (m/s²)";
}

/// The smoothed points that are used (or not used), as lines that break where points of the other kind lie in between:
/// t, y, sd.
PlotData smoothed_lines(const core::ClipResult& clip, Variable variable, bool used, std::string name) {
  const std::vector<core::MotionPoint>& motion = clip.motion;
  PlotData data{std::move(name), {}, {"t (s)", axis_of(variable), "its standard deviation"}};
  const auto belongs = [&](std::size_t i) {
    return motion[i].smoothed && (motion[i].left_out == core::LeftOut::used) == used;
  };
  for (std::size_t from = 0; from < motion.size();) {
    if (!belongs(from)) {
      ++from;
      continue;
    }
    std::size_t to = from;
    while (to < motion.size() && belongs(to)) ++to;
    std::vector<double> y;
    for (std::size_t i = from; i < to; ++i) y.push_back(value(motion[i], variable));
    const std::size_t share = std::max<std::size_t>(4, kLinePoints * y.size() / motion.size());
    for (const std::size_t i : outline(y, share)) {
      data.rows.push_back({motion[from + i].t_s, y[i], deviation(motion[from + i], variable)});
    }
    data.rows.emplace_back();
    from = to;
  }
  return never_empty(std::move(data));
}

/// Positions of frames that have no smoothed value.
PlotData bare_positions(const core::ClipResult& clip) {
  PlotData data{"bare", {}, {"t (s)", axis_of(Variable::x)}};
  std::vector<std::size_t> bare;
  for (std::size_t i = 0; i < clip.motion.size(); ++i) {
    if (!clip.motion[i].smoothed && clip.motion[i].measured_m) bare.push_back(i);
  }
  for (const std::size_t i : every_nth(bare.size(), kCloudPoints)) {
    data.rows.push_back({clip.motion[bare[i]].t_s, *clip.motion[bare[i]].measured_m});
  }
  return never_empty(std::move(data));
}

std::string shading(const core::ClipResult& clip) {
  std::string script;
  for (const core::LeftOutInterval& interval : clip.left_out) {
    script += fmt::format(
        "set object rectangle from {:.6g}, graph 0 to {:.6g}, graph 1 behind fillcolor rgb '{}' fillstyle solid "
        "noborder\n",
        interval.from_s, interval.to_s, kShade);
  }
  return script;
}

/// The range of the used points, with a margin: beyond the ends of a stretch the smoothed derivatives diverge.
std::optional<std::pair<double, double>> used_range(const core::ClipResult& clip, Variable variable) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const core::MotionPoint& point : clip.motion) {
    if (!point.smoothed || point.left_out != core::LeftOut::used) continue;
    low = std::min(low, value(point, variable));
    high = std::max(high, value(point, variable));
  }
  if (!(high > low)) return std::nullopt;
  const double margin = 0.3 * (high - low);
  return std::pair(low - margin, high + margin);
}

/// If a band is thinner than its line, its size is given in words.
std::string largest_deviation(const core::ClipResult& clip, Variable variable) {
  double largest = 0.0;
  for (const core::MotionPoint& point : clip.motion) {
    if (point.smoothed && point.left_out == core::LeftOut::used)
      largest = std::max(largest, deviation(point, variable));
  }
  if (!(largest > 0.0) || !std::isfinite(largest)) return {};
  const std::string size = variable == Variable::x   ? size_text(2.0 * largest, 2, "m")
                           : variable == Variable::v ? size_text(2.0 * largest, 2, "m") + "/s"
                                                     : size_text(2.0 * largest, 2, "m/s²");
  return fmt::format(" (at most {})", size);
}

Plot motion_plot(const core::ClipResult& clip, Variable variable) {
  const char* const axis = axis_of(variable);
  std::string script(kFrame);
  script += shading(clip);
  script += fmt::format("set xlabel 't  (s)'\nset ylabel '{}'\nunset key\n", axis);
  if (!clip.motion.empty() && clip.motion.back().t_s > clip.motion.front().t_s) {
    script += fmt::format("set xrange [{:.7g}:{:.7g}]\n", clip.motion.front().t_s, clip.motion.back().t_s);
  }
  const auto range = variable == Variable::x ? std::nullopt : used_range(clip, variable);
  if (range) script += fmt::format("set yrange [{:.7g}:{:.7g}]\n", range->first, range->second);
  std::vector<PlotData> data = {smoothed_lines(clip, variable, true, "used"),
                                smoothed_lines(clip, variable, false, "unused")};
  script += "plot ";
  if (variable == Variable::x) {
    data.push_back(bare_positions(clip));
    script += fmt::format("$bare using 1:2 with points pt 7 ps 0.25 lc rgb '{}', ", kGrey);
  }
  script += fmt::format(
      "$used using 1:($2-2*$3):($2+2*$3) with filledcurves fillcolor rgb '{}' fillstyle transparent solid 0.25, ",
      kColors[0]);
  script += fmt::format("$unused using 1:2 with lines lw 1.5 lc rgb '{}', $used using 1:2 with lines lw 2 lc rgb '{}'",
                        kGrey, kColors[0]);
  const char* const name = variable == Variable::x ? "Position" : variable == Variable::v ? "Velocity" : "Acceleration";
  Plot plot;
  plot.drawing = {script, data};
  plot.caption =
      fmt::format("{} {}(t), with two standard deviations{}", name, axis[0], largest_deviation(clip, variable));
  plot.description = fmt::format("{} of clip {} over time", name, clip.name);
  return plot;
}

}  // namespace

std::vector<Plot> motion_plots(const core::ClipResult& clip) {
  const bool any = std::any_of(clip.motion.begin(), clip.motion.end(), [](const core::MotionPoint& point) {
    return point.smoothed || point.measured_m.has_value();
  });
  if (!any) return {};
  std::vector<Plot> plots;
  if (!clip.speed_noise_m_s) plots.push_back(motion_plot(clip, Variable::x));
  const bool smoothed = std::any_of(clip.motion.begin(), clip.motion.end(),
                                    [](const core::MotionPoint& point) { return point.smoothed; });
  if (smoothed) {
    plots.push_back(motion_plot(clip, Variable::v));
    plots.push_back(motion_plot(clip, Variable::a));
  }
  return plots;
}

namespace {

constexpr std::size_t kPointsOfAll = 1500;  // in one diagram; more only makes the page heavy
constexpr double kDetail = 0.15;            // of the largest speed: the part shown in figures 7 and 9
constexpr std::size_t kBars = 12;           // per configuration; bars on every point would hide each other
constexpr int kSteps = 24;                  // along a line, whose band is a hyperbola
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct PhasePoint {
  double v_m_s;
  double a_m_s2;
  double residual_m_s2;  ///< NaN if there is no line for this direction
  double half95_m_s2;    ///< of a, due to the noise of the positions
};

/// The points of one configuration; the drawing code thins them out.
struct Cloud {
  std::size_t configuration;
  std::vector<PhasePoint> points;
  bool forced;  ///< a known force acts on some of them
};

std::vector<Cloud> clouds(const core::AnalysisResults& results, const PhaseGroup& group) {
  std::vector<Cloud> all;
  for (const std::size_t c : group.configurations) {
    const core::ConfigurationResult& configuration = results.configurations[c];
    Cloud cloud{c, {}, false};
    for (const core::ClipResult& clip : results.clips) {
      const auto& names = configuration.clips;
      if (std::find(names.begin(), names.end(), clip.name) == names.end()) continue;
      for (const core::MotionPoint& point : clip.motion) {
        if (!point.smoothed || point.left_out != core::LeftOut::used) continue;
        cloud.forced = cloud.forced || point.force_n != 0.0;
        const double a = point.a_m_s2 - point.force_n / configuration.mass_kg;
        const core::LineFit* line = line_of(configuration.lines, point.v_m_s);
        const double residual = line == nullptr ? kNan : a - line_at(*line, point.v_m_s);
        cloud.points.push_back({point.v_m_s, a, residual, base::kNormal95 * point.sd_a_m_s2});
      }
    }
    all.push_back(std::move(cloud));
  }
  return all;
}

std::string data_name(const char* kind, std::size_t configuration) {
  return fmt::format("{}{}", kind, configuration);
}

PlotData thinned(const Cloud& cloud, const char* kind, std::size_t most, double from_v, double to_v) {
  PlotData data{data_name(kind, cloud.configuration),
                {},
                {"v (m/s)", "a (m/s²)", "residual of the line (m/s²)", "half of the 95 % interval of a (m/s²)"}};
  std::vector<PhasePoint> inside;
  for (const PhasePoint& point : cloud.points) {
    if (point.v_m_s >= from_v && point.v_m_s <= to_v) inside.push_back(point);
  }
  for (const std::size_t i : every_nth(inside.size(), most)) {
    data.rows.push_back({inside[i].v_m_s, inside[i].a_m_s2, inside[i].residual_m_s2, inside[i].half95_m_s2});
  }
  return never_empty(std::move(data));
}

/// Where a line's drawing begins: at v = 0, or at its slowest point if v = 0 is farther from its points than they
/// reach.
double drawn_from_m_s(const core::LineFit& line) {
  const double near = std::min(std::abs(line.from_v_m_s), std::abs(line.to_v_m_s));
  const double far = std::max(std::abs(line.from_v_m_s), std::abs(line.to_v_m_s));
  return near <= far - near ? 0.0 : std::copysign(near, line.from_v_m_s);
}

/// Each line with its band, to the end of its points.
PlotData fitted_lines(const core::ConfigurationResult& configuration, std::size_t index) {
  PlotData data{data_name("lines", index), {}, {"v (m/s)", "a (m/s²)", "half of the line's 95 % interval (m/s²)"}};
  for (const core::LineFit& line : configuration.lines) {
    const double far = std::abs(line.from_v_m_s) > std::abs(line.to_v_m_s) ? line.from_v_m_s : line.to_v_m_s;
    const double near = drawn_from_m_s(line);
    for (int i = 0; i <= kSteps; ++i) {
      const double v = near + (far - near) * static_cast<double>(i) / kSteps;
      data.rows.push_back({v, line_at(line, v), line_half95_m_s2(line, v)});
    }
    data.rows.emplace_back();
  }
  return never_empty(std::move(data));
}

struct Window {
  double from_v;
  double to_v;
  std::string script;
  bool has_limit;  ///< a line crosses a = 0 within it, on its own side of v = 0
};

/// With more steps, labels with a minus sign would overlap.
constexpr int kMostSteps = 6;

Window detail_window(const core::AnalysisResults& results, const PhaseGroup& group, double v_max) {
  const double half = kDetail * v_max;
  double low = 0.0;
  double high = 0.0;  // a = 0, the equilibrium, is always visible
  bool has_limit = false;
  for (const std::size_t c : group.configurations) {
    for (const core::LineFit& line : results.configurations[c].lines) {
      has_limit = has_limit || line_at(line, 0.0) * line_at(line, line.direction * half) < 0.0;
      for (const double v : {0.0, line.direction * half}) {
        low = std::min(low, line_at(line, v));
        high = std::max(high, line_at(line, v));
      }
    }
  }
  std::string script =
      fmt::format("set xrange [{:.6g}:{:.6g}]\nset xtics {:.6g}\n", -half, half, tick_step(2.0 * half, kMostSteps));
  if (high > low) {
    const double margin = 0.08 * (high - low);
    script += fmt::format("set yrange [{:.6g}:{:.6g}]\n", low - margin, high + margin);
  }
  return {-half, half, script, has_limit};
}

/// The data for gnuplot, and the command that draws them.
struct Diagram {
  std::string plot;
  std::vector<PlotData> data;
};

/// Points with some bars, lines and their bands: of a, or of its residuals.
Diagram diagram(const core::AnalysisResults& results, const PhaseGroup& group, const std::vector<Cloud>& all,
                double from_v, double to_v, bool residuals) {
  std::vector<PlotData> data;
  std::string bands, points, lines;
  std::size_t n = 0;
  for (const Cloud& cloud : all) {
    const std::string own = color(n++);
    data.push_back(thinned(cloud, "points", kPointsOfAll / all.size(), from_v, to_v));
    data.push_back(thinned(cloud, "bars", kBars, from_v, to_v));
    data.push_back(fitted_lines(results.configurations[cloud.configuration], cloud.configuration));
    const std::string line = data_name("lines", cloud.configuration);
    bands += fmt::format(
        "${0} using 1:({1}-$3):({1}+$3) with filledcurves fillcolor rgb '{2}' fillstyle transparent solid 0.2 "
        "notitle, ",
        line, residuals ? "0" : "$2", own);
    // Strokes instead of error bars, because gnuplot leaves white space around the points of error bars.
    points += fmt::format(
        "${0} using 1:{2} with points pt 7 ps 0.3 lc rgb '{3}' notitle, ${1} using 1:(${2}-$4):(0):(2*$4) with vectors "
        "nohead lw 1.2 lc rgb '{3}' notitle, ",
        data_name("points", cloud.configuration), data_name("bars", cloud.configuration), residuals ? 3 : 2, own);
    const std::string label = gnuplot_quoted(shortened(phase_label(results, group, cloud.configuration)));
    lines += (n > 1 ? ", " : "") +
             (residuals ? fmt::format("keyentry with points pt 7 ps 0.8 lc rgb '{}' title {}", own, label)
                        : fmt::format("${} using 1:2 with lines lw 1.6 lc rgb '{}' title {}", line, own, label));
  }
  return {"plot " + bands + points + lines + "\n", std::move(data)};
}

std::string axes(const char* y) {
  return fmt::format(
      "set xlabel 'v  (m/s)'\nset ylabel '{}'\n"
      "set xzeroaxis lt 1 lw 1 dt 1 lc rgb '#888888'\n"  // an arrow would be drawn outside the axes as well
      "set yzeroaxis lt 1 lw 1 dt 1 lc rgb '#888888'\n",
      y);
}

/// Half of the usual 95 % interval, against which residuals are judged. 0 if no bar is drawn.
double usual_bar(const std::vector<PlotData>& data) {
  constexpr std::size_t kHalf = 3;  // column of a bar's half length
  std::vector<double> halves;
  for (const PlotData& block : data) {
    if (!block.name.starts_with("bars")) continue;
    for (const std::vector<double>& row : block.rows) {
      if (row.size() > kHalf && std::isfinite(row[kHalf])) halves.push_back(row[kHalf]);
    }
  }
  if (halves.empty()) return 0.0;
  const auto middle = halves.begin() + static_cast<std::ptrdiff_t>(halves.size() / 2);
  std::nth_element(halves.begin(), middle, halves.end());
  return *middle;
}

/// The range of the points and the lines (the band of a poorly known line may extend beyond it), and the labels of v.
/// If residuals are much smaller than their bars, there is room for the bars.
std::string ranges_of(const std::vector<PlotData>& data, bool residuals) {
  const double bar = residuals ? usual_bar(data) : 0.0;
  double low = bar > 0.0 ? -bar : HUGE_VAL, high = bar > 0.0 ? bar : -HUGE_VAL, slowest = HUGE_VAL, fastest = -HUGE_VAL;
  for (const PlotData& block : data) {
    const bool lines = block.name.starts_with("lines");
    if (lines && residuals) continue;
    for (const std::vector<double>& row : block.rows) {
      const std::size_t column = residuals ? 2 : 1;
      if (row.size() <= column || !std::isfinite(row[column])) continue;
      low = std::min(low, row[column]);
      high = std::max(high, row[column]);
      slowest = std::min(slowest, row.front());
      fastest = std::max(fastest, row.front());
    }
  }
  if (!(high > low) || !(fastest > slowest)) return {};
  if (const double half = residuals ? 0.0 : usual_bar(data); half > 0.5 * (high - low)) {  // as in a fall near its end
    low -= half;
    high += half;
  }
  const double margin = 0.08 * (high - low);
  return fmt::format("set yrange [{:.6g}:{:.6g}]\nset xtics {:.6g}\n", low - margin, high + margin,
                     tick_step(fastest - slowest, kMostSteps));
}

Plot residual_plot(const core::AnalysisResults& results, const PhaseGroup& group, const std::vector<Cloud>& all) {
  const Diagram of = diagram(results, group, all, -HUGE_VAL, HUGE_VAL, true);
  const std::string script = std::string(kFrame) + axes("residual  (m/s²)") + ranges_of(of.data, true) + of.plot;
  return {Drawing{script, of.data},
          "Residuals: what the lines leave unexplained in a(v). Bands: 95 % of each line; bars: 95 % intervals of some "
          "points",
          "Residuals of the fitted lines against v"};
}

}  // namespace

double line_half95_m_s2(const core::LineFit& line, double v_m_s) {
  const double var_k = line.k_over_m_1_s.sd * line.k_over_m_1_s.sd, var_a0 = line.a0_m_s2.sd * line.a0_m_s2.sd;
  if (!(var_a0 > 0.0)) return 0.0;
  const double quantile = (line.a0_m_s2.high95 - line.a0_m_s2.value) / line.a0_m_s2.sd;  // that of both coefficients
  const double variance = var_a0 - 2.0 * v_m_s * line.covariance + v_m_s * v_m_s * var_k;
  return quantile * std::sqrt(std::max(0.0, variance));  // below 0 only by rounding
}

std::vector<PhaseGroup> phase_groups(const core::AnalysisResults& results) {
  std::vector<PhaseGroup> groups;
  for (std::size_t c = 0; c < results.configurations.size(); ++c) {
    const double incline_deg = results.configurations[c].incline_deg;
    auto found = std::find_if(groups.begin(), groups.end(),
                              [&](const PhaseGroup& group) { return group.incline_deg == incline_deg; });
    if (found == groups.end()) found = groups.insert(groups.end(), PhaseGroup{incline_deg, {}});
    found->configurations.push_back(c);
  }
  return groups;
}

std::string phase_label(const core::AnalysisResults& results, const PhaseGroup& group, std::size_t configuration) {
  const core::ConfigurationResult& own = results.configurations[configuration];
  std::string label = own.mass_kg < 1.0 ? fmt::format("{:.6g} g", own.mass_kg * 1e3)  // readable form
                                        : fmt::format("{:.6g} kg", own.mass_kg);
  const auto others = [&](const auto& which) {
    return std::ranges::any_of(group.configurations, [&](std::size_t other) {
      return other != configuration && which(results.configurations[other]);
    });
  };
  if (others([&](const core::ConfigurationResult& of) { return of.incline_deg != own.incline_deg; })) {
    label += fmt::format(", {:.4g}°", own.incline_deg);
  }
  const auto same = [&](const core::ConfigurationResult& of) {
    return of.mass_kg == own.mass_kg && of.incline_deg == own.incline_deg;
  };
  if (others(same)) label += ", " + own.group;
  return label;
}

namespace {

double fastest(const std::vector<Cloud>& all) {
  double v_max = 0.0;
  for (const Cloud& cloud : all) {
    for (const PhasePoint& point : cloud.points) v_max = std::max(v_max, std::abs(point.v_m_s));
  }
  return v_max;
}

const char* acceleration_axis(const std::vector<Cloud>& all) {
  const bool forced = std::any_of(all.begin(), all.end(), [](const Cloud& cloud) { return cloud.forced; });
  return forced ? "a − F/m  (m/s²)" : "a  (m/s²)";
}

Plot whole_plot(const core::AnalysisResults& results, const PhaseGroup& group, const std::vector<Cloud>& all) {
  const Diagram whole = diagram(results, group, all, -HUGE_VAL, HUGE_VAL, false);
  const std::string script =
      std::string(kFrame) + axes(acceleration_axis(all)) + ranges_of(whole.data, false) + whole.plot;
  return {
      Drawing{script, whole.data},
      "Phase diagram: measured and smoothed points, and the lines fitted for v < 0 and v > 0 with their 95 % bands; "
      "bars: 95 % intervals of some points",
      "Acceleration against velocity with fitted lines"};
}

}  // namespace

std::optional<Plot> phase_overview(const core::AnalysisResults& results) {
  PhaseGroup every;
  for (std::size_t c = 0; c < results.configurations.size(); ++c) every.configurations.push_back(c);
  const std::vector<Cloud> all = clouds(results, every);
  if (fastest(all) == 0.0) return std::nullopt;
  Plot plot = whole_plot(results, every, all);
  const bool both = std::ranges::any_of(results.configurations,
                                        [](const core::ConfigurationResult& one) { return one.lines.size() == 2; });
  plot.caption = fmt::format(
      "Acceleration against velocity. The slope of the lines is −K/m{}. Bands: 95 % of each line; bars: 95 % intervals "
      "of some points",
      both ? "; half of the step between the two lines of a glider at v = 0 is µ g cos α" : "");
  plot.description = "Acceleration against velocity of all configurations";
  if (all.size() > kColors.size()) plot.drawing.script.insert(plot.drawing.script.find("plot "), "unset key\n");
  return plot;
}

std::vector<Plot> phase_plots(const core::AnalysisResults& results, const PhaseGroup& group) {
  const std::vector<Cloud> all = clouds(results, group);
  const double v_max = fastest(all);
  if (v_max == 0.0) return {};
  std::vector<Plot> plots = {whole_plot(results, group, all)};
  const bool near_rest = std::ranges::any_of(group.configurations, [&](std::size_t c) {
    return std::ranges::any_of(results.configurations[c].lines,
                               [](const core::LineFit& line) { return drawn_from_m_s(line) == 0.0; });
  });
  if (near_rest) {
    const Window window = detail_window(results, group, v_max);
    const Diagram detail = diagram(results, group, all, window.from_v, window.to_v, false);
    const std::string script =
        std::string(kFrame) + axes(acceleration_axis(all)) + "unset offsets\n" + window.script + detail.plot;
    plots.push_back({Drawing{script, detail.data},
                     std::string("Near v = 0: the step between the lines is twice the Coulomb friction per unit mass") +
                         (window.has_limit ? ", and the line for v > 0 crosses a = 0 at the terminal velocity" : ""),
                     "Detail of the phase diagram near v = 0"});
  }
  plots.push_back(residual_plot(results, group, all));
  return plots;
}

}  // namespace glidelab::report
