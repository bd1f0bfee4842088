#include "core/pictures/scene/scene_watch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kPatchesPerDirection = 12;  // patches, for each of the two directions
constexpr std::size_t kPatchesForLight = 12;      // patches all over the image, for the light
constexpr std::size_t kReferenceFrames = 6;
constexpr double kLeastRestep = 0.2;  // px
constexpr int kMargin = 12;           // px around a patch

cv::Rect margined(const cv::Rect& place) {
  return {place.x - kMargin, place.y - kMargin, place.width + 2 * kMargin, place.height + 2 * kMargin};
}

/// Blurred by a Gaussian of 1 px, so that derivatives are meaningful.
std::vector<float> soft_pixels_of(const cv::Mat& grey, const cv::Rect& place) {
  cv::Mat_<float> part, soft;
  grey({place.x - 2, place.y - 2, kPatchSide + 4, kPatchSide + 4}).convertTo(part, CV_32F);
  cv::GaussianBlur(part, soft, {5, 5}, 1.0);
  const cv::Mat_<float> middle = soft({2, 2, kPatchSide, kPatchSide}).clone();
  return {middle.begin(), middle.end()};
}

struct Candidate {
  cv::Rect place;
  double uu = 0.0, vv = 0.0;
};

constexpr double kMostRelativeResidual = 3.0;  // residuals over the usual ones
constexpr double kMostShiftSd = 0.5;           // px; a shift with a larger uncertainty is not a measurement
constexpr double kMostShiftSdToCompare =
    0.2;                                     // px; a patch that is to agree with the others must know its shift so well
constexpr double kMostShiftOff = 5.0;        // of its standard deviations
constexpr double kInterpolationError = 0.1;  // px: residual over gradient of structure near the pixels' own size
constexpr double kLossyNoise = 1.0;          // codes, of a pixel
constexpr double kPixelsPerBlock = 64.0;     // pixels that share a codec's error
constexpr double kLeastShiftSd = 0.01;       // px; of a patch relative to the others
constexpr double kMedianOfSquare = 0.455;    // of a standard normal deviate
constexpr int kFramesOfChange = 3;           // in a row that give changes over one frame and over two

void keep_known(SceneLook& look) {
  if (!(look.sd_u_px < kMostShiftSd)) look.u_px = look.sd_u_px = 0.0;
  if (!(look.sd_v_px < kMostShiftSd)) look.v_px = look.sd_v_px = 0.0;
}

double of_lossy(double variance) {
  return kPixelsPerBlock * std::max(variance, kLossyNoise * kLossyNoise);
}

}  // namespace

void SceneWatch::choose(const cv::Mat& grey) {
  const int margin = kMargin;
  const int free_u = grey.cols - kPatchSide - 2 * margin, free_v = grey.rows - kPatchSide - 2 * margin;
  if (free_u < 0 || free_v < 0) return;
  std::vector<Candidate> candidates;
  const int step = std::max(kPatchSide, static_cast<int>(std::sqrt(static_cast<double>(grey.total()) / 400.0)));
  for (int v = margin; v <= margin + free_v; v += step) {
    for (int u = margin; u <= margin + free_u; u += step) {
      Candidate candidate{cv::Rect(u, v, kPatchSide, kPatchSide), 0.0, 0.0};
      cv::Mat soft, gu, gv;
      grey(candidate.place).convertTo(soft, CV_32F);
      cv::GaussianBlur(soft, soft, {5, 5}, 1.0);
      cv::Sobel(soft, gu, CV_32F, 1, 0, 1, 0.5);
      cv::Sobel(soft, gv, CV_32F, 0, 1, 1, 0.5);
      candidate.uu = gu.dot(gu);
      candidate.vv = gv.dot(gv);
      candidates.push_back(candidate);
    }
  }
  std::vector<char> taken(candidates.size(), 0);
  const auto take_best = [&](auto&& score) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < candidates.size(); ++i) order.push_back(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return score(candidates[a]) > score(candidates[b]); });
    for (std::size_t i = 0; i < std::min(kPatchesPerDirection, order.size()); ++i) taken[order[i]] = 1;
  };
  take_best([](const Candidate& c) { return c.uu; });
  take_best([](const Candidate& c) { return c.vv; });
  for (std::size_t i = 0; i < kPatchesForLight; ++i) {
    taken[std::min(candidates.size() - 1, (2 * i + 1) * candidates.size() / (2 * kPatchesForLight))] = 1;
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (taken[i] == 0) continue;
    patches_.emplace_back();
    patches_.back().place = candidates[i].place;
  }
}

