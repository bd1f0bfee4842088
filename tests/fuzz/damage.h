/// Ways to damage a file of a recording: a card pulled too early, a bad sector, a header that lies.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>

namespace glidelab::fuzz {

using Random = std::mt19937_64;

inline std::size_t below(Random& random, std::size_t count) {
  return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}

/// CRC-32 of ISO 3309 as PNG has it (ISO/IEC 15948, annex D), so that an absurd size in a header is not just a bad sum.
inline std::uint32_t png_crc(std::string_view bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (const unsigned char byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

inline void put_big_endian(std::string& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (24 - 8 * i));
}

/// A PNG whose header states another size, with the right check sum.
inline std::string with_png_size(std::string png, std::uint32_t width, std::uint32_t height) {
  if (png.size() < 33) return png;
  put_big_endian(png, 16, width);
  put_big_endian(png, 20, height);
  put_big_endian(png, 29, png_crc(std::string_view(png).substr(12, 17)));
  return png;
}

inline constexpr std::array kDamages = {"cut",   "bits",   "header", "empty", "zeros",    "random", "twice",
                                        "moved", "spread", "value",  "size",  "appended", "tail"};

/// `bytes` with one damage, the kind being one of kDamages; `other` is a file of the same kind and another size.
inline std::string damaged(std::string bytes, std::string_view kind, const std::string& other, Random& random) {
  const std::size_t size = bytes.size();
  if (size < 64) return bytes;
  const auto byte = [&] { return static_cast<char>(below(random, 256)); };
  const std::size_t at = below(random, size), length = std::min(size - at, 1 + below(random, size / 4));
  if (kind == "cut") return bytes.substr(0, at);
  if (kind == "tail") return bytes.substr(at);
  if (kind == "empty") return {};
  if (kind == "bits") {
    for (std::size_t n = 1 + below(random, 32); n > 0; --n)
      bytes[below(random, size)] ^= static_cast<char>(1 << below(random, 8));
  } else if (kind == "header") {
    for (std::size_t n = 1 + below(random, 8); n > 0; --n)
      bytes[below(random, std::min<std::size_t>(size, 600))] = byte();
  } else if (kind == "zeros") {
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), length, '\0');
  } else if (kind == "random") {
    std::generate_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), length, byte);
  } else if (kind == "twice") {
    bytes.insert(at, bytes.substr(at, length));
  } else if (kind == "moved") {
    std::rotate(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.end());
  } else if (kind == "spread") {  // one byte in a few hundred, all over
    for (std::size_t i = at % 400; i < size; i += 1 + below(random, 400)) bytes[i] = byte();
  } else if (kind == "value") {  // a length, a size, a time stamp becomes extreme
    const std::uint32_t extremes[] = {0u, 1u, 0x7fffffffu, 0x80000000u, 0xffffffffu, 0xffffu, 0x10000u, 0x01000000u};
    put_big_endian(bytes, std::min(below(random, std::min<std::size_t>(size, 1200)), size - 4),
                   extremes[below(random, 8)]);
  } else if (kind == "size") {
    const std::uint32_t sizes[] = {0u, 1u, 16u, 65535u, 1000000u, 0x7fffffffu, 0xffffffffu};
    return with_png_size(std::move(bytes), sizes[below(random, 7)], sizes[below(random, 7)]);
  } else if (kind == "appended") {
    bytes += other;
  }
  return bytes;
}

}  // namespace glidelab::fuzz
