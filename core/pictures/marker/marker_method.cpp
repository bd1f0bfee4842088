#include "core/pictures/marker/marker_method.h"

#include <algorithm>
#include <map>

#include "core/math/quantile.h"
#include "core/pictures/marker/marker_centroid.h"

namespace glidelab::core {
namespace {

constexpr double kLeastBicGainPerFrame = 10.0;  // a frame, on average: "very strong" on the usual scale
constexpr double kSmallestShadedPx = 3.0;       // below, shading and place cannot be told apart
constexpr double kMostDiscResidual = 0.1;       // of the amplitude; what is no disc leaves more
constexpr double kLeastJitterRatio = 1.2;       // times, by which a centroid must be to be preferred

/// What all windows agree on, the image's sharpness and the marker's size, from which each fit then starts.
void share_guesses(std::vector<MarkerSample>& samples, SignalKind kind) {
  std::vector<double> blurs, sizes;
  for (const MarkerSample& sample : samples) {
    const auto fit = measure_marker(sample.window, sample.guess, MarkerMethod::uniform, kind);
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

/// The samples measured in every way that may be chosen.
struct Remeasured {
  std::map<MarkerMethod, std::map<std::size_t, MarkerFit>> fits = {
      {MarkerMethod::uniform, {}}, {MarkerMethod::shaded, {}}, {MarkerMethod::centroid, {}}};  ///< by frame
  double bic_gain = 0.0;  ///< of shading over none, summed over frames
  std::size_t both = 0;   ///< frames that have both
};

Remeasured remeasure(const std::vector<MarkerSample>& samples, SignalKind kind) {
  Remeasured again;
  for (const MarkerSample& sample : samples) {
    std::vector<MarkerMethod> methods{MarkerMethod::uniform};
    if (sample.guess.radius_px >= kSmallestShadedPx) methods.push_back(MarkerMethod::shaded);
    if (kind == SignalKind::colored) methods.push_back(MarkerMethod::centroid);
    for (const MarkerMethod method : methods) {
      auto fit = measure_marker(sample.window, sample.guess, method, kind);
      if (!fit) continue;
      fit->centre += cv::Point2d(sample.corner);
      again.fits[method][sample.frame] = *fit;
    }
    const auto uniform = again.fits[MarkerMethod::uniform].find(sample.frame);
    const auto shaded = again.fits[MarkerMethod::shaded].find(sample.frame);
    if (uniform == again.fits[MarkerMethod::uniform].end() || shaded == again.fits[MarkerMethod::shaded].end())
      continue;
    again.bic_gain += uniform->second.bic - shaded->second.bic;
    ++again.both;
  }
  return again;
}

MarkerMethod best_of(const Remeasured& again, std::size_t samples, SignalKind kind) {
  const auto most = [&](MarkerMethod method) { return 10 * again.fits.at(method).size() >= 9 * samples; };
  const auto jitter = [&](MarkerMethod method) {
    Places places;
    for (const auto& [frame, fit] : again.fits.at(method)) places[frame] = fit.centre;
    return jitter_of(places);
  };
  MarkerMethod chosen = MarkerMethod::uniform;
  if (most(MarkerMethod::shaded) && again.both > 0 &&
      again.bic_gain > kLeastBicGainPerFrame * static_cast<double>(again.both))
    chosen = MarkerMethod::shaded;
  if (kind == SignalKind::colored && most(MarkerMethod::centroid)) {
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
  // A thing that is known by its hue may have any shape.
  if (method == MarkerMethod::centroid || (!fit && method == MarkerMethod::undecided && kind == SignalKind::colored)) {
    fit = centroid_of_marker(signal, guess);
  }
  if (fit && fit->amplitude < least_contrast(kind)) return std::nullopt;
  return fit;
}

void choose_method(MarkerPath& path, SignalKind kind, const RadiusAt& radius_at) {
  share_guesses(path.samples, kind);
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
      kept.push_back(sighting);  // followed back, or asleep
    }
  }
  path.samples.clear();
  if (kept.size() < 2) return;
  path.seen.clear();
  path.travel_px = 0.0;
  for (const MarkerSeen& sighting : kept) path.push(sighting);
}

}  // namespace glidelab::core
