#include "core/motion/free/lost_frames.h"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "core/math/quantile.h"
#include "core/motion/free/motion.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kBefore = 4, kBehind = 4;  // positions on either side to which a cubic is fitted
constexpr std::size_t kFewestBehind = 2;         // if another loss follows soon
constexpr std::size_t kFewestInWindow = 6;       // on both sides together
constexpr int kMostPoints = kBefore + 1 + kBehind;
constexpr double kLeastEvidenceOfLoss = 50.0;    // variances by which a loss lowers the sum of squares
constexpr double kMostResidualSds = 4.0;         // allowed residual, in standard deviations of the noise
constexpr double kMostResidualOfDistance = 0.1;  // allowed residual, as a fraction of the distance per frame: a law may
                                                 // change at a reversal
constexpr double kMostOffWholeFrame = 1.0 / 7.0;  // allowed deviation of the jump from a whole number of frames
constexpr double kMostFramesMissing = 2.0;        // allowed frames without a marker in a window
constexpr double kUnit = 1.0 / static_cast<double>(kBefore);  // of a step: keeps the design's columns alike
constexpr int kTurnRounds = 4;                                // iterations for the time of a turn
constexpr Eigen::Index kFewestAtTurn = 7;                     // points

/// The positions of a window around a pair of neighbouring frames, in units of kBefore steps from the first one after
/// the gap.
struct Window {
  std::vector<double> u, y_m;
  std::size_t before = 0;  ///< points before the gap
};

Window window_of(std::span<const double> t_s, std::span<const double> y_m, std::size_t before, double step_s) {
  Window window{{}, {}, before};
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    window.u.push_back((t_s[i] - t_s[before]) / step_s * kUnit);
    window.y_m.push_back(y_m[i] - y_m[before]);
  }
  return window;
}

/// The cubic through the positions of a window, with those after the gap at later times. If the motion turns within the
/// window, the acceleration may step, as with dry friction: a fifth parameter.
struct CubicFit {
  double squares = 0.0;   ///< of the residuals
  double freedom = 1.0;   ///< points minus parameters
  double off = 0.0;       ///< further delay of the points after the gap in frames, to first order
  double off_gain = 0.0;  ///< its variance over the noise's
  double distance = 0.0;  ///< per frame, after the gap
};

using Design = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostPoints, 5>;
using Points = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostPoints, 1>;
using Parameters = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 5, 1>;

double speed_at(const Parameters& c, double u, double turn) {
  return c[1] + u * (2.0 * c[2] + 3.0 * c[3] * u) + (c.size() > 4 ? c[4] * std::max(0.0, u - turn) : 0.0);
}

