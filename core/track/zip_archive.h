/// A zip archive, of which single entries are read into memory. Nothing is unpacked to the disk, so that the names in
/// the archive are only compared and shown.
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
    std::string name;  ///< as the archive states it; control characters are blanks
    std::uint64_t index = 0;
  };

  /// InputError where the file is no zip archive, or has more than kMostEntries.
  explicit ZipArchive(const std::filesystem::path& file);
  ~ZipArchive();
  ZipArchive(const ZipArchive&) = delete;
  ZipArchive& operator=(const ZipArchive&) = delete;

  const std::vector<Entry>& entries() const { return entries_; }

  /// The entry's bytes. InputError where it is larger than `most` bytes once it is unpacked (whatever size the archive
  /// states: no more than that is ever unpacked), encrypted, damaged, or packed in a way that libzip does not know.
  std::string read(const Entry& entry, std::size_t most) const;

  static constexpr std::uint64_t kMostEntries = 100'000;  ///< a project with a folder of images has some thousands

 private:
  struct Handle;  ///< libzip's
  std::filesystem::path file_;
  std::unique_ptr<Handle> handle_;
  std::vector<Entry> entries_;
};

/// Whether the file begins as a zip archive does ("PK\x03\x04", or "PK\x05\x06" of an empty one).
bool is_zip_archive(std::string_view first_bytes);

}  // namespace glidelab::core
