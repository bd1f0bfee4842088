#include "core/pictures/marker/marker_search.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/pictures/image/disc_search.h"
#include "core/pictures/image/pixel_signal.h"

namespace glidelab::core {
namespace {

constexpr double kLeastChannelRange = 30.0;  // of 255: largest minus smallest channel; less is a tinted grey
constexpr double kDarkestGrey = 64.0;        // of 255
constexpr double kOwnColor = 200.0;          // of 255: the likeness of the marker's own colour to itself
constexpr double kWorkingRadiusPx = 3.0;     // the image is shrunk until the marker has this radius
constexpr double kLeastOverNoise = 5.0;
constexpr double kLeastShareOfBest = 0.04;           // of the highest contrast in the region
constexpr int kMostPixelsSearchedWhole = 200 * 200;  // a smaller region is searched as a whole

cv::Mat likeness(const cv::Mat& bgr, cv::Vec3b color) {
  const double grey = (color[0] + color[1] + color[2]) / 3.0;
  const cv::Vec3d target(color[0] - grey, color[1] - grey, color[2] - grey);
  const double strength = cv::norm(target);
  const auto tb = static_cast<float>(target[0] / strength);
  const auto tg = static_cast<float>(target[1] / strength);
  const auto tr = static_cast<float>(target[2] / strength);
  const auto scale = static_cast<float>(kOwnColor / strength);
  cv::Mat values(bgr.size(), CV_8U);
  for (int v = 0; v < bgr.rows; ++v) {
    const auto* from = bgr.ptr<cv::Vec3b>(v);
    auto* to = values.ptr<unsigned char>(v);
    for (int u = 0; u < bgr.cols; ++u) {
      const float b = from[u][0], g = from[u][1], r = from[u][2];
      const float mean = (b + g + r) * (1.0F / 3.0F);
      const float cb = b - mean, cg = g - mean, cr = r - mean;
      const float along = cb * tb + cg * tg + cr * tr;
      if (along <= 0.0F) {
        to[u] = 0;
        continue;
      }
      const float across = std::sqrt(std::max(cb * cb + cg * cg + cr * cr - along * along, 0.0F));
      to[u] = cv::saturate_cast<unsigned char>(scale * (along - 0.5F * across));
    }
  }
  return values;
}

/// The scale at which an image is searched for discs of a radius.
struct Scale {
  double shrink;  ///< factor by which the image is shrunk
  double radius;  ///< of the disc in the shrunk image
  DiscSquares squares;

