/// Measured recordings that no one here made, analysed with the experiment.toml of tests/real. The environment variable
/// GLIDELAB_REAL_DATA names their folder (DATA-FOLDER of tools/real-recordings). Without the data, tests of them pass
/// with a warning.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "core/analysis/analyze.h"
#include "test_paths.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

namespace glidelab::tests {

/// The folder or file `name` of the measured data; nothing, with a warning, where it is not there.
inline std::optional<std::filesystem::path> real_data(const std::string& name) {
  const char* folder = std::getenv("GLIDELAB_REAL_DATA");
  if (folder == nullptr || *folder == '\0') {
    WARN("skipped: no measured data (GLIDELAB_REAL_DATA is not set)");
    return {};
  }
  const std::filesystem::path data = std::filesystem::path(folder) / name;
  if (!std::filesystem::exists(data)) {
    WARN("skipped: no measured data in " << data);
    return {};
  }
  return data;
}

/// What `use` makes of the folder that an experimenter would have; nothing where the data are not there.
template <typename Use>
auto with_real(const std::string& name, const Use& use) -> std::optional<decltype(use(std::filesystem::path()))> {
  namespace fs = std::filesystem;
  const std::optional<fs::path> data = real_data(name);
  if (!data) return {};
  const TempDir temp;
  for (const auto& file : fs::directory_iterator(*data)) {
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
