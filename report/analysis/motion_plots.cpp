#include "report/analysis/motion_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "report/html/decimate.h"
#include "report/html/plot_style.h"
#include "report/text/handy_units.h"

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

/// The smoothed points that are used (or not), as lines that break where the other kind stands between: t, y, sd.
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

/// The range of what is used, with a margin: beyond the ends of a stretch the smoothed derivatives run away.
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

/// A band that is thinner than its line is told in words.
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
  std::vector<Plot> plots = {motion_plot(clip, Variable::x)};
  const bool smoothed = std::any_of(clip.motion.begin(), clip.motion.end(),
                                    [](const core::MotionPoint& point) { return point.smoothed; });
  if (smoothed) {
    plots.push_back(motion_plot(clip, Variable::v));
    plots.push_back(motion_plot(clip, Variable::a));
  }
  return plots;
}

}  // namespace glidelab::report
