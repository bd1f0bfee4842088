#include "core/pictures/image/edge_response.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "base/math/dense.h"

namespace glidelab::core {
namespace {

constexpr std::array kNarrower_px2{0.0, 0.15, 0.3};
constexpr int kLearningRounds = 3;       // the terms settle to a hundredth
constexpr double kFewestPixels = 300.0;  // beyond the windows' own parameters
constexpr std::size_t kFolds = 8, kFewestWindows = 8;
constexpr double kMostCurvature = 1.0;      // E + t E (1 - E) falls nowhere: a tone that falls is none
constexpr double kGainSd = 3.0;             // gain of the squares in windows that did not teach the terms
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

constexpr Eigen::Index kShapes = EdgeResponse::kTerms, kAll = kShapes + 1;
using Products = Eigen::Matrix<double, kAll, kAll>;

/// The squares and products of a window's terms, and of its residuals in the last place, with each pixel times `scale`:
/// the part that the window's own parameters do not absorb (the Schur complement).
Products products_of(const FittedWindow& window, const Columns& columns, const Eigen::VectorXd& scale) {
  const Eigen::Index own = window.jacobian.cols();
  Eigen::MatrixXd all(window.jacobian.rows(), own + kAll);
  all << window.jacobian, columns.terms, window.light - columns.sharp;
  all = (window.weight.cwiseSqrt().cwiseProduct(scale)).asDiagonal() * all;
  const Eigen::VectorXd size = all.leftCols(own).colwise().norm().transpose().cwiseMax(1e-300);
  all.leftCols(own) *= size.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd products = base::transposed_product(all, all);
  const Eigen::MatrixXd across = products.topRightCorner(own, kAll);
  return products.bottomRightCorner(kAll, kAll) -
         base::transposed_product(across, base::solve_positive(products.topLeftCorner(own, own), across));
}

double freedom_of(const FittedWindow& window) {
  return window.weight.sum() - static_cast<double>(window.jacobian.cols());
}

Eigen::VectorXd by_contrast(const FittedWindow& window) {
  return Eigen::VectorXd::Constant(window.light.size(), 1.0 / window.contrast);
}

/// What a residual of a pixel is worth as a share of the largest code.
Eigen::VectorXd codes_per_light(const FittedWindow& window, ToneCurve tone) {
  const auto slope = [&](double model) {
    constexpr double kStep = 1e-4;  // of full light: far below a code at 8 bits
    const double light = std::clamp((window.inverse ? window.full - model : model) / window.full, kStep, 1.0 - kStep);
    return (code_of_light(tone, light + kStep) - code_of_light(tone, light - kStep)) / (2.0 * kStep * window.full);
  };
  return window.model.unaryExpr(slope);
}

/// Held at the terms of the round before: well determined terms converge, poorly determined ones stay.
EdgeResponse::Terms terms_of(const Products& sum, const EdgeResponse::Terms& before) {
  Eigen::MatrixXd held = sum.topLeftCorner(kShapes, kShapes);
  const double weight = kRidge * held.diagonal().maxCoeff();
  held.diagonal().array() += weight;
  return base::solve_positive(held, sum.topRightCorner(kShapes, 1) + weight * before);
}

/// The sum of squares that these terms leave.
double left_by(const EdgeResponse::Terms& terms, const Products& products) {
  Eigen::Matrix<double, kAll, 1> with;
  with << -terms, 1.0;
  return with.dot(products * with);
}

/// The products of the windows, one by one (empty where a fit failed), and their sum.
struct Shown {
  std::vector<std::optional<Products>> windows;
  Products sum = Products::Zero();
  void add(std::size_t window, const Products& products) {
    windows[window] = products;
    sum += products;
  }
};

/// The response with one of the reductions of the blur.
struct Candidate {
  EdgeResponse response;
  double left = 0.0;  // sum of the residuals' squares, over the contrast's
};

/// What the windows show that are fitted as they are.
struct Learnt {
  std::vector<Candidate> candidates;  // in order of what they leave
  double plain = 0.0;                 // what is left without a response
  bool told = false;                  // whether the response of some windows foretells the residuals of others
  Shown in_codes;
};

/// Whether a sum of what windows gain is beyond chance, by the scatter from window to window: neither the size of the
/// noise nor its correlation within a window matters.
bool is_beyond_chance(const std::vector<double>& gains) {
  const auto count = static_cast<double>(gains.size());
  if (gains.size() < kFewestWindows) return false;
  double sum = 0.0, squares = 0.0;
  for (const double gain : gains) {
    sum += gain;
    squares += gain * gain;
  }
  return sum > 0.0 && sum * sum > kGainSd * kGainSd * (squares - sum * sum / count) * count / (count - 1.0);
}

/// Whether terms from some windows reduce the residuals of the others. Where there is no response, terms that are made
/// of noise add to them.
bool foretells(const Shown& plain, const Shown& shown) {
  std::array<Products, kFolds> rest;
  rest.fill(shown.sum);
  const std::size_t count = shown.windows.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (shown.windows[i]) rest[i % kFolds] -= *shown.windows[i];
  }
  std::array<EdgeResponse::Terms, kFolds> terms;
  for (std::size_t fold = 0; fold < kFolds; ++fold) terms[fold] = terms_of(rest[fold], EdgeResponse::Terms::Zero());
  std::vector<double> gains;
  for (std::size_t i = 0; i < count; ++i) {
    if (!shown.windows[i]) continue;
    gains.push_back((*plain.windows[i])(kShapes, kShapes) - left_by(terms[i % kFolds], *shown.windows[i]));
  }
  return is_beyond_chance(gains);
}

/// Empty if too few pixels are fitted.
std::optional<Learnt> learn(std::size_t windows, ToneCurve tone, const FitWindow& fit) {
  std::array<Shown, kNarrower_px2.size()> shown, in_codes;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    shown[k].windows.resize(windows);
    in_codes[k].windows.resize(windows);
  }
  double freedom = 0.0;
  for (std::size_t i = 0; i < windows; ++i) {
    const std::optional<FittedWindow> window = fit(i, tone, nullptr);
    if (!window) continue;
    freedom += freedom_of(*window);
    const Eigen::VectorXd as_codes = codes_per_light(*window, tone);
    for (std::size_t k = 0; k < shown.size(); ++k) {
      const Columns columns = columns_of(*window, kNarrower_px2[k]);
      shown[k].add(i, products_of(*window, columns, by_contrast(*window)));
      in_codes[k].add(i, products_of(*window, columns, as_codes));
    }
  }
  if (!(freedom > kFewestPixels)) return std::nullopt;
  std::array<std::size_t, kNarrower_px2.size()> order{};
  std::array<Candidate, kNarrower_px2.size()> found;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const EdgeResponse::Terms terms = terms_of(shown[k].sum, EdgeResponse::Terms::Zero());
    found[k] = {{terms, kNarrower_px2[k], tone}, left_by(terms, shown[k].sum)};
    order[k] = k;
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return found[k].left; });
  Learnt learnt;
  for (const std::size_t k : order) learnt.candidates.push_back(found[k]);
  learnt.plain = shown.front().sum(kShapes, kShapes);
  learnt.told = foretells(shown.front(), shown[order.front()]);
  learnt.in_codes = std::move(in_codes[order.front()]);
  return learnt;
}

