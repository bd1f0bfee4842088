#include "core/math/skipped_frames.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "base/math/dense.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kMostLost = 2;  // frames in a row

/// How many places on either side of a boundary count, and the ratio of the sums of squares without and with a loss
/// that shows it. White noise reaches it at one boundary in some thousand: the probabilities of F(14, 14) > 9 and
/// F(6, 6) > 36 are 1e-4 and 2e-4. The fewer places, the closer two losses may be.
struct Reach {
  std::size_t places;
  double ratio;
};
constexpr std::array<Reach, 2> kReaches{{{5, 9.0}, {3, 36.0}}};

/// The sum of squares that a quadratic leaves of `reach` places on either side of a boundary, those after it with
/// `more` added to their clock.
double left_by_quadratic(const std::vector<PlaceAtFrame>& places, std::size_t boundary, std::size_t reach,
                         std::size_t more) {
  const auto first = static_cast<double>(places[boundary - reach].frame);
  const double scale = static_cast<double>(places[boundary + reach - 1].frame) - first;
  const auto for_each = [&](const auto& take) {
    for (std::size_t i = boundary - reach; i < boundary + reach; ++i) {
      const double t = (static_cast<double>(places[i].frame + (i < boundary ? 0 : more)) - first) / scale;
      take(Eigen::Vector3d(1.0, t, t * t), Eigen::Vector2d(places[i].at - places[boundary].at));
    }
  };
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> b = Eigen::Matrix<double, 3, 2>::Zero();
  for_each([&](const Eigen::Vector3d& powers, const Eigen::Vector2d& at) {
    a += powers * powers.transpose();
    b += powers * at.transpose();
  });
  const Eigen::Matrix<double, 3, 2> found = base::solve_positive(a, b);
  if (!found.allFinite()) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for_each([&](const Eigen::Vector3d& powers, const Eigen::Vector2d& at) {
    sum += (at - found.transpose() * powers).squaredNorm();
  });
  return sum;
}

struct Loss {
  std::size_t boundary = 0;  ///< the place after it
  std::size_t frames = 0;
};

/// The loss that shows most clearly.
std::optional<Loss> clearest_loss(const std::vector<PlaceAtFrame>& places, const Reach& reach, double least_sum) {
  std::optional<Loss> clearest;
  double best = reach.ratio;
  for (std::size_t i = reach.places; i + reach.places <= places.size(); ++i) {
    const double without = left_by_quadratic(places, i, reach.places, 0);
    if (without <= best * least_sum) continue;
    for (std::size_t more = 1; more <= kMostLost; ++more) {
      const double with = std::max(left_by_quadratic(places, i, reach.places, more), least_sum);
      if (without <= best * with) continue;
      best = without / with;
      clearest = Loss{i, more};
    }
  }
  return clearest;
}

}  // namespace

std::vector<std::size_t> lost_before(std::vector<PlaceAtFrame> places, double least_sum) {
  std::vector<std::size_t> lost(places.size(), 0);
  for (const Reach& reach : kReaches) {
    for (std::size_t round = 0; round < places.size(); ++round) {
      const auto loss = clearest_loss(places, reach, least_sum);
      if (!loss) break;
      for (std::size_t i = loss->boundary; i < places.size(); ++i) {
        places[i].frame += loss->frames;
        lost[i] += loss->frames;
      }
    }
  }
  return lost;
}

}  // namespace glidelab::core
