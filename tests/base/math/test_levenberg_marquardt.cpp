#include "base/math/levenberg_marquardt.h"

#include <Eigen/Dense>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "tests/catch.h"

using namespace glidelab::base;

namespace {

struct Sample {
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
};
using Model = std::function<Sample(const Eigen::VectorXd&)>;

struct Run {
  Eigen::VectorXd at;
  FitSummary summary;
  std::vector<Eigen::VectorXd> path;  // every trial's point
};

/// Marquardt's damping of the diagonal, as the options say; `step` is what no longer matters, in every parameter.
Run run(const Model& model, const Eigen::VectorXd& start, const FitOptions& options, double step = 1e-12) {
  Run result{start, {}, {}};
  const auto try_step = [&](const Eigen::VectorXd& here, double damping) {
    const Sample sample = model(here);
    const Eigen::MatrixXd normal = sample.jacobian.transpose() * sample.jacobian;
    Eigen::MatrixXd damped = normal;
    damped.diagonal() *= 1.0 + damping;
    FitTrial<Eigen::VectorXd> trial;
    const Eigen::FullPivLU<Eigen::MatrixXd> factor(damped);
    if (!factor.isInvertible()) return trial;
    const Eigen::VectorXd change = -factor.solve(sample.jacobian.transpose() * sample.residual);
    trial.point = here + change;
    trial.cost = model(*trial.point).residual.squaredNorm();
    trial.is_small = change.cwiseAbs().maxCoeff() < step;
    result.path.push_back(*trial.point);
    return trial;
  };
  result.summary = levenberg_marquardt(result.at, model(start).residual.squaredNorm(), options, try_step);
  return result;
}

/// y = a + b x through (0, 1), (1, 3), (2, 4), (3, 4): b = 5/5 = 1, a = 3 - 1.5 = 1.5, sum of squares 4 (1/2)^2 = 1.
Sample line(const Eigen::VectorXd& p) {
  Sample sample{Eigen::VectorXd(4), Eigen::MatrixXd(4, 2)};
  const double y[] = {1.0, 3.0, 4.0, 4.0};
  for (int i = 0; i < 4; ++i) {
    sample.residual[i] = p[0] + p[1] * i - y[i];
    sample.jacobian.row(i) << 1.0, i;
  }
  return sample;
}

/// Rosenbrock's valley: residuals 10 (y - x^2) and 1 - x, zero at (1, 1).
Sample rosenbrock(const Eigen::VectorXd& p) {
  Sample sample{Eigen::VectorXd(2), Eigen::MatrixXd(2, 2)};
  sample.residual << 10.0 * (p[1] - p[0] * p[0]), 1.0 - p[0];
  sample.jacobian << -20.0 * p[0], 10.0, -1.0, 0.0;
  return sample;
}

Eigen::VectorXd at(double x, double y) {
  return Eigen::Vector2d(x, y);
}

}  // namespace

TEST_CASE("an undamped step leads to the line of the closed form, and the next one is small") {
  FitOptions options;
  options.damping_start = options.damping_least = 0.0;
  const Run fit = run(line, at(-3.0, 7.0), options, 1e-9);
  // The arithmetic is that of numbers below 100 and a condition number of 10: 1e-13.
  CHECK(std::abs(fit.at[0] - 1.5) < 1e-13);
  CHECK(std::abs(fit.at[1] - 1.0) < 1e-13);
  CHECK(std::abs(fit.summary.cost - 1.0) < 1e-13);
  CHECK(fit.summary.start_cost == 16.0 + 1.0 + 49.0 + 196.0);  // residuals -4, 1, 7, 14
  CHECK(fit.summary.iterations >= 2);
  CHECK((fit.summary.stop == FitStop::step_small || fit.summary.stop == FitStop::no_descent));
}

TEST_CASE("Rosenbrock's valley is followed to its end, and the cost never rises on the way") {
  FitOptions options;
  options.most_iterations = 200;
  const Run fit = run(rosenbrock, at(-1.2, 1.0), options, 1e-10);
  CHECK(is_settled(fit.summary.stop));
  CHECK((fit.at - at(1.0, 1.0)).norm() < 1e-9);  // ten steps of the tolerance
  CHECK(fit.summary.iterations < 60);
  CHECK(fit.summary.cost <= fit.summary.start_cost);
}

TEST_CASE("with zero residuals at the minimum the error is squared from step to step") {
  FitOptions options;
  options.damping_start = options.damping_least = 0.0;
  options.take_every_step = true;
  // Residuals x^2 - 2 and y^2 - 3: Gauss and Newton's step is Newton's, error' = error^2 / (2 root).
  const Model roots = [](const Eigen::VectorXd& p) {
    Sample sample{Eigen::VectorXd(2), Eigen::MatrixXd::Zero(2, 2)};
    sample.residual << p[0] * p[0] - 2.0, p[1] * p[1] - 3.0;
    sample.jacobian.diagonal() << 2.0 * p[0], 2.0 * p[1];
    return sample;
  };
  const Run fit = run(roots, at(1.6, 1.9), options);
  CHECK(fit.summary.stop == FitStop::step_small);
  double error = 1.6 - std::sqrt(2.0);
  for (int k = 0; k < 2; ++k) {
    const double next = fit.path[static_cast<std::size_t>(k)][0] - std::sqrt(2.0);
    // error'/error^2 = 1/(2 x) with x between the root and the point before: 0.31 to 0.354.
    CHECK(next / (error * error) > 0.31);
    CHECK(next / (error * error) < 0.3536);
    error = next;
  }
}

