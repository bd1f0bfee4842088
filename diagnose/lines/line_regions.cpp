#include "diagnose/lines/line_regions.h"

#include <algorithm>
#include <cmath>

#include "base/math/dense.h"
#include "diagnose/effects/effect_library.h"

namespace glidelab::diagnose {
namespace {

constexpr double kOff = 3.0;  // standard deviations
constexpr int kPoints = 60;   // of a curve

/// The projection that leaves what the columns do not explain.
Eigen::MatrixXd leaves(const Eigen::MatrixXd& columns) {
  const auto n = columns.rows();
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(n, n);
  return unit - base::product(columns, base::least_squares(columns, unit));
}

struct Mean {
  double value = 0.0, sd = 0.0;
};

Mean mean_of(const Eigen::VectorXd& residual, const Eigen::MatrixXd& leaving, const Eigen::VectorXd& group,
             double scatter) {
  const Eigen::VectorXd w = group / group.sum();
  return {w.dot(residual), scatter * std::sqrt(std::max(0.0, w.dot(base::product(leaving, w).col(0))))};
}

double drag_of(const std::vector<TableLine>& lines) {
  double sum = 0.0;
  for (const TableLine& line : lines) sum += std::log(line.k_over_m_1_s * line.mass_kg);
  return std::exp(sum / static_cast<double>(lines.size()));
}

}  // namespace

std::vector<GapRegion> line_regions(const std::vector<TableLine>& lines, const LineData& data,
                                    const LineSolution& nominal, const OwnScatter& scatter) {
  std::vector<GapRegion> regions;
  if (!scatter.known()) return regions;
  const Eigen::MatrixXd leaves_a = leaves(data.base_a0), leaves_k = leaves(data.base_log_k);
  const double drag = drag_of(lines);
  const auto look = [&](const std::string& variable, double TableLine::*member, double value, int direction) {
    Eigen::VectorXd group(data.a0.size());
    for (Eigen::Index i = 0; i < group.size(); ++i) {
      const TableLine& line = lines[static_cast<std::size_t>(i)];
      group[i] = line.*member == value && (direction == 0 || line.direction == direction) ? 1.0 : 0.0;
    }
    if (!(group.sum() > 0.0)) return;
    const bool slopes = direction == 0;
    const Mean mean = slopes ? mean_of(nominal.off_k, leaves_k, group, scatter.slope)
                             : mean_of(nominal.off_a, leaves_a, group, scatter.intercept_m_s2);
    if (!(mean.sd > 0.0) || std::abs(mean.value) < kOff * mean.sd) return;
    GapRegion region{variable, value, value, std::abs(mean.value) / mean.sd, mean.value, "m/s²", "intercept", ""};
    region.size_sd = mean.sd;
    region.direction = direction;
    if (slopes) {
      region.what = "drag";
      region.unit = "N s/m";
      region.size *= drag;
      *region.size_sd *= drag;
    }
    regions.push_back(region);
  };
  for (const int direction : {-1, 1, 0}) {
    for (const double mass : different(lines, &TableLine::mass_kg)) {
      look("mass_kg", &TableLine::mass_kg, mass, direction);
    }
    for (const double incline : different(lines, &TableLine::incline_deg)) {
      look("group", &TableLine::incline_deg, incline, direction);
    }
  }
  std::stable_sort(regions.begin(), regions.end(),
                   [](const GapRegion& a, const GapRegion& b) { return a.excess > b.excess; });
  return regions;
}

std::vector<LineOff> lines_off(const std::vector<TableLine>& lines, const LineSolution& nominal) {
  std::vector<LineOff> off;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const TableLine& line = lines[i];
    const auto at = static_cast<Eigen::Index>(i);
    off.push_back({line.mass_kg, line.incline_deg, line.direction, line.k_over_m_1_s,
                   -line.direction * nominal.off_a[at], nominal.off_k[at]});
  }
  return off;
}

LineCurve line_curve(const std::vector<TableLine>& lines, const LineData& data, const LineTerm& term,
                     const LineSolution& with) {
  LineCurve curve{term.id, {}, {}, {}};
  const bool force = term.id == ids::load_independent_friction;
  if (!force && term.id != ids::smoothing_bias) return curve;
  // What the term takes from mu goes with it: the part of its column that the usual model would have fitted.
  const Eigen::VectorXd fitted = base::least_squares(data.base_a0, term.of_a0).col(0);
  const double taken = fitted[fitted.size() - 1] * -data.base_a0.col(data.base_a0.cols() - 1).cwiseAbs().mean();
  const std::vector<double> masses = different(lines, &TableLine::mass_kg);
  const double drag = drag_of(lines), from = 1.0 / masses.back(), to = 1.0 / masses.front();
  for (int i = 0; i <= kPoints; ++i) {
    const double mass = 1.0 / (from + (to - from) * (1.1 * i / kPoints - 0.05));
    const double k = drag / mass, column = force ? 1.0 / mass : k * k;
    curve.mass_kg.push_back(mass);
    curve.k_over_m_1_s.push_back(k);
    curve.friction_m_s2.push_back(with.size[0] * (column + taken));
  }
  return curve;
}

}  // namespace glidelab::diagnose
