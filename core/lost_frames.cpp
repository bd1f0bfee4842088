#include "core/lost_frames.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "core/outliers.h"
#include "core/quantile.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kBefore = 4, kBehind = 4;  // positions that a cubic goes through on either side
constexpr std::size_t kFewestBehind = 2;         // where another loss follows soon
constexpr double kEvidence = 50.0;
constexpr double kExplained = 4.0;      // standard deviations of the noise that residuals may have
constexpr double kOfWay = 0.1;          // of a frame's way that they may be: a law that changes at a reversal
constexpr double kOfFrame = 1.0 / 7.0;  // that the jump may be from a whole number of frames
constexpr double kMarkerMissing = 2.0;  // frames without a marker that a window may hold
constexpr double kUniform = 0.1;        // of the step

bool is_uniform(const std::vector<double>& t_s, double step_s) {
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    if (std::abs(t_s[i] - t_s[i - 1] - step_s) > kUniform * step_s) return false;
  }
  return step_s > 0.0;
}

/// The cubic through the positions of a window, those behind the pair at later times.
struct CubicFit {
  double squares = 0.0;   ///< of the residuals
  double off = 0.0;       ///< frames by which those behind lie later still, to first order
  double off_gain = 0.0;  ///< its variance in units of the noise's
  double way = 0.0;       ///< in one frame, behind the pair
};

/// The first `before` points keep their times, the others are `lost` frames later.
CubicFit cubic_through(std::span<const double> t_s, std::span<const double> y_m, std::size_t before, double step_s,
                       int lost) {
  const auto n = static_cast<Eigen::Index>(t_s.size());
  Eigen::Matrix<double, Eigen::Dynamic, 4, 0, kBefore + kBehind, 4> design(n, 4), by_frames(n, 4);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kBefore + kBehind, 1> y(n);
  for (Eigen::Index r = 0; r < n; ++r) {
    const auto i = static_cast<std::size_t>(r);
    const double late = i < before ? 0.0 : lost, unit = 1.0 / static_cast<double>(kBefore);
    const double u = ((t_s[i] - t_s[before]) / step_s + late) * unit;
    design.row(r) << 1.0, u, u * u, u * u * u;
    by_frames.row(r) << 0.0, 1.0, 2.0 * u, 3.0 * u * u;
    by_frames.row(r) *= i < before ? 0.0 : unit;
    y[r] = y_m[i] - y_m[before];
  }
  const Eigen::HouseholderQR<decltype(design)> qr(design);
  const Eigen::Vector4d cubic = qr.solve(y);
  const auto residual = (y - design * cubic).eval();
  const auto late = (by_frames * cubic).eval();  // change of the model by one frame
  const auto own = (late - design * qr.solve(late)).eval();
  const double norm = own.squaredNorm();
  return {residual.squaredNorm(), norm > 0.0 ? own.dot(residual) / norm : 0.0,
          norm > 0.0 ? 1.0 / norm : std::numeric_limits<double>::infinity(),
          std::abs(late[static_cast<Eigen::Index>(before)])};
}

/// How many frames are lost between the two sides; 0 where nothing says so.
int lost_between(std::span<const double> t_s, std::span<const double> y_m, std::size_t before, double step_s,
                 double noise_m) {
  const double variance = noise_m * noise_m, freedom = static_cast<double>(t_s.size()) - 4.0;
  const double without = cubic_through(t_s, y_m, before, step_s, 0).squares;
  if (without < kEvidence * variance) return 0;
  int best = 0;
  CubicFit fit{without};
  for (int lost = 1; lost <= kMostLost; ++lost) {
    const CubicFit tried = cubic_through(t_s, y_m, before, step_s, lost);
    if (tried.squares >= fit.squares) continue;
    best = lost;
    fit = tried;
  }
  const double scatter = std::max(variance, fit.squares / freedom);
  const double explained = std::max(kExplained * noise_m, kOfWay * fit.way);
  const bool explains = without - fit.squares > kEvidence * scatter && scatter < explained * explained;
  const bool whole = std::abs(fit.off) < kOfFrame && std::sqrt(scatter * fit.off_gain) < kOfFrame;
  return best > 0 && explains && whole ? best : 0;
}

}  // namespace

std::vector<LostFrames> find_lost_frames(const TrackData& track, const Motion& motion) {
  const double step = median_step(track.frame_t_s);
  std::vector<LostFrames> all;
  if (!is_uniform(track.frame_t_s, step) || !(motion.noise_m > 0.0)) return all;
  std::vector<double> t = motion.t_s;
  for (std::size_t i = 2; i + kFewestBehind <= t.size(); ++i) {
    const std::size_t before = std::min(i, kBefore);
    // Fewer points behind where the whole window does not say: another loss may follow.
    for (std::size_t behind = std::min(kBehind, t.size() - i); behind >= kFewestBehind; --behind) {
      if (before + behind < 6) break;
      const std::size_t first = i - before;
      const std::span times = std::span(t).subspan(first, before + behind);
      const double span_s = motion.t_s[i + behind - 1] - motion.t_s[first];
      if (span_s > (static_cast<double>(before + behind) + kMarkerMissing) * step) continue;
      const std::span places = std::span(motion.y_m).subspan(first, before + behind);
      const int lost = lost_between(times, places, before, step, motion.noise_m);
      if (lost == 0) continue;
      all.push_back({motion.t_s[i - 1], static_cast<std::size_t>(lost)});
      for (std::size_t k = i; k < t.size(); ++k) t[k] += lost * step;
      break;
    }
  }
  return all;
}

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
