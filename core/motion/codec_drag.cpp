#include "core/motion/codec_drag.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/math/dense.h"
#include "core/motion/free/free_motion.h"
#include "core/motion/free/lost_frames.h"
#include "core/motion/free/motion.h"
#include "core/motion/smoothing/wiener_smoother.h"

namespace glidelab::core {
namespace {

constexpr Eigen::Index kWaves = 8, kTerms = kWaves + 1;  // down to a quarter of a pixel
constexpr double kHeld_px = 0.05;                        // per frame; a slower marker is held
// r: H.264 by x264 at 1 to 2 bits a pixel gives 0.3 to 0.5, and more when it compresses more. One standard deviation to
// each side.
constexpr std::array<double, 3> kCarriedOver{0.3, 0.5, 0.7};
constexpr std::size_t kLeastCarried = 0, kUsualCarried = 1, kMostCarried = 2;
constexpr double kLeastTravel_px = 2.0;  // least distance of a marker that moves
constexpr double kPeriod_px =
    2.0;  // per frame, of h: below it nothing of h recurs, and it looks like any law of motion
constexpr double kFewestPoints = 60.0;
constexpr std::size_t kNeighbours = 3;  // frames to each side that determine a displacement
constexpr int kPasses = 200;            // of expectation maximisation
constexpr double kLeast_px = 1e-7;      // p; below it there is no drag
// For H.264 at 1 to 2 bits per pixel, both grey and behind a colour mosaic, p is 0.014 to 0.02. This knowledge has the
// weight of four waves.
constexpr double kExpected_px = 0.02, kExpectedCounts = 4.0;

/// The line along which the marker moves in the image, and x as a function of the distance along it.
struct ImagePath {
  Eigen::Vector2d direction;
  std::vector<double> along_px;
  std::vector<double> m_per_px;  ///< dx / d(along), at each point
};

std::optional<ImagePath> path_of(const TrackData& track) {
  const auto n = static_cast<Eigen::Index>(track.sightings.size());
  if (track.sightings.size() != track.x_m.size() || n < 8) return {};
  Eigen::MatrixXd place(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    const MarkerSighting& sighting = track.sightings[static_cast<std::size_t>(i)];
    place.row(i) << sighting.u_px, sighting.v_px;
  }
  const Eigen::RowVector2d middle = place.colwise().mean();
  place.rowwise() -= middle;
  const base::SymmetricEigen axes = base::symmetric_eigen(base::transposed_product(place, place));
  ImagePath path;
  path.direction = axes.vectors.col(1);
  const Eigen::VectorXd along = base::product(place, axes.vectors.col(1));
  const double reach = along.cwiseAbs().maxCoeff();
  if (!(along.maxCoeff() - along.minCoeff() > kLeastTravel_px)) return {};
  // x as a cubic of the position in the image: perspective and distortion are smooth.
  constexpr Eigen::Index kCoefficients = 4;
  Eigen::MatrixXd powers(n, kCoefficients);
  for (Eigen::Index i = 0; i < n; ++i) {
    double power = 1.0;
    for (Eigen::Index c = 0; c < kCoefficients; ++c, power *= along[i] / reach) powers(i, c) = power;
  }
  const Eigen::VectorXd cubic =
      base::least_squares(powers, Eigen::Map<const Eigen::VectorXd>(track.x_m.data(), n)).col(0);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double z = along[i] / reach;
    path.along_px.push_back(along[i]);
    path.m_per_px.push_back((cubic[1] + z * (2.0 * cubic[2] + z * 3.0 * cubic[3])) / reach);
  }
  return path;
}

/// Displacement in pixels per frame, from a parabola through the point's neighbours in time, or from a line if there
/// are few.
double displacement(const TrackData& track, const ImagePath& path, std::size_t k) {
  const double here = static_cast<double>(track.frame[k]);
  std::size_t from = k, to = k + 1;
  const auto near = [&](std::size_t i) {
    return std::abs(static_cast<double>(track.frame[i]) - here) <= static_cast<double>(kNeighbours);
  };
  while (from > 0 && near(from - 1)) --from;
  while (to < track.frame.size() && near(to)) ++to;
  const auto n = static_cast<Eigen::Index>(to - from);
  if (n < 2) return 0.0;
  Eigen::MatrixXd powers(n, n < 4 ? 2 : 3);
  Eigen::VectorXd along(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto q = from + static_cast<std::size_t>(i);
    const double z = static_cast<double>(track.frame[q]) - here;
    powers(i, 0) = 1.0;
    powers(i, 1) = z;
    if (powers.cols() > 2) powers(i, 2) = z * z;
    along[i] = path.along_px[q];
  }
  return base::least_squares(powers, along)(1, 0);
}

/// The terms at each point, in metres along x for one pixel.
Eigen::MatrixXd terms_of(const TrackData& track, const ImagePath& path, double handed) {
  Eigen::MatrixXd terms(static_cast<Eigen::Index>(track.x_m.size()), kTerms);
  Eigen::RowVectorXd handed_on;
  double came_px = 0.0;  // its last movement
  for (std::size_t k = 0; k < track.x_m.size(); ++k) {
    const double moved = displacement(track, path, k);
    Eigen::RowVectorXd now(kWaves);
    for (Eigen::Index n = 0; n < kWaves; ++n) {
      now[n] = 0.0;
      for (const double part : {path.direction[0], path.direction[1]}) {
        now[n] += part * std::sin(std::numbers::pi * static_cast<double>(n + 1) * part * moved);
      }
    }
    const bool follows = k > 0 && track.frame[k] == track.frame[k - 1] + 1;
    handed_on = follows ? Eigen::RowVectorXd(handed * handed_on + (1.0 - handed) * now) : now;
    if (came_px == 0.0 || std::abs(moved) > kHeld_px) came_px = moved;
    const auto row = static_cast<Eigen::Index>(k);
    terms.row(row).head(kWaves) = path.m_per_px[k] * handed_on;
    terms(row, kWaves) = -path.m_per_px[k] * std::copysign(std::exp(-0.5 * std::pow(moved / kHeld_px, 2)), came_px);
  }
  return terms;
}

/// Sums over one track's points of free motion: H the terms, z the positions, P = I - S.
struct TrackSums {
  Eigen::MatrixXd terms;  ///< H' P H
  Eigen::VectorXd seen;   ///< H' P z
  double square = 0.0;    ///< z' P z
  double freedom = 0.0;   ///< trace of P
  double variance = 0.0;  ///< s^2
};

/// The free motion's positions in parts, and their indices in the motion.
struct FreePoints {
  SmoothingInput input;
  std::vector<std::size_t> point;
};

FreePoints free_points(const Motion& motion, const ClipSetup& setup) {
  FreePoints free;
  const FreeMotion found = find_free_motion(motion, setup);
  for (std::size_t s = 0; s < found.stretches.size(); ++s) {
    const FreeStretch& stretch = found.stretches[s];
    if (s > 0 && turns_into(found.stretches[s - 1], stretch)) {
      free.input.breaks_s.push_back(0.5 * (motion.t_s[stretch.first - 1] + motion.t_s[stretch.first]));
    } else if (s > 0) {
      free.input.starts.push_back(free.point.size());
    }
    for (std::size_t i = stretch.first; i < stretch.first + stretch.count; ++i) {
      free.point.push_back(i);
      free.input.t_s.push_back(motion.t_s[i]);
      free.input.x_m.push_back(motion.y_m[i]);
    }
  }
  return free;
}

/// For each r.
template <typename Of>
using EachCarried = std::array<Of, kCarriedOver.size()>;

/// Freedom is 0 if there is no free motion.
EachCarried<TrackSums> sums_of(const ClipSetup& setup, const TrackData& filed,
                               const EachCarried<Eigen::MatrixXd>& terms) {
  EachCarried<TrackSums> sums;
  const TrackData track = put_right(filed, find_lost_frames(filed, motion_of(filed, setup.mass_kg)));
  const Motion measured = motion_of(track, setup.mass_kg);
  const Motion motion = without(measured, find_outliers(measured));
  const FreePoints free = free_points(motion, setup);
  if (free.point.empty()) return sums;
  const std::vector<std::optional<KernelRow>> rows = lawless_rows(free.input);
  const auto n = static_cast<Eigen::Index>(free.point.size());
  constexpr auto kColumns = static_cast<Eigen::Index>(kCarriedOver.size()) * kTerms;
  Eigen::MatrixXd columns(n, kColumns + 1);
  const double middle_m = motion.y_m[free.point[free.point.size() / 2]];
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t of_motion = free.point[static_cast<std::size_t>(i)];
    for (std::size_t r = 0; r < terms.size(); ++r) {
      columns.row(i).segment(static_cast<Eigen::Index>(r) * kTerms, kTerms) =
          terms[r].row(static_cast<Eigen::Index>(motion.point[of_motion]));
    }
    columns(i, kColumns) = motion.y_m[of_motion] - middle_m;
  }
  Eigen::MatrixXd left = Eigen::MatrixXd::Zero(n, kColumns + 1);  // P times them
  double freedom = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::optional<KernelRow>& row = rows[static_cast<std::size_t>(i)];
    if (!row) continue;
    left.row(i) = columns.row(i);
    const std::vector<double>& weights = row->weights->x;
    for (std::size_t j = 0; j < weights.size(); ++j) {
      left.row(i) -= weights[j] * columns.row(static_cast<Eigen::Index>(row->first + j));
    }
    freedom += 1.0 - weights[static_cast<std::size_t>(i) - row->first];
  }
  const Eigen::MatrixXd all = base::transposed_product(columns, left);
  const Eigen::MatrixXd even = 0.5 * (all + all.transpose());  // fading weights are cut off on one side
  for (std::size_t r = 0; r < sums.size(); ++r) {
    const Eigen::Index first = static_cast<Eigen::Index>(r) * kTerms;
    sums[r].terms = even.block(first, first, kTerms, kTerms);
    sums[r].seen = even.col(kColumns).segment(first, kTerms);
    sums[r].square = even(kColumns, kColumns);
    sums[r].freedom = freedom;
    sums[r].variance = freedom > 0.0 ? sums[r].square / freedom : 0.0;
  }
  return sums;
}

