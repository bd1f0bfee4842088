#include "report/diagnosis/twin_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/html/plot_axis.h"
#include "report/html/plot_style.h"

namespace glidelab::report {
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
      {Drawing{std::string(kFrame) + "set xlabel 'speed v (m/s)'\nset ylabel 'acceleration a (m/s²)'\n" +
                   points("data", "twin"),
               std::vector{never_empty(data), never_empty(twin)}},
       "Acceleration against speed, of the data and of the twin, smoothed alike",
       "Acceleration over speed of data and twin"}};
}

}  // namespace glidelab::report
