#include "report/diagnosis/words/unit_words.h"

#include <fmt/format.h>

#include <variant>

#include "report/check/finding_words.h"

namespace glidelab::report {
namespace {

std::string first_to_check(const diagnose::DoubtfulUnit& of) {
  const FindingWords words = finding_words(of.found);
  if (std::holds_alternative<core::found::FallsSlowly>(of.found)) {
    return fmt::format(
        "First find out why it falls so slowly ({}: {}). {} Otherwise nothing below holds.", of.clip, words.found,
        of.weight_open
            ? "The force that drives it is therefore fitted. If it was at its final speed from the start, terminal "
              "velocities hold; if a liquid bears part of its weight, K/m holds as well."
            : "If it was at its final speed from the start, terminal velocities hold. If a liquid bears part of its "
              "weight, they hold as well, and drags are too large by the ratio of its weight to that in the liquid.");
  }
  const bool scale = std::holds_alternative<core::found::FallAboveGravity>(of.found);
  return fmt::format("First {} ({}: {}). {}.", words.advice, of.clip, words.found,
                     scale ? "Drag and friction cannot explain that" : "In another unit, nothing below holds");
}

/// A path that turns by less hardly changes gravity along it.
std::string bent_words(const diagnose::OfReading& of) {
  constexpr double kClearly_deg = 3.0;
  const auto* const path = std::get_if<core::PathBends>(&of.note);
  if (path == nullptr || path->slope_deg < kClearly_deg) return {};
  return fmt::format(
      "First find out whether the track is straight: in {}, the direction of the path in x and y changes by {:.1f}°. "
      "On a bent track gravity along the motion changes, and the causes named below may be an effect of that.",
      of.clip, path->slope_deg);
}

}  // namespace

std::string unit_words(const diagnose::Diagnosis& diagnosis) {
  for (const diagnose::Note& note : diagnosis.notes) {
    if (const auto* const of = std::get_if<diagnose::DoubtfulUnit>(&note)) return first_to_check(*of);
  }
  for (const diagnose::Note& note : diagnosis.notes) {
    if (const auto* const of = std::get_if<diagnose::OfReading>(&note)) {
      if (std::string words = bent_words(*of); !words.empty()) return words;
    }
  }
  return {};
}

}  // namespace glidelab::report