/// The next round: the windows are fitted with the response that is known, and the best of the reductions of the blur
/// is taken. Empty if too few pixels are fitted.
std::optional<Candidate> learn_again(std::size_t windows, const EdgeResponse& known,
                                     std::span<const double> narrower_px2, const FitWindow& fit) {
  std::vector<Products> sums(narrower_px2.size(), Products::Zero());
  double freedom = 0.0;
  bool within = false;  // the model has the response in it, and its blur is that of I
  for (std::size_t i = 0; i < windows; ++i) {
    const std::optional<FittedWindow> window = fit(i, known.tone, &known);
    if (!window) continue;
    freedom += freedom_of(*window);
    within = !window->bright.empty();
    for (std::size_t k = 0; k < (within ? 1 : sums.size()); ++k) {
      const Columns columns = columns_of(*window, within ? 0.0 : narrower_px2[k]);
      sums[k] += products_of(*window, columns, by_contrast(*window));
    }
  }
  if (!(freedom > kFewestPixels)) return std::nullopt;
  std::optional<Candidate> best;
  for (std::size_t k = 0; k < (within ? 1 : sums.size()); ++k) {
    const EdgeResponse::Terms terms = terms_of(sums[k], known.terms);
    const double left = left_by(terms, sums[k]);
    if (!best || left < best->left) best = Candidate{{terms, within ? 0.0 : narrower_px2[k], known.tone}, left};
  }
  return best;
}

