#include "core/pictures/board/board_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "core/pictures/image/pixel_signal.h"

namespace glidelab::core {
namespace {

constexpr int kLargestCoarse = 512;    // px; in the first look, which finds a board of large squares
constexpr int kMostCoarse = 4;         // times coarser than the image, so that a corner is found to about a pixel
constexpr int kLargestAtFirst = 1600;  // px; larger images are shrunk for the search
constexpr int kLargestAgain = 4096;    // px; if nothing was found, because small squares may have been lost
constexpr double kLargeSquare = 12.0;  // px of the first look: what it finds of smaller ones is looked for again
constexpr int kSmallestSide = 20;      // px; OpenCV's detectors refuse windows of a tenth of the side where that is 1
constexpr double kLeastNoiseToBlur = 8.0;  // codes
constexpr int kMostBlurs = 5;              // by 1 px
constexpr std::size_t kMostQuads = 1000;   // in one version of the image: about a second
constexpr int kSmallestQuadPx = 25;        // findChessboardCorners' own
constexpr int kMostDilations = 7;          // likewise
constexpr int kFewDilations = 2;           // of an image that is cut locally: more leave fewer spots
constexpr int kLevelStep = 32;             // codes between the brightnesses at which an image is cut

/// 8 bits for the detectors, the darkest and brightest half per cent clipped.
cv::Mat to_8_bits(const cv::Mat& grey) {
  if (grey.depth() == CV_8U) return grey;
  cv::Mat flat = grey.reshape(1, 1).clone();
  std::vector<std::uint16_t> values;
  for (int i = 0; i < flat.cols; i += 7) values.push_back(flat.at<std::uint16_t>(0, i));
  const auto quantile = [&](double share) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return static_cast<double>(*at);
  };
  const double low = quantile(0.005);
  const double high = std::max(quantile(0.995), low + 1.0);
  cv::Mat eight;
  grey.convertTo(eight, CV_8U, 255.0 / (high - low), -low * 255.0 / (high - low));
  return eight;
}

/// Noise makes many outlines. The image is blurred until its noise is below kLeastNoiseToBlur; the corners are refined
/// in the original image.
cv::Mat without_specks(const cv::Mat& eight) {
  cv::Mat seen = eight, values;
  for (int pass = 0; pass < kMostBlurs; ++pass) {
    seen.convertTo(values, CV_32F);
    if (noise_of(values) < kLeastNoiseToBlur) break;
    cv::Mat softer;
    cv::GaussianBlur(seen, softer, {}, 1.0);
    seen = softer;
  }
  return seen;
}

/// In the image itself, and with its white areas dilated step by step, as in the detector.
std::size_t most_quads(const cv::Mat& white, int dilations) {
  cv::Mat grown = white.clone();
  std::size_t most = 0;
  for (int step = 0; step <= dilations && most <= kMostQuads; ++step) {
    if (step > 0) cv::dilate(grown, grown, cv::Mat());
    most = std::max(most, count_quads(grown));
  }
  return most;
}

/// White where the image is brighter than its surroundings, of a share of the shorter side, less `offset` codes.
cv::Mat locally_cut(const cv::Mat& image, double share, double offset) {
  const int block = std::max(3, static_cast<int>(std::lround(share * std::min(image.cols, image.rows))) | 1);
  cv::Mat white;
  cv::adaptiveThreshold(image, white, 255.0, cv::ADAPTIVE_THRESH_MEAN_C, cv::THRESH_BINARY, block, offset);
  return white;
}

/// The black-and-white versions of an image in which a board would show.
std::vector<cv::Mat> versions_of(const cv::Mat& image) {
  std::vector<cv::Mat> versions(1);
  cv::threshold(image, versions[0], 0.0, 255.0, cv::THRESH_BINARY | cv::THRESH_OTSU);
  for (const double offset : {0.0, 5.0, 10.0}) {
    for (const double share : {0.2, 0.1}) versions.push_back(locally_cut(image, share, offset));
  }
  return versions;
}

/// Whether findChessboardCorners would have more to compare than it can in about a second: it cuts the image at one
/// brightness, then locally.
bool is_crowded(const cv::Mat& image) {
  cv::Mat white;
  for (int level = kLevelStep; level < 256; level += kLevelStep) {
    cv::threshold(image, white, level, 255.0, cv::THRESH_BINARY);
    cv::dilate(white, white, cv::Mat());
    if (count_quads(white) > kMostQuads) return true;
  }
  for (const double share : {0.2, 0.1}) {
    if (most_quads(locally_cut(image, share, 0.0), kFewDilations) > kMostQuads) return true;
  }
  return false;
}

/// One search of one image.
class Search {
 public:
  Search(const cv::Mat& image, cv::Size inner_corners, BoardDetector detector, const std::function<void()>& between)
      : inner_corners_(inner_corners), detector_(detector), between_(between) {
    if (std::min(image.cols, image.rows) < kSmallestSide) return;
    eight_ = without_specks(image);
    crowded_ = is_crowded(eight_);
    step();
  }

  /// The quicker detector alone, if the image is not crowded.
  std::vector<cv::Point2f> run_quickly() {
    if (eight_.empty() || crowded_ || detector_ == BoardDetector::sector_based) return {};
    const bool found = classic(eight_, cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE);
    step();
    const bool whole = found && corners_.size() == static_cast<std::size_t>(inner_corners_.area());
    return whole && least_side() >= kLargeSquare ? corners_ : std::vector<cv::Point2f>{};
  }

