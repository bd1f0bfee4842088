#include "core/motion/free/fall_ends.h"

#include <boost/math/tools/minima.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr int kBits = 16;               // of a release or of a rate: far finer than the points tell
constexpr double kClearly = 25.0;       // chi²: five standard deviations
constexpr double kSlowly = 2.0;         // chi²: a hand that opens slowly is not ruled out
constexpr double kClearlyOff = 5.0;     // standard deviations of a position
constexpr double kAsNoise = 4.0;        // largest mean square of the residuals, in squares of the noise
constexpr double kMostOpening = 0.4;    // of the time after the release: a longer one is not told from the drag
constexpr std::size_t kParameters = 4;  // x0, a, w, t_r

enum class Drag { viscous, quadratic };

/// s(u)/a of released_at().
double fallen_since(Drag drag, double w_1_s, double u_s) {
  if (u_s <= 0.0) return 0.0;
  const double z = w_1_s * u_s;
  if (z < 1e-4) return 0.5 * u_s * u_s;
  const double of_z =
      drag == Drag::viscous ? std::expm1(-z) + z : z + std::log1p(std::exp(-2.0 * z)) - std::numbers::ln2;
  return of_z / (w_1_s * w_1_s);
}

/// The same for a hand that opens within `opening_s` about the time of the release, and bears less and less of the
/// weight meanwhile: as many small releases, each at its time.
double fallen(Drag drag, double w_1_s, double u_s, double opening_s) {
  if (opening_s == 0.0) return fallen_since(drag, w_1_s, u_s);
  constexpr int kReleases = 8;
  double sum = 0.0;
  for (int i = 0; i < kReleases; ++i) {
    sum += fallen_since(drag, w_1_s, u_s + opening_s * ((i + 0.5) / kReleases - 0.5));
  }
  return sum / kReleases;
}

struct Release {
  double t_s = 0.0;
  double squares = 0.0;  ///< of the residuals, the least with this release
};

/// The positions of one fall, downwards, and how well a release fits them.
class Fall {
 public:
  Fall(const Motion& motion, int direction, std::size_t to)
      : t_s_(motion.t_s.begin(), motion.t_s.begin() + static_cast<std::ptrdiff_t>(to)), step_s_(motion.step_s) {
    for (std::size_t i = 0; i < to; ++i) x_m_.push_back(direction * (motion.x_m[i] - motion.x_m[0]));
  }

  /// Each law by itself: over the time of the release, the smaller of the two has more than one valley.
  Release best_release(double from_s, double to_s, double opening_s = 0.0) const {
    Release best{from_s, std::numeric_limits<double>::infinity()};
    for (const Drag drag : {Drag::viscous, Drag::quadratic}) {
      const auto of_t = [&](double t_s) { return squares_at(drag, t_s, opening_s); };
      const auto [t_s, squares] = boost::math::tools::brent_find_minima(of_t, from_s, to_s, kBits);
      if (squares < best.squares) best = {t_s, squares};
    }
    return best;
  }

 private:
  double squares_at(Drag drag, double release_s, double opening_s) const {
    const double longest_s = t_s_.back() - release_s;
    const auto of_log = [&](double log_w) { return squares_of(drag, std::exp(log_w), release_s, opening_s); };
    return boost::math::tools::brent_find_minima(of_log, std::log(1e-2 / longest_s), std::log(3.0 / step_s_), kBits)
        .second;
  }

  /// x0 and a are linear: two sums of squares and one of products give the rest.
  double squares_of(Drag drag, double w_1_s, double release_s, double opening_s) const {
    const auto n = static_cast<double>(t_s_.size());
    double s1 = 0.0, x1 = 0.0, ss = 0.0, sx = 0.0, xx = 0.0;
    for (std::size_t i = 0; i < t_s_.size(); ++i) {
      const double s = fallen(drag, w_1_s, t_s_[i] - release_s, opening_s), x = x_m_[i];
      s1 += s;
      x1 += x;
      ss += s * s;
      sx += s * x;
      xx += x * x;
    }
    const double of_s = ss - s1 * s1 / n, of_both = sx - s1 * x1 / n, of_x = xx - x1 * x1 / n;
    if (!(of_s > 0.0) || of_both <= 0.0) return of_x;  // nothing falls
    return std::max(0.0, of_x - of_both * of_both / of_s);
  }

