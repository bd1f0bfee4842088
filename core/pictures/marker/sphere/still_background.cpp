#include "core/pictures/marker/sphere/still_background.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kMostKept = 41;             // frames; odd, so that the median is one of them
constexpr std::size_t kMostKeptBytes = 1U << 27;  // fewer frames of a large image,
constexpr std::size_t kFewestKept = 9;            // but at least these
constexpr double kNearMedian = 3.0;               // standard deviations: codes within these count for the mean

template <class Code>
void put_median(const std::vector<const Code*>& rows, int columns, Code* out) {
  std::vector<Code> codes(rows.size());
  const auto middle = codes.begin() + static_cast<std::ptrdiff_t>(codes.size() / 2);
  for (int u = 0; u < columns; ++u) {
    for (std::size_t k = 0; k < rows.size(); ++k) codes[k] = rows[k][u];
    std::nth_element(codes.begin(), middle, codes.end());
    out[u] = *middle;
  }
}

double code_at(const cv::Mat& grey, int u, int v) {
  return grey.depth() == CV_8U ? static_cast<double>(grey.at<unsigned char>(v, u))
                               : static_cast<double>(grey.at<std::uint16_t>(v, u));
}

}  // namespace

void StillBackground::add(const cv::Mat& grey, std::size_t frame) {
  const std::size_t bytes = std::max<std::size_t>(grey.total() * grey.elemSize(), 1);
  const std::size_t most = std::clamp(kMostKeptBytes / bytes, kFewestKept, kMostKept);
  const std::size_t every = std::max<std::size_t>((clip_frames_ + most - 1) / most, 1);
  if (frame % every == 0 && kept_.size() < most) kept_.push_back({frame, grey.clone()});
}

cv::Mat StillBackground::median() const {
  if (kept_.empty()) return {};
  cv::Mat found(kept_.front().grey.size(), kept_.front().grey.type());
  const auto fill = [&]<class Code>(Code /*of*/) {
    std::vector<const Code*> rows(kept_.size());
    for (int v = 0; v < found.rows; ++v) {
      for (std::size_t k = 0; k < kept_.size(); ++k) rows[k] = kept_[k].grey.ptr<Code>(v);
      put_median(rows, found.cols, found.ptr<Code>(v));
    }
  };
  if (found.depth() == CV_8U) {
    fill(static_cast<unsigned char>(0));
  } else {
    fill(static_cast<std::uint16_t>(0));
  }
  return found;
}

StillBackground::Part StillBackground::behind(const cv::Rect& region, const Hides& hides) const {
  Part part;
  part.codes = cv::Mat::zeros(region.size(), CV_32F);
  part.known = cv::Mat::zeros(region.size(), CV_8U);
  // First the noise, from some pixels, to tell which codes are near the median.
  std::vector<double> deviations, codes;
  const auto gather = [&](int u, int v) {
    codes.clear();
    for (const Kept& kept : kept_) {
      if (!hides(kept.frame, {u, v})) codes.push_back(code_at(kept.grey, u, v));
    }
    return codes.size() >= kFewest;
  };
  constexpr int kEvery = 7;
  for (int v = region.y; v < region.br().y; v += kEvery) {
    for (int u = region.x; u < region.br().x; u += kEvery) {
      if (!gather(u, v)) continue;
      const double middle = median_of(codes);
      double sum = 0.0, count = 0.0;
      for (const double code : codes) {
        // One of the codes is the median itself, so the sum has one degree of freedom less.
        sum += std::abs(code - middle);
        count += 1.0;
      }
      if (count > 1.0) deviations.push_back(sum / (count - 1.0));
    }
  }
  constexpr double kSdOverMeanMagnitude = 1.2533;  // sqrt(pi/2), for a normal distribution
  constexpr double kRounding = 0.29;               // codes, 1 / sqrt(12)
  part.noise = deviations.empty() ? kRounding : std::max(kSdOverMeanMagnitude * median_of(deviations), kRounding);
  for (int v = region.y; v < region.br().y; ++v) {
    for (int u = region.x; u < region.br().x; ++u) {
      if (!gather(u, v)) continue;
      const double middle = median_of(codes);
      double sum = 0.0, count = 0.0;
      for (const double code : codes) {
        if (std::abs(code - middle) > kNearMedian * part.noise) continue;
        sum += code;
        count += 1.0;
      }
      part.codes.at<float>(v - region.y, u - region.x) = static_cast<float>(sum / count);
      part.known.at<unsigned char>(v - region.y, u - region.x) = 1;
    }
  }
  return part;
}

}  // namespace glidelab::core
