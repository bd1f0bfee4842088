#include "report/text/gap_text.h"

#include <fmt/format.h>

#include "base/text/number_text.h"

namespace glidelab::report {

std::string interval_text(const std::optional<diagnose::GapInterval>& interval) {
  if (!interval) return "–";
  return fmt::format("{} to {}", base::digits_text(interval->low, 3), base::digits_text(interval->high, 3));
}

std::string shrink_text(const diagnose::GapSizes& gap) {
  if (!gap.shrink) return "";
  std::string text = fmt::format("{:.1f} %", 100.0 * *gap.shrink);
  if (const auto& of = gap.interval95.shrink)
    text += fmt::format(" ({:.1f} to {:.1f} %)", 100.0 * of->low, 100.0 * of->high);
  return text;
}

}  // namespace glidelab::report
