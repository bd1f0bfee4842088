#include "core/pictures/marker/marker_method.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "core/math/quantile.h"
#include "core/pictures/image/disc_search.h"

namespace glidelab::core {
namespace {

constexpr double kBoxRadii = 2.2, kBoxMargin_px = 2.0;  // of the radius, with a margin: half the side of the box
constexpr double kMostRadiiOfMarker = 1.6;              // of the radius: pixels farther out are background
constexpr double kSmallest_px = 1.5;                    // the marker's pixels are sought at least as far out
constexpr std::size_t kFewestOfRim = 8;                 // pixels
constexpr double kFloorOfPeak = 0.2;                    // of the peak
constexpr int kClearOfEdge_px = 2;  // between the marker's pixels and the image's edge, which may cut off others
constexpr double kFlatFrom = 0.25;  // weight above which all pixels count alike in the second centroid

/// The background by the median of the rim of the box, the peak by the brightest tenth near the guess.
struct Peak {
  double level;
  double amplitude;  ///< above the level, > 0
  double floor() const { return level + kFloorOfPeak * amplitude; }
};

cv::Rect box_around(const Signal& signal, const MarkerGuess& guess) {
  const double reach = kBoxRadii * guess.radius_px + kBoxMargin_px;
  const cv::Point corner(static_cast<int>(std::floor(guess.centre.x - reach)),
                         static_cast<int>(std::floor(guess.centre.y - reach)));
  const int side = 2 * static_cast<int>(std::ceil(reach)) + 1;
  return cv::Rect(corner.x, corner.y, side, side) & cv::Rect(0, 0, signal.values.cols, signal.values.rows);
}

constexpr unsigned char kMarked = 255;

/// Marks the pixels of a box that are no farther from the guess than `radius_px`.
cv::Mat mask_within(const cv::Rect& box, const MarkerGuess& guess, double radius_px) {
  cv::Mat mask = cv::Mat::zeros(box.size(), CV_8U);
  for (int v = 0; v < box.height; ++v) {
    const double dv = v + box.y - guess.centre.y, half2 = radius_px * radius_px - dv * dv;
    if (half2 < 0.0) continue;
    const double middle = guess.centre.x - box.x, half = std::sqrt(half2);
    const int first = std::max(0, static_cast<int>(std::ceil(middle - half)));
    const int last = std::min(box.width - 1, static_cast<int>(std::floor(middle + half)));
    if (first <= last) std::fill_n(mask.ptr<unsigned char>(v) + first, last - first + 1, kMarked);
  }
  return mask;
}

/// How often each value from `least` to `most` occurs under a mask.
class Levels {
 public:
  Levels(const cv::Mat& values, const cv::Mat& mask, double least, double most) : least_(least) {
    const int channel = 0, bins = static_cast<int>(most - least) + 1;
    const float range[] = {static_cast<float>(least), static_cast<float>(most + 1.0)};
    const float* ranges[] = {range};
    cv::calcHist(&values, 1, &channel, mask, counts_, 1, &bins, ranges);
    size_ = static_cast<std::size_t>(cv::countNonZero(mask));
  }
  std::size_t size() const { return size_; }
  /// Number `rank` of the sorted values, from 0; below size().
  double sorted(std::size_t rank) const {
    double below = 0.0;
    int bin = 0;
    while (bin + 1 < counts_.rows && (below += counts_.at<float>(bin)) <= static_cast<double>(rank)) ++bin;
    return least_ + bin;
  }

 private:
  cv::Mat counts_;
  double least_;
  std::size_t size_ = 0;
};

/// Pixels of a box near the guess: the smallest box around them, relative to the first one, with their mask.
struct Near {
  cv::Rect part;
  cv::Mat mask;