SceneWatch::Pixels SceneWatch::cut(const cv::Mat& grey) const {
  Pixels pixels;
  for (const Patch& patch : patches_) pixels.push_back(soft_pixels_of(grey, patch.place));
  return pixels;
}

SceneWatch::Terms SceneWatch::derivatives_at(const Patch& patch, std::size_t pixel) {
  const double row = static_cast<double>(pixel / kPatchSide);
  const double z = (2.0 * row + 1.0) / kPatchSide - 1.0;
  // Less its mean, so that the gain is that of the whole patch.
  constexpr double kMeanSquare = 1.0 / 3.0;
  const double level = patch.reference[pixel], contrast = level - patch.mean, curve = z * z - kMeanSquare;
  return {level,         -patch.gu[pixel], -patch.gv[pixel], z * level,
          curve * level, contrast,         z * contrast,     curve * contrast};
}

/// Moves a patch's reference to the present position of the scene in the image.
void SceneWatch::shift_reference(Patch& patch, cv::Point2d shift) {
  cv::Mat_<float> whole = patch.around.clone();
  if (cv::norm(shift) > 0.0) {
    const cv::Matx23d move(1.0, 0.0, shift.x, 0.0, 1.0, shift.y);
    cv::warpAffine(patch.around, whole, move, patch.around.size(), cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  }
  // Derivative of fourth order: exact to 2 % for what the blur leaves (periods above 5 px).
  const cv::Matx<float, 1, 5> slope(1.0F / 12, -8.0F / 12, 0.0F, 8.0F / 12, -1.0F / 12);
  cv::Mat_<float> gu, gv;
  cv::filter2D(whole, gu, CV_32F, slope);
  cv::filter2D(whole, gv, CV_32F, slope.t());
  const cv::Rect middle(kMargin, kMargin, kPatchSide, kPatchSide);
  const auto flat = [&](const cv::Mat_<float>& from) {
    const cv::Mat_<float> part = from(middle).clone();
    return std::vector<float>(part.begin(), part.end());
  };
  patch.reference = flat(whole);
  patch.gu = flat(gu);
  patch.gv = flat(gv);
  patch.mean = 0.0;
  for (const float value : patch.reference) patch.mean += value / static_cast<double>(patch.reference.size());
  Normal normal = Normal::zeros();
  for (std::size_t i = 0; i < patch.reference.size(); ++i) {
    const Terms row = derivatives_at(patch, i);
    normal += row * row.t();
  }
  // A patch without any structure has no shift; the ridge is far below one code's worth of gradient.
  for (int k = 0; k < kTerms; ++k) normal(k, k) += 1e-3;
  patch.inverse = normal.inv();
  patch.structure =
      cv::Matx22d(patch.inverse(1, 1), patch.inverse(1, 2), patch.inverse(2, 1), patch.inverse(2, 2)).inv();
  patch.gain_variance = patch.inverse(0, 0);
  patch.noise_left = noise_left_by_fit(patch);
}

/// The part of the blurred noise's variance that a fit leaves in a patch, 1 - tr(P K) / tr(K): K is the covariance of
/// noise blurred by B, K = B B^T, and P = D inverse D^T projects onto the terms D.
double SceneWatch::noise_left_by_fit(const Patch& patch) {
  constexpr int kRim = 2;  // that noise from outside the patch is blurred across
  std::vector<cv::Mat_<double>> terms;
  for (int k = 0; k < kTerms; ++k) {
    terms.emplace_back(kPatchSide + 2 * kRim, kPatchSide + 2 * kRim, 0.0);
    for (std::size_t i = 0; i < patch.reference.size(); ++i) {
      const int at = static_cast<int>(i);
      terms.back()(kRim + at / kPatchSide, kRim + at % kPatchSide) = derivatives_at(patch, i)[k];
    }
    cv::GaussianBlur(terms.back(), terms.back(), {5, 5}, 1.0, 1.0, cv::BORDER_CONSTANT);
  }
  double taken = 0.0;
  for (int k = 0; k < kTerms; ++k) {
    for (int j = 0; j < kTerms; ++j) {
      taken += patch.inverse(k, j) * terms[static_cast<std::size_t>(k)].dot(terms[static_cast<std::size_t>(j)]);
    }
  }
  return 1.0 - taken / (kPatchSofter * kPatchSofter * static_cast<double>(patch.reference.size()));
}

void SceneWatch::make_reference() {
  constexpr int kWhole = kPatchSide + 2 * kMargin;
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    Patch& patch = patches_[p];
    patch.around = cv::Mat_<float>(kWhole, kWhole, 0.0F);
    for (const cv::Mat& frame : early_) {
      cv::Mat_<float> part;
      frame(margined(patch.place)).convertTo(part, CV_32F);
      patch.around += part;
    }
    patch.around /= static_cast<float>(early_.size());
    cv::GaussianBlur(patch.around, patch.around, {5, 5}, 1.0);
    shift_reference(patch, {});
    // The usual residuals are those of the first frames themselves, whatever the light did in them; what passes by then
    // makes a patch of no use.
    double sum = 0.0;
    for (const cv::Mat& frame : early_) {
      fit_terms(patch, soft_pixels_of(frame, patch.place));
      for (const float off : patch.residual) sum += off * off;
    }
    const double frames = static_cast<double>(early_.size());
    const double count = frames * static_cast<double>(patch.reference.size());
    patch.usual_rms = std::sqrt(sum / count / (1.0 - 1.0 / frames));
    patch.residual.clear();
  }
  std::vector<double> usual;
  for (const Patch& patch : patches_) usual.push_back(patch.usual_rms);
  const double most = 3.0 * std::max(median_of(usual), kPatchNoise);
  std::erase_if(patches_, [&](const Patch& patch) { return patch.usual_rms > most; });
  ready_ = true;
}

