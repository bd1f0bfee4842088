#include "diagnose/lines/line_gap.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "diagnose/gap/clip_interval.h"

namespace glidelab::diagnose {
namespace {

constexpr double kReadAngle = 0.3;  // degrees: what a person reads off a plumb, where a table says nothing

/// Over lines, each of which is held out by itself.
void add_intervals(GapSizes& gap) {
  std::vector<ClipSquares> before, after;
  for (const double one : gap.before_by_clip) before.push_back({one * one, 1.0});
  for (const double one : gap.after_by_clip) after.push_back({one * one, 1.0});
  gap.interval95.why_none = why_no_interval(before.size());
  gap.interval95.before = rms_interval(before);
  gap.interval95.after = rms_interval(after);
  if (gap.shrink) gap.interval95.shrink = shrink_interval(before, after);
}

double mean_intercept(const std::vector<TableLine>& lines, double incline_deg) {
  double mean = 0.0, count = 0.0;
  for (const TableLine& line : lines) {
    if (line.incline_deg != incline_deg) continue;
    mean += line.a0_m_s2;
    count += 1.0;
  }
  return mean / count;
}

void compare_inclination(double stated_deg, double intercept_m_s2, double g, LineGap& gap) {
  const std::string stated = fmt::format("{} deg", stated_deg);
  if (!(std::abs(intercept_m_s2) <= g)) {
    gap.sizes.parameters.push_back({"alpha_deg", "stated", stated});
    gap.notes.push_back(
        fmt::format("Lines stated at {} degrees have a mean intercept of {:.3g} m/s², more than gravity ({:.6g} "
                    "m/s²): no inclination has it.",
                    stated_deg, intercept_m_s2, g));
    return;
  }
  const double degrees = std::asin(intercept_m_s2 / g) * 180.0 / std::numbers::pi;
  const double z = (degrees - stated_deg) / kReadAngle;
  gap.sizes.parameters.push_back({"alpha_deg", "stated", stated, z, z});
  gap.notes.push_back(fmt::format(
      "Lines stated at {} degrees have a mean intercept of {:.3f} degrees; a table does not say how well the angle "
      "was read ({} degrees are taken).",
      stated_deg, degrees, kReadAngle));
}

}  // namespace

LineGap line_gap(const std::vector<TableLine>& lines, double g, const LineSolution& before, const LineSolution& after,
                 const OwnScatter& scatter) {
  LineGap result;
  GapSizes& gap = result.sizes;
  gap.before = gap_of_lines(before, scatter);
  gap.after = gap_of_lines(after, scatter);
  gap.standard_error = std::sqrt(0.5 / static_cast<double>(lines.size()) + 0.5 / static_cast<double>(scatter.freedom));
  if (gap.before > 1.0 + gap.standard_error) gap.shrink = (gap.before - gap.after) / (gap.before - 1.0);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    gap.held_out.push_back(fmt::format("{:.0f} g, {}°, v {} 0", 1000.0 * lines[i].mass_kg, lines[i].incline_deg,
                                       lines[i].direction > 0 ? ">" : "<"));
    gap.before_by_clip.push_back(gap_of_line(before, scatter, i));
    gap.after_by_clip.push_back(gap_of_line(after, scatter, i));
  }
  add_intervals(gap);
  for (const double incline : different(lines, &TableLine::incline_deg)) {
    compare_inclination(incline, mean_intercept(lines, incline), g, result);
  }
  return result;
}

}  // namespace glidelab::diagnose
