#include "diagnose/pictures/image_recording.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "base/math/dense.h"
#include "core/math/quantile.h"
#include "core/pictures/scene/camera_traces.h"
#include "diagnose/effects/effect_library.h"

namespace glidelab::diagnose {
namespace {

constexpr double kMemorySd = 0.05;    // uncertainty of a ratio of variances that should be 1,
constexpr double kUsualMemory = 1.1;  // and its usual value for a fault-free clip

}  // namespace

double memory_log_evidence(const std::vector<FilmedClip>& clips) {
  double memory = 1.0;
  for (const FilmedClip& clip : clips) memory = std::max(memory, clip.record->noise_memory.value_or(1.0));
  return log_deviation_evidence((memory - kUsualMemory) / kMemorySd, 1.0 / kMemorySd);
}

void add_codec(const std::vector<FilmedClip>& clips, ImageEvidence& evidence) {
  double excess = 0.0, relative = 0.0, memory = 0.0;
  std::size_t lossy = 0, lossless = 0;
  std::string codec, lossy_codec;
  for (const FilmedClip& clip : clips) {
    const core::BlockEdges edges = core::block_edges(clip.record->steps);
    if (edges.z > excess) {
      excess = edges.z;
      relative = edges.relative;
    }
    memory = std::max(memory, clip.record->noise_memory.value_or(1.0));
    if (clip.record->lossy) ++(*clip.record->lossy ? lossy : lossless);
    if (codec.empty()) codec = clip.record->codec;
    if (lossy_codec.empty() && clip.record->lossy.value_or(false)) lossy_codec = clip.record->codec;
  }
  const bool changes = std::any_of(evidence.findings.begin(), evidence.findings.end(), [](const ImageFinding& other) {
    const std::optional<InImages>& shown = effect_of(other.id).in_images;
    return shown && shown->over == GapVariable::time && other.log_evidence > kSeenInImages;
  });
  ImageFinding finding = finding_of(ids::compression);
  const double blocks =
      log_deviation_evidence((excess - 3.0) / 2.0, 100.0);  // of columns that tell their scatter poorly
  // A file that says that it is lossily compressed hides nothing: compression is named for its effect on the positions.
  finding.stated = lossy > 0;
  finding.log_evidence =
      std::max(lossy > 0 ? std::max(-1.0, blocks) : blocks, changes ? blocks : memory_log_evidence(clips));
  finding.parameters = {{"block_steps", relative, relative / std::max(1.0, excess)}};
  if (!lossy_codec.empty()) finding.parameters.push_back({"codec", 0.0, 0.0, lossy_codec});
  image::Compression compression{{}, lossy > 0 ? lossy_codec : codec, relative, {}};
  if (lossy + lossless > 0) compression.lossy = lossy > 0;
  if (memory > kUsualMemory) compression.noise_memory = memory;
  finding.fact = std::move(compression);
  evidence.findings.push_back(std::move(finding));
}

void add_missing(const std::vector<FilmedClip>& clips, ImageEvidence& evidence) {
  std::size_t missing = 0, repeated = 0, frames = 0;
  for (const FilmedClip& clip : clips) {
    missing += clip.record->stamps_missing;
    const auto& looks = clip.record->marker;
    frames += std::max(looks.size(), clip.record->scene.size());  // a target has no looks
    for (std::size_t i = 2; i < looks.size(); ++i) {
      const bool same = looks[i].u_px == looks[i - 1].u_px && looks[i].v_px == looks[i - 1].v_px;
      if (same && std::hypot(looks[i - 1].u_px - looks[i - 2].u_px, looks[i - 1].v_px - looks[i - 2].v_px) > 0.05)
        ++repeated;
    }
  }
  if (missing + repeated == 0) return;
  ImageFinding finding = finding_of(ids::dropped_frames);
  finding.log_evidence = std::min(50.0, 5.0 * static_cast<double>(missing + repeated));
  const double count = static_cast<double>(missing + repeated);
  finding.parameters = {
      {"fraction", count / static_cast<double>(frames), std::sqrt(count) / static_cast<double>(frames)}};
  finding.fact = image::FrameTimes{repeated, missing};
  evidence.findings.push_back(std::move(finding));
}

namespace {

constexpr int kReach = 4;                         // frames to each side that give a frame's speed
constexpr std::size_t kFewestFramesOfShape = 40;  // frames of all clips together
constexpr int kPlace = 4;                         // number of terms of a cubic
constexpr double kShortest_s = 2e-5;
constexpr double kFinest = 1.06;  // step of the exposures that are tried
constexpr int kBins = 24;
constexpr int kRounds = 3;                  // of the fit, each without the last one's outliers
constexpr double kOutlier = 7.0;            // median deviations
constexpr double kLeastScatter_px2 = 1e-9;  // so that exact data have one
constexpr double kSlowest_px_s = 1.0;       // of the fastest sample: slower, nothing smears
constexpr double kLongestSmear = 3.0;       // radii
constexpr double kHighestSpeeds = 0.95;     // quantile of v²

struct Sample {
  double place = 0.0;  ///< u, -1 to 1 over the image
  std::size_t view = 0;
  double wu = 0.0, wv = 0.0, vv = 0.0;
  double stretch = 0.0, shear = 0.0;  ///< m_uu - m_vv, m_uv
};

/// Speed of the marker's image by a line through the frames around.
std::vector<Sample> samples_of(const FilmedClip& clip) {
  const auto& looks = clip.record->marker;
  std::vector<Sample> samples;
  for (std::size_t i = kReach; i + kReach < looks.size(); ++i) {
    if (looks[i + kReach].frame - looks[i - kReach].frame != 2 * kReach) continue;
    double tt = 0.0, tu = 0.0, tv = 0.0, mean_t = 0.0;
    for (std::size_t j = i - kReach; j <= i + kReach; ++j) mean_t += looks[j].t_s / (2 * kReach + 1);
    for (std::size_t j = i - kReach; j <= i + kReach; ++j) {
      const double t = looks[j].t_s - mean_t;
      tt += t * t;
      tu += t * looks[j].u_px;
      tv += t * looks[j].v_px;
    }
    const auto& m = looks[i];
    const double place = clip.down ? m.v_px / clip.record->height_px : m.u_px / clip.record->width_px;
    samples.push_back({2.0 * place - 1.0, clip.view, tu / tt, tv / tt, m.vv_px2, m.stretch_px2, m.uv_px2});
  }
  return samples;
}

/// The second moment that a smear adds along it, more than across it.
double smear(double length_px) {
  return length_px * length_px / 12.0;
}

/// Its derivatives with T² in the two rows of a sample: stretch and shear.
std::array<double, 2> smear_of_unit(const Sample& s) {
  return {(s.wu * s.wu - s.wv * s.wv) / 12.0, s.wu * s.wv / 12.0};
}

struct Solved {
  double chi2 = 0.0;
  double line = 0.0, line_variance = 0.0;  ///< for a variance of 1
  Eigen::VectorXd rest;
};

/// Everything linear (the cubics of position, the line time) at a given exposure. Rows: stretch of all, then shear of
/// all.
class Linear {
 public:
  Linear(const std::vector<Sample>& samples, std::size_t views, double shear_weight)
      : samples_(samples), w_(shear_weight) {
    const auto n = static_cast<Eigen::Index>(samples.size());
    const auto columns = static_cast<Eigen::Index>(2 * views * kPlace + 1);
    design_ = Eigen::MatrixXd::Zero(2 * n, columns);
    data_.resize(2 * n);
    double top = 1.0;
    for (const Sample& s : samples) top = std::max(top, std::abs(s.wu) * s.vv);
    scale_ = 1.0 / top;
    for (Eigen::Index i = 0; i < n; ++i) {
      const Sample& s = samples[static_cast<std::size_t>(i)];
      double power = 1.0;
      for (Eigen::Index k = 0; k < kPlace; ++k, power *= s.place) {
        design_(i, static_cast<Eigen::Index>(2 * s.view) * kPlace + k) = power;
        design_(n + i, static_cast<Eigen::Index>(2 * s.view + 1) * kPlace + k) = w_ * power;
      }
      design_(i, columns - 1) = -2.0 * s.wv * s.vv * scale_;
      design_(n + i, columns - 1) = w_ * s.wu * s.vv * scale_;
      data_[i] = s.stretch;
      data_[n + i] = w_ * s.shear;
    }
    Eigen::MatrixXd normal = base::transposed_product(design_, design_);
    normal.diagonal().array() += 1e-12 * normal.diagonal().maxCoeff();
    inverse_ = base::inverse_positive(normal);
  }