/// The response after the last round. Terms that do to an edge what its blur does (w) may grow from round to round,
/// until they leave more than no response does; and a marker smeared by its motion has edges that no curve makes. Then
/// there is none.
std::optional<EdgeResponse> settled(const Candidate& first, double plain, std::size_t windows,
                                    std::span<const double> narrower_px2, const FitWindow& fit) {
  Candidate last = first;
  for (int round = 1; round < kLearningRounds; ++round) {
    const std::optional<Candidate> next = learn_again(windows, last.response, narrower_px2, fit);
    if (!next || !(next->left < plain)) return std::nullopt;
    last = *next;
  }
  if (std::abs(last.response.curvature()) > kMostCurvature) return std::nullopt;
  return last.response;
}

/// Whether the light by a curve is the better description: what both leave is compared in codes, window by window, or
/// it makes the edges' curvature go.
bool is_straighter(const Learnt& light, const Learnt& codes) {
  const EdgeResponse::Terms none = EdgeResponse::Terms::Zero(), by_light = terms_of(light.in_codes.sum, none),
                            by_codes = terms_of(codes.in_codes.sum, none);
  std::vector<double> gains;
  for (std::size_t i = 0; i < codes.in_codes.windows.size(); ++i) {
    if (!light.in_codes.windows[i] || !codes.in_codes.windows[i]) continue;
    gains.push_back(left_by(by_codes, *codes.in_codes.windows[i]) - left_by(by_light, *light.in_codes.windows[i]));
  }
  if (is_beyond_chance(gains)) return true;
  const double curved = std::abs(codes.candidates.front().response.curvature());
  return curved > kLeastCurvature &&
         std::abs(light.candidates.front().response.curvature()) < kMostCurvatureLeft * curved;
}

}  // namespace

Eigen::VectorXd added_by(const EdgeResponse& response, const FittedWindow& window) {
  const Columns columns = columns_of(window, response.narrower_px2);
  return columns.sharp + columns.terms * response.terms - window.model;
}

std::optional<EdgeResponse> edge_response_of(std::size_t windows, bool may_be_curved, const FitWindow& fit) {
  const std::optional<Learnt> codes = learn(windows, ToneCurve::linear, fit);
  if (!codes || !codes->told) return std::nullopt;
  const std::optional<Learnt> light = may_be_curved ? learn(windows, ToneCurve::srgb, fit) : std::nullopt;
  const Learnt& better = light && is_straighter(*light, *codes) ? *light : *codes;
  const auto from = [&](const Candidate& first, std::span<const double> narrower_px2) {
    return settled(first, better.plain, windows, narrower_px2, fit);
  };
  if (std::optional<EdgeResponse> found = from(better.candidates.front(), kNarrower_px2)) return found;
  for (const Candidate& candidate : better.candidates) {  // each with the one reduction of the blur
    if (std::optional<EdgeResponse> found = from(candidate, std::span(&candidate.response.narrower_px2, 1)))
      return found;
  }
  return std::nullopt;
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
