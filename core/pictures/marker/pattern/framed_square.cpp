#include "core/pictures/marker/pattern/framed_square.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <ranges>
#include <utility>

namespace glidelab::core {
namespace {

constexpr double kSurroundingsRadii = 2.0;  // half the side of what a pixel is compared with
constexpr double kDarker = 7.0;             // codes of 8 bits below the mean of the surroundings
constexpr double kLeastSideRadii = 1.15;    // of a square whose stated size is the side of the paper around it
constexpr double kMostSideRadii = 2.6;      // of one whose stated size is that of its pattern without the frame
constexpr double kSmallestSide_px = 8.0;    // a frame and holes are a few pixels wide
constexpr double kMostUnequalSides = 1.25;  // long side over short one
constexpr double kLeastFilled = 0.9;        // area over that of the rectangle around it; a disc has 0.79
constexpr double kLeastHoles = 0.02;        // of the area
constexpr double kLeastRimContrast = 20.0;  // codes
constexpr int kRim_px = 2;
constexpr std::size_t kWatched = 5;        // frames, from one to the next that is looked at
constexpr std::size_t kFewestWatched = 3;  // frames with a square elsewhere
constexpr std::size_t kFewestSquareFrames = 8;
constexpr std::size_t kFewestSquaresForSpeed = 3;
constexpr std::size_t kMostSquaresMissed = 6;  // frames in a row
constexpr double kFirstSquareGateRadii = 2.5;  // around a square whose speed is not known yet;
constexpr double kSquareGateRadii = 0.75;      // later around the expected place,
constexpr double kSquareGateSteps = 2.2;       // and times its step, for it may bounce

double middle_radius(const cv::Mat& grey, const RadiusAt& radius_at) {
  return radius_at({0.5 * (grey.cols - 1), 0.5 * (grey.rows - 1)});
}

/// How much brighter the pixels just outside an outline are than those just inside.
double rim_contrast(const cv::Mat& grey, const std::vector<cv::Point>& outline) {
  const cv::Rect box = cv::boundingRect(outline);
  const cv::Rect part = cv::Rect(box.x - kRim_px, box.y - kRim_px, box.width + 2 * kRim_px, box.height + 2 * kRim_px) &
                        cv::Rect({}, grey.size());
  cv::Mat filled = cv::Mat::zeros(part.size(), CV_8U);
  cv::drawContours(filled, std::vector<std::vector<cv::Point>>{outline}, 0, cv::Scalar(255), cv::FILLED, cv::LINE_8,
                   cv::noArray(), 0, -part.tl());
  const cv::Mat brush = cv::Mat::ones(2 * kRim_px + 1, 2 * kRim_px + 1, CV_8U);
  cv::Mat larger, smaller;
  cv::dilate(filled, larger, brush);
  cv::erode(filled, smaller, brush);
  return cv::mean(grey(part), larger - filled)[0] - cv::mean(grey(part), filled - smaller)[0];
}

/// One framed square through the frames.
struct SquarePath {
  MarkerPath path;
  cv::Mat look;
  std::size_t missed = 0;

  double gate(double radius_px) const {
    if (path.seen.size() < kFewestSquaresForSpeed) return kFirstSquareGateRadii * radius_px;
    return kSquareGateRadii * radius_px + kSquareGateSteps * cv::norm(path.velocity());
  }
  void push(std::size_t frame, cv::Point2d at, double radius_px) {
    MarkerSeen seen;
    seen.frame = frame;
    seen.fit.centre = at;
    seen.fit.radius_px = seen.expected_px = radius_px;
    path.push(seen);
    missed = 0;
  }
};

/// The pixels around a place; empty at the edge of the image.
cv::Mat look_at(const cv::Mat& grey, cv::Point2d at, double radius_px) {
  const int half = static_cast<int>(std::ceil(radius_px));
  const cv::Rect part(static_cast<int>(std::lround(at.x)) - half, static_cast<int>(std::lround(at.y)) - half,
                      2 * half + 1, 2 * half + 1);
  cv::Mat look;
  if ((part & cv::Rect({}, grey.size())) == part) grey(part).convertTo(look, CV_32F);
  return look;
}

}  // namespace

std::vector<cv::Point2d> framed_squares(const cv::Mat& grey, double radius_px) {
  std::vector<cv::Point2d> centres;
  if (kMostSideRadii * radius_px < kSmallestSide_px) return centres;
  cv::Mat values = grey, dark;
  if (grey.depth() != CV_8U) grey.convertTo(values, CV_8U, 1.0 / 257.0);
  const int around = 2 * static_cast<int>(std::ceil(kSurroundingsRadii * radius_px)) + 1;
  cv::adaptiveThreshold(values, dark, 255.0, cv::ADAPTIVE_THRESH_MEAN_C, cv::THRESH_BINARY_INV, around, kDarker);
  std::vector<std::vector<cv::Point>> outlines;
  std::vector<cv::Vec4i> tree;  // next, previous, first hole, outline around a hole
  cv::findContours(dark, outlines, tree, cv::RETR_CCOMP, cv::CHAIN_APPROX_NONE);
  const double least = std::max(kSmallestSide_px, kLeastSideRadii * radius_px), most = kMostSideRadii * radius_px;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    if (tree[i][3] >= 0 || static_cast<double>(outlines[i].size()) < 2.0 * least) continue;
    const cv::RotatedRect box = cv::minAreaRect(outlines[i]);  // through the centres of the pixels at the rim
    const double width = box.size.width + 1.0, height = box.size.height + 1.0;
    if (std::min(width, height) < least || std::max(width, height) > most) continue;
    if (std::max(width, height) > kMostUnequalSides * std::min(width, height)) continue;
    const double area = cv::contourArea(outlines[i]);
    if (area < kLeastFilled * static_cast<double>(box.size.area())) continue;
    double holes = 0.0;
    for (int hole = tree[i][2]; hole >= 0; hole = tree[static_cast<std::size_t>(hole)][0])
      holes += cv::contourArea(outlines[static_cast<std::size_t>(hole)]);
    if (holes < kLeastHoles * area || rim_contrast(values, outlines[i]) < kLeastRimContrast) continue;
    const cv::Moments moments = cv::moments(outlines[i]);
    centres.emplace_back(moments.m10 / moments.m00, moments.m01 / moments.m00);
  }
  return centres;
}