  Solved at(double exposure_s) const {
    const auto n = static_cast<Eigen::Index>(samples_.size());
    Eigen::VectorXd left = data_;
    for (Eigen::Index i = 0; i < n; ++i) {
      const Sample& s = samples_[static_cast<std::size_t>(i)];
      const auto [stretch, shear] = smear_of_unit(s);
      left[i] -= stretch * exposure_s * exposure_s;
      left[n + i] -= w_ * shear * exposure_s * exposure_s;
    }
    const Eigen::VectorXd coefficients = base::product(inverse_, base::transposed_product(design_, left));
    Solved solved;
    solved.rest = left - base::product(design_, coefficients);
    solved.chi2 = solved.rest.squaredNorm();
    const Eigen::Index last = design_.cols() - 1;
    solved.line = coefficients[last] * scale_;
    solved.line_variance = inverse_(last, last) * scale_ * scale_;
    return solved;
  }

  /// Everything linear, with T² up to a squared speed and T² of what is beyond it; their variances for a variance of 1.
  struct Halves {
    double slower = 0.0, faster = 0.0, slower_variance = 0.0, faster_variance = 0.0, covariance = 0.0;
  };
  Halves halves(double speed2) const {
    const auto n = static_cast<Eigen::Index>(samples_.size());
    const Eigen::Index slow = design_.cols(), fast = slow + 1;
    Eigen::MatrixXd wider = Eigen::MatrixXd::Zero(2 * n, fast + 1);
    wider.leftCols(slow) = design_;
    const double unit = speed2 > 0.0 ? 12.0 / speed2 : 1.0;  // of columns of about 1
    for (Eigen::Index i = 0; i < n; ++i) {
      const Sample& s = samples_[static_cast<std::size_t>(i)];
      const double own2 = s.wu * s.wu + s.wv * s.wv;
      const double below = own2 > speed2 ? speed2 / own2 : 1.0;
      const auto [stretch, shear] = smear_of_unit(s);
      wider(i, slow) = unit * stretch * below;
      wider(i, fast) = unit * stretch * (1.0 - below);
      wider(n + i, slow) = w_ * unit * shear * below;
      wider(n + i, fast) = w_ * unit * shear * (1.0 - below);
    }
    Eigen::MatrixXd normal = base::transposed_product(wider, wider);
    normal.diagonal().array() += 1e-12 * normal.diagonal().maxCoeff();
    const Eigen::MatrixXd inverse = base::inverse_positive(normal);
    const Eigen::VectorXd found = base::product(inverse, base::transposed_product(wider, data_));
    const double unit2 = unit * unit;
    return {unit * found[slow], unit * found[fast], unit2 * inverse(slow, slow), unit2 * inverse(fast, fast),
            unit2 * inverse(slow, fast)};
  }