void SceneWatch::look(const cv::Mat& grey, double t_s) {
  SceneLook look = compare(cut(grey));
  look.frame = looks_.size();
  look.t_s = t_s;
  looks_.push_back(look);
  const cv::Point2d now(look.u_px, look.v_px);
  // References are moved to the scene's position once it has shifted so far that a first-order step is not enough.
  if (cv::norm(now - shift_) < kLeastRestep || cv::norm(now) > kMargin - 2) return;
  shift_ = now;
  for (Patch& patch : patches_) shift_reference(patch, shift_);
}

void SceneWatch::add(const cv::Mat& grey, double t_s) {
  if (looks_.empty() && early_.empty()) {
    size_ = grey.size();
    choose(grey);
  }
  steps_.add(grey);
  if (patches_.empty()) return;
  if (ready_) return look(grey, t_s);
  early_.push_back(grey.clone());
  early_t_s_.push_back(t_s);
  if (early_.size() < kReferenceFrames) return;
  make_reference();
  for (std::size_t f = 0; f < early_.size(); ++f) look(early_[f], early_t_s_[f]);
  early_.clear();
}

PixelChanges SceneWatch::changes_by_level() const {
  PixelChanges pixels;
  for (const Patch& patch : patches_) {
    for (std::size_t i = 0; i < patch.changed.size(); ++i) {
      pixels.push_back({patch.reference[i], patch.changed[i], patch.changes});
    }
  }
  return pixels;
}

