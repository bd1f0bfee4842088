#include "core/pictures/frames/read_image.h"

#include <fmt/format.h>
#include <stdlib.h>
#include <algorithm>
#include <fstream>
#include <limits>
#include <mutex>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/errors.h"
#include "base/text/number_text.h"

namespace glidelab::core {

namespace fs = std::filesystem;

void silence_opencv() {
  static std::once_flag once;
  std::call_once(once, [] {
    ::setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);  // AV_LOG_QUIET; a user's own setting stays
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  });
}

cv::Mat read_image(const fs::path& path, std::size_t most_pixels) {
  silence_opencv();
  const auto fail = [&](const std::string& found) {
    throw base::InputError(base::Issue{path.string(), 0, "", found, "an image (PNG, JPEG, TIFF, BMP, PGM)"});
  };
  std::error_code error;
  if (!fs::is_regular_file(path, error)) fail("no file");
  if (fs::file_size(path, error) == 0) fail("an empty file");
  const auto size = stated_image_size(path);
  if (!size) fail("no image that can be decoded");
  check_pixels(path, "", size->width, size->height, most_pixels);
  check_pixels(path, "tile", size->part_width, size->part_height, most_pixels);
  cv::Mat image;
  try {
    image = cv::imread(path.string(), cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH);
  } catch (const cv::Exception& exception) {
    fail("an image that cannot be decoded (" + std::string(exception.err) + ")");
  }
  if (image.empty()) fail("no image that can be decoded");
  if (image.depth() != CV_8U && image.depth() != CV_16U) fail("an image of neither 8 nor 16 bits");
  return image;
}

