#include "core/characterize/flat_field_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "core/pictures/frames/read_image.h"

namespace glidelab::core {
namespace fs = std::filesystem;

namespace {

// Where this part of the pixels has another code than the most frequent one, many pixels lie near a boundary between
// two codes, and any noise at all makes two frames differ.
constexpr double kSpreadThatShowsNoise = 0.1;

[[noreturn]] void fail(const fs::path& file, std::string found, std::string expected) {
  throw base::InputError(base::Issue{file.string(), 0, "", std::move(found), std::move(expected)});
}

std::string bits(int depth) {
  return depth == CV_8U ? "8 bits" : "16 bits";
}

/// Grey codes; a colour file counts as grey where its three channels are equal.
cv::Mat read_codes(const fs::path& file) {
  const cv::Mat image = read_image(file);
  if (image.channels() == 1) return image;
  std::vector<cv::Mat> channels;
  cv::split(image, channels);
  if (cv::norm(channels[0], channels[1], cv::NORM_INF) > 0.0 ||
      cv::norm(channels[0], channels[2], cv::NORM_INF) > 0.0) {
    fail(file, "an image with colours", "a grey image: raw codes (a mosaic is fine), or one channel of them");
  }
  return channels[0];
}

/// Part of the pixels that do not have the most frequent code.
double spread(const cv::Mat& codes) {
  cv::Mat wide;
  codes.convertTo(wide, CV_16U);
  std::vector<std::size_t> count(std::size_t{1} << 16, 0);
  for (const std::uint16_t code : cv::Mat_<std::uint16_t>(wide)) ++count[code];
  const auto most = static_cast<double>(*std::max_element(count.begin(), count.end()));
  return 1.0 - most / static_cast<double>(wide.total());
}

}  // namespace

FrameForm form_of(const fs::path& file) {
  const cv::Mat codes = read_codes(file);
  if (codes.cols < kSmallestFlatFieldPx || codes.rows < kSmallestFlatFieldPx) {
    fail(file, fmt::format("{} x {} pixels", codes.cols, codes.rows),
         fmt::format("at least {0} x {0} pixels", kSmallestFlatFieldPx));
  }
  return {codes.size(), codes.depth(), file.string()};
}

cv::Mat read_flat_field_frame(const fs::path& file, const FrameForm& form, int largest_code) {
  const cv::Mat codes = read_codes(file);
  if (codes.size() != form.size) {
    fail(file, fmt::format("{} x {} pixels", codes.cols, codes.rows),
         fmt::format("{} x {} pixels, as {}", form.size.width, form.size.height, form.named));
  }
  if (codes.depth() != form.depth)
    fail(file, bits(codes.depth()), fmt::format("{}, as {}", bits(form.depth), form.named));
  double largest = 0.0;
  cv::minMaxLoc(codes, nullptr, &largest);
  if (largest > largest_code) {
    fail(file, fmt::format("a code of {}", largest),
         fmt::format("codes up to {}, by bit_depth in characterize.toml (are the bits shifted to the top of 16? divide "
                     "the codes, or give bit_depth = 16)",
                     largest_code));
  }
  return codes;
}

void reject_copy(const fs::path& file, const cv::Mat& frame, const fs::path& last_file, const cv::Mat& last) {
  if (cv::norm(frame, last, cv::NORM_INF) > 0.0 || spread(frame) <= kSpreadThatShowsNoise) return;
  fail(file, "the same image as " + last_file.filename().string(), "another frame, with noise of its own");
}

}  // namespace glidelab::core