  explicit Scale(double radius_px)
      : shrink(std::max(1.0, radius_px / kWorkingRadiusPx)), radius(radius_px / shrink), squares(radius) {}
  /// The margin around the region that is part of the searched image.
  int surroundings_px() const { return static_cast<int>(std::ceil(3.0 * radius * shrink + 3.0)); }
  /// Pixels farther away than this do not count for the contrast at a position.
  int sight_px() const { return static_cast<int>(std::ceil((squares.away + squares.outer + 1.0) * shrink)) + 1; }
};

/// Adds the blobs of a region. `noise`, if given, is that of the pixels of the shrunk image.
void add_blobs(const cv::Mat& values, const cv::Rect& region, const BlobSearch& search, const Scale& scale,
               const std::optional<double>& noise, std::vector<Blob>& blobs) {
  const cv::Rect taken = with_border(region, scale.surroundings_px()) & cv::Rect({}, values.size());
  cv::Mat small;
  const cv::Size size(std::max(1, static_cast<int>(std::lround(taken.width / scale.shrink))),
                      std::max(1, static_cast<int>(std::lround(taken.height / scale.shrink))));
  if (scale.shrink > 1.0) {
    small = area_means(values(taken), size);
  } else {
    values(taken).convertTo(small, CV_32F);
  }
  const double fu = static_cast<double>(taken.width) / small.cols;
  const double fv = static_cast<double>(taken.height) / small.rows;
  const auto to_image = [&](double u, double v) {
    return cv::Point2d((u + 0.5) * fu - 0.5 + taken.x, (v + 0.5) * fv - 0.5 + taken.y);
  };

  // The part of the shrunk image that lies in the region.
  const auto first_in = [](int count, double from, const auto& place) {
    int k = 0;
    while (k < count && place(k) < from) ++k;
    return k;
  };
  const auto column = [&](int u) { return to_image(u, 0).x; };
  const auto line = [&](int v) { return to_image(0, v).y; };
  const cv::Point begin(first_in(small.cols, region.x - 0.5, column), first_in(small.rows, region.y - 0.5, line));
  const cv::Point end(first_in(small.cols, region.br().x, column), first_in(small.rows, region.br().y, line));
  const cv::Mat response = disc_response(small, cv::Rect(begin, end), scale.squares, search.bright_neighbours);
  double best = 0.0;
  cv::minMaxLoc(response, nullptr, &best);
  const double of_pixel = noise ? *noise : noise_of(small);
  const double of_mean = of_pixel / (2.0 * std::min(scale.squares.inner, scale.squares.outer) + 1.0);
  const double least =
      std::max({kLeastOverNoise * std::sqrt(2.0) * of_mean, kLeastShareOfBest * best, search.least_contrast, 1e-6});

  for (int v = begin.y; v < end.y; ++v) {  // there is none elsewhere
    const auto* const row = response.ptr<float>(v);
    for (int u = begin.x; u < end.x; ++u) {
      const float here = row[u];
      if (static_cast<double>(here) < least) continue;
      bool highest = true;
      for (int dv = -1; dv <= 1 && highest; ++dv) {
        for (int du = -1; du <= 1; ++du) {
          if ((du == 0 && dv == 0) || u + du < 0 || v + dv < 0 || u + du >= small.cols || v + dv >= small.rows)
            continue;
          const float other = response.at<float>(v + dv, u + du);
          // Of equal neighbours, the first one counts.
          if (other > here || (other == here && (dv < 0 || (dv == 0 && du < 0)))) highest = false;
        }
      }
      if (!highest) continue;
      // Centroid of the response around its maximum.
      double sum = 0.0, su = 0.0, sv = 0.0;
      for (int dv = -2; dv <= 2; ++dv) {
        for (int du = -2; du <= 2; ++du) {
          if (u + du < 0 || v + dv < 0 || u + du >= small.cols || v + dv >= small.rows) continue;
          const auto w = static_cast<double>(response.at<float>(v + dv, u + du));
          sum += w;
          su += w * du;
          sv += w * dv;
        }
      }
      blobs.push_back({to_image(u + su / sum, v + sv / sum), static_cast<double>(here)});
    }
  }
}

}  // namespace

SignalKind signal_kind(const MarkerSetup& marker) {
  if (!marker.color_bgr) return SignalKind::bright;
  const std::array<unsigned char, 3>& c = *marker.color_bgr;
  const int high = std::max({c[0], c[1], c[2]}), low = std::min({c[0], c[1], c[2]});
  if (high - low >= kLeastChannelRange) return SignalKind::colored;
  return (c[0] + c[1] + c[2]) / 3.0 < kDarkestGrey ? SignalKind::dark : SignalKind::bright;
}

double least_contrast(SignalKind kind) {
  return kind == SignalKind::colored ? kOwnColor / 6.0 : 0.0;
}

std::optional<Signal> signal_of(const Frame& frame, const MarkerSetup& marker, SignalKind kind) {
  if (kind == SignalKind::colored) {
    if (frame.color.empty()) return std::nullopt;
    return Signal{likeness(frame.color, cv::Vec3b(marker.color_bgr->data()))};
  }
  if (kind == SignalKind::bright || kind == SignalKind::any_shape) return Signal{frame.grey, frame.draw};
  if (frame.draw) frame.draw(cv::Rect({}, frame.grey.size()));
  cv::Mat inverse;
  cv::bitwise_not(frame.grey, inverse);
  return Signal{inverse, {}, true};
}

std::vector<Blob> find_blobs(const Signal& signal, const BlobSearch& search) {
  const cv::Rect whole({}, signal.values.size());
  const cv::Rect region = search.region & whole;
  const Scale scale(search.radius_px);
  const cv::Rect taken = with_border(region, scale.surroundings_px()) & whole;
  if (region.empty() || taken.empty()) return {};
  signal.see(taken);
  std::vector<Blob> blobs;
  if (search.least_contrast > 0.0 && region.area() > kMostPixelsSearchedWhole) {
    const double noise = noise_when_shrunk(signal.values(taken), static_cast<int>(std::lround(scale.shrink)));
    for (const cv::Rect& part : parts_with_contrast(signal.values, region, search.least_contrast, scale.sight_px())) {
      add_blobs(signal.values, part, search, scale, noise, blobs);
    }
  } else {
    add_blobs(signal.values, region, search, scale, std::nullopt, blobs);
  }
  std::stable_sort(blobs.begin(), blobs.end(), [](const Blob& a, const Blob& b) { return a.contrast > b.contrast; });
  std::vector<Blob> apart;
  for (const Blob& blob : blobs) {
    if (blob.contrast < kLeastShareOfBest * blobs.front().contrast) break;
    const bool near = std::any_of(apart.begin(), apart.end(), [&](const Blob& other) {
      return cv::norm(blob.centre - other.centre) < 1.2 * search.radius_px;
    });
    if (near) continue;
    apart.push_back(blob);
    if (apart.size() == search.most) break;
  }
  return apart;
}

}  // namespace glidelab::core