/// The time at which the speed changes sign inside the window, if it does so once.
std::optional<double> turn_of(const Parameters& c, const std::vector<double>& u, double turn) {
  constexpr int kHalvings = 30;
  double low = u[1], high = u[u.size() - 2];
  if (!(speed_at(c, low, turn) * speed_at(c, high, turn) < 0.0)) return {};
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (speed_at(c, low, turn) * speed_at(c, middle, turn) <= 0.0 ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

/// The first `before` points keep their times; the others are `lost` frames later.
CubicFit cubic_through(const Window& window, int lost) {
  const auto n = static_cast<Eigen::Index>(window.u.size());
  std::vector<double> u = window.u;
  for (std::size_t i = window.before; i < u.size(); ++i) u[i] += lost * kUnit;
  Points y(n);
  for (Eigen::Index r = 0; r < n; ++r) y[r] = window.y_m[static_cast<std::size_t>(r)];
  CubicFit fit;
  std::optional<double> turn;
  for (int round = 0; round < kTurnRounds; ++round) {
    const Eigen::Index many = turn ? 5 : 4;
    Design design(n, 5);
    Points late(n);
    for (Eigen::Index r = 0; r < n; ++r) {
      const double at = u[static_cast<std::size_t>(r)], beyond = turn ? std::max(0.0, at - *turn) : 0.0;
      design.row(r) << 1.0, at, at * at, at * at * at, 0.5 * beyond * beyond;
    }
    const Design used = design.leftCols(many);
    const Eigen::HouseholderQR<Design> qr(used);
    const Parameters cubic = qr.solve(y);
    for (Eigen::Index r = 0; r < n; ++r) {
      const auto i = static_cast<std::size_t>(r);
      late[r] = i < window.before ? 0.0 : kUnit * speed_at(cubic, u[i], turn.value_or(0.0));
    }
    const Points own = late - used * qr.solve(late);
    const Points residual = y - used * cubic;
    const double norm = own.squaredNorm();
    fit = {residual.squaredNorm(), static_cast<double>(n - many), norm > 0.0 ? own.dot(residual) / norm : 0.0,
           norm > 0.0 ? 1.0 / norm : std::numeric_limits<double>::infinity(),
           std::abs(late[static_cast<Eigen::Index>(window.before)])};
    if (n < kFewestAtTurn) break;
    const std::optional<double> next = turn_of(cubic, u, turn.value_or(0.0));
    if (!next) break;
    turn = next;
  }
  return fit;
}

/// How many frames are lost between the two sides; 0 without evidence of a loss.
int lost_between(const Window& window, double noise_m) {
  const double variance = noise_m * noise_m;
  const double without = cubic_through(window, 0).squares;
  if (without < kLeastEvidenceOfLoss * variance) return 0;
  int best = 0;
  CubicFit fit{.squares = without};
  for (int lost = 1; lost <= kMostLost; ++lost) {
    const CubicFit tried = cubic_through(window, lost);
    if (tried.squares >= fit.squares) continue;
    best = lost;
    fit = tried;
  }
  const double scatter = std::max(variance, fit.squares / fit.freedom);
  const double explained = std::max(kMostResidualSds * noise_m, kMostResidualOfDistance * fit.distance);
  const bool explains = without - fit.squares > kLeastEvidenceOfLoss * scatter && scatter < explained * explained;
  const bool whole = std::abs(fit.off) < kMostOffWholeFrame && std::sqrt(scatter * fit.off_gain) < kMostOffWholeFrame;
  return best > 0 && explains && whole ? best : 0;
}

/// Whether one cubic explains point i and those around it well enough that nothing is lost before it or next to it: in
/// a window with fewer of these points the residuals can be no larger.
bool is_smooth(const Motion& motion, const std::vector<double>& t_s, std::size_t i, double step_s) {
  const std::size_t before = std::min(i, kBefore), behind = std::min(kBehind, t_s.size() - i - 1), first = i - before;
  const auto n = static_cast<Eigen::Index>(before + 1 + behind);
  Design design(n, 4);
  Points y(n);
  for (Eigen::Index r = 0; r < n; ++r) {
    const std::size_t point = first + static_cast<std::size_t>(r);
    const double u = (t_s[point] - t_s[i]) / step_s * kUnit;
    design.row(r) << 1.0, u, u * u, u * u * u;
    y[r] = motion.y_m[point] - motion.y_m[i];
  }
  const Eigen::HouseholderQR<Design> qr(design);
  y.applyOnTheLeft(qr.householderQ().adjoint());
  return y.tail(n - 4).squaredNorm() < kLeastEvidenceOfLoss * motion.noise_m * motion.noise_m;
}

/// Whether a window of these points has hardly any frame without a marker.
bool is_close(const Motion& motion, std::size_t first, std::size_t count, double step_s) {
  const double span_s = motion.t_s[first + count - 1] - motion.t_s[first];
  return span_s <= (static_cast<double>(count) + kMostFramesMissing) * step_s;
}

/// Number of frames lost before point i of a motion whose points are at the times t_s; 0 without evidence of a loss.
int lost_before(const Motion& motion, const std::vector<double>& t_s, std::size_t i, double step_s) {
  const std::size_t before = std::min(i, kBefore), first = i - before;
  // Uses fewer points after the gap if the whole window does not decide: another loss may follow.
  for (std::size_t behind = std::min(kBehind, t_s.size() - i); behind >= kFewestBehind; --behind) {
    const std::size_t count = before + behind;
    if (count < kFewestInWindow) break;
    if (!is_close(motion, first, count, step_s)) continue;
    const Window window =
        window_of(std::span(t_s).subspan(first, count), std::span(motion.y_m).subspan(first, count), before, step_s);
    if (const int lost = lost_between(window, motion.noise_m); lost > 0) return lost;
  }
  return 0;
}

/// Frames lost before and after point i, if it stands alone between two losses.
struct Beside {
  int before = 0, behind = 0;
};

/// The points around it tell how many frames are missing in all; their cubic then tells how many of these precede point
/// i.
std::optional<Beside> lost_beside(const Motion& motion, const std::vector<double>& t_s, std::size_t i, double step_s) {
  const std::size_t before = std::min(i, kBefore), behind = std::min(kBehind, t_s.size() - i - 1), first = i - before;
  const std::size_t count = before + 1 + behind;
  if (before + behind < kFewestInWindow || behind < kFewestBehind || !is_close(motion, first, count, step_s)) return {};
  std::vector<double> times(t_s.begin() + static_cast<long>(first), t_s.begin() + static_cast<long>(first + count));
  std::vector<double> places(motion.y_m.begin() + static_cast<long>(first),
                             motion.y_m.begin() + static_cast<long>(first + count));
  const auto alone = static_cast<long>(before);
  std::vector<double> other_times = times, other_places = places;
  other_times.erase(other_times.begin() + alone);
  other_places.erase(other_places.begin() + alone);
  const int all = lost_between(window_of(other_times, other_places, before, step_s), motion.noise_m);
  if (all < 2) return {};
  std::vector<CubicFit> fits;
  for (int lost = 0; lost <= all; ++lost) {
    fits.push_back(cubic_through(window_of(times, places, before + 1, step_s), all));
    times[before] += step_s;
  }
  const auto best = std::min_element(fits.begin(), fits.end(),
                                     [](const CubicFit& a, const CubicFit& b) { return a.squares < b.squares; });
  const auto lost = static_cast<int>(best - fits.begin());
  if (lost == 0 || lost == all) return {};  // one loss with nothing between: found as such
  const double scatter = std::max(motion.noise_m * motion.noise_m, best->squares / best->freedom);
  const double explained = std::max(kMostResidualSds * motion.noise_m, kMostResidualOfDistance * best->distance);
  const double otherwise = std::min(fits.front().squares, fits.back().squares);
  if (scatter >= explained * explained || otherwise - best->squares < kLeastEvidenceOfLoss * scatter) return {};
  return Beside{lost, all - lost};
}

/// The known losses and those found in addition, in order of time.
std::vector<LostFrames> losses_of(const Motion& motion, std::vector<LostFrames> known, double step_s) {
  std::vector<double> t = motion.t_s;
  for (double& at : t) at = put_right(at, known, step_s);
  const auto add = [&](std::size_t i, int lost) {
    known.push_back({motion.t_s[i - 1], static_cast<std::size_t>(lost)});
    for (std::size_t k = i; k < t.size(); ++k) t[k] += lost * step_s;
  };
  for (std::size_t i = 2; i + kFewestBehind <= t.size(); ++i) {
    if (is_smooth(motion, t, i, step_s)) continue;
    if (const int lost = lost_before(motion, t, i, step_s); lost > 0) {
      add(i, lost);
    } else if (const std::optional<Beside> beside = lost_beside(motion, t, i, step_s)) {
      add(i, beside->before);
      add(i + 1, beside->behind);
    }
  }
  std::sort(known.begin(), known.end(), [](const LostFrames& a, const LostFrames& b) { return a.after_s < b.after_s; });
  return known;
}

/// Outliers without a neighbouring outlier: after a jump several positions look like outliers.
std::vector<std::size_t> single_outliers(const Motion& motion) {
  const std::vector<std::size_t> outliers = find_outliers(motion);
  std::vector<std::size_t> single;
  for (std::size_t k = 0; k < outliers.size(); ++k) {
    const bool before = k > 0 && outliers[k - 1] + 1 == outliers[k];
    const bool behind = k + 1 < outliers.size() && outliers[k] + 1 == outliers[k + 1];
    if (!before && !behind) single.push_back(outliers[k]);
  }
  return single;
}

}  // namespace

std::vector<LostFrames> find_lost_frames(const TrackData& track, const Motion& motion) {
  const double step = median_step(track.frame_t_s);
  if (!has_even_steps(track.frame_t_s, step) || !(motion.noise_m > 0.0)) return {};
  // A position next to a jump may look like an outlier, so losses found with all positions are corrected first.
  const std::vector<LostFrames> plain = losses_of(motion, {}, step);
  Motion right = motion;
  for (double& at : right.t_s) at = put_right(at, plain, step);
  const std::vector<std::size_t> single = single_outliers(right);
  return single.empty() ? plain : losses_of(without(motion, single), plain, step);
}

double put_right(double file_s, const std::vector<LostFrames>& lost, double step_s) {
  std::size_t before = 0;
  for (const LostFrames& gap : lost) {
    if (file_s > gap.after_s + 0.5 * step_s) before += gap.count;
  }
  return file_s + static_cast<double>(before) * step_s;
}

TrackData put_right(TrackData track, const std::vector<LostFrames>& lost) {
  const double step = median_step(track.frame_t_s);
  for (double& t : track.t_s) t = put_right(t, lost, step);
  for (double& t : track.frame_t_s) t = put_right(t, lost, step);
  return track;
}

}  // namespace glidelab::core
