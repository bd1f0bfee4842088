#include "report/phase_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/decimate.h"
#include "report/gnuplot.h"
#include "report/plot_style.h"

namespace glidelab::report {
namespace {

constexpr std::size_t kPointsOfAll = 1500;  // in one diagram; more only makes the page heavy
constexpr double kDetail = 0.15;            // of the largest speed: the part that figures 7 and 9 show

struct PhasePoint {
  double v_m_s;
  double a_m_s2;
  double residual_m_s2;  ///< NaN where there is no line of this direction
};

/// The points of one configuration, thinned out by whoever draws them.
struct Cloud {
  std::size_t configuration;
  std::vector<PhasePoint> points;
};

const core::LineFit* line_of(const core::ConfigurationResult& configuration, double v_m_s) {
  for (const core::LineFit& line : configuration.lines) {
    if (line.direction * v_m_s > 0.0) return &line;
  }
  return nullptr;
}

double line_at(const core::LineFit& line, double v_m_s) {
  return line.a0_m_s2.value - line.k_over_m_1_s.value * v_m_s;
}

std::vector<Cloud> clouds(const core::AnalysisResults& results, const PhaseGroup& group, bool& force_applied) {
  std::vector<Cloud> all;
  for (const std::size_t c : group.configurations) {
    const core::ConfigurationResult& configuration = results.configurations[c];
    Cloud cloud{c, {}};
    for (const core::ClipResult& clip : results.clips) {
      const auto& names = configuration.clips;
      if (std::find(names.begin(), names.end(), clip.name) == names.end()) continue;
      for (const core::MotionPoint& point : clip.motion) {
        if (!point.smoothed || point.left_out != core::LeftOut::used) continue;
        if (point.force_n != 0.0) force_applied = true;
        const double a = point.a_m_s2 - point.force_n / configuration.mass_kg;
        const core::LineFit* line = line_of(configuration, point.v_m_s);
        const double residual =
            line == nullptr ? std::numeric_limits<double>::quiet_NaN() : a - line_at(*line, point.v_m_s);
        cloud.points.push_back({point.v_m_s, a, residual});
      }
    }
    all.push_back(std::move(cloud));
  }
  return all;
}

std::string data_name(const char* kind, std::size_t configuration) {
  return fmt::format("{}{}", kind, configuration);
}

/// gnuplot counts the rows of a block that is empty as an error; one row of NaN draws nothing.
PlotData never_empty(PlotData data) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  if (data.rows.empty()) data.rows.push_back({kNan, kNan, kNan});
  return data;
}

PlotData thinned(const Cloud& cloud, std::size_t most, double from_v, double to_v) {
  PlotData data{data_name("points", cloud.configuration), {}};
  std::vector<PhasePoint> inside;
  for (const PhasePoint& point : cloud.points) {
    if (point.v_m_s >= from_v && point.v_m_s <= to_v) inside.push_back(point);
  }
  for (const std::size_t i : every_nth(inside.size(), most)) {
    data.rows.push_back({inside[i].v_m_s, inside[i].a_m_s2, inside[i].residual_m_s2});
  }
  return never_empty(std::move(data));
}

/// Each line from v = 0 to where its points end.
PlotData fitted_lines(const core::ConfigurationResult& configuration, std::size_t index) {
  PlotData data{data_name("lines", index), {}};
  for (const core::LineFit& line : configuration.lines) {
    const double far = std::abs(line.from_v_m_s) > std::abs(line.to_v_m_s) ? line.from_v_m_s : line.to_v_m_s;
    data.rows.push_back({0.0, line_at(line, 0.0)});
    data.rows.push_back({far, line_at(line, far)});
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

Window detail_window(const core::AnalysisResults& results, const PhaseGroup& group, double v_max) {
  const double half = kDetail * v_max;
  double low = 0.0;
  double high = 0.0;  // a = 0, the equilibrium, is always in view
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
  std::string script = fmt::format("set xrange [{:.6g}:{:.6g}]\n", -half, half);
  if (high > low) {
    const double margin = 0.08 * (high - low);
    script += fmt::format("set yrange [{:.6g}:{:.6g}]\n", low - margin, high + margin);
  }
  return {-half, half, script, has_limit};
}

/// Points and lines of all configurations in one diagram.
std::string diagram(const core::AnalysisResults& results, const PhaseGroup& group, const std::vector<Cloud>& all,
                    double from_v, double to_v, double point_size, std::vector<PlotData>& data) {
  std::string points;
  std::string lines;
  std::size_t n = 0;
  for (const Cloud& cloud : all) {
    data.push_back(thinned(cloud, kPointsOfAll / all.size(), from_v, to_v));
    data.push_back(fitted_lines(results.configurations[cloud.configuration], cloud.configuration));
    points += fmt::format("{}${} using 1:2 with points pt 7 ps {} lc rgb '{}' notitle", n == 0 ? "" : ", ",
                          data_name("points", cloud.configuration), point_size, color(n));
    lines +=
        fmt::format(", ${} using 1:2 with lines lw 1.6 lc rgb '{}' title {}", data_name("lines", cloud.configuration),
                    color(n), gnuplot_quoted(configuration_label(results, group, cloud.configuration)));
    ++n;
  }
  return "plot " + points + lines + "\n";
}

std::string axes(const char* y) {
  return fmt::format(
      "set xlabel 'v  (m/s)'\nset ylabel '{}'\n"
      "set arrow from graph 0, first 0 to graph 1, first 0 nohead back lw 1 lc rgb '#888888'\n"
      "set arrow from first 0, graph 0 to first 0, graph 1 nohead back lw 1 lc rgb '#888888'\n",
      y);
}

Plot residual_plot(const core::AnalysisResults& results, const PhaseGroup& group, const std::vector<Cloud>& all) {
  std::vector<PlotData> data;
  std::string script = std::string(kFrame) + axes("residual  (m/s²)") + "plot ";
  std::size_t n = 0;
  for (const Cloud& cloud : all) {
    data.push_back(thinned(cloud, kPointsOfAll / all.size(), -HUGE_VAL, HUGE_VAL));
    script += fmt::format(
        "{0}${1} using 1:3 with points pt 7 ps 0.3 lc rgb '{2}' notitle, keyentry with points pt 7 ps 0.8 lc rgb '{2}' "
        "title {3}",
        n == 0 ? "" : ", ", data_name("points", cloud.configuration), color(n),
        gnuplot_quoted(configuration_label(results, group, cloud.configuration)));
    ++n;
  }
  return {Drawing{script, data}, "Residuals of the lines: what a(v) leaves unexplained",
          "Residuals of the fitted lines over v"};
}

}  // namespace

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

std::string configuration_label(const core::AnalysisResults& results, const PhaseGroup& group,
                                std::size_t configuration) {
  const core::ConfigurationResult& own = results.configurations[configuration];
  std::string label = own.mass_kg < 1.0 ? fmt::format("{:.6g} g", own.mass_kg * 1e3)  // as a person reads it
                                        : fmt::format("{:.6g} kg", own.mass_kg);
  const auto same_mass =
      std::count_if(group.configurations.begin(), group.configurations.end(),
                    [&](std::size_t other) { return results.configurations[other].mass_kg == own.mass_kg; });
  if (same_mass > 1) label += ", " + own.group;
  return label;
}

std::vector<Plot> phase_plots(const core::AnalysisResults& results, const PhaseGroup& group) {
  bool force_applied = false;
  const std::vector<Cloud> all = clouds(results, group, force_applied);
  double v_max = 0.0;
  for (const Cloud& cloud : all) {
    for (const PhasePoint& point : cloud.points) v_max = std::max(v_max, std::abs(point.v_m_s));
  }
  if (v_max == 0.0) return {};
  const char* const y = force_applied ? "a − F/m  (m/s²)" : "a  (m/s²)";

  std::vector<PlotData> data;
  std::string script = std::string(kFrame) + axes(y) + diagram(results, group, all, -HUGE_VAL, HUGE_VAL, 0.3, data);
  std::vector<Plot> plots = {{Drawing{script, data},
                              "Phase diagram: points as measured and smoothed, lines fitted for v < 0 and v > 0",
                              "Acceleration over velocity with fitted lines"}};
  const Window window = detail_window(results, group, v_max);
  data.clear();
  const std::string detail = diagram(results, group, all, window.from_v, window.to_v, 0.3, data);
  script = std::string(kFrame) + axes(y) + "unset offsets\n" + window.script + detail;
  plots.push_back({Drawing{script, data},
                   std::string("Near v = 0: the gap between the lines is twice the Coulomb friction") +
                       (window.has_limit ? ", their crossing of a = 0 the limit velocity" : ""),
                   "Detail of the phase diagram near v = 0"});
  plots.push_back(residual_plot(results, group, all));
  return plots;
}

}  // namespace glidelab::report
