#include "core/track/container/zip_archive.h"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "base/errors.h"

namespace glidelab::core {
namespace {

struct CloseEntry {
  void operator()(zip_file_t* entry) const { zip_fclose(entry); }
};

std::string text_of_open_error(int code) {
  zip_error_t error;
  zip_error_init_with_code(&error, code);
  std::string text = zip_error_strerror(&error);
  zip_error_fini(&error);
  return text;
}

std::string without_control_characters(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text;
}

}  // namespace

struct ZipArchive::Handle {
  explicit Handle(zip_t* opened) : zip(opened) {}
  ~Handle() { zip_discard(zip); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  zip_t* zip;
};

ZipArchive::ZipArchive(const std::filesystem::path& file) : file_(file) {
  int code = 0;
  zip_t* const opened = zip_open(file.c_str(), ZIP_RDONLY, &code);
  if (opened == nullptr) {
    throw base::InputError(base::Issue{
        file.string(), 0, "", "a zip archive that cannot be read: " + text_of_open_error(code), "a complete archive"});
  }
  handle_ = std::make_unique<Handle>(opened);
  const auto count = static_cast<std::uint64_t>(zip_get_num_entries(opened, 0));
  if (count > kMostEntries) {
    throw base::InputError(base::Issue{file.string(), 0, "", fmt::format("an archive of {} files", count),
                                       fmt::format("at most {}", kMostEntries)});
  }
  for (std::uint64_t index = 0; index < count; ++index) {
    const char* const name = zip_get_name(opened, index, 0);
    if (name != nullptr) entries_.push_back({without_control_characters(name), index});
  }
}

ZipArchive::~ZipArchive() = default;

std::string ZipArchive::read(const Entry& entry, std::size_t most) const {
  const auto refuse = [&](std::string found, std::string expected) {
    throw base::InputError(base::Issue{file_.string(), 0, entry.name, std::move(found), std::move(expected)});
  };
  const std::unique_ptr<zip_file_t, CloseEntry> opened(zip_fopen_index(handle_->zip, entry.index, 0));
  if (!opened) refuse(zip_strerror(handle_->zip), "a file that can be unpacked");
  std::string bytes;
  std::array<char, 1 << 16> part;
  for (;;) {
    const zip_int64_t got = zip_fread(opened.get(), part.data(), part.size());
    if (got < 0) refuse(zip_file_strerror(opened.get()), "a file that can be unpacked");
    if (got == 0) return bytes;
    if (static_cast<std::size_t>(got) > most - bytes.size()) {
      refuse(fmt::format("more than {} bytes", most), "no more than that");
    }
    bytes.append(part.data(), static_cast<std::size_t>(got));
  }
}

bool is_zip_archive(std::string_view first_bytes) {
  return first_bytes.starts_with("PK\x03\x04") || first_bytes.starts_with("PK\x05\x06");
}

std::string first_bytes_of(const std::filesystem::path& file, std::size_t count) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(count, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

}  // namespace glidelab::core
