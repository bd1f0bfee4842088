#include "report/certificate/certificate_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/math/angles.h"
#include "base/text/number_text.h"
#include "report/text/display_text.h"
#include "report/text/why_words.h"

namespace glidelab::report {
namespace {

std::string cause_advice(const validate::ChangedTwin& changed) {
  const bool several = changed.causes.size() > 1, worse = std::ranges::any_of(changed.quantities, makes_worse);
  const std::string them = several ? "these causes" : "the cause";
  if (changed.causes.empty()) return "Remove the cause from the experiment";
  const std::string command = fmt::format("(glidelab analyze --with {})", fmt::join(changed.causes, " --with "));
  if (worse) return fmt::format("Put {} into the model {}", them, command);
  return fmt::format("Remove {} from the experiment, or put {} into the model {}", them, several ? "them" : "it",
                     command);
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

std::string micrometres(double length_m) {
  return base::number_text(length_m * 1e6, 3) + " µm";
}

}  // namespace

std::string whole_percent(double share) {
  return fmt::format("{:.0f}", std::round(100.0 * share) + 0.0);  // + 0.0: no "-0"
}

std::string percent_text(double share, double low, double high) {
  return fmt::format("{} % ({} to {} %)", whole_percent(share), whole_percent(low), whole_percent(high));
}

std::string fall_text(const validate::RunFall& fall) {
  if (fall.value < -1.0) return rise_text(fall);
  constexpr double kNearEnd = 0.99, kMostTold = 0.999;  // no error disappears: none is 100 % smaller
  if (fall.high <= kNearEnd) return percent_text(fall.value, fall.low, fall.high);
  if (fall.low > kMostTold) return "over 99.9 %";
  const auto told = [&](double share) { return 100.0 * std::min(share, kMostTold); };
  return fmt::format("{:.1f} % ({:.1f} to {:.1f} %)", told(fall.value), told(fall.low), told(fall.high));
}

std::string rise_text(const validate::RunFall& fall) {
  if (fall.value >= -1.0) return percent_text(-fall.value, -fall.high, -fall.low) + " larger";
  return fmt::format("{} times larger ({} to {})", base::number_text(1.0 - fall.value, 2),
                     base::number_text(1.0 - fall.high, 2), base::number_text(1.0 - fall.low, 2));
}

bool makes_worse(const validate::QuantityFall& one) {
  constexpr double kWorthTelling = 0.1;
  return one.fall.high < 0.0 && one.fall.value < -kWorthTelling;
}

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
      return {changed.causes.size() > 1 ? "causes that the law lacks" : "a cause that the law lacks",
              "viscous and Coulomb friction alone", cause_advice(changed)};
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

std::string twin_words(const validate::Certificate& certificate) {
  std::string text =
      fmt::format("{} twins of this recording ({}), {}, were analysed with the {}. They repeat the fitted motions{}",
                  certificate.runs, clip_words(certificate),
                  certificate.filmed ? "filmed by its camera and tracked, each with its own calibration"
                                     : "simulated at its frame times with its noise and rounding",
                  estimator_name(certificate.estimator),
                  certificate.motions > certificate.clips ? ", each as a clip of its own" : "");
  std::vector<std::string> names;
  for (const std::string& cause : certificate.causes) names.push_back(effect_name(cause));
  const std::string causes = list_of(names);
  text += causes.empty() ? ", with no cause besides the nominal law." : fmt::format(", with {} as diagnosed.", causes);
  if (certificate.explanations.size() > 1)
    text += " Each likely explanation is used for a share of the twins equal to its probability.";
  if (!certificate.filmed)
    text += " What an explanation leaves unexplained in each motion is in the twins as well, drawn afresh for each.";
  text += fmt::format(" Positions scatter by {} in the recording, by {} in its twins.",
                      micrometres(certificate.recorded_noise_m), micrometres(certificate.twin_noise_m));
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
