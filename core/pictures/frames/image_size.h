/// The size of an image as its file states it, before any of it is decoded: a small file can state an image that takes
/// gigabytes.
///
/// PNG (ISO/IEC 15948, IHDR), JPEG (ITU-T T.81, the frame header SOF), TIFF 6.0 and BigTIFF (the tags of the first
/// directory), BMP, and PBM, PGM and PPM. What is none of these is not an image here, whatever OpenCV would make of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace glidelab::core {

struct ImageSize {
  std::uint64_t width = 0, height = 0;
  std::uint64_t part_width = 0, part_height = 0;  ///< of a TIFF's tiles, which may be larger than the image; else 0
};

/// Nothing for a file that is none of these, or whose header is cut.
std::optional<ImageSize> stated_image_size(const std::filesystem::path& file);

/// InputError (file, key, the size, the limit and the option that raises it) for more than `most_pixels`.
void check_pixels(const std::filesystem::path& file, std::string key, std::uint64_t width, std::uint64_t height,
                  std::size_t most_pixels);

}  // namespace glidelab::core