void SceneWatch::finish(ImageRecord& record) {
  record.scene = std::move(looks_);
  record.steps = steps_.finish();
  if (!lossy_ && through_lossy_codec(record)) allow_for_codec(record.scene);
  if (changes_ == 0) return;
  record.noise_code = std::sqrt(0.5 * change_one_ / static_cast<double>(changes_)) / kPatchSofter;
  for (NoiseAtLevel& one : record.noise_levels = noise_by_level(changes_by_level())) {
    one.sd_code /= kPatchSofter;
    one.known_to /= kPatchSofter;
  }
  if (change_one_ > 0.0) record.noise_memory = change_two_ / change_one_;
}

// What follows compares a frame with the references.
/// The best terms of a patch in a frame; the residuals stay in the patch.
SceneWatch::Terms SceneWatch::fit_terms(Patch& patch, const std::vector<float>& pixels) {
  const std::size_t n = patch.reference.size();
  patch.residual.assign(n, 0.0F);
  Terms right = Terms::all(0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const double off = pixels[i] - patch.reference[i];
    right += off * derivatives_at(patch, i);
  }
  const Terms by = patch.inverse * right;
  for (std::size_t i = 0; i < n; ++i) {
    const double model = by.dot(derivatives_at(patch, i));
    patch.residual[i] = static_cast<float>(pixels[i] - patch.reference[i] - model);
  }
  return by;
}

/// Gains and shift of a patch that nothing passes through.
std::optional<SceneWatch::Moved> SceneWatch::fit_patch(Patch& patch, const std::vector<float>& pixels) const {
  const std::size_t n = patch.reference.size();
  std::swap(patch.before_that, patch.before);
  std::swap(patch.before, patch.residual);
  patch.residual.assign(n, 0.0F);
  if (pixels.empty()) return std::nullopt;
  const Terms by = fit_terms(patch, pixels);
  double rest = 0.0;
  for (const float off : patch.residual) rest += off * off;
  // Interpolation never quite reproduces fine structure that has moved by part of a pixel.
  const double moved = std::min(1.0, std::hypot(shift_.x + by[1], shift_.y + by[2]));
  const double steep = std::sqrt((patch.structure(0, 0) + patch.structure(1, 1)) / static_cast<double>(n));
  const double usual = std::hypot(std::max(patch.usual_rms, kPatchNoise), kInterpolationError * steep * moved);
  const double mean = rest / static_cast<double>(n);
  if (std::sqrt(mean) > kMostRelativeResidual * usual) return std::nullopt;
  return Moved{&patch, by, mean / patch.noise_left};
}

/// A patch that moves differently from half of the informative patches does not belong to the scene.
void SceneWatch::drop_odd(std::vector<Moved>& found, double variance) {
  for (const int axis : {1, 2}) {
    std::vector<double> shifts;
    for (const Moved& one : found) {
      if (variance * one.patch->inverse(axis, axis) < kMostShiftSdToCompare * kMostShiftSdToCompare)
        shifts.push_back(one.by[axis]);
    }
    if (shifts.size() < 3) continue;
    const double usual = median_of(shifts);
    std::erase_if(found, [&](const Moved& one) {
      const double sd = std::sqrt(variance * one.patch->inverse(axis, axis));
      const bool off =
          sd < kMostShiftSdToCompare && std::abs(one.by[axis] - usual) > kMostShiftOff * std::max(sd, kLeastShiftSd);
      if (off) one.patch->good = 0;
      return off;
    });
  }
}

/// For the bands of rows that have a patch.
void SceneWatch::tell_gains(const std::vector<Moved>& found, double variance, SceneLook& look) const {
  std::array<double, kRowBands> gain{}, weight{};
  for (const Moved& one : found) {
    const auto band = static_cast<std::size_t>(
        std::clamp((one.patch->place.y + kPatchSide / 2) * static_cast<int>(kRowBands) / size_.height, 0,
                   static_cast<int>(kRowBands) - 1));
    gain[band] += one.by[0] / one.patch->gain_variance;
    weight[band] += 1.0 / one.patch->gain_variance;
  }
  for (std::size_t b = 0; b < kRowBands; ++b) {
    if (weight[b] == 0.0) continue;
    look.gain[b] = gain[b] / weight[b];
    look.gain_sd[b] = std::sqrt(variance / weight[b]);
  }
}

