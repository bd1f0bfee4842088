/// A zip archive from which single entries are read into memory. Nothing is unpacked to disk, so the names in the
/// archive are only compared and shown.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace glidelab::core {

class ZipArchive {
 public:
  struct Entry {
    std::string name;  ///< as stated by the archive; control characters become blanks
    std::uint64_t index = 0;
  };

  /// InputError if the file is not a zip archive or has more than kMostEntries.
  explicit ZipArchive(const std::filesystem::path& file);
  ~ZipArchive();
  ZipArchive(const ZipArchive&) = delete;
  ZipArchive& operator=(const ZipArchive&) = delete;

  const std::vector<Entry>& entries() const { return entries_; }

  /// The entry's bytes. InputError if it is larger than `most` bytes when unpacked (whatever size the archive states:
  /// no more than that is ever unpacked), encrypted, damaged, or packed in a way that libzip does not know.
  std::string read(const Entry& entry, std::size_t most) const;

  static constexpr std::uint64_t kMostEntries = 100'000;  ///< a project with a folder of images has a few thousand

 private:
  struct Handle;  ///< libzip's
  std::filesystem::path file_;
  std::unique_ptr<Handle> handle_;
  std::vector<Entry> entries_;
};

/// Whether the file begins like a zip archive ("PK\x03\x04", or "PK\x05\x06" for an empty one).
bool is_zip_archive(std::string_view first_bytes);

/// `count` bytes, fewer if the file has fewer or cannot be read.
std::string first_bytes_of(const std::filesystem::path& file, std::size_t count);

}  // namespace glidelab::core
