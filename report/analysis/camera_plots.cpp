#include "report/analysis/camera_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/text/number_text.h"
#include "report/html/plot.h"

namespace glidelab::report {
namespace {

constexpr double kArrow = 0.08;  // length of the largest, as a fraction of the image's width
constexpr int kMostTics = 7;     // leaves room for adjacent pixel numbers

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
               "across the image indicate a lens that the model does not describe, or a pattern that is not flat",
               experiment.empty() ? "" : experiment + ": ", base::number_text(largest, 2),
               base::number_text(rests.excess, 2)),
           (experiment.empty() ? "" : experiment + ", ") + "Residuals of the calibration over the image"}};
}

double curve_excess(const diagnose::ImageCurve& curve) {
  double sum = 0.0;
  for (std::size_t p = 0; p < curve.at.size(); ++p) {
    sum += std::pow((curve.value[p] - curve.fitted[p]) / curve.sd[p], 2);
  }
  return curve.at.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(curve.at.size()));
}

Plot noise_plot(const diagnose::ImageCurve& curve) {
  PlotData data{
      "noise", {}, {"level (codes)", "variance (codes²)", "its standard deviation (codes²)", "linear (codes²)"}};
  for (std::size_t p = 0; p < curve.at.size(); ++p) {
    data.rows.push_back({curve.at[p], curve.value[p], curve.sd[p], curve.fitted[p]});
  }
  const std::string script =
      std::string(kFrame) +
      fmt::format(
          "set xrange [0:*]\nset yrange [0:*]\nset xlabel 'brightness of a static pixel  (codes)'\nset ylabel "
          "'variance of its noise  (codes²)'\nplot $noise using 1:2:3 with yerrorbars pt 7 ps 0.5 lc rgb '{0}' "
          "title 'measured', $noise using 1:4 with lines lw 2 lc rgb '{0}' title 'shot noise, linear sensor'\n",
          kColors[0]);
  return {Drawing{script, std::vector{data}},
          fmt::format("Frame-to-frame variance of static pixels against their brightness. Shot noise gives a straight "
                      "line; a tone curve, a codec or in-camera smoothing bends it. The points deviate from it by {} "
                      "times their standard deviation",
                      base::number_text(curve_excess(curve), 2)),
          "Pixel noise against brightness"};
}

namespace {

constexpr std::size_t kFewest = 20;
constexpr std::size_t kCloud = 1500;
constexpr std::size_t kBins = 20;

double place_of(const core::MarkerSighting& sighting, bool across) {
  return across ? sighting.v_px : sighting.u_px;
}

/// The image axis along which the marker moves, and its pixels per metre of x (signed).
struct Course {
  bool vertical = false;
  double px_per_m = 0.0;
};

std::optional<Course> course_of(const core::ClipResult& clip) {
  double n = 0.0, x = 0.0, u = 0.0, v = 0.0, xx = 0.0, xu = 0.0, xv = 0.0;
  for (const core::MarkerSighting& sighting : clip.sightings) {
    if (sighting.frame >= clip.motion.size() || !clip.motion[sighting.frame].measured_m) continue;
    n += 1.0;  // Welford's update
    const double dx = *clip.motion[sighting.frame].measured_m - x;
    const double du = sighting.u_px - u, dv = sighting.v_px - v;
    x += dx / n;
    u += du / n;
    v += dv / n;
    xx += dx * (*clip.motion[sighting.frame].measured_m - x);
    xu += dx * (sighting.u_px - u);
    xv += dx * (sighting.v_px - v);
  }
  if (!(xx > 0.0)) return std::nullopt;
  return std::abs(xv) > std::abs(xu) ? Course{true, xv / xx} : Course{false, xu / xx};
}

PixelPhase point_of(const core::MarkerSighting& sighting, const Course& course, double error_m) {
  const double place = place_of(sighting, course.vertical);
  return {place - std::round(place), error_m * course.px_per_m};
}

struct Harmonic {
  double mean = 0.0, cosine = 0.0, sine = 0.0, rms = 0.0;
};

/// Least squares by the normal equations of three columns, Cramer's rule.
Harmonic harmonic_of(const std::vector<PixelPhase>& points) {
  std::array<std::array<double, 3>, 3> normal{};
  std::array<double, 3> right{};
  const auto columns = [](double phase) {
    const double angle = 2.0 * std::numbers::pi * phase;
    return std::array<double, 3>{1.0, std::cos(angle), std::sin(angle)};
  };
  for (const PixelPhase& point : points) {
    const auto row = columns(point.phase_px);
    for (std::size_t i = 0; i < 3; ++i) {
      right[i] += row[i] * point.error_px;
      for (std::size_t j = 0; j < 3; ++j) normal[i][j] += row[i] * row[j];
    }
  }
  const auto determinant = [](const std::array<std::array<double, 3>, 3>& m) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  };
  const double whole = determinant(normal);
  std::array<double, 3> solution{};
  for (std::size_t k = 0; k < 3; ++k) {
    auto replaced = normal;
    for (std::size_t i = 0; i < 3; ++i) replaced[i][k] = right[i];
    solution[k] = determinant(replaced) / whole;
  }
  Harmonic harmonic{solution[0], solution[1], solution[2], 0.0};
  double squares = 0.0;
  for (const PixelPhase& point : points) {
    const auto row = columns(point.phase_px);
    squares += std::pow(point.error_px - row[0] * solution[0] - row[1] * solution[1] - row[2] * solution[2], 2);
  }
  harmonic.rms = std::sqrt(squares / static_cast<double>(points.size()));
  return harmonic;
}