cv::Mat to_grey(const cv::Mat& image) {
  if (image.channels() == 1) return image;
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

cv::Mat read_grey_image(const fs::path& path, std::size_t most_pixels) {
  return to_grey(read_image(path, most_pixels));
}

namespace fs = std::filesystem;

namespace {

using std::uint64_t;

enum class ByteOrder { little, big };

/// The bytes of a file, by their offsets; reads beyond its end give nothing.
class Bytes {
 public:
  explicit Bytes(const fs::path& file) : in_(file, std::ios::binary) {}

  std::optional<uint64_t> number(uint64_t place, int bytes, ByteOrder order) {
    const std::string raw = text(place, bytes);
    if (raw.size() != static_cast<std::size_t>(bytes)) return std::nullopt;
    uint64_t value = 0;
    for (int i = 0; i < bytes; ++i) {
      const char next = raw[static_cast<std::size_t>(order == ByteOrder::big ? i : bytes - 1 - i)];
      value = value << 8U | static_cast<unsigned char>(next);
    }
    return value;
  }

  /// At most `count` bytes.
  std::string text(uint64_t place, int count) {
    if (place > static_cast<uint64_t>(std::numeric_limits<std::int64_t>::max())) return {};
    in_.clear();
    in_.seekg(static_cast<std::streamoff>(place));
    std::string raw(static_cast<std::size_t>(count), '\0');
    in_.read(raw.data(), count);
    raw.resize(static_cast<std::size_t>(std::max<std::streamsize>(in_.gcount(), 0)));
    return raw;
  }

 private:
  std::ifstream in_;
};

uint64_t product(uint64_t a, uint64_t b) {
  constexpr uint64_t kLargest = std::numeric_limits<uint64_t>::max();
  return b != 0 && a > kLargest / b ? kLargest : a * b;
}

std::optional<ImageSize> size_of(std::optional<uint64_t> width, std::optional<uint64_t> height) {
  if (!width || !height) return std::nullopt;
  return ImageSize{*width, *height};
}

std::optional<ImageSize> png_size(Bytes& bytes) {
  if (bytes.text(12, 4) != "IHDR") return std::nullopt;
  return size_of(bytes.number(16, 4, ByteOrder::big), bytes.number(20, 4, ByteOrder::big));
}

std::optional<ImageSize> jpeg_size(Bytes& bytes) {
  constexpr uint64_t kStart = 0xD8, kEnd = 0xD9, kScan = 0xDA, kTemporary = 0x01, kFirstRestart = 0xD0;
  constexpr int kMostSkipped = 100'000;  // bytes that are no segment, and segments
  constexpr uint64_t kFirstFrame = 0xC0, kLastFrame = 0xCF, kHuffman = 0xC4, kExtension = 0xC8, kArithmetic = 0xCC;
  uint64_t place = 2;
  for (int skipped = 0; skipped < kMostSkipped;) {
    const auto mark = bytes.number(place, 1, ByteOrder::big);
    if (!mark) return std::nullopt;
    if (*mark != 0xFF) {  // a decoder skips to the next marker
      ++place;
      ++skipped;
      continue;
    }
    const auto marker = bytes.number(++place, 1, ByteOrder::big);
    if (!marker || *marker == kEnd || *marker == kScan) return std::nullopt;
    ++skipped;
    if (*marker == 0xFF) continue;  // a fill byte
    ++place;
    if (*marker == 0 || *marker == kTemporary || (*marker >= kFirstRestart && *marker <= kStart)) continue;
    if (*marker >= kFirstFrame && *marker <= kLastFrame && *marker != kHuffman && *marker != kExtension &&
        *marker != kArithmetic) {
      return size_of(bytes.number(place + 5, 2, ByteOrder::big), bytes.number(place + 3, 2, ByteOrder::big));
    }
    const auto length = bytes.number(place, 2, ByteOrder::big);
    if (!length || *length < 2) return std::nullopt;
    place += *length;
  }
  return std::nullopt;
}

std::optional<ImageSize> tiff_size(Bytes& bytes) {
  const ByteOrder order = bytes.text(0, 1) == "I" ? ByteOrder::little : ByteOrder::big;
  const bool large = bytes.number(2, 2, order) == 43;  // BigTIFF
  const int wide = large ? 8 : 4;
  const auto directory = bytes.number(large ? 8 : 4, wide, order);
  if (!directory || *directory > static_cast<uint64_t>(std::numeric_limits<std::int64_t>::max()) / 2) {
    return std::nullopt;
  }
  const auto entries = bytes.number(*directory, large ? 8 : 2, order);
  if (!entries) return std::nullopt;
  constexpr uint64_t kWidth = 256, kHeight = 257, kTileWidth = 322, kTileHeight = 323, kMostEntries = 65'535;
  if (*entries > kMostEntries) return std::nullopt;
  uint64_t width = 0, height = 0, tile_width = 0, tile_height = 0;
  for (uint64_t i = 0; i < *entries; ++i) {
    const uint64_t at = *directory + (large ? 8 + 20 * i : 2 + 12 * i);
    const auto tag = bytes.number(at, 2, order), type = bytes.number(at + 2, 2, order);
    if (!tag || !type) return std::nullopt;
    uint64_t* const wanted = *tag == kWidth        ? &width
                             : *tag == kHeight     ? &height
                             : *tag == kTileWidth  ? &tile_width
                             : *tag == kTileHeight ? &tile_height
                                                   : nullptr;
    if (wanted == nullptr) continue;
    const int length = *type == 1 ? 1 : *type == 3 ? 2 : *type == 4 ? 4 : *type == 16 && large ? 8 : 0;
    if (length == 0 || bytes.number(at + 4, wide, order) != 1) return std::nullopt;
    const auto value = bytes.number(at + (large ? 12 : 8), length, order);
    if (!value) return std::nullopt;
    *wanted = std::max(*wanted, *value);  // if a tag occurs twice, readers differ in which one they use
  }
  if (width == 0 || height == 0) return std::nullopt;
  return ImageSize{width, height, tile_width, tile_height};
}

std::optional<ImageSize> bmp_size(Bytes& bytes) {
  const auto header = bytes.number(14, 4, ByteOrder::little);
  if (!header) return std::nullopt;
  if (*header == 12) {
    return size_of(bytes.number(18, 2, ByteOrder::little), bytes.number(20, 2, ByteOrder::little));
  }
  const auto width = bytes.number(18, 4, ByteOrder::little);
  auto height = bytes.number(22, 4, ByteOrder::little);
  constexpr uint64_t kNegative = uint64_t{1} << 31U;  // rows from the top
  if (height && *height >= kNegative) height = 2 * kNegative - *height;
  return size_of(width, height);
}

/// PBM, PGM, PPM: the first two numbers after the letters; comments run from # to the end of the line.
std::optional<ImageSize> pnm_size(Bytes& bytes) {
  constexpr int kChunk = 4096;
  constexpr uint64_t kLongest = 1 << 20;  // bytes of comments
  std::vector<uint64_t> numbers;
  bool comment = false, inside = false;
  for (uint64_t place = 2; place < kLongest; place += kChunk) {
    const std::string chunk = bytes.text(place, kChunk);
    if (chunk.empty()) return std::nullopt;
    for (const char c : chunk) {
      if (comment) {
        comment = c != '\n' && c != '\r';
        continue;
      }
      if (base::is_digit(c)) {
        if (!inside) numbers.push_back(0);
        numbers.back() = std::min<uint64_t>(10 * numbers.back() + static_cast<uint64_t>(c - '0'), UINT32_MAX);
        inside = true;
        continue;
      }
      if (inside && numbers.size() == 2) return size_of(numbers[0], numbers[1]);
      inside = false;
      comment = c == '#';
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<ImageSize> stated_image_size(const fs::path& file) {
  Bytes bytes(file);
  using namespace std::string_view_literals;
  const std::string head = bytes.text(0, 8);
  const auto begins = [&](std::string_view magic) { return head.starts_with(magic); };
  if (begins("\x89PNG\r\n\x1A\n"sv)) return png_size(bytes);
  if (begins("\xFF\xD8\xFF"sv)) return jpeg_size(bytes);
  if (begins("II*\0"sv) || begins("MM\0*"sv) || begins("II+\0"sv) || begins("MM\0+"sv)) return tiff_size(bytes);
  if (begins("BM"sv)) return bmp_size(bytes);
  if (head.size() > 2 && head[0] == 'P' && head[1] >= '1' && head[1] <= '6') return pnm_size(bytes);
  return std::nullopt;
}

void check_pixels(const fs::path& file, std::string key, uint64_t width, uint64_t height, std::size_t most_pixels) {
  if (product(width, height) <= most_pixels) return;
  const double megapixels = 1e-6 * static_cast<double>(width) * static_cast<double>(height);
  throw base::InputError(base::Issue{file.string(), 0, std::move(key),
                                     fmt::format("{} x {} pixels, {:.4g} megapixels", width, height, megapixels),
                                     fmt::format("at most {:.4g} megapixels (--max-megapixels permits more)",
                                                 1e-6 * static_cast<double>(most_pixels))});
}

}  // namespace glidelab::core
