#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/median.h"
#include "core/scene_watch.h"

namespace glidelab::core {
namespace {

constexpr double kDisturbed = 3.0;     // residuals over the usual ones
constexpr double kWellKnown = 0.5;     // px; a shift known less well is no measurement
constexpr double kTells = 0.2;         // px; a patch that is to agree with the others must know its shift so well
constexpr double kOff = 5.0;           // of its standard deviations
constexpr double kInterpolated = 0.1;  // px: residual over gradient of structure near the pixels' own size
constexpr double kLossyNoise = 1.0;    // codes, of a pixel
constexpr double kBlock = 64.0;        // pixels that a codec errs in together

void keep_known(SceneLook& look) {
  if (!(look.sd_u_px < kWellKnown)) look.u_px = look.sd_u_px = 0.0;
  if (!(look.sd_v_px < kWellKnown)) look.v_px = look.sd_v_px = 0.0;
}

double of_lossy(double variance) {
  return kBlock * std::max(variance, kLossyNoise * kLossyNoise);
}

}  // namespace

SceneLook SceneWatch::compare(const Pixels& pixels) {
  SceneLook look;
  variances_.push_back(0.0);
  struct Found {
    Patch* patch;
    cv::Vec3d by;
    double rest;
  };
  std::vector<Found> found;
  std::vector<double> rests;
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    Patch& patch = patches_[p];
    const std::size_t n = patch.reference.size();
    std::swap(patch.before_that, patch.before);
    std::swap(patch.before, patch.residual);
    patch.residual.assign(n, 0.0F);
    if (pixels[p].empty()) {
      patch.good = 0;
      continue;
    }
    cv::Vec3d right(0.0, 0.0, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      const double off = pixels[p][i] - patch.reference[i];
      right += off * cv::Vec3d(patch.reference[i], -patch.gu[i], -patch.gv[i]);
    }
    const cv::Vec3d by = patch.inverse * right;
    double rest = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double model = by[0] * patch.reference[i] - by[1] * patch.gu[i] - by[2] * patch.gv[i];
      patch.residual[i] = static_cast<float>(pixels[p][i] - patch.reference[i] - model);
      rest += patch.residual[i] * patch.residual[i];
    }
    // Fine structure that has moved by part of a pixel is never quite what interpolation makes of it.
    const double moved = std::min(1.0, std::hypot(shift_.x + by[1], shift_.y + by[2]));
    const double steep = std::sqrt((patch.structure(0, 0) + patch.structure(1, 1)) / static_cast<double>(n));
    const double usual = std::hypot(std::max(patch.usual_rms, kPatchNoise), kInterpolated * steep * moved);
    if (std::sqrt(rest / static_cast<double>(n)) > kDisturbed * usual) {
      patch.good = 0;
      continue;
    }
    found.push_back({&patch, by, rest / static_cast<double>(n)});
    rests.push_back(found.back().rest);
  }
  if (found.empty()) return look;
  double variance =
      std::max(median_of(rests), kPatchNoise * kPatchNoise) / (kPatchSofter * kPatchSofter);  // of a pixel
  if (lossy_) variance = of_lossy(variance);
  variances_.back() = variance;
  // What moves otherwise than half of the patches that can tell is not the scene.
  for (const int axis : {0, 1}) {
    std::vector<double> shifts;
    for (const Found& one : found) {
      if (variance * one.patch->inverse(1 + axis, 1 + axis) < kTells * kTells) shifts.push_back(one.by[1 + axis]);
    }
    if (shifts.size() < 3) continue;
    const double usual = median_of(shifts);
    std::erase_if(found, [&](const Found& one) {
      const double sd = std::sqrt(variance * one.patch->inverse(1 + axis, 1 + axis));
      const bool off = sd < kTells && std::abs(one.by[1 + axis] - usual) > kOff * std::max(sd, 0.01);
      if (off) one.patch->good = 0;
      return off;
    });
  }
  cv::Matx22d information = cv::Matx22d::zeros();
  cv::Vec2d sum(0.0, 0.0);
  std::array<double, kRowBands> gain{}, weight{};
  for (const Found& one : found) {
    Patch& patch = *one.patch;
    ++patch.good;
    information += patch.structure;
    sum += patch.structure * cv::Vec2d(one.by[1], one.by[2]);
    const auto band = static_cast<std::size_t>(
        std::clamp((patch.place.y + kPatchSide / 2) * static_cast<int>(kRowBands) / size_.height, 0,
                   static_cast<int>(kRowBands) - 1));
    gain[band] += one.by[0] / patch.gain_variance;
    weight[band] += 1.0 / patch.gain_variance;
    if (patch.good < 3) continue;
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
  for (std::size_t b = 0; b < kRowBands; ++b) {
    if (weight[b] == 0.0) continue;
    look.gain[b] = gain[b] / weight[b];
    look.gain_sd[b] = std::sqrt(variance / weight[b]);
  }
  if (found.empty()) return look;
  const cv::Matx22d inverse = information.inv();
  const cv::Vec2d shift = inverse * sum;
  // What patches differ by beyond their pixels' noise errs in all pixels of a patch together, as a codec's blocks do.
  std::array<std::vector<double>, 2> off;
  for (const Found& one : found) {
    for (const int axis : {0, 1}) {
      const double own = variance * one.patch->inverse(1 + axis, 1 + axis);
      off[static_cast<std::size_t>(axis)].push_back(std::pow(one.by[1 + axis] - shift[axis], 2) / own);
    }
  }
  const auto excess = [](const std::vector<double>& squares) {
    constexpr double kMedianOfSquare = 0.455;  // of a standard normal deviate
    return std::max(1.0, median_of(squares) / kMedianOfSquare);
  };
  look.sd_u_px = std::sqrt(variance * inverse(0, 0) * excess(off[0]));
  look.sd_v_px = std::sqrt(variance * inverse(1, 1) * excess(off[1]));
  look.u_px = shift_.x + shift[0];
  look.v_px = shift_.y + shift[1];
  keep_known(look);
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
