#include "core/math/least_squares.h"

#include <Eigen/LU>

#include <cmath>
#include <vector>

#include "tests/catch.h"

using namespace glidelab::core;

namespace {

/// A line through points that scatter, of which each has a weight: linear, so that everything is known in closed form.
struct Line {
  std::vector<double> x{0.0, 1.0, 2.0, 3.0, 4.0, 5.0}, y{0.3, 0.9, 2.2, 2.8, 4.3, 4.9}, w{1.0, 0.5, 2.0, 1.0, 1.5, 1.0};
  int evaluations = 0;

  NormalEquations<2> equations(const Eigen::Vector2d& p) {
    ++evaluations;
    NormalEquations<2> sums;
    for (std::size_t i = 0; i < x.size(); ++i) sums.add({1.0, x[i]}, p[0] + p[1] * x[i] - y[i], w[i]);
    return sums;
  }
};

}  // namespace

TEST_CASE("a last small step is taken without another evaluation, and leaves the cost that it has there") {
  Line line;
  const auto evaluate = [&](const Eigen::Vector2d& p) { return std::optional(line.equations(p)); };
  const auto fit = fit_least_squares<2>(evaluate, Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(0.1, 0.1), 20);
  CHECK(glidelab::base::is_settled(fit.stop));
  CHECK(line.evaluations == 2);  // at the start and after the first step
  NormalEquations<2> there = line.equations(Eigen::Vector2d::Zero());
  there.complete();
  const Eigen::Vector2d best = -there.jtj.inverse() * there.jtr;
  // Steps damped by 1e-3 and 2e-4 leave parts of these of a distance of 1, the damping's directions apart.
  CHECK((fit.parameters - best).norm() < 1e-4);
  CHECK((fit.parameters - best).norm() < 0.01 * (fit.evaluated_at - best).norm());
  const NormalEquations<2> end = line.equations(fit.parameters);
  CHECK(std::abs(fit.rms / std::sqrt(end.cost / (end.weight - 2.0)) - 1.0) < 1e-12);
}

TEST_CASE("a fit that its caller calls hopeless ends there") {
  Line line;
  const auto evaluate = [&](const Eigen::Vector2d& p) { return std::optional(line.equations(p)); };
  const auto after_one = [](const LeastSquaresFit<2>& fit, const NormalEquations<2>&) { return fit.iterations == 1; };
  const Eigen::Vector2d start(1.0, 0.0), step(1e-12, 1e-12);
  const auto fit = fit_least_squares<2>(evaluate, start, step, 20, after_one);
  CHECK(fit.stop == glidelab::base::FitStop::hopeless);
  CHECK(line.evaluations == 2);
}
