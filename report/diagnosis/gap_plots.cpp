#include "report/diagnosis/gap_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/math/distributions.h"
#include "report/diagnosis/diagnosis_plots.h"
#include "report/diagnosis/words/verdict_words.h"
#include "report/html/plot.h"

namespace glidelab::report {
namespace {

constexpr double kEmptyCell = std::numeric_limits<double>::quiet_NaN();
constexpr double kWide = 8.0;           // times the noise: above this the axis is logarithmic
constexpr double kLogFrom = 0.5;        // where the logarithmic axis begins
constexpr std::size_t kCells = 60;      // per row of the map
constexpr double kDeepest = 5.0;        // standard deviations at which the colours end
constexpr std::size_t kMostNamed = 40;  // rows with readable names

std::string domain_name(diagnose::GapDomainKind domain) {
  switch (domain) {
    case diagnose::GapDomainKind::positions:
      return "positions of held-out clips";
    case diagnose::GapDomainKind::phase_plane:
      return "phase plane: a against v";
    case diagnose::GapDomainKind::parameters:
      return "parameters: K, µ, α";
    case diagnose::GapDomainKind::images:
      return "images";
  }
  return {};
}

/// One bar of a horizontal chart from the axis' left end to `value`.
std::vector<double> bar(double left, double value, double middle, double half) {
  return {0.5 * (left + std::max(left, value)), middle, left, std::max(left, value), middle - half, middle + half};
}

Plot phase_plot(const diagnose::PhaseGap& gap, bool one) {
  PlotData data{"bins",
                {},
                {"v (m/s)", "a measured - modelled before (m/s²)", "half of its 95 % interval (m/s²)", "after (m/s²)",
                 "half of its 95 % interval (m/s²)"}};
  for (const diagnose::PhaseBin& bin : gap.bins) {
    data.rows.push_back({bin.v_m_s, bin.before.value, base::kNormal95 * bin.before.sd, bin.after.value,
                         base::kNormal95 * bin.after.sd});
  }
  std::string script(kFrame);
  script += fmt::format(
      "set xlabel '{0}'\nset ylabel 'a measured − a modelled  (m/s²)'\n"
      "plot 0 with lines lw 1 lc rgb '{1}' notitle, "
      "$bins using 1:($2-$3):($2+$3) with filledcurves fillcolor rgb '{2}' fillstyle transparent solid 0.25 notitle, "
      "$bins using 1:2 with linespoints lw 2 pt 6 ps 0.8 lc rgb '{2}' title '{3}'",
      axis_of(diagnose::GapVariable::speed), kGrey, kColors[1], one ? kNominalModel : "before");
  if (!one) {
    script += fmt::format(
        ", $bins using 1:($4-$5):($4+$5) with filledcurves fillcolor rgb '{0}' fillstyle transparent solid 0.25 "
        "notitle, $bins using 1:4 with linespoints lw 2 pt 7 ps 0.6 lc rgb '{0}' title 'after'",
        kColors[0]);
  }
  script += "\n";
  return {Drawing{script, std::vector{data}},
          "Acceleration of the glider minus that of the model at the same velocity, both smoothed alike: the mean over "
          "intervals of velocity, with the band that holds noise alone 95 times in 100. A curve outside its "
          "band is a force that the model lacks",
          "Measured minus modelled acceleration against speed"};
}

Plot phase_plot_by_mass(const std::vector<diagnose::PhaseGap>& gaps, bool one) {
  std::vector<PlotData> data;
  std::string script(kFrame), curves;
  for (const diagnose::PhaseGap& gap : gaps) {
    if (!gap.mass_kg) continue;
    PlotData of{fmt::format("mass{}", data.size() + 1),
                {},
                {"v (m/s)", fmt::format("a measured - modelled of {:g} kg (m/s²)", *gap.mass_kg),
                 "half of its 95 % interval (m/s²)"}};
    for (const diagnose::PhaseBin& bin : gap.bins) {
      of.rows.push_back({bin.v_m_s, bin.before.value, base::kNormal95 * bin.before.sd});
    }
    curves += fmt::format("{}${} using 1:2:3 with yerrorbars pt 7 ps 0.5 lw 1.2 lc rgb '{}' title '{:g} kg'",
                          curves.empty() ? "" : ", ", of.name, color(data.size()), *gap.mass_kg);
    data.push_back(std::move(of));
  }
  script += fmt::format("set xlabel '{}'\nset ylabel 'a measured − a modelled  (m/s²)'\nplot {}\n",
                        axis_of(diagnose::GapVariable::speed), curves);
  return {
      Drawing{script, std::move(data)},
      one ? "The same for each mass: where the masses differ, what is missing is not proportional to the load"
          : "The same for each mass, before: where the masses differ, what is missing is not proportional to the load",
      "Measured minus modelled acceleration against speed, by mass"};
}

Plot map_plot(const ResidualMap& map, const std::vector<std::vector<double>>& cells, diagnose::GapVariable variable,
              const char* when) {
  PlotData data{"cells", {}, {axis_of(variable), "clip (row)", "residual / noise"}};
  const double width = (map.high - map.low) / static_cast<double>(cells.front().size());
  for (std::size_t r = 0; r < cells.size(); ++r) {
    for (std::size_t c = 0; c < cells[r].size(); ++c) {
      data.rows.push_back({map.low + width * (static_cast<double>(c) + 0.5), -static_cast<double>(r), cells[r][c]});
    }
    data.rows.emplace_back();
  }
  std::string script(kFrame);
  script += fmt::format("unset key\nunset grid\nset offsets 0,0,0,0\nset xlabel '{}'\n", axis_of(variable));
  if (map.clips.size() <= kMostNamed) {
    script += chart_labels(map.clips);
  } else {
    script += "unset ytics\nset ylabel 'clips'\n";
  }
  script += fmt::format(
      "set xrange [{}:{}]\nset yrange [{}:0.5]\nset cbrange [-{}:{}]\nset palette defined (0 '#053061', 1 '#4393c3', 2 "
      "'#f7f7f7', 3 '#d6604d', 4 '#67001f')\nset cblabel 'residual / noise' offset 1.2,0\n"
      "plot $cells using 1:2:3 with image pixels\n",
      map.low, map.high, 0.5 - static_cast<double>(cells.size()), kDeepest, kDeepest);
  const int height = 110 + std::clamp(22 * static_cast<int>(cells.size()), 190, 700);
  return {Drawing{script, std::vector{data}, {520, height}},
          fmt::format("Residuals of each clip{1}: the sum of a few neighbouring positions over what their noise "
                      "allows (0: none; {0:g} and -{0:g}: as many standard deviations or more)",
                      kDeepest, when),
          fmt::format("Map of the residuals by clip{}", when)};
}

}  // namespace

std::vector<Plot> domain_plots(const diagnose::Diagnosis& diagnosis) {
  if (!diagnosis.gap || diagnosis.gap->domains.empty()) return {};
  const std::vector<diagnose::GapDomain>& domains = diagnosis.gap->domains;
  const bool one = one_model(diagnosis);
  double most = 1.0, least = kLogFrom;
  std::vector<std::string> names;
  for (const diagnose::GapDomain& domain : domains) {
    most = std::max({most, domain.before, domain.after.value_or(0.0)});
    for (const double size : {domain.before, domain.after.value_or(0.0)}) {
      if (size > 0.0) least = std::min(least, 0.8 * size);
    }
    names.push_back(domain_name(domain.domain));
  }
  const double left = most > kWide ? least : 0.0;
  const std::vector<std::string> columns = {"middle of the bar (gap / noise)", "row", "from", "to", "low", "high"};
  PlotData before{"before", {}, columns}, after{"after", {}, columns};
  for (std::size_t d = 0; d < domains.size(); ++d) {
    const double middle = -static_cast<double>(d);
    before.rows.push_back(bar(left, domains[d].before, middle + (one ? 0.0 : 0.19), one ? 0.3 : 0.17));
    after.rows.push_back(domains[d].after ? bar(left, *domains[d].after, middle - 0.19, 0.17)
                                          : std::vector<double>(6, kEmptyCell));
  }
  std::string script(kFrame);
  script += "set offsets 0,0,0,0\nset xlabel 'gap / noise'\n" + chart_labels(names);
  script += fmt::format("set yrange [{}:0.6]\n", 0.4 - static_cast<double>(domains.size()));
  script += most > kWide ? fmt::format("set logscale x\nset xrange [{}:{}]\n", left, 1.5 * most)
                         : fmt::format("set xrange [0:{}]\n", 1.15 * most);
  script += fmt::format(
      "set style fill solid 0.85 noborder\nset arrow from 1, graph 0 to 1, graph 1 nohead front lw 1.5 lc rgb '{}'\n"
      "plot $before using 1:2:3:4:5:6 with boxxyerror lc rgb '{}' title '{}'",
      color(6), kColors[1], one ? kNominalModel : "before");
  if (!one) script += fmt::format(", $after using 1:2:3:4:5:6 with boxxyerror lc rgb '{}' title 'after'", kColors[0]);
  script += "\n";
  return {
      {Drawing{script, std::vector{before, after}, {620, std::max(240, 110 + 48 * static_cast<int>(domains.size()))}},
       one ? "The gap in each domain, as a multiple of the gap from noise alone (line at 1)"
           : "The gap in each domain, as a multiple of the gap from noise alone (line at 1): before, with the "
             "nominal model, and after, with what is missing. Where there is no bar, it cannot be determined",
       one ? "Bars of the gap in each domain" : "Bars of the gap in each domain, before and after"}};
}

std::vector<Plot> phase_gap_plots(const diagnose::Diagnosis& diagnosis) {
  if (!diagnosis.gap || diagnosis.gap->phase_plane.empty()) return {};
  const std::vector<diagnose::PhaseGap>& gaps = diagnosis.gap->phase_plane;
  const bool one = one_model(diagnosis);
  std::vector<Plot> plots = {phase_plot(gaps.front(), one)};
  if (gaps.size() > 2) plots.push_back(phase_plot_by_mass(gaps, one));
  return plots;
}

ResidualMap residual_map(const std::vector<diagnose::ResidualCurve>& curves, diagnose::GapVariable variable,
                         std::size_t cells) {
  ResidualMap map;
  bool any = false;
  for (const diagnose::ResidualCurve& curve : curves) {
    if (std::find(map.clips.begin(), map.clips.end(), curve.clip) == map.clips.end()) map.clips.push_back(curve.clip);
    for (const double at : along(curve, variable)) {
      map.low = any ? std::min(map.low, at) : at;
      map.high = any ? std::max(map.high, at) : at;
      any = true;
    }
  }
  map.before.assign(map.clips.size(), std::vector<double>(cells, 0.0));
  map.after = map.before;
  std::vector<std::vector<double>> count = map.before;
  for (const diagnose::ResidualCurve& curve : curves) {
    const auto row =
        static_cast<std::size_t>(std::find(map.clips.begin(), map.clips.end(), curve.clip) - map.clips.begin());
    for (std::size_t p = 0; p < along(curve, variable).size() && map.high > map.low; ++p) {
      const double part = (along(curve, variable)[p] - map.low) / (map.high - map.low);
      const std::size_t cell = std::min(cells - 1, static_cast<std::size_t>(part * static_cast<double>(cells)));
      map.before[row][cell] += curve.before_m[p] / curve.noise_m[p];
      map.after[row][cell] += curve.after_m[p] / curve.noise_m[p];
      count[row][cell] += 1.0;
    }
  }
  for (std::size_t r = 0; r < map.clips.size(); ++r) {
    for (std::size_t c = 0; c < cells; ++c) {
      const double over = count[r][c] > 0.0 ? std::sqrt(count[r][c]) : kEmptyCell;
      map.before[r][c] /= over;
      map.after[r][c] /= over;
    }
  }
  return map;
}

std::vector<Plot> residual_maps(const diagnose::Diagnosis& diagnosis) {
  using diagnose::GapVariable;
  GapVariable variable = GapVariable::time;
  if (!diagnosis.regions.empty()) {
    const GapVariable of = diagnosis.regions.front().variable;
    if (of == GapVariable::position || of == GapVariable::speed) variable = of;
  }
  const ResidualMap map = residual_map(diagnosis.residuals, variable, kCells);
  if (!(map.high > map.low)) return {};
  if (one_model(diagnosis)) return {map_plot(map, map.before, variable, "")};
  return {map_plot(map, map.before, variable, ", before"), map_plot(map, map.after, variable, ", after")};
}

namespace {

constexpr std::size_t kTwinPoints = 4000;  // of all clips

/// Two sets of points, the second one over the first.
std::string points(const char* below, const char* above) {
  return fmt::format(
      "plot $data using 1:2 with points pt 7 ps 0.3 lc rgb '{0}' notitle, keyentry with points pt 7 ps 0.8 lc rgb "
      "'{0}' title '{2}', $twin using 1:2 with points pt 7 ps 0.15 lc rgb '{1}' notitle, keyentry with points pt 7 ps "
      "0.8 lc rgb '{1}' title '{3}'\n",
      kColors[4], kColors[1], below, above);
}

void add(const std::vector<double>& at, const std::vector<double>& value, double scale, std::size_t step,
         PlotData& into) {
  for (std::size_t p = 0; p < at.size(); p += step) into.rows.push_back({at[p], scale * value[p]});
}

}  // namespace

std::vector<Plot> twin_plots(const std::vector<validate::TwinMotion>& motions) {
  PlotData rest{"data", {}}, noise{"twin", {}};
  PlotData data{"data", {}, {"v (m/s)", "a of the data (m/s²)"}}, twin{"twin", {}, {"v (m/s)", "a of the twin (m/s²)"}};
  std::size_t count = 0;
  for (const validate::TwinMotion& motion : motions) count += motion.t_s.size();
  const std::size_t step = 1 + count / kTwinPoints;
  double largest_m = 0.0;
  for (const validate::TwinMotion& motion : motions) {
    for (const double x : motion.rest_m) largest_m = std::max(largest_m, std::abs(x));
  }
  const auto [unit, scale] = small_length_unit(largest_m);
  rest.columns = {"t (s)", fmt::format("data - twin ({})", unit)};
  noise.columns = {"t (s)", fmt::format("noise of the twin ({})", unit)};
  for (const validate::TwinMotion& motion : motions) {
    add(motion.t_s, motion.rest_m, scale, step, rest);
    add(motion.t_s, motion.noise_m, scale, step, noise);
    add(motion.v_m_s, motion.a_m_s2, 1.0, step, data);
    add(motion.twin_v_m_s, motion.twin_a_m_s2, 1.0, step, twin);
  }
  return {
      {Drawing{std::string(kFrame) + "set offsets 0, graph 0.02, graph 0.06, graph 0.06\nset xlabel 'time t (s)'\n" +
                   fmt::format("set ylabel 'position  ({})'\n", unit) + points("data − twin", "noise of the twin"),
               std::vector{never_empty(rest), never_empty(noise)}},
       "Measured positions of all clips minus those of the twin: where nothing is missing, as large as noise alone",
       "Measured positions minus those of the twin over time, with noise for comparison"},
      {Drawing{std::string(kFrame) + "set xlabel 'velocity v (m/s)'\nset ylabel 'acceleration a (m/s²)'\n" +
                   points("data", "twin"),
               std::vector{never_empty(data), never_empty(twin)}},
       "Acceleration against speed, of the data and of the twin, smoothed alike",
       "Acceleration against speed of data and twin"}};
}

}  // namespace glidelab::report
