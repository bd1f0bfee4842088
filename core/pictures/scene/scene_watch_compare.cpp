#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/math/quantile.h"
#include "core/pictures/scene/scene_watch.h"

namespace glidelab::core {
namespace {

constexpr double kDisturbed = 3.0;         // residuals over the usual ones
constexpr double kWellKnown = 0.5;         // px; a shift known less well is no measurement
constexpr double kTells = 0.2;             // px; a patch that is to agree with the others must know its shift so well
constexpr double kOff = 5.0;               // of its standard deviations
constexpr double kInterpolated = 0.1;      // px: residual over gradient of structure near the pixels' own size
constexpr double kLossyNoise = 1.0;        // codes, of a pixel
constexpr double kBlock = 64.0;            // pixels that a codec errs in together
constexpr double kLeastShiftSd = 0.01;     // px: of a patch against the others
constexpr double kMedianOfSquare = 0.455;  // of a standard normal deviate
constexpr int kFramesOfChange = 3;         // in a row that give changes over one frame and over two

void keep_known(SceneLook& look) {
  if (!(look.sd_u_px < kWellKnown)) look.u_px = look.sd_u_px = 0.0;
  if (!(look.sd_v_px < kWellKnown)) look.v_px = look.sd_v_px = 0.0;
}

double of_lossy(double variance) {
  return kBlock * std::max(variance, kLossyNoise * kLossyNoise);
}

}  // namespace

/// Gain and shift of a patch that nothing passes through; what is left over stays in the patch.
std::optional<SceneWatch::Moved> SceneWatch::fit_patch(Patch& patch, const std::vector<float>& pixels) const {
  const std::size_t n = patch.reference.size();
  std::swap(patch.before_that, patch.before);
  std::swap(patch.before, patch.residual);
  patch.residual.assign(n, 0.0F);
  if (pixels.empty()) return std::nullopt;
  cv::Vec3d right(0.0, 0.0, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const double off = pixels[i] - patch.reference[i];
    right += off * cv::Vec3d(patch.reference[i], -patch.gu[i], -patch.gv[i]);
  }
  const cv::Vec3d by = patch.inverse * right;
  double rest = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double model = by[0] * patch.reference[i] - by[1] * patch.gu[i] - by[2] * patch.gv[i];
    patch.residual[i] = static_cast<float>(pixels[i] - patch.reference[i] - model);
    rest += patch.residual[i] * patch.residual[i];
  }
  // Fine structure that has moved by part of a pixel is never quite what interpolation makes of it.
  const double moved = std::min(1.0, std::hypot(shift_.x + by[1], shift_.y + by[2]));
  const double steep = std::sqrt((patch.structure(0, 0) + patch.structure(1, 1)) / static_cast<double>(n));
  const double usual = std::hypot(std::max(patch.usual_rms, kPatchNoise), kInterpolated * steep * moved);
  const double mean = rest / static_cast<double>(n);
  if (std::sqrt(mean) > kDisturbed * usual) return std::nullopt;
  return Moved{&patch, by, mean};
}

/// What moves otherwise than half of the patches that can tell is not the scene.
void SceneWatch::drop_odd(std::vector<Moved>& found, double variance) {
  for (const int axis : {1, 2}) {
    std::vector<double> shifts;
    for (const Moved& one : found) {
      if (variance * one.patch->inverse(axis, axis) < kTells * kTells) shifts.push_back(one.by[axis]);
    }
    if (shifts.size() < 3) continue;
    const double usual = median_of(shifts);
    std::erase_if(found, [&](const Moved& one) {
      const double sd = std::sqrt(variance * one.patch->inverse(axis, axis));
      const bool off = sd < kTells && std::abs(one.by[axis] - usual) > kOff * std::max(sd, kLeastShiftSd);
      if (off) one.patch->good = 0;
      return off;
    });
  }
}

/// Of the bands of rows that have a patch.
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
  // What patches differ by beyond their pixels' noise errs in all pixels of a patch together, as a codec's blocks do.
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
    const double change = patch.residual[i] - patch.before[i];
    patch.changed[i] += change * change;
    change_one_ += change * change;
    change_two_ += std::pow(patch.residual[i] - patch.before_that[i], 2);
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

/// Errors as of a file that says that it is compressed with loss; what is known too little then is no measurement.
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
