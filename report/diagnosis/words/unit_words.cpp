#include "report/diagnosis/words/unit_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <variant>
#include <vector>

#include "core/check/finding.h"
#include "report/check/finding_words.h"

namespace glidelab::report {
namespace {

/// What a check finds as well (core/check/motion_look.h).
std::optional<core::Found> doubtful_unit(const diagnose::MeasuredMotion& motion, bool falls) {
  if (motion.x_m.size() < 2 || motion.t_s.size() != motion.x_m.size()) return {};
  const auto [least, most] = std::minmax_element(motion.x_m.begin(), motion.x_m.end());
  if (*most - *least > (falls ? core::kLongFall_m : core::kLongRange_m)) return core::found::LongRun{*most - *least};
  const double apart_s = (motion.t_s.back() - motion.t_s.front()) / static_cast<double>(motion.t_s.size() - 1);
  if (apart_s > core::kSlowFrames_s) return core::found::SlowFrames{apart_s};
  return {};
}

/// The median acceleration, if that is above gravity by more than a scale or a frame rate is off, and most of the
/// others are above gravity as well.
std::optional<core::Found> above_gravity(std::vector<double> a_m_s2) {
  constexpr double kGravity_m_s2 = 9.80665, kAbove = 1.05;
  if (a_m_s2.empty()) return {};
  std::sort(a_m_s2.begin(), a_m_s2.end());
  const double median = a_m_s2[a_m_s2.size() / 2], lower_quartile = a_m_s2[a_m_s2.size() / 4];
  if (median < kAbove * kGravity_m_s2 || lower_quartile < kGravity_m_s2) return {};
  return core::found::FallAboveGravity{median, kGravity_m_s2};
}

}  // namespace

std::string unit_words(const diagnose::Diagnosis& diagnosis) {
  const bool falls = std::any_of(diagnosis.notes.begin(), diagnosis.notes.end(), [](const diagnose::Note& note) {
    return std::holds_alternative<diagnose::OnlyFalls>(note);
  });
  for (const diagnose::MeasuredMotion& motion : diagnosis.measured) {
    const std::optional<core::Found> scale = falls ? above_gravity(motion.a_m_s2) : std::nullopt;
    const std::optional<core::Found> unit = scale ? std::nullopt : doubtful_unit(motion, falls);
    if (!unit && !scale) continue;
    const FindingWords words = finding_words(unit ? *unit : *scale);
    return fmt::format("First {} ({}: {}). {}.", words.advice, motion.clip, words.found,
                       unit ? "In another unit, nothing below holds" : "Drag and friction cannot explain that");
  }
  return {};
}

}  // namespace glidelab::report
