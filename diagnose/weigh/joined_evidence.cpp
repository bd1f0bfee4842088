#include "diagnose/weigh/joined_evidence.h"

#include <algorithm>
#include <cmath>

#include "base/math/log_sum.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/fit_neighbourhood.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/pictures/image_scene.h"

namespace glidelab::diagnose {
namespace {

constexpr double kWorthJoining = -3.0;    // log evidence: an effect that the images contradict by more is not weighed
                                          // with others
constexpr std::size_t kMostTogether = 4;  // effects in one explanation
constexpr double kMostByScatter = 6.0;    // log evidence that a stated codec may take over from scattered frames

bool same_effects(const Hypothesis& a, const Hypothesis& b) {
  return a.unnamed == b.unnamed &&
         std::set(a.effects.begin(), a.effects.end()) == std::set(b.effects.begin(), b.effects.end());
}

/// What the images say about a camera that sways as this fit has it: no more than they say of the sway by themselves.
double sway_support(const ImageEvidence& images, const MotionFit& fit, std::size_t effect, double by_images) {
  double amplitude_m = 0.0, f_hz = 0.0;
  const auto& globals = fit.layout->globals();
  for (std::size_t g = 0; g < globals.size(); ++g) {
    if (globals[g].parameter == nullptr || globals[g].effect != effect) continue;
    const double value = fit.at.global[static_cast<Eigen::Index>(g)];
    if (globals[g].parameter->slot == slot_of(ids::camera_motion)) amplitude_m = value;
    if (globals[g].parameter->slot == slot_of(ids::camera_motion, 1)) f_hz = value;
  }
  if (!(f_hz > 0.0)) return by_images;
  const double support = camera_sway_support(images.clips, amplitude_m, f_hz);
  return by_images > 0.0 ? std::min(support, by_images) : support;
}

/// What the images say about a camera that sways where no fit has it: no more than where the fit has what they see.
double sway_alone(const ImageEvidence& images, const ImageFinding& finding) {
  double amplitude_px = 0.0, f_hz = 0.0, px_per_m = 0.0;
  for (const DiagnosedParameter& of : finding.parameters) {
    if (of.key == "amplitude_px") amplitude_px = of.value;
    if (of.key == "f_hz") f_hz = of.value;
  }
  for (const FilmedClip& clip : images.clips) px_per_m = std::max(px_per_m, clip.px_per_m);
  if (!(f_hz > 0.0) || !(px_per_m > 0.0)) return finding.log_evidence;
  const double along = camera_sway_support(images.clips, amplitude_px / px_per_m, f_hz);
  return along > 0.0 ? std::min(finding.log_evidence, along) : finding.log_evidence;
}

/// What the marker's shear says about the line time of this fit.
double line_support(const ImageEvidence& images, const ImageFinding& finding, const MotionFit& fit,
                    std::size_t effect) {
  const std::size_t g = fit.layout->first_of(effect);
  const auto at = static_cast<Eigen::Index>(g);
  const double sd = std::sqrt(std::max(0.0, common_covariance(fit)(at, at)));
  const DiagnosedParameter& sheared = finding.parameters.front();
  return agreement({sheared.value - images.stated_line_s, sheared.sd}, {fit.at.global[at], sd});
}

/// Log likelihood of one motion's residuals, of variance s²((1 - share) white + share exp(-lag/frames)).
double correlated_likelihood(const Eigen::VectorXd& r, const std::vector<char>& outlier, double s2, double share,
                             double frames) {
  const double keep = std::exp(-1.0 / frames), driven = s2 * share * (1.0 - keep * keep), white = s2 * (1.0 - share);
  double mean = 0.0, variance = s2 * share, sum = 0.0;
  for (Eigen::Index i = 0; i < r.size(); ++i) {
    if (outlier[static_cast<std::size_t>(i)] == 0) {
      const double total = variance + white, off = r[i] - mean;
      sum -= 0.5 * (off * off / total + std::log(total));
      mean += variance / total * off;
      variance *= white / total;
    }
    mean *= keep;
    variance = keep * keep * variance + driven;
  }
  return sum;
}

}  // namespace

double agreement(const Measured& in_images, const Measured& in_tracks) {
  const double own = in_images.sd * in_images.sd, both = own + in_tracks.sd * in_tracks.sd;
  const double off = in_images.value - in_tracks.value;
  return 0.5 * (in_images.value * in_images.value / own - off * off / both - std::log(both / own));
}

CorrelatedNoise scan_correlation(const TrackSet& set, const MotionFit& fit) {
  CorrelatedNoise found;
  const auto of_all = [&](double s2, double share, double frames) {
    double sum = 0.0;
    for (std::size_t i = 0; i < set.motions.size(); ++i) {
      sum += correlated_likelihood(fit.motions[i].residual, set.motions[i].outlier, s2, share, frames);
    }
    return sum;
  };
  const double white = of_all(1.0, 0.0, 1.0);
  std::vector<double> logs;
  for (const double s : {1.0, 1.2, 1.45, 1.75, 2.1}) {
    for (const double share : {0.15, 0.3, 0.5, 0.7}) {
      for (const double frames : {1.0, 2.0, 4.0, 8.0}) {
        logs.push_back(of_all(s * s, share, frames) - white);
        if (logs.back() <= found.gain) continue;
        // 1 + 2 sum of exp(-lag/frames) for the correlated part.
        const double keep = std::exp(-1.0 / frames);
        found = {logs.back(), 0.0, share, frames, s * s * (1.0 - share + share * (1.0 + keep) / (1.0 - keep))};
      }
    }
  }
  found.log_evidence = base::log_mean(logs);
  return found;
}

namespace {

/// In a file with lossy compression, noise that lasts over several frames imitates anything slow. The log evidence of
/// every explanation by a motion is therefore divided by the ratio of this noise's variance in slow quantities to that
/// under white noise, as the residuals of the best explanation of all show it.
void temper(const TrackSet& set, Comparison& comparison) {
  const CorrelatedNoise left = scan_correlation(set, comparison.fits[static_cast<std::size_t>(comparison.left_fit)]);
  if (left.log_evidence < kSeenInImages) return;
  for (Hypothesis& hypothesis : comparison.all) {
    if (hypothesis.log_evidence > 0.0) hypothesis.log_evidence /= std::max(1.0, left.inflation);
  }
}

}  // namespace

void join_images(const TrackSet& set, const ImageEvidence& images, const std::set<std::size_t>& without,
                 Comparison& comparison) {
  const std::size_t codec = effect_index(ids::compression), sway = effect_index(ids::camera_motion),
                    rows = effect_index(ids::rolling_shutter), tails = effect_index(ids::heavy_tailed_noise);
  std::vector<const ImageFinding*> findings;
  for (const ImageFinding& finding : images.findings) {
    if (!without.contains(effect_index(finding.id))) findings.push_back(&finding);
  }
  std::sort(findings.begin(), findings.end(),
            [](const auto* a, const auto* b) { return a->log_evidence > b->log_evidence; });
  if (std::any_of(findings.begin(), findings.end(), [](const auto* finding) { return finding->stated; })) {
    temper(set, comparison);
  }
  for (const ImageFinding* finding : findings) {
    const std::size_t effect = effect_index(finding->id);
    comparison.in_images.insert(effect);
    const double of_images = finding->stated  ? 0.0
                             : effect == sway ? sway_alone(images, *finding)
                                              : finding->log_evidence;
    const std::vector<Hypothesis> so_far = comparison.all;
    for (Hypothesis& hypothesis : comparison.all) {
      if (!has(hypothesis, effect)) continue;
      double support = of_images;
      if (hypothesis.fit >= 0) {
        const MotionFit& fit = comparison.fits[static_cast<std::size_t>(hypothesis.fit)];
        if (effect == sway) support = sway_support(images, fit, sway, finding->log_evidence);
        if (effect == rows) support = line_support(images, *finding, fit, rows);
      }
      hypothesis.log_evidence += support;
      hypothesis.of_images += support;
    }
    for (const Hypothesis& other : so_far) {
      if (has(other, effect) || other.effects.size() >= kMostTogether) continue;
      Hypothesis with = other;
      with.effects.push_back(effect);
      const bool known = std::any_of(comparison.all.begin(), comparison.all.end(),
                                     [&](const Hypothesis& h) { return same_effects(h, with); });
      if (known) continue;
      double of_tracks = 0.0, scatter = 0.0, outliers = 0.0;
      if (std::none_of(other.effects.begin(), other.effects.end(), is_scatter)) {
        for (const FrameEffect& frame : comparison.frames) {
          scatter = std::max(scatter, frame.log_evidence);
          if (frame.effect == tails) outliers = std::max(outliers, frame.log_evidence);
        }
      }
      if (effect == codec && finding->stated && !other.unnamed && other.fit >= 0 && other.effects.size() < 2) {
        // If the noise of filmed positions was measured by itself, no model enters it: what a fit leaves of a motion is
        // not the codec's.
        if (set.position_noise) {
          of_tracks = std::max(0.0, set.position_noise->lasting_log_evidence);
          with.gain += set.position_noise->lasting_gain;
        } else {
          const CorrelatedNoise noise = scan_correlation(set, comparison.fits[static_cast<std::size_t>(other.fit)]);
          of_tracks = std::max(0.0, noise.log_evidence);
          with.gain += noise.gain;
        }
        // The codec's errors grow with the changes in the image, and single ones are large where its blocks are
        // visible.
        if (of_tracks > kSeenInImages) {
          of_tracks += std::max(std::min(kMostByScatter, scatter), finding->seen ? outliers : 0.0);
        }
      }
      // A smeared marker is located less well the faster it moves: the part shown by the scatter is the blur's own.
      if (finding->id == ids::exposure_blur && finding->seen) of_tracks = scatter;
      if (of_images + of_tracks < kWorthJoining) continue;
      with.log_evidence += of_images + of_tracks;
      with.of_images += of_images + of_tracks;
      with.gain += std::max(0.0, of_images);
      comparison.all.push_back(std::move(with));
    }
  }
}

}  // namespace glidelab::diagnose
