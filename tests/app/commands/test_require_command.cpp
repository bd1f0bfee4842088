/// glidelab require as a user of the shell sees it: the answer, and the status that says whether there is one.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/files/file_io.h"
#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "tests/validate/small_sweep.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

tests::ProcessResult require_of(const tests::TempDir& dir, const std::string& target) {
  tests::write_sweep(dir.path(), "", tests::kTwoKeys);
  return tests::glidelab({"require", "sweep.toml", "--target", target, "-o", "out", "-q"}, dir.path());
}

nlohmann::json answer_in(const fs::path& folder) {
  return nlohmann::json::parse(base::read_file(folder / "require.json"));
}

}  // namespace

TEST_CASE("A target that is within reach ends with status 0, one beyond any setting with 4, and both leave a page") {
  // sd of K/m: some 1e-3 1/s with 20 um at 50 to 80 Hz over 1.2 s; a thousand times more and less are clear cases.
  const tests::TempDir easy, hard;
  const tests::ProcessResult reached = require_of(easy, "k_over_m_1_s=1");
  INFO(reached.err);
  CHECK(reached.status == 0);
  CHECK(reached.out.starts_with("Choose "));
  CHECK(reached.out.substr(0, reached.out.find('\n')).find("Expect K/m within") != std::string::npos);
  CHECK(fs::exists(easy / "out/report.html"));
  const nlohmann::json within = answer_in(easy / "out");
  for (const nlohmann::json& candidate : within["candidates"]) {
    CHECK(candidate["verdict"].get<std::string>().starts_with("reached"));
  }
  const tests::ProcessResult missed = require_of(hard, "k_over_m_1_s=1e-6");
  CHECK(missed.status == 4);
  CHECK(missed.err.find("nothing reaches k_over_m_1_s=1e-6") != std::string::npos);
  CHECK(fs::exists(hard / "out/report.html"));
  const nlohmann::json beyond = answer_in(hard / "out");
  for (const nlohmann::json& candidate : beyond["candidates"]) {
    CHECK(candidate["verdict"] == "impossible");
  }
}