  Near(const cv::Rect& box, const MarkerGuess& guess) {
    const double radius = std::max(guess.radius_px, kSmallest_px);
    const cv::Point first(static_cast<int>(std::floor(guess.centre.x - radius)),
                          static_cast<int>(std::floor(guess.centre.y - radius)));
    const int side = static_cast<int>(std::ceil(2.0 * radius)) + 2;
    const cv::Rect whole = cv::Rect(first.x, first.y, side, side) & box;
    part = whole - box.tl();
    if (!part.empty()) mask = mask_within(whole, guess, radius);
  }
};

std::optional<Peak> peak_in(const cv::Mat& values, const Near& near, const cv::Mat& rim) {
  double least = 0.0, most = 0.0;
  cv::minMaxLoc(values, &least, &most);
  const Levels around(values, rim, least, most), inside(values(near.part), near.mask, least, most);
  if (around.size() < kFewestOfRim || inside.size() == 0) return std::nullopt;
  const double level = around.sorted(around.size() / 2);
  const double amplitude = inside.sorted(9 * inside.size() / 10) - level;
  if (!(amplitude > 0.0)) return std::nullopt;
  return Peak{level, amplitude};
}

/// The pixels above the floor that are connected, side by side, with the brightest one near the guess.
struct Spot {
  cv::Mat mask;  ///< kTaken where a pixel is one of them
  cv::Rect part;
  static constexpr int kTaken = 1;
};

std::optional<Spot> spot_in(const cv::Mat& values, const Near& near, double floor) {
  double brightest = 0.0;
  cv::Point seed;
  cv::minMaxLoc(values(near.part), nullptr, &brightest, nullptr, &seed, near.mask);
  if (!(brightest > floor)) return std::nullopt;
  Spot spot;
  cv::compare(values, floor, spot.mask, cv::CMP_GT);
  constexpr int kSideBySide = 4;
  cv::floodFill(spot.mask, seed + near.part.tl(), Spot::kTaken, &spot.part, {}, {}, kSideBySide);
  return spot;
}

}  // namespace

std::optional<MarkerFit> centroid_of_marker(const Signal& signal, const MarkerGuess& guess) {
  const cv::Rect box = box_around(signal, guess);
  if (box.width < 3 || box.height < 3) return std::nullopt;
  signal.see(box);
  const cv::Mat values = signal.values(box);
  const Near near(box, guess);
  if (near.part.empty()) return std::nullopt;
  cv::Mat rim;
  cv::bitwise_not(mask_within(box, guess, kMostRadiiOfMarker * guess.radius_px), rim);
  const std::optional<Peak> peak = peak_in(values, near, rim);
  if (!peak) return std::nullopt;
  const double floor = peak->floor();
  const std::optional<Spot> spot = spot_in(values, near, floor);
  if (!spot) return std::nullopt;
  const cv::Rect needed = with_border(spot->part + box.tl(), kClearOfEdge_px);
  if ((needed & cv::Rect({}, signal.values.size())) != needed) return std::nullopt;

  double sum = 0.0, sum_u = 0.0, sum_v = 0.0, area = 0.0;
  double flat_sum = 0.0, flat_u = 0.0, flat_v = 0.0;
  for (int v = spot->part.y; v < spot->part.br().y; ++v) {
    const unsigned char* const mask = spot->mask.ptr<unsigned char>(v);
    for (int u = spot->part.x; u < spot->part.br().x; ++u) {
      if (mask[u] != Spot::kTaken) continue;
      // The weight rises linearly from 0 at the floor, so that a pixel that comes or goes there does not matter.
      const double above = signal.at(u + box.x, v + box.y) - floor;
      const double weight = std::min(above / ((1.0 - kFloorOfPeak) * peak->amplitude), 1.0);
      sum += weight;
      sum_u += weight * (u + box.x);
      sum_v += weight * (v + box.y);
      area += std::min(weight * 2.0, 1.0);
      const double flat = std::min(weight / kFlatFrom, 1.0);
      flat_sum += flat;
      flat_u += flat * (u + box.x);
      flat_v += flat * (v + box.y);
    }
  }
  if (!(sum > 0.0)) return std::nullopt;
  MarkerFit marker;
  marker.centre = {sum_u / sum, sum_v / sum};
  marker.light_px = marker.centre - cv::Point2d(flat_u / flat_sum, flat_v / flat_sum);
  marker.radius_px = std::sqrt(area / std::numbers::pi);
  marker.amplitude = peak->amplitude;
  marker.background = peak->level;
  if (!has_expected_size(marker, guess)) return std::nullopt;
  return marker;
}

namespace {

constexpr double kLeastBicGainPerFrame = 10.0;  // average per frame: "very strong" on the usual scale
constexpr double kLeastOverScatter = 2.0;       // of a shading from frame to frame, times its scatter
constexpr double kSmallestShadedPx = 3.0;       // below, shading cannot be told from a shift
constexpr double kSameStart = 0.05;             // radii from the first start: the fit would fail again
// A ball that is lit from the side: half a radius from its centre to the centroid of its lit part. The disc that fits
// that part lies between the two and is smaller than the ball.
constexpr double kLitPartOff = 0.3, kLitRadius = 0.85;  // radii: from the centroid to that disc's centre; its radius
constexpr double kMostLitElongation = 1.5, kMostLitSizeOff = 0.3;  // of that disc; of the logarithm of its radius
constexpr double kMostLitResidual = 0.15;                          // relative to the amplitude: a ball is no such disc
constexpr double kMostDiscResidual = 0.1;  // relative to the amplitude; an object that is no disc leaves more
constexpr double kLeastJitterRatio = 1.2;  // a centroid must be steadier by this factor to be preferred to a disc

/// Starts each fit from what all windows share: the sharpness of the image and the size of the marker.
void share_guesses(std::vector<MarkerSample>& samples, MarkerMethod method, SignalKind kind) {
  std::vector<double> blurs, sizes;
  for (const MarkerSample& sample : samples) {
    const auto fit = measure_marker(sample.window, sample.guess, method, kind);
    if (!fit) continue;
    blurs.push_back(fit->blur_px);
    sizes.push_back(fit->radius_px / sample.guess.radius_px);
  }
  for (MarkerSample& sample : samples) {
    if (blurs.empty()) break;
    sample.guess.blur_px = median_of(blurs);
    sample.guess.radius_px *= median_of(sizes);
    sample.guess.shape.reset();
  }
}

/// The samples, measured by every method that may be chosen.
struct Remeasured {
  std::map<MarkerMethod, std::map<std::size_t, MarkerFit>> fits = {
      {MarkerMethod::uniform, {}}, {MarkerMethod::shaded, {}}, {MarkerMethod::centroid, {}}};  ///< by frame
  double bic_gain = 0.0;  ///< gain of a shaded over a uniform surface, summed over frames
  std::size_t both = 0;   ///< frames with both fits
};

bool are_most(std::size_t some, std::size_t all) {
  return 10 * some >= 9 * all;
}

/// Whether a method measures most samples. Those that are left once it fails in too many are not measured if
/// `needs_most`.
bool remeasure_by(MarkerMethod method, const std::vector<MarkerSample>& samples, SignalKind kind, bool needs_most,
                  std::map<std::size_t, MarkerFit>& fits) {
  std::size_t failed = 0;
  for (const MarkerSample& sample : samples) {
    if (needs_most && !are_most(samples.size() - failed, samples.size())) break;
    auto fit = measure_marker(sample.window, sample.guess, method, kind);
    if (!fit) {
      ++failed;
      continue;
    }
    fit->centre += cv::Point2d(sample.corner);
    fits[sample.frame] = *fit;
  }
  return are_most(fits.size(), samples.size());
}

Remeasured remeasure(const std::vector<MarkerSample>& samples, SignalKind kind) {
  Remeasured again;
  std::vector<MarkerSample> large;
  for (const MarkerSample& sample : samples) {
    if (sample.guess.radius_px >= kSmallestShadedPx) large.push_back(sample);
  }
  auto& uniform = again.fits[MarkerMethod::uniform];
  auto& shaded = again.fits[MarkerMethod::shaded];
  auto& centroid = again.fits[MarkerMethod::centroid];
  const bool is_centroid =
      may_have_any_shape(kind) && remeasure_by(MarkerMethod::centroid, samples, kind, false, centroid);
  const bool may_be_shaded =
      are_most(large.size(), samples.size()) && remeasure_by(MarkerMethod::shaded, large, kind, true, shaded);
  // Without most samples by either surface it is the centroid.
  remeasure_by(MarkerMethod::uniform, samples, kind, is_centroid && !may_be_shaded, uniform);
  for (const auto& [frame, fit] : shaded) {
    const auto other = uniform.find(frame);
    if (other == uniform.end()) continue;
    again.bic_gain += other->second.bic - fit.bic;
    ++again.both;
  }
  return again;
}

/// Whether the shading is that of a lit surface: the same in direction and size from frame to frame, and larger than
/// what the fits leave unexplained. Smear, a codec and a rounded edge also gain from a shaded surface, each frame in
/// its own way.
bool is_lit(const std::map<std::size_t, MarkerFit>& shaded) {
  cv::Vec3d sum;
  double squares = 0.0;
  std::vector<double> residuals;
  for (const auto& [frame, fit] : shaded) {
    sum += fit.shade;
    squares += fit.shade.dot(fit.shade);
    residuals.push_back(fit.rms / fit.amplitude);
  }
  const auto n = static_cast<double>(shaded.size());
  const cv::Vec3d mean = sum * (1.0 / n);
  const double size = cv::norm(mean), scatter = std::sqrt(std::max(0.0, squares / n - size * size));
  return size > kLeastOverScatter * scatter && size > median_of(std::move(residuals));
}

MarkerMethod best_of(const Remeasured& again, std::size_t samples, SignalKind kind) {
  const auto most = [&](MarkerMethod method) { return are_most(again.fits.at(method).size(), samples); };
  const auto jitter = [&](MarkerMethod method) {
    Places places;
    for (const auto& [frame, fit] : again.fits.at(method)) places[frame] = fit.centre;
    return jitter_of(places);
  };
  MarkerMethod chosen = MarkerMethod::uniform;
  const bool gains = again.both > 0 && again.bic_gain > kLeastBicGainPerFrame * static_cast<double>(again.both);
  if (most(MarkerMethod::shaded) &&
      (!most(MarkerMethod::uniform) || (gains && is_lit(again.fits.at(MarkerMethod::shaded)))))
    chosen = MarkerMethod::shaded;
  if (may_have_any_shape(kind) && most(MarkerMethod::centroid)) {
    std::vector<double> residuals{0.0};
    for (const auto& [frame, fit] : again.fits.at(chosen)) residuals.push_back(fit.rms / fit.amplitude);
    const auto of_fit = jitter(chosen);
    const auto of_centroid = jitter(MarkerMethod::centroid);
    const bool is_disc = most(chosen) && median_of(residuals) < kMostDiscResidual;
    if (!is_disc || (of_fit && of_centroid && *of_fit > kLeastJitterRatio * *of_centroid))
      chosen = MarkerMethod::centroid;
  }
  return chosen;
}

}  // namespace

std::optional<MarkerFit> measure_marker(const Signal& signal, const MarkerGuess& guess, MarkerMethod method,
                                        SignalKind kind) {
  std::optional<MarkerFit> fit;
  if (method == MarkerMethod::uniform || method == MarkerMethod::undecided)
    fit = fit_marker(signal, guess, Surface::uniform);
  if (method == MarkerMethod::shaded) fit = fit_marker(signal, guess, Surface::shaded);
  // An object that is told by its hue or its light may have any shape.
  if (method == MarkerMethod::centroid || (!fit && method == MarkerMethod::undecided && may_have_any_shape(kind))) {
    fit = centroid_of_marker(signal, guess);
  }
  if (fit && fit->amplitude < least_contrast(kind)) return std::nullopt;
  return fit;
}

std::optional<MeasuredMarker> measure_near(const Signal& signal, const MarkerGuess& guess, MarkerMethod method,
                                           SignalKind kind) {
  if (const auto fit = measure_marker(signal, guess, method, kind)) return MeasuredMarker{guess, *fit};
  if (method == MarkerMethod::centroid) return std::nullopt;
  const std::optional<MarkerFit> spot = centroid_of_marker(signal, guess);
  if (!spot || cv::norm(spot->centre - guess.centre) < kSameStart * guess.radius_px) return std::nullopt;
  MarkerGuess nearer = guess;
  nearer.centre = spot->centre;
  const auto fit = measure_marker(signal, nearer, method, kind);
  return fit ? std::optional(MeasuredMarker{nearer, *fit}) : std::nullopt;
}

std::optional<MeasuredMarker> measure_lit(const Signal& signal, const MarkerGuess& guess, SignalKind kind) {
  if (may_have_any_shape(kind) || guess.radius_px < kSmallestShadedPx) return std::nullopt;
  const std::optional<MarkerFit> spot = centroid_of_marker(signal, guess);
  if (!spot) return std::nullopt;
  MarkerGuess beside = guess;
  beside.shape = cv::Vec3d(1.0, 0.0, 1.0) * (1.0 / (kLitRadius * guess.radius_px));
  constexpr int kDirections = 8;
  std::optional<MeasuredMarker> best;
  for (int direction = 0; direction < kDirections; ++direction) {
    const double angle = 2.0 * std::numbers::pi * direction / kDirections;
    beside.centre = spot->centre + kLitPartOff * guess.radius_px * cv::Point2d(std::cos(angle), std::sin(angle));
    const auto fit = measure_marker(signal, beside, MarkerMethod::shaded, kind);
    if (!fit || fit->rms > kMostLitResidual * fit->amplitude || fit->elongation > kMostLitElongation) continue;
    if (std::abs(std::log(fit->radius_px / guess.radius_px)) > kMostLitSizeOff) continue;
    if (!best || fit->rms < best->fit.rms) best = MeasuredMarker{beside, *fit};
  }
  return best;
}

void choose_method(MarkerPath& path, SignalKind kind, const RadiusAt& radius_at) {
  share_guesses(path.samples, path.lit ? MarkerMethod::shaded : MarkerMethod::uniform, kind);
  const Remeasured measured = remeasure(path.samples, kind);
  path.method = best_of(measured, path.samples.size(), kind);
  const std::map<std::size_t, MarkerFit>& fits = measured.fits.at(path.method);
  std::vector<MarkerSeen> kept;
  for (const MarkerSeen& sighting : path.seen) {
    const bool sampled = std::any_of(path.samples.begin(), path.samples.end(),
                                     [&](const MarkerSample& sample) { return sample.frame == sighting.frame; });
    const auto again = fits.find(sighting.frame);
    if (again != fits.end()) {
      kept.push_back({sighting.frame, again->second, radius_at(again->second.centre)});
    } else if (!sampled) {
      kept.push_back(sighting);  // found while following back, or at rest
    }
  }
  path.samples.clear();
  if (kept.size() < 2) return;
  path.seen.clear();
  path.travel_px = 0.0;
  for (const MarkerSeen& sighting : kept) path.push(sighting);
}

}  // namespace glidelab::core
