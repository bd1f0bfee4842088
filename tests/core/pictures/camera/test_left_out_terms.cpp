#include "core/pictures/camera/left_out_terms.h"

#include <algorithm>
#include <cmath>

#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr double kRounding = 1e-12;  // relative

/// A radial term at the place `place` of the nine, found as `value` with the standard deviation `sd`, alone.
core::LeftOutTerm term(int power, double usual, double of_extent, int place, double value, double sd) {
  core::LeftOutTerm one{power, usual, of_extent, 0.36, Eigen::VectorXd::Constant(1, value), {}, {}};
  one.own = Eigen::MatrixXd::Constant(1, 1, sd * sd);
  one.with_others = Eigen::MatrixXd::Zero(9, 1);
  one.with_others(place, 0) = sd * sd;
  return one;
}

}  // namespace

TEST_CASE("a k1 that was left out has its own uncertainty, however small it was found") {
  const double sd = 0.01, corner = 0.36 * sd;
  const double found = core::effect_of({term(1, 0.3, 0.0, 4, 0.0, sd)}, 0.0)(4, 4);
  const double closed = sd * sd * 0.09 / (0.09 + corner * corner);  // N(0, 0.3²) at the corner, and nothing else
  CHECK(std::abs(found / closed - 1.0) < kRounding);
  CHECK(found > 0.999 * sd * sd);
}

TEST_CASE("a k2 that was left out is as large as the lens's extent allows, and never larger than usual") {
  const double sd = 1.0, corner = 0.36 * sd;
  for (const double extent : {0.001, 0.02, 5.0}) {
    const double usual = std::min(0.2, 2.0 * extent);
    const double closed = sd * sd * usual * usual / (usual * usual + corner * corner);
    INFO(extent);
    CHECK(std::abs(core::effect_of({term(2, 0.2, 2.0, 5, 0.0, sd)}, extent)(5, 5) / closed - 1.0) < kRounding);
  }
}

TEST_CASE("a k1 that was left out adds its size and two standard deviations to the extent") {
  const double sd1 = 0.01, value1 = -0.005, sd2 = 1.0, corner2 = 0.36 * sd2;
  const Eigen::Matrix<double, 9, 9> found =
      core::effect_of({term(2, 0.2, 2.0, 5, 0.0, sd2), term(1, 0.3, 0.0, 4, value1, sd1)}, 0.003);
  const double usual = 2.0 * (0.003 + 0.36 * (0.005 + 2.0 * sd1));
  const double closed = sd2 * sd2 * usual * usual / (usual * usual + corner2 * corner2);
  CHECK(std::abs(found(5, 5) / closed - 1.0) < kRounding);
}