void SquareWatch::add(const cv::Mat& grey, std::size_t frame, const RadiusAt& radius_at) {
  if (frame % kWatched != 0) return;
  radius_px_ = middle_radius(grey, radius_at);
  places_.push_back(framed_squares(grey, radius_px_));
}

bool SquareWatch::any_moves() const {
  const double apart = least_travel(radius_px_);
  const auto is_there = [&](const std::vector<cv::Point2d>& places, cv::Point2d at) {
    return std::ranges::any_of(places, [&](cv::Point2d place) { return cv::norm(place - at) < apart; });
  };
  // What rests is at its place in most frames.
  const auto rests = [&](cv::Point2d at) {
    return 2 * std::ranges::count_if(places_, [&](const auto& places) { return is_there(places, at); }) >
           std::ssize(places_);
  };
  const auto elsewhere = std::ranges::count_if(places_, [&](const std::vector<cv::Point2d>& places) {
    return std::ranges::any_of(places, [&](cv::Point2d at) { return !rests(at); });
  });
  return static_cast<std::size_t>(elsewhere) >= kFewestWatched;
}

std::vector<MovingPattern> moving_squares(const ClipAgain& clip, const RadiusAt& radius_at) {
  std::vector<SquarePath> followed, ended;
  const auto source = clip.open();
  while (const auto frame = source->next()) {
    std::vector<cv::Point2d> squares = framed_squares(frame->grey, middle_radius(frame->grey, radius_at));
    for (SquarePath& one : followed) {
      ++one.missed;
      const cv::Point2d expected = one.path.predict(frame->index);
      const auto near = std::ranges::min_element(squares, {}, [&](cv::Point2d at) { return cv::norm(at - expected); });
      if (near == squares.end() || cv::norm(*near - expected) > one.gate(radius_at(expected))) continue;
      one.push(frame->index, *near, radius_at(*near));
      squares.erase(near);
    }
    for (const cv::Point2d at : squares) {
      SquarePath one;
      one.look = look_at(frame->grey, at, radius_at(at));
      if (one.look.empty()) continue;
      one.push(frame->index, at, radius_at(at));
      followed.push_back(std::move(one));
    }
    const auto lost =
        std::ranges::stable_partition(followed, [](const SquarePath& one) { return one.missed <= kMostSquaresMissed; });
    std::ranges::move(lost, std::back_inserter(ended));
    followed.erase(lost.begin(), lost.end());
  }
  std::ranges::move(followed, std::back_inserter(ended));
  std::erase_if(ended, [](const SquarePath& one) {
    return one.path.seen.size() < kFewestSquareFrames || steady_travel(one.path) < least_travel(one.path.radius_px);
  });
  std::ranges::stable_sort(ended, std::ranges::greater{}, [](const SquarePath& one) { return one.path.seen.size(); });
  std::vector<MovingPattern> patterns;
  for (const SquarePath& one : ended) {
    MovingPattern& pattern = patterns.emplace_back();
    pattern.look = one.look;
    for (const MarkerSeen& seen : one.path.seen) {
      pattern.rough.sightings.push_back({seen.frame, seen.fit.centre.x, seen.fit.centre.y, 0.5, seen.fit.radius_px});
      pattern.rough.fits.push_back(seen.fit);
    }
  }
  return patterns;
}

}  // namespace glidelab::core
