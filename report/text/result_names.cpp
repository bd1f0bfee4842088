#include "report/text/result_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace glidelab::report {

std::string configuration_name(const core::AnalysisResults& results, const core::ConfigurationResult& configuration) {
  const auto alike = std::count_if(
      results.configurations.begin(), results.configurations.end(), [&](const core::ConfigurationResult& other) {
        return other.mass_kg == configuration.mass_kg && other.incline_deg == configuration.incline_deg;
      });
  const std::string name = fmt::format("{:.6g} kg, {:.4g}°", configuration.mass_kg, configuration.incline_deg);
  return alike > 1 ? name + ", " + configuration.group : name;
}

std::string file_name_part(std::string_view text) {
  std::string name;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '/' || c == '%' || byte < 0x20 || byte == 0x7f) {
      name += fmt::format("%{:02X}", byte);
    } else {
      name += c;
    }
  }
  return name;
}

std::vector<std::string> phase_file_names(const core::AnalysisResults& results) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const core::ClipResult& clip : results.clips) {
    const auto same = std::count_if(results.clips.begin(), results.clips.end(),
                                    [&](const core::ClipResult& other) { return other.name == clip.name; });
    const std::string stem = same == 1
                                 ? file_name_part(clip.name)
                                 : fmt::format("{}-{}", file_name_part(clip.experiment), file_name_part(clip.name));
    std::string name = fmt::format("phase-{}.csv", stem);
    for (int n = 2; !taken.insert(name).second; ++n) name = fmt::format("phase-{}-{}.csv", stem, n);
    names.push_back(std::move(name));
  }
  return names;
}

}  // namespace glidelab::report
