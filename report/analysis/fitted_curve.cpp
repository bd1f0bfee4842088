#include "report/analysis/fitted_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/text/number_text.h"
#include "report/analysis/motion_plots.h"
#include "report/text/display_text.h"

namespace glidelab::report {
namespace {

constexpr std::size_t kLeastPositions = 4;
constexpr std::size_t kDrawn = 250;  // per clip; more only makes the page heavy

struct Law {
  double k_1_s = 0.0, a0_m_s2 = 0.0;
};

std::optional<Law> law_of(const core::ConfigurationResult& of, int direction, double gravity_m_s2) {
  if (of.k_over_m_1_s.estimate && of.mu.estimate && of.alpha_deg.estimate) {
    const double alpha = of.alpha_deg.estimate->value * std::numbers::pi / 180.0;
    return Law{of.k_over_m_1_s.estimate->value,
               gravity_m_s2 * (std::sin(alpha) - direction * of.mu.estimate->value * std::cos(alpha))};
  }
  const core::LineFit* const line = line_of(of.lines, direction);
  if (line == nullptr) return std::nullopt;
  return Law{line->k_over_m_1_s.value, line->a0_m_s2.value};
}

/// phi and psi as defined at the top of fitted_curve.h; computed by their series if k t is so small that they cancel
/// (to 1e-12).
struct Shape {
  double phi, psi;
};
Shape shape_at(double k, double t) {
  const double kt = k * t;
  if (std::abs(kt) < 1e-3) {
    return {t * (1.0 - kt / 2.0 + kt * kt / 6.0 - kt * kt * kt / 24.0),
            t * t * (0.5 - kt / 6.0 + kt * kt / 24.0 - kt * kt * kt / 120.0)};
  }
  const double phi = -std::expm1(-kt) / k;
  return {phi, (t - phi) / k};
}

/// Fits x0 and v0 and stores the law's positions in the curve.
bool fit_start(const Law& law, const std::vector<double>& measured_m, FittedCurve& curve) {
  double n = 0.0, p = 0.0, pp = 0.0, y = 0.0, py = 0.0;
  std::vector<Shape> shapes;
  for (std::size_t i = 0; i < curve.t_s.size(); ++i) {
    const Shape shape = shape_at(law.k_1_s, curve.t_s[i] - curve.t_s.front());
    const double rest = measured_m[i] - law.a0_m_s2 * shape.psi;
    shapes.push_back(shape);
    n += 1.0;
    p += shape.phi;
    pp += shape.phi * shape.phi;
    y += rest;
    py += shape.phi * rest;
  }
  const double determinant = n * pp - p * p;
  if (!(determinant > 0.0)) return false;
  const double x0 = (pp * y - p * py) / determinant, v0 = (n * py - p * y) / determinant;
  double square = 0.0;
  for (std::size_t i = 0; i < curve.t_s.size(); ++i) {
    curve.x_m.push_back(x0 + v0 * shapes[i].phi + law.a0_m_s2 * shapes[i].psi);
    square += std::pow(measured_m[i] - curve.x_m.back(), 2);
  }
  curve.rms_m = std::sqrt(square / n);
  return std::isfinite(curve.rms_m);
}

const core::ConfigurationResult* configuration_of(const core::AnalysisResults& results, const core::ClipResult& clip) {
  for (const core::ConfigurationResult& configuration : results.configurations) {
    const std::vector<std::string>& clips = configuration.clips;
    if (std::find(clips.begin(), clips.end(), clip.name) != clips.end()) return &configuration;
  }
  return nullptr;
}

bool is_used(const core::MotionPoint& point) {
  return point.measured_m && point.left_out == core::LeftOut::used;
}

Plot fitted_plot(const core::ClipResult& clip, const std::vector<FittedCurve>& curves) {
  PlotData used{"used", {}, {"t (s)", "x (m)"}}, others{"others", {}, {"t (s)", "x (m), not used"}};
  PlotData law{"law", {}, {"t (s)", "x by the law (m)"}};
  const std::size_t step = std::max<std::size_t>(1, clip.motion.size() / kDrawn);
  for (std::size_t i = 0; i < clip.motion.size(); i += step) {
    const core::MotionPoint& point = clip.motion[i];
    if (point.measured_m) (is_used(point) ? used : others).rows.push_back({point.t_s, *point.measured_m});
  }
  double square = 0.0, count = 0.0;
  for (const FittedCurve& curve : curves) {
    for (const std::size_t i : every_nth(curve.t_s.size(), kDrawn)) law.rows.push_back({curve.t_s[i], curve.x_m[i]});
    law.rows.emplace_back();
    const auto n = static_cast<double>(curve.t_s.size());
    square += n * curve.rms_m * curve.rms_m;
    count += n;
  }
  std::string script(kFrame);
  script += "set autoscale xfix\nset xlabel 't  (s)'\nset ylabel 'x  (m)'\n";
  script += fmt::format(
      "plot $others using 1:2 with points pt 7 ps 0.3 lc rgb '{}' title 'left out', $used using 1:2 with points pt 7 "
      "ps 0.4 lc rgb '{}' title 'measured', $law using 1:2 with lines lw 2 lc rgb '{}' title 'fitted law'",
      kGrey, kColors[4], kColors[1]);
  return {
      Drawing{script, {never_empty(used), never_empty(others), never_empty(law)}},
      fmt::format("{}: x(t) with K/m, µ and α of the table, and the measured positions, which lie {} (rms) from it; "
                  "their noise is {}",
                  clip.name, base::size_text(std::sqrt(square / count), 2, "m"),
                  base::size_text(clip.position_noise_m, 2, "m")),
      fmt::format("Measured positions and fitted law of clip {}", clip.name)};
}

}  // namespace

std::vector<FittedCurve> fitted_curves(const core::ClipResult& clip, const core::ConfigurationResult& configuration,
                                       double gravity_m_s2) {
  std::vector<FittedCurve> curves;
  if (clip.forced || clip.speed_noise_m_s) return curves;
  for (const core::Stretch& stretch : clip.stretches) {
    const std::optional<Law> law = law_of(configuration, stretch.direction, gravity_m_s2);
    if (!law) continue;
    FittedCurve curve;
    std::vector<double> measured_m;
    for (const core::MotionPoint& point : clip.motion) {
      if (point.t_s < stretch.from_s || point.t_s > stretch.to_s || !is_used(point)) continue;
      curve.t_s.push_back(point.t_s);
      measured_m.push_back(*point.measured_m);
    }
    if (curve.t_s.size() >= kLeastPositions && fit_start(*law, measured_m, curve)) curves.push_back(std::move(curve));
  }
  return curves;
}

std::vector<Plot> fitted_plots(const core::AnalysisResults& results, std::size_t most) {
  std::vector<Plot> plots;
  for (const core::ClipResult& clip : results.clips) {
    if (plots.size() == most) break;
    const core::ConfigurationResult* const configuration = configuration_of(results, clip);
    if (configuration == nullptr) continue;
    const std::vector<FittedCurve> curves = fitted_curves(clip, *configuration, results.gravity_m_s2);
    if (!curves.empty()) plots.push_back(fitted_plot(clip, curves));
  }
  return plots;
}

}  // namespace glidelab::report
