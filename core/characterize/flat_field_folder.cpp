#include "core/characterize/flat_field_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/errors.h"
#include "base/toml/strict_toml.h"
#include "core/experiment/file_names.h"

namespace glidelab::core {
namespace fs = std::filesystem;

namespace {

/// Folders below `folder`, in natural order of their numbers.
std::vector<std::string> folder_names(const fs::path& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory()) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end(), natural_less);
  return names;
}

/// The frames of one set. Errors go into `issues`, so that the user sees all of them at once.
class SetReader {
 public:
  explicit SetReader(fs::path folder) : folder_(std::move(folder)) {}

  FrameSet read(const std::string& name) {
    static const std::set<std::string> kOtherFormats{".jpg",  ".jpeg", ".tif", ".tiff", ".pgm", ".bmp",
                                                     ".webp", ".mp4",  ".mov", ".avi",  ".mkv"};
    FrameSet set{name, {}, std::nullopt};
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / name)) {
      const std::string ending = lower_extension(entry.path());
      if (entry.path().filename().string().starts_with('.') || !entry.is_regular_file()) continue;
      if (ending == ".png") set.files.push_back(entry.path());
      if (kOtherFormats.contains(ending)) reject(entry.path(), "a file " + ending, "grey PNG frames only");
    }
    std::sort(set.files.begin(), set.files.end(),
              [](const fs::path& a, const fs::path& b) { return natural_less(a.native(), b.native()); });
    if (set.files.size() < 2) {
      reject(folder_ / name, set.files.empty() ? "no PNG frame" : "a single PNG frame",
             "two or more frames under the same light (their differences are the noise)");
    }
    return set;
  }

  void reject(const fs::path& file, std::string found, std::string expected) {
    issues.push_back({file.string(), 0, "", std::move(found), std::move(expected)});
  }

  std::vector<base::Issue> issues;

 private:
  fs::path folder_;
};

void read_sets(FlatFieldFolder& result, const fs::path& folder) {
  SetReader reader(folder);
  const std::vector<std::string> names = folder_names(folder);
  if (std::find(names.begin(), names.end(), "dark") == names.end()) {
    reader.reject(folder / "dark", "no such folder", "dark frames: lens covered, same exposure as the flat fields");
  } else {
    result.darks.push_back(reader.read("dark"));
  }
  for (const std::string& name : names) {
    if (name.starts_with("dark-")) {
      result.darks.push_back(reader.read(name));
    } else if (name.starts_with("flat-")) {
      result.flats.push_back(reader.read(name));
    } else if ((name.starts_with("dark") && name != "dark") || name.starts_with("flat")) {
      reader.reject(folder / name, "a folder of this name", "dark, dark-… or flat-…");
    }
  }
  if (result.flats.size() < 2) {
    reader.reject(folder, fmt::format("{} folder{} flat-…", result.flats.size(), result.flats.size() == 1 ? "" : "s"),
                  "flat fields of at least two levels of light, preferably ten or more");
  }
  if (!reader.issues.empty()) throw base::InputError(std::move(reader.issues));
}

/// [exposures_s] names sets; sets that it does not name have the exposure_s of the whole folder.
void read_exposures(FlatFieldFolder& result, const base::TomlTable& root) {
  const std::optional<double> common = root.maybe_number("exposure_s", base::above(0.0));
  const std::optional<base::TomlTable> table = root.maybe_table("exposures_s");
  for (std::vector<FrameSet>* sets : {&result.darks, &result.flats}) {
    for (FrameSet& set : *sets) {
      if (table) set.exposure_s = table->maybe_number(set.name, base::above(0.0));
      if (!set.exposure_s) set.exposure_s = common;
    }
  }
  if (result.darks.size() == 1) return;
  for (const FrameSet& dark : result.darks) {
    if (dark.exposure_s) continue;
    root.reject("exposures_s", fmt::format("no exposure of {}", dark.name),
                "the exposure of every dark set if there are several");
  }
}

}  // namespace

FlatFieldFolder read_flat_field_folder(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw base::InputError(base::Issue{folder.string(), 0, "", "no folder", "a folder with characterize.toml"});
  }
  const base::TomlFile file = base::TomlFile::load(folder / "characterize.toml");
  const base::TomlTable root = file.root();
  FlatFieldFolder result;
  root.integer("format", 1, 1);
  result.name = root.text("name");
  result.bit_depth = static_cast<int>(root.integer("bit_depth", 8, 16));
  result.frame_rate_hz = root.maybe_number("frame_rate_hz", base::above(0.0));
  result.pixel_pitch_m = root.maybe_number("pixel_pitch_m", base::between_open(0.0, 1e-3));
  result.price_class = root.text_or("price_class", "");
  root.ignore("extra");
  read_sets(result, folder);
  read_exposures(result, root);
  file.finish();
  return result;
}

}  // namespace glidelab::core