 private:
  const std::vector<Sample>& samples_;
  double w_;
  double scale_ = 1.0;
  Eigen::MatrixXd design_, inverse_;
  Eigen::VectorXd data_;
};

/// The factor by which a correlated series has fewer independent values: 1 + 2 sum of its correlations, while they
/// last.
double memory_of(const Eigen::VectorXd& rest) {
  const double variance = rest.squaredNorm() / static_cast<double>(rest.size());
  double memory = 1.0;
  for (Eigen::Index lag = 1; lag < std::min<Eigen::Index>(40, rest.size() / 4); ++lag) {
    const double r = rest.head(rest.size() - lag).dot(rest.tail(rest.size() - lag)) /
                     static_cast<double>(rest.size() - lag) / variance;
    if (r < 2.0 / std::sqrt(static_cast<double>(rest.size()))) break;
    memory += 2.0 * r;
  }
  return memory;
}

double fastest_of(const std::vector<Sample>& samples) {
  double fastest = 0.0;
  for (const Sample& s : samples) fastest = std::max(fastest, std::hypot(s.wu, s.wv));
  return fastest;
}

ImageCurve lengthening(const std::vector<Sample>& samples, const Eigen::VectorXd& rest, double exposure_s,
                       const std::optional<double>& stated_s) {
  ImageCurve curve;
  curve.what = "lengthening";
  const double fastest = std::max(kSlowest_px_s, fastest_of(samples));
  std::vector<std::vector<double>> bins(kBins);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double speed = std::hypot(samples[i].wu, samples[i].wv);
    const auto bin = std::min<std::size_t>(kBins - 1, static_cast<std::size_t>(speed / fastest * kBins));
    bins[bin].push_back(rest[static_cast<Eigen::Index>(i)] + smear(speed * exposure_s));
  }
  for (std::size_t b = 0; b < bins.size(); ++b) {
    if (bins[b].size() < 2) continue;
    const double speed = fastest * (static_cast<double>(b) + 0.5) / kBins;
    double mean = 0.0, square = 0.0;
    const auto count = static_cast<double>(bins[b].size());
    for (const double value : bins[b]) mean += value / count;
    for (const double value : bins[b]) square += (value - mean) * (value - mean) / (count - 1.0);
    curve.at.push_back(speed);
    curve.value.push_back(mean);
    curve.sd.push_back(std::sqrt(square / count));
    curve.fitted.push_back(smear(speed * exposure_s));
    if (stated_s) curve.expected.push_back(smear(speed * *stated_s));
  }
  return curve;
}

/// The samples of every clip; its view is counted from 0 in the order of the clips.
std::vector<Sample> all_samples(const std::vector<FilmedClip>& clips, std::size_t& views) {
  std::map<std::size_t, std::size_t> numbers;
  std::vector<Sample> samples;
  for (const FilmedClip& clip : clips) {
    for (Sample sample : samples_of(clip)) {
      sample.view = numbers.emplace(sample.view, numbers.size()).first->second;
      samples.push_back(sample);
    }
  }
  views = numbers.size();
  return samples;
}

/// The fits at every possible exposure, and the best of them.
struct Scan {
  std::vector<double> tried_s, chi2;
  double best_s = 0.0;
  Solved best;
};

Scan scan_exposures(const Linear& linear, double longest_s, double longest_px, double fastest_px_s) {
  Scan scan;
  scan.tried_s = {0.0};
  for (double t = kShortest_s; t < longest_s && t * fastest_px_s < longest_px; t *= kFinest) scan.tried_s.push_back(t);
  scan.best.chi2 = std::numeric_limits<double>::infinity();
  for (const double t : scan.tried_s) {
    Solved solved = linear.at(t);
    scan.chi2.push_back(solved.chi2);
    if (solved.chi2 >= scan.best.chi2) continue;
    scan.best_s = t;
    scan.best = std::move(solved);
  }
  return scan;
}

/// Leaves out the outliers of the last fit, and reweights the shear by its scatter relative to that of the stretch.
void leave_outliers(const Solved& last, std::vector<Sample>& samples, double& shear_weight) {
  const auto n = static_cast<Eigen::Index>(samples.size());
  std::vector<double> of_stretch, of_shear;
  for (Eigen::Index i = 0; i < n; ++i) {
    of_stretch.push_back(std::abs(last.rest[i]));
    of_shear.push_back(std::abs(last.rest[n + i] / shear_weight));
  }
  const double stretch = std::max(kLeastScatter_px2, core::median_of(of_stretch));
  const double shear = std::max(kLeastScatter_px2, core::median_of(of_shear));
  std::vector<Sample> kept;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (of_stretch[i] < kOutlier * stretch && of_shear[i] < kOutlier * shear) kept.push_back(samples[i]);
  }
  samples = std::move(kept);
  shear_weight = stretch / shear;
}

