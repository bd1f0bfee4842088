#include "report/certificate/certificate_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "base/math/angles.h"
#include "report/text/display_text.h"
#include "report/text/why_words.h"

namespace glidelab::report {
namespace {

std::string cause_advice(const std::vector<std::string>& causes) {
  const std::string advice = "Remove the cause from the experiment";
  if (causes.empty()) return advice;
  return advice + fmt::format(", or put it into the model (glidelab analyze --with {})", fmt::join(causes, " --with "));
}

/// Words for everything that twins may lack; a feature without them does not compile.
struct LackWords {
  std::string operator()(const validate::lacking::Inexpressible& of) const {
    return fmt::format("{} ({})", effect_name(of.what), of.why);
  }
  std::string operator()(const validate::lacking::Images& of) const {
    std::string why = of.error;
    std::replace(why.begin(), why.end(), '\n', ' ');
    return fmt::format("images and calibration ({})", why);
  }
  std::string operator()(const validate::lacking::Pattern&) const {
    return "the calibration by a pattern (one folder has a pattern and another a scale: all twins are measured by the "
           "scale, with its error)";
  }
  std::string operator()(const validate::lacking::ClipScatter&) const {
    return "the scatter from clip to clip (errors of filming may explain it)";
  }
  std::string operator()(const validate::lacking::Noise& of) const {
    return fmt::format(
        "noise as in the recording (its positions scatter by {:.3g} m, the twin's by {:.3g} m: something other than "
        "pixel noise is at work)",
        of.recorded_m, of.twin_m);
  }
};

}  // namespace

LimitWords limit_words(const validate::ChangedTwin& changed, const validate::Certificate& certificate) {
  using validate::TwinLimit;
  switch (changed.limit) {
    case TwinLimit::pixel_noise:
      return {"noise", "half the noise of each pixel",
              "Use more light, or a wider aperture: four times the light halves the noise"};
    case TwinLimit::position_noise:
      return {"noise", "half the noise of each position",
              "Lower the noise of the positions: more light, a larger marker, a finer scale or a better tracker"};
    case TwinLimit::marker:
      return {"marker", "a marker of twice the diameter", "Use a larger marker"};
    case TwinLimit::frame_rate:
      return {"frame rate", "twice as many frames a second", "Use a higher frame rate"};
    case TwinLimit::scale:
      return {"scale", "the scale without error",
              "Measure the scale better (a longer ruler, in the plane of motion), or use a pattern"};
    case TwinLimit::calibration:
      return {"calibration", "the camera known without error",
              "Take more calibration images, tilted more and filling the image"};
    case TwinLimit::codec:
      return {"codec", "no compression loss", "Compress less: a higher bit rate or quality, or a lossless codec"};
    case TwinLimit::rounding:
      return {"rounding", "positions with all their digits", "Export more digits"};
    case TwinLimit::cause:
      return {"a cause that the law lacks", "viscous and Coulomb friction alone", cause_advice(changed.causes)};
    case TwinLimit::clip_scatter: {
      constexpr const char* kHow = "the track clean and level, the air still, nothing that touches the glider";
      if (certificate.clips > 1) {
        return {"what differs from clip to clip", "one law for every clip",
                fmt::format("Make the clips alike: {}", kHow)};
      }
      if (certificate.motions > 1) {
        return {"what differs from motion to motion", "one law for every motion",
                fmt::format("Make the motions alike: {}", kHow)};
      }
      return {"what the law leaves unexplained", "the law alone",
              fmt::format("Find what disturbs the motion: {}", kHow)};
    }
    case TwinLimit::few_clips:
      return {"few clips", "every clip recorded twice", "Record a second clip of each kind"};
  }
  return {};
}

std::string clip_words(const validate::Certificate& certificate) {
  std::string text = fmt::format("{} clip{}", certificate.clips, certificate.clips == 1 ? "" : "s");
  if (certificate.motions > certificate.clips) text += fmt::format(" with {} motions", certificate.motions);
  return text;
}

std::string lack_words(const validate::NotInTwins& lack) {
  return std::visit(LackWords{}, lack);
}

std::string unanswered_words(const validate::CertifiedQuantity& quantity) {
  return quantity.why ? why_words(quantity.why) : "none of its clips could be used";
}

std::string all_lacks(const validate::Certificate& certificate) {
  if (certificate.without.empty()) return {};
  std::string lacks;
  for (const validate::NotInTwins& lack : certificate.without) lacks += (lacks.empty() ? "" : "; ") + lack_words(lack);
  return fmt::format("The recording has what its twins lack: {}. The answer holds only if this does not matter.",
                     lacks);
}

std::string all_unanswered(const validate::Certificate& certificate) {
  std::vector<std::pair<std::string, std::vector<std::string>>> by_reason;
  for (const validate::CertifiedQuantity& quantity : certificate.quantities) {
    if (quantity.answered() > 0) continue;
    const std::string why = unanswered_words(quantity);
    auto known = std::ranges::find(by_reason, why, [](const auto& one) { return one.first; });
    if (known == by_reason.end()) known = by_reason.insert(known, {why, {}});
    known->second.push_back(symbol_of(quantity.quantity));
  }
  std::string text;
  for (const auto& [why, names] : by_reason)
    text += fmt::format("{}No twin has a value of {}: {}.", text.empty() ? "" : " ", list_of(names), why);
  return text;
}

std::vector<std::string> setup_names(const validate::Certificate& certificate) {
  std::vector<std::string> names;
  for (const validate::CertifiedSetup& setup : certificate.setups)
    names.push_back(fmt::format("{:.4g} kg, {:.4g}°", setup.mass_kg, setup.incline_rad * base::kDegreesPerRad));
  std::vector<std::string> own = names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::count(names.begin(), names.end(), names[i]) > 1)
      own[i] = fmt::format("{} ({})", names[i], certificate.setups[i].name);
  }
  return own;
}

}  // namespace glidelab::report
