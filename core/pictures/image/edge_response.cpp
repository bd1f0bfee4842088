#include "core/pictures/image/edge_response.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/math/dense.h"

namespace glidelab::core {
namespace {

constexpr std::array kNarrower_px2{0.0, 0.15, 0.3};
constexpr int kLearningRounds = 3;          // the terms settle to a hundredth
constexpr double kFewestPixels = 300.0;     // beyond the windows' own parameters
constexpr double kMostLeft = 0.93;          // of the residuals' squares: noise alone leaves 1 - 13 / pixels
constexpr double kMostLeftByCurve = 0.7;    // left by the curve's light: the noise of bright pixels weighs other there
constexpr double kLeastCurvature = 0.2;     // t of codes that follow a curve: 0.3 to 0.5 for BT.709
constexpr double kMostCurvatureLeft = 0.5;  // of that, left by the curve's light
constexpr double kRidge = 1e-3;             // of the best seen term: what the windows hardly show stays out

/// The terms with which a window's light is compared.
struct Columns {
  Eigen::VectorXd sharp;                                              // I
  Eigen::Matrix<double, Eigen::Dynamic, EdgeResponse::kTerms> terms;  // by which each term is multiplied
};

Columns columns_of(const FittedWindow& window, double narrower_px2) {
  cv::Point first = window.pixels.front(), last = first;
  for (const cv::Point& pixel : window.pixels) {
    first = {std::min(first.x, pixel.x), std::min(first.y, pixel.y)};
    last = {std::max(last.x, pixel.x), std::max(last.y, pixel.y)};
  }
  first -= cv::Point(1, 1);
  const int width = last.x - first.x + 2, height = last.y - first.y + 2;
  std::vector<ModelPixel> seen(static_cast<std::size_t>(width) * static_cast<std::size_t>(height),
                               {std::numeric_limits<double>::quiet_NaN(), 0.0});
  const auto at = [&](cv::Point pixel) -> const ModelPixel& {
    ModelPixel& known = seen[static_cast<std::size_t>(pixel.y - first.y) * static_cast<std::size_t>(width) +
                             static_cast<std::size_t>(pixel.x - first.x)];
    if (std::isnan(known.light)) known = window.at(pixel, narrower_px2);
    return known;
  };
  const auto count = static_cast<Eigen::Index>(window.pixels.size());
  Columns columns;
  columns.sharp.resize(count);
  columns.terms.setZero(count, EdgeResponse::kTerms);
  for (Eigen::Index i = 0; i < count; ++i) {
    const cv::Point here = window.pixels[static_cast<std::size_t>(i)];
    const auto light = [&](int u, int v) { return at(here + cv::Point(u, v)).light; };
    const ModelPixel middle = at(here);
    const int place = 2 * (here.y & 1) + (here.x & 1);
    auto mask = columns.terms.row(i).segment<EdgeResponse::kMaskTerms>(EdgeResponse::kMaskTerms * place);
    mask[0] = 0.5 * (light(-1, 0) + light(1, 0)) - middle.light;
    mask[1] = 0.5 * (light(0, -1) + light(0, 1)) - middle.light;
    mask[2] = 0.25 * (light(-1, -1) + light(1, -1) + light(-1, 1) + light(1, 1)) - middle.light;
    const double bright = window.bright.empty() ? middle.bright : window.bright[static_cast<std::size_t>(i)];
    const double bend = window.contrast * bright * (1.0 - bright);
    columns.terms(i, EdgeResponse::kCurvature) = bend;
    columns.terms(i, EdgeResponse::kTwist) = bend * (2.0 * bright - 1.0);
    columns.sharp[i] = middle.light;
  }
  return columns;
}

/// Sums over windows from which the terms follow; each window's own parameters are fitted with them.
class Sums {
 public:
  void add(const FittedWindow& window, const Columns& columns) {
    const Eigen::Index own = window.jacobian.cols();
    Eigen::MatrixXd all(window.jacobian.rows(), own + kAll);
    all << window.jacobian, columns.terms, window.light - columns.sharp;
    all = (window.weight.cwiseSqrt() / window.contrast).asDiagonal() * all;
    weight_ += window.weight.sum() - static_cast<double>(own);
    const Eigen::VectorXd size = all.leftCols(own).colwise().norm().transpose().cwiseMax(1e-300);
    all.leftCols(own) *= size.cwiseInverse().asDiagonal();
    // The part that the window's own parameters do not absorb: the Schur complement.
    const Eigen::MatrixXd products = base::transposed_product(all, all);
    const Eigen::MatrixXd across = products.topRightCorner(own, kAll);
    products_ += products.bottomRightCorner(kAll, kAll) -
                 base::transposed_product(across, base::solve_positive(products.topLeftCorner(own, own), across));
  }
  /// Held at the terms of the round before: well determined terms converge, poorly determined ones stay.
  EdgeResponse::Terms terms(const EdgeResponse::Terms& before) const {
    Eigen::MatrixXd held = products_.topLeftCorner(kTerms, kTerms);
    const double weight = kRidge * held.diagonal().maxCoeff();
    held.diagonal().array() += weight;
    return base::solve_positive(held, products_.topRightCorner(kTerms, 1) + weight * before);
  }
  /// The sum of squares with the terms.
  double left(const EdgeResponse::Terms& before) const {
    Eigen::VectorXd with(kAll);
    with << -terms(before), 1.0;
    return with.dot(products_ * with);
  }
  double weight() const { return weight_; }