  /// `thorough`: the slower detector takes part although the image is crowded.
  std::vector<cv::Point2f> run(bool thorough) {
    if (eight_.empty()) return {};
    bool found = false;
    if (detector_ != BoardDetector::sector_based) {
      found = crowded_ ? in_versions() : classic(eight_, cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE);
      step();
    }
    if (!found && detector_ != BoardDetector::classic && (thorough || !crowded_)) {
      found = cv::findChessboardCornersSB(
          eight_, inner_corners_, corners_,
          crowded_ ? cv::CALIB_CB_NORMALIZE_IMAGE : cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE);
      step();
    }
    const bool whole = found && corners_.size() == static_cast<std::size_t>(inner_corners_.area());
    return whole ? corners_ : std::vector<cv::Point2f>{};
  }

 private:
  void step() const {
    if (between_) between_();
  }

  /// The shortest distance between neighbours in a row or a column.
  double least_side() const {
    double least = std::numeric_limits<double>::infinity();
    const auto width = static_cast<std::size_t>(inner_corners_.width);
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      if ((i + 1) % width != 0) least = std::min(least, cv::norm(corners_[i + 1] - corners_[i]));
      if (i + width < corners_.size()) least = std::min(least, cv::norm(corners_[i + width] - corners_[i]));
    }
    return least;
  }

  bool classic(const cv::Mat& image, int flags) {
    return cv::findChessboardCorners(image, inner_corners_, corners_, flags);
  }

  bool in_versions() {
    for (const cv::Mat& version : versions_of(eight_)) {
      step();
      if (most_quads(version, kMostDilations) > kMostQuads || !classic(version, 0)) continue;
      // As the detector ends in a grey image.
      cv::cornerSubPix(eight_, corners_, {2, 2}, {-1, -1}, {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 15, 0.1});
      return true;
    }
    return false;
  }

  cv::Mat eight_;
  cv::Size inner_corners_;
  BoardDetector detector_;
  const std::function<void()>& between_;
  bool crowded_ = false;
  std::vector<cv::Point2f> corners_;
};

/// Shrunk so that no side is longer than `largest`.
cv::Mat shrunk_to(const cv::Mat& image, int largest) {
  const int longest = std::max(image.cols, image.rows);
  if (longest <= largest) return image;
  const double factor = static_cast<double>(largest) / longest;
  const auto length = [factor](int full) { return std::max(1, static_cast<int>(std::lround(factor * full))); };
  cv::Mat small;
  cv::resize(image, small, {length(image.cols), length(image.rows)}, 0.0, 0.0, cv::INTER_AREA);
  return small;
}

}  // namespace

std::size_t count_quads(const cv::Mat& white) {
  cv::Mat framed = white.clone();  // with a white border a dark spot at the rim has an outline
  cv::rectangle(framed, cv::Rect(0, 0, framed.cols, framed.rows), cv::Scalar(255), 3);
  std::vector<std::vector<cv::Point>> outlines;
  std::vector<cv::Vec4i> relations;  // next, previous, first child, parent
  cv::findContours(framed, outlines, relations, cv::RETR_CCOMP, cv::CHAIN_APPROX_SIMPLE);
  std::size_t quads = 0;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    const bool is_dark_spot = relations[i][3] != -1;
    if (!is_dark_spot || cv::boundingRect(outlines[i]).area() < kSmallestQuadPx) continue;
    std::vector<cv::Point> corners;
    constexpr int kCoarsest = 7;  // px, by which the detector lets a side bend
    for (int bend = 1; bend <= kCoarsest; ++bend) {
      cv::approxPolyDP(outlines[i], corners, bend, true);
      if (corners.size() <= 4) break;
    }
    if (corners.size() == 4 && cv::isContourConvex(corners)) ++quads;
  }
  return quads;
}

std::vector<cv::Point2f> search_board(const cv::Mat& grey, cv::Size inner_corners, BoardDetector detector,
                                      const std::function<void()>& between) {
  const cv::Mat eight = to_8_bits(grey);
  cv::Mat seen = shrunk_to(eight, std::max(kLargestCoarse, std::max(eight.cols, eight.rows) / kMostCoarse));
  std::vector<cv::Point2f> corners;
  if (seen.size() != eight.size()) corners = Search(seen, inner_corners, detector, between).run_quickly();
  if (corners.empty()) {
    seen = shrunk_to(eight, kLargestAtFirst);
    corners = Search(seen, inner_corners, detector, between).run(true);
  }
  if (corners.empty() && seen.size() != eight.size()) {
    seen = shrunk_to(eight, kLargestAgain);
    corners = Search(seen, inner_corners, detector, between).run(false);
  }
  const cv::Size2d factor(static_cast<double>(eight.cols) / seen.cols, static_cast<double>(eight.rows) / seen.rows);
  for (cv::Point2f& corner : corners) {
    corner.x = static_cast<float>((corner.x + 0.5) * factor.width - 0.5);
    corner.y = static_cast<float>((corner.y + 0.5) * factor.height - 0.5);
  }
  return corners;
}

}  // namespace glidelab::core
