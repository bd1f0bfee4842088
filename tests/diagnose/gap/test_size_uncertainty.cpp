#include "diagnose/gap/size_uncertainty.h"

#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr Eigen::Index kPoints = 30;

/// Motions of unit white noise whose positions follow the first common parameter alone, by the same column each; the
/// residuals are what `sizes`, one for each motion, leave at their mean. The fit stands off its minimum by `off`.
struct Scattered {
  diagnose::TrackSet set;
  diagnose::MotionFit fit;
  double column_square = 0.0;
};

Scattered scattered(const std::vector<double>& sizes, bool one_clip, double off) {
  Scattered made;
  made.set.groups.push_back({"g", 0.0, {}, 0.0});
  made.set.masses.push_back({0.4, 0.0});
  const Eigen::VectorXd along = Eigen::VectorXd::LinSpaced(kPoints, -1.0, 1.0).array().square() - 0.3;
  made.column_square = along.squaredNorm();
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (i == 0 || !one_clip) made.set.clips.push_back({"c" + std::to_string(i), 100.0, 0.4, 40, 0.0});
    diagnose::TrackedMotion motion;
    motion.clip = one_clip ? 0 : i;
    motion.sd_m = 1e-5;
    motion.t_s.resize(kPoints);
    motion.outlier.assign(kPoints, 0);
    made.set.motions.push_back(motion);
    diagnose::FitMotion of;
    of.own = Eigen::MatrixXd::Zero(kPoints, 2);
    of.own.col(0).setLinSpaced(kPoints, -1.0, 1.0);
    of.own.col(1) = of.own.col(0).array().cube();  // both are odd, and the column is even
    of.global = Eigen::MatrixXd::Zero(kPoints, 3);
    of.global.col(0) = along;
    of.residual = (sizes[i] - off) * along;
    of.plain = of.residual;
    made.fit.motions.push_back(of);
    made.fit.at.own.push_back(Eigen::Vector2d::Zero());
  }
  made.fit.layout = std::make_shared<const diagnose::ParameterLayout>(made.set, std::vector<std::size_t>{});
  made.fit.at.global = Eigen::Vector3d(off, 0.0, 0.0);
  return made;
}

double standard_error(const std::vector<double>& sizes) {
  const auto n = static_cast<double>(sizes.size());
  const double mean = std::accumulate(sizes.begin(), sizes.end(), 0.0) / n;
  double square = 0.0;
  for (const double size : sizes) square += (size - mean) * (size - mean);
  return std::sqrt(square / (n * (n - 1.0)));
}

}  // namespace

TEST_CASE("a size that differs from clip to clip is as uncertain as the mean of what each clip says by itself") {
  const std::vector<double> sizes = {3.0, 5.5, 4.1, 9.2, 2.8};
  for (const bool one_clip : {false, true}) {
    for (const double off : {0.0, 4.0}) {
      const Scattered made = scattered(sizes, one_clip, off);
      const diagnose::SizeUncertainty uncertainty(made.set, made.fit);
      CHECK(uncertainty.sd(0) == Approx(standard_error(sizes)).epsilon(1e-3));
      CHECK(uncertainty.sd(Eigen::Vector3d(-2.0, 0.0, 0.0)) == Approx(2.0 * uncertainty.sd(0)).epsilon(1e-9));
    }
  }
}

TEST_CASE("sizes that agree within their noise, or of a single motion, are as uncertain as the noise makes them") {
  for (const std::vector<double>& sizes : {std::vector<double>{4.0, 4.0, 4.0, 4.0}, std::vector<double>{7.0}}) {
    const Scattered made = scattered(sizes, false, 4.0);
    const double noise = 1.0 / std::sqrt(static_cast<double>(sizes.size()) * made.column_square);
    CHECK(diagnose::SizeUncertainty(made.set, made.fit).sd(0) == Approx(noise).epsilon(1e-3));
  }
}
