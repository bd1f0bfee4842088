/// What images show of an effect, as data: one struct for each effect that they are searched for.
/// report/diagnosis/words/image_words.h puts it into words.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>

namespace glidelab::diagnose {
namespace image {

/// The marker is smeared as by an exposure.
struct Smear {
  double exposure_s = 0.0, sd_s = 0.0;
  std::optional<double> stated_s;
};

/// It is sheared as by a rolling shutter; a line time of 0 is a global shutter.
struct Shear {
  double line_s = 0.0, sd_s = 0.0, stated_s = 0.0;
};

/// Light along the marker's path.
struct LightAlong {
  double gradient_1_m = 0.0, sd_1_m = 0.0;
  double usual_1_m = 0.0;  ///< in a room
  bool down = false;       ///< the path goes down the image rather than across it
  /// From the outline's centre to the centroid of the marker's light, and how it changes; nothing within the noise.
  struct Pull {
    double size_px = 0.0, change_px = 0.0;
  };
  std::optional<Pull> pull;
};

/// The brightness of the fixed scene.
struct Flicker {
  bool flickers = false;
  double amplitude = 0.0;  ///< relative; if it does not flicker, less than this
  double seen_hz = 0.0;    ///< at the frame rate
  double f_hz = 0.0;       ///< of the light
};

/// The fixed scene in the image.
struct Sway {
  enum class How { shakes, drifts, rests } how = How::rests;
  double size_px = 0.0;    ///< amplitude, or drift within a clip, or bound
  double f_hz = 0.0;       ///< of How::shakes
  double speed_m_s = 0.0;  ///< of How::drifts: the fastest of a clip, along the motion, at the depth of the motion
};

struct Compression {
  std::optional<bool> lossy;  ///< as the file says
  std::string codec;
  double block_steps = 0.0;            ///< at the edges of 8 x 8 blocks over elsewhere, less 1
  std::optional<double> noise_memory;  ///< variance over two frames over that over one, if noise lasts
};

/// Frames that repeat the image before, and gaps between time stamps.
struct FrameTimes {
  std::size_t repeated = 0, missing = 0;
};

}  // namespace image

using AnyImageFact = std::variant<image::Smear, image::Shear, image::LightAlong, image::Flicker, image::Sway,
                                  image::Compression, image::FrameTimes>;

/// What copies, moves and destroys it is compiled once (image_fact.cpp), as of core::Note.
struct ImageFact : AnyImageFact {
  using AnyImageFact::AnyImageFact;
  ImageFact();
  ImageFact(const ImageFact&);
  ImageFact(ImageFact&&) noexcept;
  ImageFact& operator=(const ImageFact&);
  ImageFact& operator=(ImageFact&&) noexcept;
  ~ImageFact();
};

}  // namespace glidelab::diagnose