/// The patches' own shifts, weighted by their gradients.
void SceneWatch::tell_shift(const std::vector<Moved>& found, double variance, SceneLook& look) const {
  cv::Matx22d information = cv::Matx22d::zeros();
  cv::Vec2d sum(0.0, 0.0);
  for (const Moved& one : found) {
    information += one.patch->structure;
    sum += one.patch->structure * cv::Vec2d(one.by[1], one.by[2]);
  }
  const cv::Matx22d inverse = information.inv();
  const cv::Vec2d shift = inverse * sum;
  // Differences between patches beyond their pixels' noise are errors common to all pixels of a patch, as in a codec's
  // blocks.
  const auto variance_with_excess = [&](int axis) {
    std::vector<double> squares;
    for (const Moved& one : found) {
      const double own = variance * one.patch->inverse(1 + axis, 1 + axis);
      squares.push_back(std::pow(one.by[1 + axis] - shift[axis], 2) / own);
    }
    return variance * inverse(axis, axis) * std::max(1.0, median_of(squares) / kMedianOfSquare);
  };
  look.sd_u_px = std::sqrt(variance_with_excess(0));
  look.sd_v_px = std::sqrt(variance_with_excess(1));
  look.u_px = shift_.x + shift[0];
  look.v_px = shift_.y + shift[1];
  keep_known(look);
}

/// Each pixel's changes since the frame before, and since the one before that.
void SceneWatch::add_changes(Patch& patch) {
  patch.changed.resize(patch.residual.size(), 0.0);
  patch.changes += 1.0;
  for (std::size_t i = 0; i < patch.residual.size(); ++i) {
    const double change = std::pow(patch.residual[i] - patch.before[i], 2) / patch.noise_left;
    patch.changed[i] += change;
    change_one_ += change;
    change_two_ += std::pow(patch.residual[i] - patch.before_that[i], 2) / patch.noise_left;
  }
  changes_ += patch.residual.size();
}

SceneLook SceneWatch::compare(const Pixels& pixels) {
  SceneLook look;
  variances_.push_back(0.0);
  std::vector<Moved> found;
  std::vector<double> rests;
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    if (const std::optional<Moved> moved = fit_patch(patches_[p], pixels[p])) {
      found.push_back(*moved);
      rests.push_back(moved->rest);
    } else {
      patches_[p].good = 0;
    }
  }
  if (found.empty()) return look;
  double variance =
      std::max(median_of(rests), kPatchNoise * kPatchNoise) / (kPatchSofter * kPatchSofter);  // of a pixel
  if (lossy_) variance = of_lossy(variance);
  variances_.back() = variance;
  drop_odd(found, variance);
  for (const Moved& one : found) {
    if (++one.patch->good >= kFramesOfChange) add_changes(*one.patch);
  }
  tell_gains(found, variance, look);
  if (!found.empty()) tell_shift(found, variance, look);
  return look;
}

/// Errors as for a file that says that it is lossily compressed; a shift that is then too uncertain is not a
/// measurement.
void SceneWatch::allow_for_codec(std::vector<SceneLook>& looks) const {
  for (std::size_t k = 0; k < looks.size(); ++k) {
    SceneLook& look = looks[k];
    if (!(variances_[k] > 0.0)) continue;
    const double wider = std::sqrt(of_lossy(variances_[k]) / variances_[k]);
    for (double& sd : look.gain_sd) sd *= wider;
    look.sd_u_px *= wider;
    look.sd_v_px *= wider;
    keep_known(look);
  }
}

}  // namespace glidelab::core