TEST_CASE("a wrong Jacobian is noticed: of the wrong sign nothing descends, of a wrong size the order is lost") {
  FitOptions options;
  options.most_iterations = 200;
  const Model uphill = [](const Eigen::VectorXd& p) {
    Sample sample = rosenbrock(p);
    sample.jacobian = -sample.jacobian;
    return sample;
  };
  const Run lost = run(uphill, at(-1.2, 1.0), options);
  CHECK(lost.summary.stop == FitStop::no_descent);
  CHECK_FALSE(is_settled(lost.summary.stop));
  CHECK(lost.at == at(-1.2, 1.0));
  CHECK(lost.summary.cost == lost.summary.start_cost);

  options.damping_start = options.damping_least = 0.0;
  const Model too_steep = [](const Eigen::VectorXd& p) {
    Sample sample = line(p);
    sample.jacobian *= 1.25;  // steps are 0.8 of what they should be: a fifth of the error is left each time
    return sample;
  };
  const Run slow = run(too_steep, at(-3.0, 7.0), options, 1e-6);
  CHECK(slow.summary.stop == FitStop::step_small);
  // 0.2^n of an error of 6 is below 1.25e-6 for n >= 9.6; the right Jacobian needs 2 steps.
  CHECK(slow.summary.iterations >= 9);
}

TEST_CASE("what the data do not determine is singular undamped, and settles somewhere when it is damped") {
  const Model sum_only = [](const Eigen::VectorXd& p) {
    Sample sample{Eigen::VectorXd(2), Eigen::MatrixXd::Ones(2, 2)};
    sample.residual << p[0] + p[1] - 1.0, p[0] + p[1] - 3.0;
    return sample;
  };
  FitOptions options;
  options.damping_start = options.damping_least = 0.0;
  const Run undamped = run(sum_only, at(0.0, 0.0), options);
  CHECK(undamped.summary.stop == FitStop::singular);
  CHECK(undamped.summary.iterations == 0);
  CHECK(undamped.at == at(0.0, 0.0));

  options.damping_start = options.damping_least = 1e-3;
  options.cost_relative = 1e-12;
  const Run damped = run(sum_only, at(0.0, 0.0), options);
  CHECK(damped.summary.stop == FitStop::cost_settled);
  CHECK(std::abs(damped.at.sum() - 2.0) < 1e-5);         // the sum of squares is 2 + 2 (sum - 2)^2, flat to 2e-12
  CHECK(std::abs(damped.at[0] - damped.at[1]) < 1e-12);  // along what is not determined nothing moves
}

TEST_CASE("each limit ends the descent with its own reason") {
  FitOptions options;
  FitProgress few(options, 1.0);
  for (int i = 0; few.goes_on(); ++i) few.judge(1.0 - 0.01 * i, false);
  CHECK(few.summary().stop == FitStop::iterations);
  CHECK(few.summary().iterations == options.most_iterations);

  FitProgress refused(options, 1.0);
  while (refused.goes_on()) CHECK_FALSE(refused.judge(2.0, false));
  CHECK(refused.summary().stop == FitStop::no_descent);
  CHECK(refused.summary().damping > options.damping_most);

  CHECK(FitProgress(options, std::numeric_limits<double>::infinity()).summary().stop == FitStop::out_of_range);
  CHECK_FALSE(FitProgress(options, std::numeric_limits<double>::quiet_NaN()).goes_on());

  FitProgress given_up(options, 1.0);
  given_up.give_up(FitStop::hopeless);
  CHECK_FALSE(given_up.goes_on());
  CHECK(given_up.summary().stop == FitStop::hopeless);

  FitProgress nan(options, 1.0);
  CHECK_FALSE(nan.judge(std::numeric_limits<double>::quiet_NaN(), false));
  CHECK(nan.goes_on());
}

TEST_CASE("a small step that is refused ends the descent only where the options say so") {
  FitOptions options;
  FitProgress strict(options, 1.0);
  CHECK_FALSE(strict.judge(1.1, true));
  CHECK(strict.goes_on());
  options.refused_may_settle = true;
  FitProgress lenient(options, 1.0);
  CHECK_FALSE(lenient.judge(1.1, true));
  CHECK(lenient.summary().stop == FitStop::step_small);
  CHECK(lenient.summary().cost == 1.0);
}

TEST_CASE("a settled cost does not end a descent that is heavily damped") {
  FitOptions options;
  options.cost_relative = 1e-3;
  options.damping_start = 1.0;
  options.damping_settled = 0.05;
  FitProgress progress(options, 1.0);
  CHECK(progress.judge(1.0, false));
  CHECK(progress.judge(1.0, false));  // damping 0.1
  CHECK(progress.goes_on());
  CHECK(progress.judge(1.0, false));  // 0.01
  CHECK(progress.summary().stop == FitStop::cost_settled);
}

TEST_CASE("after a refusal the damping stays above the floor that it leaves, which decays") {
  FitOptions options;
  options.damping_start = 1e-4;
  options.floor_after_refusal = 3.0;
  options.floor_decay = 0.5;
  FitProgress progress(options, 10.0);
  progress.judge(11.0, false);
  CHECK(progress.damping() == Approx(1e-3).epsilon(1e-12));  // products of two numbers: rounding only
  progress.judge(9.0, false);
  CHECK(progress.damping() == Approx(3e-4).epsilon(1e-12));  // not 1e-4
  progress.judge(8.0, false);
  CHECK(progress.damping() == Approx(1.5e-4).epsilon(1e-12));
  progress.judge(7.0, false);
  CHECK(progress.damping() == Approx(7.5e-5).epsilon(1e-12));
}
