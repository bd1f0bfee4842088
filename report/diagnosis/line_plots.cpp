#include "report/diagnosis/line_plots.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "report/html/gnuplot.h"
#include "report/html/plot_style.h"
#include "report/text/effect_names.h"

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
  return {Drawing{script, std::move(data), {520, 470}},
          fmt::format(
              "What the nominal model leaves of the intercepts, as friction, against {}: {}. Bars are the lines' own "
              "scatter",
              over_mass ? "1/m" : "(K/m)²",
              over_mass ? "a force that does not grow with the load is straight here"
                        : "the smoothing's bias is straight here"),
          over_mass ? "Friction left over 1/m" : "Friction left over (K/m)²"};
}

}  // namespace

std::vector<Plot> line_plots(const diagnose::LineComparison& lines) {
  if (lines.curves.empty()) return {};
  return {friction_plot(lines, true), friction_plot(lines, false)};
}

}  // namespace glidelab::report
