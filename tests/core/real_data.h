/// Measured recordings that no one here made (../shared/real beside the checkout), analysed with the experiment.toml of
/// tests/real. Where the data are not there, tests of them pass with a warning.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/analysis/analyze.h"
#include "test_paths.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

namespace glidelab::tests {

/// What `use` makes of the folder that an experimenter would have; nothing where the data are not there.
template <typename Use>
auto with_real(const std::string& name, const Use& use) -> std::optional<decltype(use(std::filesystem::path()))> {
  namespace fs = std::filesystem;
  const fs::path data = fs::path(tests::kSourceDir) / "../shared/real" / name;
  if (!fs::exists(data)) {
    WARN("skipped: no measured data in " << data.lexically_normal());
    return {};
  }
  const TempDir temp;
  for (const auto& file : fs::directory_iterator(data)) {
    fs::create_symlink(fs::canonical(file), temp / file.path().filename());
  }
  fs::copy_file(fs::path(tests::kSourceDir) / "tests/real" / name / "experiment.toml", temp / "experiment.toml");
  return use(temp.path());
}

inline std::optional<core::AnalysisResults> analyze_real(const std::string& name) {
  return with_real(name, [](const std::filesystem::path& folder) {
    return core::analyze({folder}, {std::nullopt, 2});
  });
}

}  // namespace glidelab::tests
