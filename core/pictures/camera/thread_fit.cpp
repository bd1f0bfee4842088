#include "core/pictures/camera/thread_fit.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

#include "base/math/dense.h"
#include "core/math/block_scatter.h"
#include "core/math/least_squares.h"
#include "core/math/quantile.h"
#include "core/pictures/image/pixel_signal.h"

namespace glidelab::core {
namespace {

enum Parameter { kShift, kTurn, kLogWidth, kLogBlur, kParameters };
using Vector = Eigen::Matrix<double, kParameters, 1>;

constexpr double kPriorSd = 1.5;  // of ln(width) and ln(blur)
constexpr std::size_t kFewestRowsToFit = 10;
constexpr int kMostIterations = 60;

struct Setting {
  double nu, nv;  // the thread's normal in the image
  double mean_row;
  double lever;     // rows; the turn is fitted as the shift at this distance from the mean row
  double width_px;  // first guess
  double noise2;    // of a pixel, for the priors' weight
};

/// One row's residuals with its own background and strength taken out, and their derivatives.
struct RowFit {
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
};

std::optional<RowFit> fit_row(const ThreadRow& row, const Setting& setting, const Vector& p) {
  const double arm = (row.row - setting.mean_row) / setting.lever;
  const double middle = row.middle + p[kShift] + p[kTurn] * arm;
  const double width = std::exp(p[kLogWidth]), blur = std::exp(p[kLogBlur]);
  const int reach = static_cast<int>(std::ceil(2.0 * setting.width_px + 5.0));
  const int from = std::max(0, static_cast<int>(std::lround(row.middle)) - reach);
  const int to = std::min(static_cast<int>(row.values.size()) - 1, static_cast<int>(std::lround(row.middle)) + reach);
  if (to - from < 7 || middle < from + 1 || middle > to - 1) return std::nullopt;
  const Eigen::Index count = to - from + 1;
  Eigen::MatrixXd design(count, 3);
  Eigen::VectorXd seen(count), by_shift(count), by_width(count), by_blur(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double d = static_cast<double>(from + i) - middle, s = d * setting.nu;
    const PixelEdge left = pixel_edge(s + 0.5 * width, setting.nu, setting.nv, blur);
    const PixelEdge right = pixel_edge(s - 0.5 * width, setting.nu, setting.nv, blur);
    design.row(i) << 1.0, d, (left.value - right.value) / width;
    by_shift[i] = -setting.nu * (left.slope - right.slope) / width;
    by_width[i] = 0.5 * (left.slope + right.slope) - design(i, 2);
    by_blur[i] = blur * blur * (left.bend - right.bend) / width;
    seen[i] = row.values[static_cast<std::size_t>(from + i)];
  }
  const Eigen::MatrixXd normal = base::transposed_product(design, design);
  const Eigen::Vector3d own = base::solve_positive(normal, base::transposed_product(design, seen));
  if (!own.allFinite()) return std::nullopt;
  Eigen::MatrixXd jacobian(count, static_cast<Eigen::Index>(kParameters));
  jacobian << own[2] * by_shift, own[2] * arm * by_shift, own[2] * by_width, own[2] * by_blur;
  RowFit fit;
  fit.residual = base::product(design, own) - seen;
  fit.jacobian =
      jacobian - base::product(design, base::solve_positive(normal, base::transposed_product(design, jacobian)));
  return fit;
}

std::optional<NormalEquations<kParameters>> evaluate(const std::vector<ThreadRow>& rows, const Setting& setting,
                                                     const Vector& p) {
  const double width = std::exp(p[kLogWidth]), blur = std::exp(p[kLogBlur]);
  if (!(width > 0.05) || width > 30.0 || !(blur > 0.02) || blur > 6.0) return std::nullopt;
  NormalEquations<kParameters> equations;
  for (const ThreadRow& row : rows) {
    const auto fit = fit_row(row, setting, p);
    if (!fit) return std::nullopt;
    for (Eigen::Index i = 0; i < fit->residual.size(); ++i) {
      equations.add(fit->jacobian.row(i).transpose(), fit->residual[i], 1.0);
    }
  }
  // A width below the blur, and a blur below the pixel, can hardly be seen.
  for (const auto& [parameter, usual] : {std::pair{kLogWidth, setting.width_px}, std::pair{kLogBlur, 0.4}}) {
    Vector jacobian = Vector::Zero();
    jacobian[parameter] = 1.0 / kPriorSd;
    equations.add(jacobian, (p[parameter] - std::log(usual)) / kPriorSd, setting.noise2);
  }
  return equations;
}

LeastSquaresFit<kParameters> fit_from(const std::vector<ThreadRow>& rows, const Setting& setting, const Vector& start) {
  Vector step;
  step << 1e-4, 1e-4, 1e-3, 1e-2;
  return fit_least_squares<kParameters>([&](const Vector& p) { return evaluate(rows, setting, p); }, start, step,
                                        kMostIterations);
}

/// The best of several starts: width and blur make two valleys if the thread is sharp.
std::optional<LeastSquaresFit<kParameters>> fit_best(const std::vector<ThreadRow>& rows, const Setting& setting) {
  std::optional<LeastSquaresFit<kParameters>> best;
  for (const double blur : {0.12, 0.4, 1.0}) {
    Vector start;
    start << 0.0, 0.0, std::log(setting.width_px), std::log(blur);
    const auto found = fit_from(rows, setting, start);
    // The iteration may follow a valley along width or blur for long; the shift and the turn converge earlier.
    if (found.stop == base::FitStop::singular || found.stop == base::FitStop::out_of_range) continue;
    if (!(found.rms > 0.0) || (best && best->rms <= found.rms)) continue;
    best = found;
  }
  return best;
}

/// Variance of the turn by blocks of rows, over what independent pixels give (block_scatter.h).
double excess_of_blocks(const std::vector<ThreadRow>& rows, const Setting& setting,
                        const LeastSquaresFit<kParameters>& found) {
  const Vector gain = found.covariance.row(kTurn).transpose() / (found.rms * found.rms);
  const double scatter = scatter_of_blocks(rows.size(), [&](std::size_t k) {
    const auto fit = fit_row(rows[k], setting, found.parameters);
    return fit ? gain.dot(Vector(base::transposed_product(fit->jacobian, fit->residual))) : 0.0;
  });
  return excess_over_independent(scatter, found.covariance(kTurn, kTurn));
}

}  // namespace

std::optional<ThreadFit> fit_thread(const std::vector<ThreadRow>& all, double slant, double width_px) {
  if (all.size() < kFewestRowsToFit) return std::nullopt;
  const double length = std::hypot(1.0, slant);
  Setting setting{1.0 / length, -slant / length, 0.0, 1.0, std::max(width_px, 1.0), 1.0};
  std::vector<ThreadRow> rows = all;
  std::optional<LeastSquaresFit<kParameters>> found;
  ThreadFit fit;
  for (int pass = 0; pass < 2; ++pass) {
    setting.mean_row = 0.0;
    for (const ThreadRow& row : rows) setting.mean_row += row.row / static_cast<double>(rows.size());
    double lever2 = 0.0;
    for (const ThreadRow& row : rows) lever2 += std::pow(row.row - setting.mean_row, 2);
    setting.lever = std::sqrt(std::max(lever2 / static_cast<double>(rows.size()), 1e-12));
    found = fit_best(rows, setting);
    if (!found) return std::nullopt;
    setting.noise2 = found->rms * found->rms;
    if (pass == 1) break;
    std::vector<double> costs;
    for (const ThreadRow& row : rows) {
      const auto own = fit_row(row, setting, found->parameters);
      costs.push_back(own ? own->residual.squaredNorm() : 1e300);
    }
    const double limit = 16.0 * median_of(costs);
    std::vector<ThreadRow> kept;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (costs[k] <= limit) kept.push_back(rows[k]);
    }
    if (kept.size() < std::max(kFewestRowsToFit, rows.size() / 2)) return std::nullopt;
    rows = kept;
  }
  const double excess = excess_of_blocks(rows, setting, *found);
  fit.shift = found->parameters[kShift];
  fit.turn = found->parameters[kTurn] / setting.lever;
  fit.mean_row = setting.mean_row;
  fit.sd_turn = std::sqrt(found->covariance(kTurn, kTurn) * excess) / setting.lever;
  fit.width_px = std::exp(found->parameters[kLogWidth]);
  fit.blur_px = std::exp(found->parameters[kLogBlur]);
  fit.rows = rows.size();
  return fit;
}

}  // namespace glidelab::core
