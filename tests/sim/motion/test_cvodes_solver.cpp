#include "sim/motion/cvodes_solver.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "sim/motion/simulate.h"
#include "tests/catch.h"
#include "tests/sim/bodies.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using namespace glidelab::sim;

namespace {

// Good below 0.5 m/s and NaN above, or throwing.
class FailingForce final : public ForceTerm {
 public:
  explicit FailingForce(bool throws) : throws_(throws) {}
  double force_n(double v_m_s, int, const Contact&) const override {
    if (v_m_s < 0.5) return 1.0;
    if (throws_) throw std::runtime_error("the force gave up");
    return std::numeric_limits<double>::quiet_NaN();
  }
  double slope_n_s_m(double, int, const Contact&) const override { return 0.0; }
  std::vector<double> by_parameter(double, int, const Contact&) const override { return {}; }

 private:
  bool throws_;
};

// Slides harder than it holds, which no friction does.
class InconsistentForce final : public ForceTerm {
 public:
  double force_n(double, int direction, const Contact&) const override { return -2.0 * direction; }
  double slope_n_s_m(double, int, const Contact&) const override { return 0.0; }
  double holding_n(const Contact&) const override { return 0.5; }
  std::vector<double> by_parameter(double, int, const Contact&) const override { return {}; }
};

// y[1] falls exponentially.
OdeSystem decay(double rate) {
  OdeSystem system;
  system.rate = [rate](const Eigen::Vector3d& y) { return Eigen::Vector3d(y[1], -rate * y[1], 0.0); };
  system.jacobian = [rate](const Eigen::Vector3d&) {
    Eigen::Matrix3d jacobian = Eigen::Matrix3d::Zero();
    jacobian(0, 1) = 1.0;
    jacobian(1, 1) = -rate;
    return jacobian;
  };
  system.relative_tolerance = 1e-12;
  system.absolute_tolerance = Eigen::Vector3d::Constant(1e-13);
  return system;
}

// What is written to standard error during `call`, by whomever.
template <class Call>
std::string standard_error_of(const std::filesystem::path& file, Call&& call) {
  std::fflush(stderr);
  const int saved = dup(STDERR_FILENO);
  std::FILE* sink = std::fopen(file.c_str(), "w");
  REQUIRE(sink != nullptr);
  dup2(fileno(sink), STDERR_FILENO);
  call();
  std::fflush(stderr);
  dup2(saved, STDERR_FILENO);
  close(saved);
  std::fclose(sink);
  return base::read_file(file);
}

}  // namespace

TEST_CASE("the solver follows an exponential and stops at its event") {
  OdeSystem system = decay(2.0);
  system.event = [](const Eigen::Vector3d& y) { return y[1] - 0.25; };
  system.event_crossing = -1;
  CvodesSolver solver(system, 1.0, Eigen::Vector3d(0.0, 1.0, 0.0));
  const OdeState before = solver.advance(1.5);
  CHECK_FALSE(before.at_event);
  CHECK(std::abs(before.y[1] - std::exp(-1.0)) < 1e-10);  // 100 steps, each within 1e-12
  const OdeState at = solver.advance(3.0);
  CHECK(at.at_event);
  CHECK(std::abs(at.t_s - (1.0 + std::log(4.0) / 2.0)) < 1e-10);
  const long steps = solver.steps();
  solver.restart(decay(1.0), 0.0, Eigen::Vector3d(0.0, 1.0, 0.0));
  CHECK(std::abs(solver.advance(1.0).y[1] - std::exp(-1.0)) < 1e-10);
  CHECK(solver.steps() > steps);
}

TEST_CASE("an event in the other direction is passed over") {
  OdeSystem system = decay(2.0);
  system.event = [](const Eigen::Vector3d& y) { return y[1] - 0.25; };
  system.event_crossing = +1;
  CHECK_FALSE(CvodesSolver(system, 0.0, Eigen::Vector3d(0.0, 1.0, 0.0)).advance(3.0).at_event);
}

TEST_CASE("a force that is not a number is a numerical error with time, step and tolerance, and nothing is printed") {
  const tests::TempDir dir;
  const Body glider = tests::body(1.0, 0.0, std::make_shared<FailingForce>(false));
  std::string message;
  const std::string printed = standard_error_of(dir.path() / "stderr.txt", [&] {
    try {
      simulate(glider, 0.0, 0.0, std::vector<double>{1.0});
    } catch (const base::NumericalError& error) {
      message = error.what();
    }
  });
  INFO(message);
  CHECK(message.find("at t = 0.5") != std::string::npos);  // v = 1 m/s² t fails at 0.5 m/s
  CHECK(message.find("step ") != std::string::npos);
  CHECK(message.find("relative tolerance 1e-13, absolute tolerance 1e-14") != std::string::npos);
  CHECK(printed.empty());
}

TEST_CASE("what a force throws comes out as it is") {
  const Body glider = tests::body(1.0, 0.0, std::make_shared<FailingForce>(true));
  CHECK_THROWS_WITH(simulate(glider, 0.0, 0.0, std::vector<double>{1.0}), "the force gave up");
}

TEST_CASE("a tolerance that no double can reach is a numerical error") {
  const Body glider = tests::body(1.0, 0.05, laws::viscous().with({1.0}));
  CHECK_THROWS_AS(
      simulate(glider, 1.0, 1.0, std::vector<double>{1.0}, {.relative_tolerance = 1e-30, .absolute_tolerance = 1e-30}),
      base::NumericalError);
}

TEST_CASE("a term that holds less than it opposes to sliding is a numerical error, not an endless loop") {
  const Body glider = tests::body(1.0, 0.0, std::make_shared<InconsistentForce>(), laws::constant().with({1.0}));
  CHECK_THROWS_AS(simulate(glider, 0.0, 1.0, std::vector<double>{5.0}), base::NumericalError);
}