/// Mean and spread over the likelihood of the exposures tried, each weighted with its step.
void tell_exposure(const Scan& scan, double variance, ShapeFit& result) {
  double sum = 0.0, mean = 0.0, square = 0.0;
  for (std::size_t i = 0; i < scan.tried_s.size(); ++i) {
    const double t = scan.tried_s[i];
    const double step = i == 0 ? kShortest_s : t * (kFinest - 1.0);
    const double w = step * std::exp(-0.5 * (scan.chi2[i] - scan.best.chi2) / variance);
    sum += w;
    mean += w * t;
    square += w * t * t;
  }
  result.exposure_s = mean / sum;
  result.exposure_sd_s = std::sqrt(
      std::max(square / sum - result.exposure_s * result.exposure_s, std::pow(scan.best_s * (kFinest - 1.0) / 3.0, 2)));
}

/// T² of slower and faster frames, and what a single fast frame tells.
void tell_halves(const Linear& linear, const std::vector<Sample>& samples, const Solved& best, double variance,
                 ShapeFit& result) {
  std::vector<double> speed2;
  double square = 0.0, fourth = 0.0;
  for (const Sample& s : samples) {
    speed2.push_back(s.wu * s.wu + s.wv * s.wv);
    square += speed2.back();
    fourth += speed2.back() * speed2.back();
  }
  const Linear::Halves halves = linear.halves(0.5 * core::quantile(speed2, kHighestSpeeds));
  result.slower = {halves.slower, std::sqrt(variance * halves.slower_variance)};
  result.faster = {halves.faster, std::sqrt(variance * halves.faster_variance)};
  result.difference_sd_s2 =
      std::sqrt(variance * (halves.slower_variance + halves.faster_variance - 2.0 * halves.covariance));
  const auto n = static_cast<Eigen::Index>(samples.size());
  const double of_frame_px2 = best.rest.head(n).norm() / std::sqrt(static_cast<double>(n));
  result.single_frame_sd_s2 = 12.0 * of_frame_px2 * square / fourth;
}

}  // namespace

