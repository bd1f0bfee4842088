#include "report/analysis/camera_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text/number_text.h"
#include "report/html/plot_axis.h"
#include "report/html/plot_style.h"

namespace glidelab::report {
namespace {

constexpr double kArrow = 0.08;  // of the image's width, for the largest
constexpr int kMostTics = 7;     // that leave room for numbers of pixels side by side

/// 1, 2 or 5 times a power of ten, at most `value`.
double round_down(double value) {
  const double ten = std::pow(10.0, std::floor(std::log10(value)));
  return (value >= 5.0 * ten ? 5.0 : value >= 2.0 * ten ? 2.0 : 1.0) * ten;
}

}  // namespace

std::vector<Plot> calibration_plots(const core::CornerMap& rests, const std::string& experiment) {
  double largest = 0.0;
  for (const core::CornerCell& cell : rests.cells) largest = std::max(largest, std::hypot(cell.du_px, cell.dv_px));
  if (!(largest > 0.0)) return {};
  const double enlarged = round_down(kArrow * rests.width_px / largest);
  const double step = tick_step(rests.width_px, kMostTics);
  PlotData arrows{"arrows", {}, {"u (px)", "v (px)", "du, enlarged (px)", "dv, enlarged (px)"}};
  PlotData noise{"noise", {}, {"u (px)", "v (px)", "standard deviation, enlarged (px)"}};
  for (const core::CornerCell& cell : rests.cells) {
    arrows.rows.push_back({cell.u_px, cell.v_px, enlarged * cell.du_px, enlarged * cell.dv_px});
    noise.rows.push_back({cell.u_px, cell.v_px, enlarged * cell.sd_px});
  }
  const std::string script =
      std::string(kFrame) +
      fmt::format(
          "set size ratio -1\nset offsets 0,0,0,0\nset xrange [-0.5:{0}]\nset yrange [{1}:-0.5]\nset xtics {2}\nset "
          "ytics {2}\n"
          "set xlabel 'u (px)'\nset ylabel 'v (px)'\n"
          "plot $noise using 1:2:3 with circles fillcolor rgb '{3}' fillstyle solid noborder title 'expected from "
          "noise', $arrows using 1:2:3:4 with vectors filled head size graph 0.012,20 lw 1.5 lc rgb '{4}' title 'mean "
          "residual, {5:g} times enlarged'\n",
          rests.width_px - 0.5, rests.height_px - 0.5, step, kShade, kColors[0], enlarged);
  return {{Drawing{script, std::vector{noise, arrows}},
           fmt::format(
               "{}Residuals of the pattern's corners, averaged over all views in each part of the image (the largest "
               "is {} px). They are {} times what independent errors would leave; arrows that turn or grow smoothly "
               "across the image point to a lens that the model does not follow, or to a pattern that is not flat",
               experiment.empty() ? "" : experiment + ": ", base::number_text(largest, 2),
               base::number_text(rests.excess, 2)),
           (experiment.empty() ? "" : experiment + ", ") + "Residuals of the calibration over the image"}};
}

double curve_excess(const diagnose::PictureCurve& curve) {
  double sum = 0.0;
  for (std::size_t p = 0; p < curve.at.size(); ++p) {
    sum += std::pow((curve.value[p] - curve.fitted[p]) / curve.sd[p], 2);
  }
  return curve.at.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(curve.at.size()));
}

Plot noise_plot(const diagnose::PictureCurve& curve) {
  PlotData data{
      "noise", {}, {"level (codes)", "variance (codes²)", "its standard deviation (codes²)", "linear (codes²)"}};
  for (std::size_t p = 0; p < curve.at.size(); ++p) {
    data.rows.push_back({curve.at[p], curve.value[p], curve.sd[p], curve.fitted[p]});
  }
  const std::string script =
      std::string(kFrame) +
      fmt::format(
          "set xrange [0:*]\nset yrange [0:*]\nset xlabel 'brightness of a resting pixel  (codes)'\nset ylabel "
          "'variance of its noise  (codes²)'\nplot $noise using 1:2:3 with yerrorbars pt 7 ps 0.5 lc rgb '{0}' "
          "title 'seen', $noise using 1:4 with lines lw 2 lc rgb '{0}' title 'shot noise, linear sensor'\n",
          kColors[0]);
  return {Drawing{script, std::vector{data}},
          fmt::format("How much resting pixels change from frame to frame, against their brightness. Shot noise gives "
                      "a straight line; a tone curve, a codec or a camera that smooths bends it. The points lie off it "
                      "by {} times their standard deviation",
                      base::number_text(curve_excess(curve), 2)),
          "Noise of pixels over their brightness"};
}

}  // namespace glidelab::report
