#include "diagnose/noise/noise_chunks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/math/dense.h"

namespace glidelab::diagnose {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr std::size_t kMostPoints = 1920;  // of all motions: more add nothing to a handful of numbers
constexpr std::size_t kFewestInChunk = 24;
constexpr double kAlike = 1e-6;   // a slow wave is a sum of bumps but for less than this: it counts once
constexpr double kMostOff = 8.0;  // standard deviations off the neighbours

// Sine and cosine, with time and its square: a frequency between two that are tried is half a radian off at the ends of
// such points at most, of which these leave half a percent; a size that grows across the image is in them.
constexpr Eigen::Index kWaveColumns = 6;

/// Points that are taken together, and frames from bump to bump of what is set aside as slow. A codec that predicts
/// images from those before hands its errors on: what lasts for up to a dozen frames must be left to be seen.
struct Slow {
  std::size_t chunk = 80;
  double knot = 10.0;
};
constexpr Slow kNew, kHandedOn{160, 30.0};

/// Frames of a motion that are no outliers, in stretches. Beside a wave, the fit's errors by the place between pixels
/// have taken up some of it, and are set aside as well.
void add_chunks(const TrackSet& set, const MotionFit& fit, std::size_t i, double wave_hz, const Slow& slow,
                std::vector<NoiseChunk>& chunks) {
  const TrackedMotion& motion = set.motions[i];
  const SeenFrames all = seen_frames(motion, set.clips[motion.clip].frame_rate_hz);
  const std::size_t points = motion.t_s.size(), parts = std::max<std::size_t>(1, points / slow.chunk);
  for (std::size_t part = 0; part < parts; ++part) {
    NoiseChunk chunk;
    chunk.motion = i;
    std::vector<double> off, t;
    std::vector<std::vector<double>> pixel(motion.shared_m.size() -
                                           std::min(motion.shared_m.size(), motion.first_pixel_mode));
    for (std::size_t p = points * part / parts; p < points * (part + 1) / parts; ++p) {
      const bool inside = p >= 2 && p + 2 < points;
      const bool lost = inside && std::abs(neighbour_residual(motion.t_s, motion.x_m, p)) > kMostOff * motion.sd_of(p);
      if (motion.outlier[p] != 0 || lost) continue;
      chunk.frames.along_px.push_back(all.along_px[p]);
      chunk.frames.frame.push_back(all.frame[p]);
      chunk.frames.v_px_s.push_back(all.v_px_s[p]);
      t.push_back(motion.t_s[p]);
      for (std::size_t m = 0; m < pixel.size(); ++m) {
        pixel[m].push_back(motion.shared_m[motion.first_pixel_mode + m][p] / motion.m_per_px);
      }
      off.push_back(fit.motions[i].plain[static_cast<Eigen::Index>(p)] * motion.sd_of(p) / unit_m(motion));
    }
    if (off.size() < kFewestInChunk) continue;
    const auto n = std::ssize(off);
    chunk.off_px = Eigen::Map<const Eigen::VectorXd>(off.data(), n);
    const double first = chunk.frames.frame.front(), span = chunk.frames.frame.back() - first;
    const auto bumps = static_cast<Eigen::Index>(std::ceil(span / slow.knot)) + 1;
    const double width = span / static_cast<double>(bumps - 1);
    const Eigen::Index of_wave = wave_hz > 0.0 ? kWaveColumns : 0;
    const Eigen::Index of_pixels = wave_hz > 0.0 ? static_cast<Eigen::Index>(pixel.size()) : 0;
    chunk.slow = Eigen::MatrixXd::Zero(n, bumps + of_wave + of_pixels);
    for (Eigen::Index p = 0; p < n; ++p) {
      const auto q = static_cast<std::size_t>(p);
      for (Eigen::Index b = 0; b < bumps; ++b) {
        const double z = (chunk.frames.frame[q] - first) / width - static_cast<double>(b);
        chunk.slow(p, b) = std::exp(-0.5 * z * z);
      }
      for (Eigen::Index w = 0; w < of_wave; ++w) {
        const double phase = kTurn * wave_hz * t[q], along = 2.0 * (t[q] - t.front()) / (t.back() - t.front()) - 1.0;
        chunk.slow(p, bumps + w) = (w % 2 == 0 ? std::sin(phase) : std::cos(phase)) * std::pow(along, w / 2);
      }
      for (Eigen::Index m = 0; m < of_pixels; ++m) {
        chunk.slow(p, bumps + of_wave + m) = pixel[static_cast<std::size_t>(m)][q];
      }
    }
    chunk.slow = base::orthonormal_columns(chunk.slow, kAlike);
    chunks.push_back(std::move(chunk));
  }
}

}  // namespace

std::vector<NoiseChunk> noise_chunks(const TrackSet& set, const MotionFit& fit, double wave_hz) {
  std::vector<NoiseChunk> chunks;
  const Slow& slow = set.handed_on ? kHandedOn : kNew;
  for (std::size_t i = 0; i < set.motions.size(); ++i) add_chunks(set, fit, i, wave_hz, slow, chunks);
  const std::size_t most = kMostPoints / slow.chunk;
  if (chunks.size() <= most) return chunks;
  std::vector<NoiseChunk> some;
  for (std::size_t k = 0; k < most; ++k) some.push_back(chunks[k * chunks.size() / most]);
  return some;
}

}  // namespace glidelab::diagnose
