
#include <array>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/pictures/frames/read_image.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using tests::TempDir;
namespace fs = std::filesystem;

namespace {

void put_big(std::string& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (24 - 8 * i) & 255U);
}

/// Of a PNG's chunk (ISO/IEC 15948, annex D).
std::uint32_t crc_of(const std::string& bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int k = 0; k < 8; ++k) crc = (crc & 1U) != 0 ? 0xEDB88320U ^ crc >> 1U : crc >> 1U;
  }
  return ~crc;
}

/// A PNG of 2 x 2 pixels that states another size, with the right check sum.
void write_huge_png(const fs::path& file, std::uint32_t width, std::uint32_t height) {
  cv::imwrite(file.string(), cv::Mat(2, 2, CV_8U, cv::Scalar(9)));
  std::string bytes = base::read_file(file);
  put_big(bytes, 16, width);
  put_big(bytes, 20, height);
  put_big(bytes, 29, crc_of(bytes.substr(12, 17)));
  base::write_file(file, bytes);
}

std::string error_of(const fs::path& file, std::size_t most_pixels = core::kMostPixels) {
  try {
    core::read_image(file, most_pixels);
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("the stated size is that of the image that is decoded, for every format that is read") {
  const TempDir dir;
  cv::Mat grey(37, 211, CV_8U), colour(37, 211, CV_8UC3), deep(37, 211, CV_16U), large(1037, 1211, CV_8UC3);
  for (cv::Mat* image : {&grey, &colour, &deep, &large}) cv::randu(*image, 0, 255);
  const std::vector<std::pair<std::string, cv::Mat>> files = {
      {"a.png", grey}, {"b.png", colour}, {"c.png", deep}, {"d.jpg", grey},  {"e.jpg", large}, {"f.tif", grey},
      {"g.tif", deep}, {"h.bmp", colour}, {"i.pgm", deep}, {"j.ppm", large}, {"k.pbm", grey},  {"l.tiff", large}};
  for (const auto& [name, image] : files) {
    INFO(name);
    REQUIRE(cv::imwrite((dir / name).string(), image));
    const auto size = core::stated_image_size(dir / name);
    REQUIRE(size);
    CHECK(size->width == static_cast<std::uint64_t>(image.cols));
    CHECK(size->height == static_cast<std::uint64_t>(image.rows));
    CHECK(core::read_image(dir / name).size() == image.size());
  }
  cv::imwrite((dir / "progressive.jpg").string(), large, {cv::IMWRITE_JPEG_PROGRESSIVE, 1});
  CHECK(core::stated_image_size(dir / "progressive.jpg")->width == 1211);
  base::write_file(dir / "remark.pgm", "P2 # 9999 9999\n# 7\n3\n2 255\n1 2 3 4 5 6\n");
  CHECK(core::stated_image_size(dir / "remark.pgm")->width == 3);
  CHECK(core::stated_image_size(dir / "remark.pgm")->height == 2);
}

TEST_CASE("an image larger than permitted is refused with its size before it is decoded, and the limit can be raised") {
  const TempDir dir;
  write_huge_png(dir / "huge.png", 30'000, 30'000);
  CHECK(error_of(dir / "huge.png") == (dir / "huge.png").string() +
                                          ": found 30000 x 30000 pixels, 900 megapixels, expected at most 100 "
                                          "megapixels (--max-megapixels permits more)");
  write_huge_png(dir / "absurd.png", 0x7FFFFFFF, 0x7FFFFFFF);
  CHECK_THAT(error_of(dir / "absurd.png"), Catch::Contains("at most 100 megapixels"));
  write_huge_png(dir / "small.png", 20, 10);  // its pixels are missing, which only a decoder can see
  CHECK_THAT(error_of(dir / "small.png", 199), Catch::Contains("20 x 10 pixels"));
  CHECK_THAT(error_of(dir / "small.png", 200), !Catch::Contains("20 x 10 pixels"));
  cv::imwrite((dir / "fine.png").string(), cv::Mat(10, 20, CV_8U, cv::Scalar(9)));
  CHECK(error_of(dir / "fine.png", 200) == "");
}

TEST_CASE("a TIFF's tiles count as its image does") {
  // ISO-like: little-endian, one directory of the four tags, each a LONG.
  const TempDir dir;
  std::string bytes("II*\0\x08\0\0\0\x04\0", 10);
  for (const auto& [tag, value] :
       std::vector<std::pair<int, std::uint32_t>>{{256, 8}, {257, 8}, {322, 65'536}, {323, 65'536}}) {
    for (const std::uint32_t word : {static_cast<std::uint32_t>(tag) | 4U << 16U, 1U, value}) {
      for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>(word >> shift & 255U));
    }
  }
  base::write_file(dir / "tiles.tif", bytes + std::string(4, '\0'));
  CHECK_THAT(error_of(dir / "tiles.tif"), Catch::Contains("tile: found 65536 x 65536 pixels"));
}

TEST_CASE("what is no image of these formats is refused, whatever else could read it, and so is a header that is cut") {
  const TempDir dir;
  cv::imwrite((dir / "whole.jpg").string(), cv::Mat(40, 40, CV_8U, cv::Scalar(9)));
  const std::string jpeg = base::read_file(dir / "whole.jpg");
  for (const std::string& text :
       {std::string("NITF02.10 and so on"), std::string("<VRTDataset rasterXSize=\"4\" rasterYSize=\"4\"/>"),
        std::string("GIF89a......"), std::string("\x89PNG\r\n\x1A\n"), jpeg.substr(0, 60), std::string("BM"),
        std::string("II*\0\xFF\xFF\xFF\x7F", 8), std::string("P5 12")}) {
    base::write_file(dir / "file.png", text);
    CHECK_FALSE(core::stated_image_size(dir / "file.png"));
    CHECK_THAT(error_of(dir / "file.png"), Catch::Contains("no image that can be decoded"));
  }
}
