#include "report/diagnosis/words/image_words.h"

#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;
using Catch::Matchers::Contains;
namespace image = diagnose::image;

TEST_CASE("whatever images show of an effect has words, with its data in the units that people read") {
  using How = image::Sway::How;
  const std::vector<std::pair<diagnose::ImageFact, std::string>> rows = {
      {image::Smear{0.0041, 0.0002, 0.001}, "smeared as if by an exposure of 4.10 ± 0.20 ms; 1 ms is stated."},
      {image::Smear{0.0041, 0.0002, {}}, "4.10 ± 0.20 ms; none is stated."},
      {image::Shear{30e-6, 2e-6, 0.0}, "30.0 ± 2.0 µs from row to row; 0 µs (a global shutter) is stated."},
      {image::Shear{30e-6, 2e-6, 12e-6}, "from row to row; 12 µs is stated."},
      {image::LightAlong{0.5, 0.02, 0.2, true, {}},
       "by 50.0 ± 2.0 % per metre down the image; 20 % is usual in a room."},
      {image::LightAlong{0.5, 0.02, 0.2, false, {{0.6, 0.2}}},
       "to the right; 20 % is usual in a room. The centroid of the marker's light lies 0.6 px from the centre of its "
       "outline, which is what is fitted; this offset changes by ±0.2 px along the path. Brightness is that of the "
       "image, in codes"},
      {image::Flicker{true, 0.02, 20.0, 100.0}, "by ±2 % at 20 Hz (100 Hz looks like this at this frame rate)."},
      {image::Flicker{true, 0.02, 20.0, 20.0},
       "by ±2 % at 20 Hz. Brightness is that of the image, in codes; with the usual tone curve (sRGB) the light "
       "changes 2.2 times"},
      {image::Flicker{false, 0.001, 20.0, 20.0}, "does not flicker: no wave above 0.1 %"},
      {image::Sway{How::shakes, 0.4, 7.0}, "sways in the image by ±0.4 px at 7 Hz: the camera shakes."},
      {image::Sway{How::drifts, 0.4, 0.0}, "drifts in the image by 0.4 px within a clip: the camera moves."},
      {image::Sway{How::drifts, 0.4, 0.0, 0.0024}, "up to 2.4 mm/s along it: every speed is uncertain by as much"},
      {image::Sway{How::rests, 0.02, 0.0}, "at rest: the fixed scene stays within 0.02 px"},
      {image::Compression{true, "H264", 0.5, {}},
       "The file is compressed with loss (H.264); steps between pixels are 50.0 % larger at the edges of 8 × 8 blocks "
       "than elsewhere."},
      {image::Compression{false, "M8G0", -0.01, {}}, "without loss (MagicYUV)"},
      {image::Compression{false, "FFV1", -0.01, {}}, "without loss (FFV1); steps between pixels are 1.0 % smaller"},
      {image::Compression{{}, "", 3.0, 1.5},
       "The file's compression is not known; steps between pixels are 4 times as large at the edges of 8 × 8 blocks as "
       "elsewhere. Noise persists over frames (changes over two frames are 1.50 times those over one)."},
      {image::FrameTimes{3, 2}, "3 frames repeat the one before, and the time stamps leave room for 2 more."},
  };
  std::set<std::size_t> kinds;
  for (const auto& [what, says] : rows) {
    CHECK_THAT(report::image_words(what), Contains(says));
    kinds.insert(what.index());
  }
  CHECK(kinds.size() == std::variant_size_v<diagnose::AnyImageFact>);
}
