#include "diagnose/lines/line_table.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "base/text/csv.h"

namespace glidelab::diagnose {
namespace {

constexpr double kSmallest = 1e-6, kLargest = 1e6;  // kg, m/s², 1/s: beyond all tables, and squares stay numbers

}  // namespace

std::vector<TableLine> read_lines(const std::filesystem::path& file) {
  const base::CsvTable table =
      base::read_csv(file, {"mass_kg", "incline_deg", "direction", "a0_m_s2", "k_over_m_1_s"}, {"r2"}, true);
  std::vector<TableLine> lines;
  std::vector<base::Issue> issues;
  const auto& mass = table.column("mass_kg");
  const auto& incline = table.column("incline_deg");
  const auto& direction = table.column("direction");
  const auto& a0 = table.column("a0_m_s2");
  const auto& k = table.column("k_over_m_1_s");
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const auto wrong = [&](const char* key, double value, const char* expected) {
      issues.push_back({file.string(), table.line[i], key, fmt::format("{}", value), expected});
    };
    if (!(mass[i] >= kSmallest && mass[i] <= kLargest)) wrong("mass_kg", mass[i], "a number from 1e-6 to 1e6");
    if (!(std::abs(incline[i]) < 90.0)) wrong("incline_deg", incline[i], "an angle between -90 and 90");
    if (direction[i] != 1.0 && direction[i] != -1.0) wrong("direction", direction[i], "1 or -1, the sign of v");
    if (!(std::abs(a0[i]) <= kLargest)) wrong("a0_m_s2", a0[i], "a number from -1e6 to 1e6");
    if (!(k[i] >= kSmallest && k[i] <= kLargest)) wrong("k_over_m_1_s", k[i], "a number from 1e-6 to 1e6");
    lines.push_back({mass[i], incline[i], direction[i] > 0.0 ? 1 : -1, a0[i], k[i], table.last_digit_of("a0_m_s2"),
                     table.last_digit_of("k_over_m_1_s")});
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
  if (lines.size() < kFewestLines) throw base::InputError(too_few_lines(file.string(), lines.size()));
  return lines;
}

core::Experiment read_recording(const std::filesystem::path& path, core::OutsideFiles outside) {
  std::error_code ignored;  // what cannot be looked at is read as a folder, which says what is wrong
  if (path.extension() != ".csv" || !std::filesystem::is_regular_file(path, ignored)) {
    return core::read_experiment(path, outside);
  }
  core::Experiment experiment;
  experiment.folder = path.parent_path();
  experiment.file = path;
  experiment.name = path.stem().string();
  experiment.lines = path;
  return experiment;
}

base::Issue too_few_lines(const std::string& file, std::size_t lines) {
  return {file, 0, "lines", fmt::format("{} of them", lines), fmt::format("{} or more", kFewestLines)};
}

std::vector<double> different(const std::vector<TableLine>& lines, double TableLine::*member) {
  std::set<double> values;
  for (const TableLine& line : lines) values.insert(line.*member);
  return {values.begin(), values.end()};
}

}  // namespace glidelab::diagnose
