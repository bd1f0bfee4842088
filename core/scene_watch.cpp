#include "core/scene_watch.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/median.h"

namespace glidelab::core {
namespace {

constexpr int kSide = 24;                 // px
constexpr std::size_t kOfStructure = 12;  // patches, for each of the two directions
constexpr std::size_t kSpread = 12;       // patches all over the picture, for the light
constexpr std::size_t kReferenceFrames = 6;
constexpr double kDisturbed = 3.0;     // residuals over the usual ones
constexpr std::size_t kStepEvery = 4;  // frames
constexpr int kStepRows = 24;
constexpr double kLargestStep = 12.0 / 255.0;  // of full scale: larger ones are edges of things
constexpr double kWellKnown = 0.5;             // px; a shift known less well is no measurement
constexpr double kTells = 0.2;         // px; a patch that is to agree with the others must know its shift so well
constexpr double kOff = 5.0;           // of its standard deviations
constexpr double kRestep = 0.2;        // px
constexpr double kInterpolated = 0.1;  // px: residual over gradient of structure near the pixels' own size
constexpr double kLeastNoise = 0.1;    // codes: rounding, blurred
constexpr double kLossyNoise = 1.0;    // codes, of a pixel
constexpr double kBlock = 64.0;        // pixels that a codec errs in together
constexpr double kSofter = 0.2873;     // noise of a pixel after the blur below: sum of its weights' squares
constexpr int kMargin = 12;            // px around a patch

std::vector<float> pixels_of(const cv::Mat& grey, const cv::Rect& place) {
  cv::Mat_<float> part;
  grey(place).convertTo(part, CV_32F);
  return {part.begin(), part.end()};
}

cv::Rect margined(const cv::Rect& place) {
  return {place.x - kMargin, place.y - kMargin, place.width + 2 * kMargin, place.height + 2 * kMargin};
}

/// Blurred by a normal distribution of 1 px, so that a derivative means something.
std::vector<float> soft_pixels_of(const cv::Mat& grey, const cv::Rect& place) {
  cv::Mat_<float> part, soft;
  grey({place.x - 2, place.y - 2, kSide + 4, kSide + 4}).convertTo(part, CV_32F);
  cv::GaussianBlur(part, soft, {5, 5}, 1.0);
  const cv::Mat_<float> middle = soft({2, 2, kSide, kSide}).clone();
  return {middle.begin(), middle.end()};
}

struct Candidate {
  cv::Rect place;
  double uu = 0.0, vv = 0.0;
};

}  // namespace

void SceneWatch::choose(const cv::Mat& grey) {
  const int margin = kMargin;
  const int free_u = grey.cols - kSide - 2 * margin, free_v = grey.rows - kSide - 2 * margin;
  if (free_u < 0 || free_v < 0) return;
  std::vector<Candidate> candidates;
  const int step = std::max(kSide, static_cast<int>(std::sqrt(static_cast<double>(grey.total()) / 400.0)));
  for (int v = margin; v <= margin + free_v; v += step) {
    for (int u = margin; u <= margin + free_u; u += step) {
      Candidate candidate{cv::Rect(u, v, kSide, kSide), 0.0, 0.0};
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
    for (std::size_t i = 0; i < std::min(kOfStructure, order.size()); ++i) taken[order[i]] = 1;
  };
  take_best([](const Candidate& c) { return c.uu; });
  take_best([](const Candidate& c) { return c.vv; });
  for (std::size_t i = 0; i < kSpread; ++i) {
    taken[std::min(candidates.size() - 1, (2 * i + 1) * candidates.size() / (2 * kSpread))] = 1;
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

/// Puts a patch's reference where the scene now stands in the picture.
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
  const cv::Rect middle(kMargin, kMargin, kSide, kSide);
  const auto flat = [&](const cv::Mat_<float>& from) {
    const cv::Mat_<float> part = from(middle).clone();
    return std::vector<float>(part.begin(), part.end());
  };
  patch.reference = flat(whole);
  patch.gu = flat(gu);
  patch.gv = flat(gv);
  cv::Matx33d normal = cv::Matx33d::zeros();
  for (std::size_t i = 0; i < patch.reference.size(); ++i) {
    const cv::Vec3d row(patch.reference[i], -patch.gu[i], -patch.gv[i]);
    normal += row * row.t();
  }
  // A patch without any structure has no shift; the ridge is far below one code's worth of gradient.
  for (int k = 0; k < 3; ++k) normal(k, k) += 1e-3;
  patch.inverse = normal.inv();
  const cv::Vec2d cross(normal(0, 1), normal(0, 2));
  patch.structure =
      cv::Matx22d(normal(1, 1), normal(1, 2), normal(2, 1), normal(2, 2)) - cross * cross.t() * (1.0 / normal(0, 0));
  patch.gain_variance = patch.inverse(0, 0);
}

void SceneWatch::make_reference() {
  constexpr int kWhole = kSide + 2 * kMargin;
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
    // The usual residuals are those of the first frames themselves; what passes by then makes a patch of no use.
    double sum = 0.0, count = 0.0;
    for (const cv::Mat& frame : early_) {
      const std::vector<float> pixels = soft_pixels_of(frame, patch.place);
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double off = pixels[i] - patch.reference[i];
        sum += off * off;
        count += 1.0;
      }
    }
    patch.usual_rms = std::sqrt(sum / count / (1.0 - 1.0 / static_cast<double>(early_.size())));
  }
  std::vector<double> usual;
  for (const Patch& patch : patches_) usual.push_back(patch.usual_rms);
  const double most = 3.0 * std::max(median_of(usual), kLeastNoise);
  std::erase_if(patches_, [&](const Patch& patch) { return patch.usual_rms > most; });
  ready_ = true;
}

SceneLook SceneWatch::compare(const Pixels& pixels) {
  SceneLook look;
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
    const double usual = std::hypot(std::max(patch.usual_rms, kLeastNoise), kInterpolated * steep * moved);
    if (std::sqrt(rest / static_cast<double>(n)) > kDisturbed * usual) {
      patch.good = 0;
      continue;
    }
    found.push_back({&patch, by, rest / static_cast<double>(n)});
    rests.push_back(found.back().rest);
  }
  if (found.empty()) return look;
  double variance = std::max(median_of(rests), kLeastNoise * kLeastNoise) / (kSofter * kSofter);  // of a pixel
  if (lossy_) variance = kBlock * std::max(variance, kLossyNoise * kLossyNoise);
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
    const auto band = static_cast<std::size_t>(std::clamp(
        (patch.place.y + kSide / 2) * static_cast<int>(kRowBands) / size_.height, 0, static_cast<int>(kRowBands) - 1));
    gain[band] += one.by[0] / patch.gain_variance;
    weight[band] += 1.0 / patch.gain_variance;
    if (patch.good < 3) continue;
    for (std::size_t i = 0; i < patch.residual.size(); ++i) {
      change_one_ += std::pow(patch.residual[i] - patch.before[i], 2);
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
  if (!(look.sd_u_px < kWellKnown)) look.u_px = look.sd_u_px = 0.0;
  if (!(look.sd_v_px < kWellKnown)) look.v_px = look.sd_v_px = 0.0;
  return look;
}

void SceneWatch::add_steps(const cv::Mat& grey) {
  const double scale = grey.depth() == CV_8U ? 1.0 : 1.0 / 257.0, most = 255.0 * kLargestStep;
  const int apart = std::max(1, grey.rows / kStepRows);
  for (int v = apart / 2; v < grey.rows; v += apart) {
    const std::vector<float> row = pixels_of(grey, cv::Rect(0, v, grey.cols, 1));
    const std::size_t whole = row.size() / 8 * 8;  // of each column as many
    for (std::size_t u = 8; u < whole; ++u) {
      steps_.mean[u % 8] += std::min(most, scale * std::abs(row[u] - row[u - 1]));
    }
    steps_.count += static_cast<double>(whole / 8 - (whole > 0 ? 1 : 0));
  }
}

void SceneWatch::look(const cv::Mat& grey, double t_s) {
  SceneLook look = compare(cut(grey));
  look.frame = looks_.size();
  look.t_s = t_s;
  looks_.push_back(look);
  const cv::Point2d now(look.u_px, look.v_px);
  // References are put where the scene stands once it has moved so far that a step to first order is not enough.
  if (cv::norm(now - shift_) < kRestep || cv::norm(now) > kMargin - 2) return;
  shift_ = now;
  for (Patch& patch : patches_) shift_reference(patch, shift_);
}

void SceneWatch::add(const cv::Mat& grey, double t_s) {
  if (looks_.empty() && early_.empty()) {
    size_ = grey.size();
    choose(grey);
  }
  if ((looks_.size() + early_.size()) % kStepEvery == 0) add_steps(grey);
  if (patches_.empty()) return;
  if (ready_) return look(grey, t_s);
  early_.push_back(grey.clone());
  early_t_s_.push_back(t_s);
  if (early_.size() < kReferenceFrames) return;
  make_reference();
  for (std::size_t f = 0; f < early_.size(); ++f) look(early_[f], early_t_s_[f]);
  early_.clear();
}

void SceneWatch::finish(PictureRecord& record) {
  record.scene = std::move(looks_);
  record.steps = steps_;
  for (double& mean : record.steps.mean) mean /= std::max(1.0, steps_.count);
  if (changes_ == 0) return;
  record.noise_code = std::sqrt(0.5 * change_one_ / static_cast<double>(changes_)) / kSofter;
  if (change_one_ > 0.0) record.noise_memory = change_two_ / change_one_;
}

}  // namespace glidelab::core