struct Sizes {
  Eigen::VectorXd size_px;
  Eigen::MatrixXd covariance_px2;
  double log_evidence = 0.0;
};

/// The most likely p and s, and the posterior of b and c.
Sizes likeliest(std::vector<TrackSums> tracks, bool predicts) {
  Eigen::VectorXd shape(kTerms);
  for (Eigen::Index n = 0; n < kWaves; ++n) shape[n] = 1.0 / static_cast<double>(n + 1);
  shape[kWaves] = 1.0;
  double without = 0.0;
  for (const TrackSums& track : tracks) without -= 0.5 * track.freedom * (std::log(track.variance) + 1.0);
  Sizes sizes;
  const double known = predicts ? kExpectedCounts : 0.0, expected_px2 = kExpected_px * kExpected_px;
  double variance_px2 = expected_px2;
  for (int pass = 0; pass < kPasses; ++pass) {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(kTerms, kTerms);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(kTerms);
    for (const TrackSums& track : tracks) {
      normal += track.terms / track.variance;
      right += track.seen / track.variance;
    }
    const Eigen::VectorXd prior = variance_px2 * shape;
    Eigen::MatrixXd precision = normal;
    precision.diagonal() += prior.cwiseInverse();
    sizes.covariance_px2 = base::inverse_positive(precision);
    sizes.size_px = base::product(sizes.covariance_px2, right).col(0);
    const Eigen::MatrixXd lower = base::cholesky_lower(precision);
    double log_likelihood =
        -lower.diagonal().array().log().sum() - 0.5 * prior.array().log().sum() + 0.5 * sizes.size_px.dot(right);
    for (const TrackSums& track : tracks) {
      log_likelihood -= 0.5 * (track.freedom * std::log(track.variance) + track.square / track.variance);
    }
    sizes.log_evidence = log_likelihood - without;
    for (TrackSums& track : tracks) {
      const Eigen::VectorXd taken = base::product(track.terms, sizes.size_px).col(0);
      const double square = track.square - 2.0 * sizes.size_px.dot(track.seen) + sizes.size_px.dot(taken) +
                            sizes.covariance_px2.cwiseProduct(track.terms).sum();
      track.variance = square / track.freedom;
    }
    const Eigen::VectorXd squares = sizes.size_px.cwiseAbs2() + sizes.covariance_px2.diagonal();
    variance_px2 = (squares.cwiseQuotient(shape).sum() + known * expected_px2) / (static_cast<double>(kTerms) + known);
    variance_px2 = std::max(variance_px2, kLeast_px * kLeast_px);
  }
  return sizes;
}

