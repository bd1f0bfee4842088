/// A folder of flat fields and dark frames, from which a camera is characterised (docs/reference/characterize.md).
///
///     FOLDER/
///       characterize.toml
///       dark/*.png        two or more frames without light, at the exposure of the flat fields
///       dark-10ms/*.png   optional: the same at other exposures, for the dark signal
///       flat-00/*.png     two or more frames of one even, constant light
///       flat-01/*.png …   other levels of light: at least two in all, better ten or more, up into saturation
///
/// All frames are grey PNG images of 8 or 16 bits and of one size. Names after "dark-" and "flat-" are free.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/experiment/permissions.h"

namespace glidelab::core {

/// Frames that were taken under the same conditions.
struct FrameSet {
  std::string name;                          ///< of its folder
  std::vector<std::filesystem::path> files;  ///< sorted by name; two or more
  std::optional<double> exposure_s;
};

struct FlatFieldFolder {
  std::string name;   ///< of the camera
  int bit_depth = 8;  ///< of the codes in the images, 8 to 16; their largest is 2^bit_depth - 1
  std::optional<double> frame_rate_hz;
  std::optional<double> pixel_pitch_m;
  std::string price_class;
  std::vector<FrameSet> darks;            ///< "dark" first, then the others by name
  std::vector<FrameSet> flats;            ///< by name
  std::size_t most_pixels = kMostPixels;  ///< of one image, as permitted by the user who runs the program

  int largest_code() const { return (1 << bit_depth) - 1; }
};

/// Reads characterize.toml and lists the frames; opens none of them. InputError with everything that is wrong: keys,
/// sets that are missing or hold a single frame, images other than PNG, exposures of sets that do not exist, and
/// dark-* sets without exposures.
FlatFieldFolder read_flat_field_folder(const std::filesystem::path& folder);

}  // namespace glidelab::core
