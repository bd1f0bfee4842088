#include "report/diagnosis/words/image_words.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <variant>

#include "base/text/number_text.h"

namespace glidelab::report {
namespace {

/// "MagicYUV" for the tag M8G0 in a file; a tag that is not known stays as it is.
std::string codec_name(const std::string& tag) {
  struct Codec {
    const char *tag, *name;
  };
  constexpr std::array<Codec, 9> kCodecs = {{{"M8", "MagicYUV"},
                                             {"M0", "MagicYUV"},
                                             {"avc1", "H.264"},
                                             {"H264", "H.264"},
                                             {"h264", "H.264"},
                                             {"hvc1", "H.265"},
                                             {"hev1", "H.265"},
                                             {"MJPG", "MJPEG"},
                                             {"mp4v", "MPEG-4"}}};
  for (const Codec& codec : kCodecs) {
    if (tag.starts_with(codec.tag)) return codec.name;
  }
  return tag;
}

namespace image = diagnose::image;

/// The pixels' codes are compared, and no file tells its tone curve. That of sRGB is a power of 2.2 on average.
constexpr const char* kOfCodes =
    " Brightness is that of the image, in codes; with the usual tone curve (sRGB) the light changes 2.2 times as much.";

/// A sentence for every kind; a kind without one does not compile.
struct ImageSentence {
  std::string operator()(const image::Smear& of) const {
    return fmt::format("The marker is smeared as if by an exposure of {} ms; {}.",
                       base::value_and_sd_text(1e3 * of.exposure_s, 1e3 * of.sd_s),
                       of.stated_s ? fmt::format("{:.3g} ms is stated", 1e3 * *of.stated_s) : "none is stated");
  }
  std::string operator()(const image::Shear& of) const {
    return fmt::format("The marker is sheared as if by {} µs from row to row; {:.3g} µs {}.",
                       base::value_and_sd_text(1e6 * of.line_s, 1e6 * of.sd_s), 1e6 * of.stated_s,
                       of.stated_s == 0.0 ? "(a global shutter) is stated" : "is stated");
  }
  std::string operator()(const image::LightAlong& of) const {
    std::string text =
        fmt::format("The brightness of the marker changes by {} % per metre {}; {:.0f} % is usual in a room.",
                    base::value_and_sd_text(100.0 * of.gradient_1_m, 100.0 * of.sd_1_m),
                    of.down ? "down the image" : "to the right", 100.0 * of.usual_1_m);
    if (of.pull) {
      text += fmt::format(
          " The centroid of the marker's light lies {:.2g} px from the centre of its outline, which is what is "
          "fitted; this offset changes by ±{:.2g} px along the path.",
          of.pull->size_px, of.pull->change_px);
    }
    return text + kOfCodes;
  }
  std::string operator()(const image::Flicker& of) const {
    if (!of.flickers) {
      return fmt::format("The light does not flicker: no wave above {:.2g} % in the fixed scene.",
                         100.0 * of.amplitude);
    }
    return fmt::format(
               "The brightness of the fixed scene varies by ±{:.2g} % at {:.4g} Hz{}.", 100.0 * of.amplitude,
               of.seen_hz,
               of.f_hz != of.seen_hz ? fmt::format(" ({:.0f} Hz looks like this at this frame rate)", of.f_hz) : "") +
           kOfCodes;
  }
  std::string operator()(const image::Sway& of) const {
    switch (of.how) {
      case image::Sway::How::shakes:
        return fmt::format("The fixed scene sways in the image by ±{:.2g} px at {:.3g} Hz: the camera shakes.",
                           of.size_px, of.f_hz);
      case image::Sway::How::drifts:
        return fmt::format("The fixed scene drifts in the image by {:.2g} px within a clip: the camera moves.",
                           of.size_px) +
               (of.speed_m_s > 0.0
                    ? fmt::format(" At the depth of the track this is up to {:.2g} mm/s along it: every speed is "
                                  "uncertain by as much, and the uncertainties of the terminal velocity and of α "
                                  "include it.",
                                  1e3 * of.speed_m_s)
                    : "");
      case image::Sway::How::rests:
        break;
    }
    return fmt::format("The camera is at rest: the fixed scene stays within {:.2g} px in the image.", of.size_px);
  }
  std::string operator()(const image::Compression& of) const {
    const bool times = of.block_steps > 2.0;
    std::string text = fmt::format(
        "{}; steps between pixels are {} at the edges of 8 × 8 blocks {} elsewhere.",
        !of.lossy
            ? "The file's compression is not known"
            : fmt::format("The file is compressed {} loss ({})", *of.lossy ? "with" : "without", codec_name(of.codec)),
        times
            ? fmt::format("{:.2g} times as large", 1.0 + of.block_steps)
            : fmt::format("{:.1f} % {}", 100.0 * std::abs(of.block_steps), of.block_steps < 0.0 ? "smaller" : "larger"),
        times ? "as" : "than");
    if (of.noise_memory) {
      text += fmt::format(" Noise persists over frames (changes over two frames are {:.2f} times those over one).",
                          *of.noise_memory);
    }
    return text;
  }
  std::string operator()(const image::FrameTimes& of) const {
    return fmt::format("{} frames repeat the one before, and the time stamps leave room for {} more.", of.repeated,
                       of.missing);
  }
};

}  // namespace

std::string image_words(const diagnose::ImageFact& fact) {
  return std::visit(ImageSentence{}, fact);
}

}  // namespace glidelab::report