std::vector<double> values_of(const Eigen::MatrixXd& terms, const Eigen::VectorXd& size_px) {
  if (terms.size() == 0) return {};
  const Eigen::MatrixXd values = base::product(terms, size_px);
  return {values.data(), values.data() + values.size()};
}

}  // namespace

std::optional<CodecDrag> find_codec_drag(const std::vector<DragTrack>& tracks, bool predicts) {
  std::vector<EachCarried<Eigen::MatrixXd>> terms(tracks.size());
  EachCarried<std::vector<TrackSums>> sums;
  double points = 0.0, square = 0.0, count = 0.0;
  std::vector<double> px_per_m(tracks.size(), 0.0);
  double fastest_px = 0.0;  // per frame
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const std::optional<ImagePath> path = path_of(*tracks[i].track);
    if (!path) continue;
    for (std::size_t k = 0; k < path->along_px.size(); ++k) {
      fastest_px = std::max(fastest_px, std::abs(displacement(*tracks[i].track, *path, k)));
    }
    px_per_m[i] = 1.0 / path->m_per_px[path->m_per_px.size() / 2];
    for (std::size_t r = 0; r < kCarriedOver.size(); ++r)
      terms[i][r] = terms_of(*tracks[i].track, *path, kCarriedOver[r]);
    EachCarried<TrackSums> of_track = sums_of(*tracks[i].setup, *tracks[i].track, terms[i]);
    if (!(of_track[0].freedom > 0.0) || !(of_track[0].variance > 0.0)) continue;
    points += of_track[0].freedom;
    for (std::size_t r = 0; r < kCarriedOver.size(); ++r) sums[r].push_back(std::move(of_track[r]));
  }
  if (points < kFewestPoints || (!predicts && fastest_px < kPeriod_px)) return {};
  EachCarried<Sizes> found;
  for (std::size_t r = 0; r < kCarriedOver.size(); ++r) found[r] = likeliest(std::move(sums[r]), predicts);
  const Sizes& usual = found[kUsualCarried];
  CodecDrag drag;
  drag.log_evidence = usual.log_evidence;
  const auto of_tracks = [&](std::size_t r, const Eigen::VectorXd& size_px) {
    std::vector<std::vector<double>> all;
    for (const EachCarried<Eigen::MatrixXd>& of_track : terms) all.push_back(values_of(of_track[r], size_px));
    return all;
  };
  drag.drag_m = of_tracks(kUsualCarried, usual.size_px);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    for (const double x_m : drag.drag_m[i]) square += std::pow(x_m * px_per_m[i], 2);
    count += static_cast<double>(drag.drag_m[i].size());
  }
  drag.rms_px = std::sqrt(square / count);
  const base::SymmetricEigen modes = base::symmetric_eigen(usual.covariance_px2);
  for (Eigen::Index m = 0; m < kTerms; ++m) {
    drag.error_m.push_back(of_tracks(kUsualCarried, std::sqrt(std::max(modes.values[m], 0.0)) * modes.vectors.col(m)));
  }
  // The posterior of r.
  std::vector<std::vector<double>> of_r = of_tracks(kMostCarried, found[kMostCarried].size_px);
  const std::vector<std::vector<double>> least = of_tracks(kLeastCarried, found[kLeastCarried].size_px);
  for (std::size_t i = 0; i < of_r.size(); ++i) {
    for (std::size_t k = 0; k < of_r[i].size(); ++k) of_r[i][k] = 0.5 * (of_r[i][k] - least[i][k]);
  }
  drag.error_m.push_back(std::move(of_r));
  return drag;
}

}  // namespace glidelab::core