double agreed_squared_exposure(const ShapeFit& fit, double stated_s) {
  constexpr double kAgree_sd = 2.0;
  const double whole = fit.exposure_s * fit.exposure_s, stated = stated_s * stated_s;
  if (std::abs(fit.slower.s2 - fit.faster.s2) <= kAgree_sd * fit.difference_sd_s2) return whole;
  const std::array<double, 3> all = {whole, std::max(0.0, fit.slower.s2), std::max(0.0, fit.faster.s2)};
  return *std::ranges::min_element(all, {}, [&](double s2) { return std::abs(s2 - stated); });
}

double codec_squared_exposure_sd(const ShapeFit& fit, const std::vector<FilmedClip>& clips) {
  const bool lossy =
      std::ranges::any_of(clips, [](const FilmedClip& clip) { return core::through_lossy_codec(*clip.record); });
  return lossy ? fit.single_frame_sd_s2 : 0.0;
}

ShapeFit fit_marker_shape(const std::vector<FilmedClip>& clips) {
  ShapeFit result;
  std::size_t views = 0;
  std::vector<Sample> samples = all_samples(clips, views);
  if (samples.size() < kFewestFramesOfShape) return result;
  std::vector<double> radii;
  double longest_s = 0.0;
  for (const FilmedClip& clip : clips) {
    for (const auto& look : clip.record->marker) radii.push_back(2.0 * std::sqrt(look.vv_px2));
    longest_s = std::max(longest_s, 1.0 / clip.camera.frame_rate_hz);
  }
  // An outline that is fitted with a fixed shape tells nothing of a smear.
  const auto differ = [&](double Sample::*moment) {
    return std::ranges::any_of(samples, [&](const Sample& s) { return s.*moment != samples.front().*moment; });
  };
  if (!differ(&Sample::stretch) || !differ(&Sample::shear)) return result;
  result.radius_px = core::median_of(radii);
  result.fastest_px_s = fastest_of(samples);
  if (!(result.fastest_px_s > kSlowest_px_s)) return result;

  double weight = 1.0;
  Scan scan;
  std::optional<Linear> linear;
  for (int round = 0; round < kRounds; ++round) {
    if (round > 0) leave_outliers(scan.best, samples, weight);
    if (samples.size() < kFewestFramesOfShape) return result;
    linear.emplace(samples, views, weight);
    scan = scan_exposures(*linear, longest_s, kLongestSmear * result.radius_px, result.fastest_px_s);
  }
  const Solved& best = scan.best;
  const auto n = static_cast<Eigen::Index>(samples.size());
  const double memory = std::max(memory_of(best.rest.head(n)), memory_of(best.rest.tail(n)));
  const double variance = memory * best.chi2 / static_cast<double>(2 * n);
  result.known = true;
  tell_exposure(scan, variance, result);
  tell_halves(*linear, samples, best, variance, result);
  result.line_s = best.line;
  result.line_sd_s = std::sqrt(best.line_variance * variance);
  result.curves.push_back(lengthening(samples, best.rest, scan.best_s, clips.front().camera.exposure_s));
  return result;
}

}  // namespace glidelab::diagnose