 private:
  static constexpr Eigen::Index kTerms = EdgeResponse::kTerms, kAll = kTerms + 1;
  Eigen::MatrixXd products_ = Eigen::MatrixXd::Zero(kAll, kAll);
  double weight_ = 0.0;
};

struct Learnt {
  EdgeResponse response;
  double left = 0.0;   // sum of the residuals' squares, over the contrast's
  double plain = 0.0;  // the same for the fits without a response
};

std::optional<Learnt> learn(std::size_t windows, ToneCurve tone, const EdgeResponse* known, const FitWindow& fit) {
  std::array<Sums, kNarrower_px2.size()> sums;
  Learnt learnt;
  for (std::size_t i = 0; i < windows; ++i) {
    const std::optional<FittedWindow> window = fit(i, tone, known);
    if (!window) continue;
    const Eigen::VectorXd rest = (window->light - window->model) / window->contrast;
    learnt.plain += rest.cwiseAbs2().dot(window->weight);
    if (window->bright.empty()) {
      for (std::size_t k = 0; k < sums.size(); ++k) sums[k].add(*window, columns_of(*window, kNarrower_px2[k]));
    } else {
      sums.front().add(*window, columns_of(*window, 0.0));
    }
  }
  const EdgeResponse::Terms before = known != nullptr ? known->terms : EdgeResponse::Terms(EdgeResponse::Terms::Zero());
  std::size_t best = 0;
  for (std::size_t k = 1; k < sums.size(); ++k) {
    if (sums[k].weight() > 0.0 && sums[k].left(before) < sums[best].left(before)) best = k;
  }
  if (!(sums[best].weight() > kFewestPixels)) return std::nullopt;
  learnt.response = {sums[best].terms(before), kNarrower_px2[best], tone};
  learnt.left = sums[best].left(before);
  return learnt;
}

/// Whether the light by a curve is the better description.
bool is_straighter(const Learnt& light, const Learnt& codes) {
  const double curved = std::abs(codes.response.curvature());
  return light.left < kMostLeftByCurve * codes.left ||
         (curved > kLeastCurvature && std::abs(light.response.curvature()) < kMostCurvatureLeft * curved);
}

}  // namespace

Eigen::VectorXd added_by(const EdgeResponse& response, const FittedWindow& window) {
  const Columns columns = columns_of(window, response.narrower_px2);
  return columns.sharp + columns.terms * response.terms - window.model;
}

std::optional<EdgeResponse> edge_response_of(std::size_t windows, bool may_be_curved, const FitWindow& fit) {
  std::optional<Learnt> best = learn(windows, ToneCurve::linear, nullptr, fit);
  if (!best || !(best->left < kMostLeft * best->plain)) return std::nullopt;
  if (may_be_curved) {
    std::optional<Learnt> light = learn(windows, ToneCurve::srgb, nullptr, fit);
    if (light && is_straighter(*light, *best)) best = std::move(light);
  }
  for (int round = 1; round < kLearningRounds; ++round) {
    const EdgeResponse known = best->response;
    best = learn(windows, known.tone, &known, fit);
    if (!best) return std::nullopt;
  }
  return best->response;
}

cv::Mat light_of(const cv::Mat& codes, ToneCurve tone) {
  if (tone == ToneCurve::linear) return codes;
  const auto of_share = [&](double code) {
    constexpr double kFullLight = 65535.0;
    return cv::saturate_cast<unsigned short>(kFullLight * light_of_code(tone, code));
  };
  cv::Mat light(codes.size(), CV_16U);
  if (codes.depth() == CV_8U) {
    std::array<unsigned short, 256> table{};
    for (std::size_t code = 0; code < table.size(); ++code) table[code] = of_share(static_cast<double>(code) / 255.0);
    for (int v = 0; v < light.rows; ++v) {
      const auto* const from = codes.ptr<unsigned char>(v);
      std::transform(from, from + light.cols, light.ptr<unsigned short>(v),
                     [&](unsigned char code) { return table[code]; });
    }
    return light;
  }
  for (int v = 0; v < light.rows; ++v) {
    const auto* const from = codes.ptr<unsigned short>(v);
    std::transform(from, from + light.cols, light.ptr<unsigned short>(v),
                   [&](unsigned short code) { return of_share(code / 65535.0); });
  }
  return light;
}

}  // namespace glidelab::core
