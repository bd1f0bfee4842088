/// A workbook of Excel. The input is the text of its parts, each after a line "@@ name"; they are put in a zip archive,
/// so that changes reach the XML. An input without such a line is the archive itself.
#include <zip.h>

#include "core/track/bare_track.h"
#include "core/track/workbook.h"
#include "tests/fuzz/fuzz_target.h"

using namespace glidelab;

namespace {

constexpr std::string_view kPart = "@@ ";

/// The parts of an input in an archive. False if a name is none that an archive takes.
bool write_parts(const std::filesystem::path& file, std::string_view input) {
  std::filesystem::remove(file);
  zip_t* const archive = zip_open(file.c_str(), ZIP_CREATE, nullptr);
  if (archive == nullptr) std::abort();
  bool taken = true;
  while (taken && input.substr(0, kPart.size()) == kPart) {
    const std::size_t end_of_name = std::min(input.find('\n'), input.size());
    const std::string name(input.substr(kPart.size(), end_of_name - kPart.size()));
    input.remove_prefix(std::min(end_of_name + 1, input.size()));
    const std::size_t next = input.find("\n@@ ");
    const std::string_view part = input.substr(0, next);
    // libzip reads the bytes when the archive is closed; they live as long as the input.
    zip_source_t* const source = zip_source_buffer(archive, part.data(), part.size(), 0);
    taken = source != nullptr && zip_file_add(archive, name.c_str(), source, ZIP_FL_OVERWRITE) >= 0;
    if (!taken) zip_source_free(source);
    input.remove_prefix(next == std::string_view::npos ? input.size() : next + 1);
  }
  if (!taken || zip_close(archive) != 0) {
    zip_discard(archive);
    return false;
  }
  return std::filesystem::exists(file);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  std::filesystem::path file = folder.path() / "made.xlsx";
  const std::string_view input = fuzz::text_of(data, size);
  if (input.substr(0, kPart.size()) != kPart) {
    file = folder.with("made.xlsx", data, size);
  } else if (!write_parts(file, input)) {
    return 0;
  }
  return fuzz::read_or_refuse([&] {
    if (core::is_spreadsheet(file)) core::read_sheet(file);
    core::read_track(file, {}, "");
  });
}