bool covers_a_pixel(const std::vector<PixelPhase>& points) {
  std::array<bool, 4> seen{};
  for (const PixelPhase& point : points) {
    seen[static_cast<std::size_t>(std::clamp(4.0 * (point.phase_px + 0.5), 0.0, 3.0))] = true;
  }
  return std::all_of(seen.begin(), seen.end(), [](bool one) { return one; });
}

}  // namespace

std::vector<PixelPhase> phase_points(const core::AnalysisResults& results) {
  std::vector<PixelPhase> points;
  for (const core::ClipResult& clip : results.clips) {
    const auto course = course_of(clip);
    if (!course) continue;
    for (const core::MarkerSighting& sighting : clip.sightings) {
      if (sighting.frame >= clip.motion.size()) continue;
      const core::MotionPoint& point = clip.motion[sighting.frame];
      if (!point.measured_m || !point.smoothed || point.left_out != core::LeftOut::used) continue;
      points.push_back(point_of(sighting, *course, *point.measured_m - point.x_m));
    }
  }
  return points;
}

std::vector<PixelPhase> phase_points(const core::AnalysisResults& results,
                                     const validate::RestitutionComparison& restitution) {
  std::vector<PixelPhase> points;
  std::vector<std::optional<Course>> courses;
  for (const core::ClipResult& clip : results.clips) courses.push_back(course_of(clip));
  for (const validate::RestitutionPoint& point : restitution.points) {
    if (point.clip >= courses.size() || !courses[point.clip]) continue;
    const std::vector<core::MarkerSighting>& sightings = results.clips[point.clip].sightings;
    const auto found =
        std::lower_bound(sightings.begin(), sightings.end(), point.frame,
                         [](const core::MarkerSighting& one, std::size_t frame) { return one.frame < frame; });
    if (found == sightings.end() || found->frame != point.frame) continue;
    points.push_back(point_of(*found, *courses[point.clip], point.error_m));
  }
  return points;
}

std::optional<PixelLocking> pixel_locking(const std::vector<PixelPhase>& points) {
  if (points.size() < kFewest || !covers_a_pixel(points)) return std::nullopt;
  const Harmonic harmonic = harmonic_of(points);
  return PixelLocking{std::hypot(harmonic.cosine, harmonic.sine),
                      harmonic.rms * std::sqrt(2.0 / static_cast<double>(points.size()))};
}

std::vector<Plot> pixel_phase_plot(const std::vector<PixelPhase>& points, bool from_truth) {
  const auto locking = pixel_locking(points);
  if (!locking) return {};
  const char* const error = from_truth ? "measured - true (px)" : "measured - smoothed (px)";
  PlotData cloud{"cloud", {}, {"centre within its pixel (px)", error}};
  PlotData means{"means", {}, {"centre within its pixel (px)", error, "standard deviation of the mean (px)"}};
  for (const std::size_t i : every_nth(points.size(), kCloud)) {
    cloud.rows.push_back({points[i].phase_px, points[i].error_px});
  }
  std::array<double, kBins> n{}, sum{}, squares{};
  double total = 0.0;
  for (const PixelPhase& point : points) {
    const auto bin = static_cast<std::size_t>(std::clamp((point.phase_px + 0.5) * kBins, 0.0, kBins - 1.0));
    n[bin] += 1.0;
    sum[bin] += point.error_px;
    squares[bin] += point.error_px * point.error_px;
    total += point.error_px * point.error_px;
  }
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    if (n[bin] < 2.0) continue;
    const double mean = sum[bin] / n[bin];
    const double sd = std::sqrt(std::max(0.0, squares[bin] / n[bin] - mean * mean) / (n[bin] - 1.0));
    means.rows.push_back({(static_cast<double>(bin) + 0.5) / kBins - 0.5, mean, sd});
  }
  const Harmonic harmonic = harmonic_of(points);
  const double reach = 3.5 * std::sqrt(total / static_cast<double>(points.size()));
  const std::vector<PlotData> data = {cloud, means};
  const std::string script =
      std::string(kFrame) + fmt::format(
                                "unset offsets\nset samples 200\nset xrange [-0.5:0.5]\nset yrange [{:.6g}:{:.6g}]\n"
                                "set xlabel 'centre within its pixel  (px)'\nset ylabel '{}  (px)'\nunset key\n"
                                "plot $cloud using 1:2 with points pt 7 ps 0.25 lc rgb '{}', "
                                "{:.8g} + {:.8g}*cos(2*pi*x) + {:.8g}*sin(2*pi*x) with lines lw 1.5 lc rgb '{}', "
                                "$means using 1:2:3 with yerrorbars pt 7 ps 0.6 lw 1.5 lc rgb '{}'",
                                -reach, reach, from_truth ? "measured − true" : "measured − smoothed", kGrey,
                                harmonic.mean, harmonic.cosine, harmonic.sine, color(1), color(0));
  return {{Drawing{script, data},
           fmt::format("Error of the marker's centre against its position within a pixel ({}), with means; a centre "
                       "biased towards whole pixels shows a wave (pixel locking). First harmonic: {} px",
                       from_truth ? "against the truth" : "against the smoothed motion",
                       base::value_and_sd_text(locking->amplitude_px, locking->sd_px)),
           "Error of the centre against the sub-pixel phase"}};
}

}  // namespace glidelab::report