  std::vector<double> t_s_, x_m_;
  double step_s_;
};

}  // namespace

std::size_t released_at(const Motion& motion, int direction, std::size_t to) {
  if (to < kFewestBlockPoints + 1) return 0;
  const auto& t = motion.t_s;
  const double clearly_m = kClearlyOff * std::sqrt(2.0) * motion.noise_m;
  std::size_t off = 1;  // the first point that is clearly elsewhere
  while (off < to && std::abs(motion.x_m[off] - motion.x_m[0]) <= clearly_m) ++off;
  if (off + 1 >= to || direction * (motion.x_m[off] - motion.x_m[0]) < 0.0) return 0;  // rests, or is thrown up

  const Fall fall(motion, direction, to);
  double before = std::numeric_limits<double>::infinity();
  for (double from = 64.0, until = 16.0; from > 0.0; from = until, until = until > 1.0 ? until / 4.0 : 0.0) {
    const double earliest_s = t[0] - from * motion.step_s, latest_s = t[0] - until * motion.step_s;
    before = std::min(before, fall.best_release(earliest_s, latest_s).squares);
  }
  const Release held = fall.best_release(t[0], t[off]);
  const auto first = static_cast<std::size_t>(std::lower_bound(t.begin(), t.end(), held.t_s) - t.begin());
  if (to - first < kFewestBlockPoints) return 0;
  const double noise_m2 = motion.noise_m * motion.noise_m;
  const double variance = std::max(noise_m2, held.squares / static_cast<double>(to - kParameters));
  if (variance > kAsNoise * noise_m2 || before - held.squares <= kClearly * variance) return 0;
  for (const double steps : {2.0, 4.0, 8.0, 16.0}) {
    const double opening_s = steps * motion.step_s;
    if (opening_s > kMostOpening * (t[to - 1] - held.t_s)) break;
    const Release slow = fall.best_release(t[0], held.t_s + opening_s, opening_s);
    if (held.squares - slow.squares > kSlowly * variance) return 0;
  }
  return first;
}

std::size_t landed_from(const Motion& motion, int direction) {
  constexpr std::size_t kFewestSteps = 6, kMostSlow = 5;  // more positions at a lower speed are a motion
  constexpr double kSlower = 0.7, kClearly_sd = 5.0;
  const std::size_t n = motion.t_s.size();
  if (n < kFewestSteps + 2) return n;
  std::vector<double> speed;  // of each step
  for (std::size_t i = 0; i + 1 < n; ++i) {
    speed.push_back(direction * (motion.x_m[i + 1] - motion.x_m[i]) / (motion.t_s[i + 1] - motion.t_s[i]));
  }
  double falling = 0.0;
  for (std::size_t i = 1; i + 1 < speed.size(); ++i) {
    falling = std::max(falling, quantile({speed[i - 1], speed[i], speed[i + 1]}, 0.5));
  }
  std::size_t last_free = n - 1;  // a point
  while (last_free > kFewestSteps && speed[last_free - 1] < kSlower * falling) --last_free;
  if (last_free + 1 == n || last_free == kFewestSteps) return n;
  const double clearly_m = kClearly_sd * std::sqrt(2.0) * motion.noise_m;
  const double floor_m = motion.x_m[n - 1], after_s = motion.t_s[n - 1] - motion.t_s[last_free];
  if (!(falling * after_s - direction * (floor_m - motion.x_m[last_free]) > clearly_m)) return n;
  for (std::size_t i = last_free + 1; i < n; ++i) {
    const bool bounces = direction * (motion.x_m[i] - floor_m) > clearly_m;
    const bool goes_on = i > last_free + kMostSlow && std::abs(motion.x_m[i] - floor_m) > clearly_m;
    if (bounces || goes_on) return n;
  }
  return last_free + 1;
}

}  // namespace glidelab::core
