// glidelab diagnose on a folder with a table of published lines.
#include <fstream>

#include <nlohmann/json.hpp>

#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using nlohmann::json;

namespace {

/// Six lines by equation (8), level, with a friction of 0.03 N that no load makes.
void write_table(const std::filesystem::path& folder) {
  std::ofstream(folder / "experiment.toml") << "format = 1\nname = \"lines\"\nlines = \"lines.csv\"\n";
  std::ofstream table(folder / "lines.csv");
  table << "mass_kg,incline_deg,direction,a0_m_s2,k_over_m_1_s\n";
  double off = 1e-4;
  for (const double mass : {0.2, 0.4, 0.8, 1.6}) {
    for (const int direction : {-1, 1}) {
      table << mass << ",0," << direction << "," << -direction * (0.06 + 0.03 / mass) + off << ","
            << 0.9 / mass * (1.0 + off) << "\n";
      off = -1.3 * off;
    }
  }
}

}  // namespace

TEST_CASE("diagnose: a table of lines has its explanations in the file, with chi² before and after or why not") {
  const tests::TempDir temp;
  write_table(temp.path());
  const tests::ProcessResult done =
      tests::glidelab({"diagnose", temp.path().string(), "--no-page", "--json", "-o", (temp / "out").string(), "-q"});
  INFO(done.err);
  REQUIRE(done.status == 0);
  const json diagnosis = json::parse(done.out);
  const json& lines = diagnosis.at("lines");
  CHECK(lines.at("count") == 8);
  for (const json& one : lines.at("candidates")) {
    INFO(one.dump());
    if (one.contains("not_weighed")) continue;
    CHECK(one.at("chi2_before").get<double>() >= one.at("chi2_after").get<double>() * (1.0 - 1e-6));
    CHECK(one.contains("log_likelihood_gain"));
  }
  for (const json& ranked : diagnosis.at("ranking")) {
    if (ranked.at("log_evidence_gain").is_null()) CHECK(ranked.at("why").contains("log_evidence_gain"));
  }
}

TEST_CASE("diagnose: a table of lines cannot be planned, and what is left out must be an effect") {
  const tests::TempDir temp;
  write_table(temp.path());
  const tests::ProcessResult planned =
      tests::glidelab({"diagnose", "--plan", temp.path().string(), "-o", (temp / "out").string()});
  CHECK(planned.status == 1);
  CHECK(planned.err.find("a table of lines, expected clips or tracks") != std::string::npos);
  const tests::ProcessResult without = tests::glidelab(
      {"diagnose", temp.path().string(), "--without", "nonsense", "--no-page", "-o", (temp / "out").string()});
  CHECK(without.status == 2);
  CHECK(without.err.find("\"nonsense\"") != std::string::npos);
}

TEST_CASE("diagnose: a table's absurd number is wrong input, with its line, and not a probability that is none") {
  const tests::TempDir temp;
  const auto refusal = [&](const std::string& line) {
    std::ofstream table(temp / "lines.csv");
    table << "mass_kg,incline_deg,direction,a0_m_s2,k_over_m_1_s\n";
    for (const double mass : {0.2, 0.3, 0.4, 0.5, 0.6, 0.7}) table << mass << ",0,1,-0.06," << 0.9 / mass << "\n";
    table << line << "\n";
    table.close();
    const tests::ProcessResult done =
        tests::glidelab({"diagnose", temp / "lines.csv", "--no-page", "-o", temp / "out", "-q"});
    CHECK(done.status == 1);
    return done.err;
  };
  CHECK(refusal("0.3,0,-1,1e300,3").find("lines.csv:8: a0_m_s2: found 1e+300") != std::string::npos);
  CHECK(refusal("0.3,0,-1,0.06,1e-300").find("lines.csv:8: k_over_m_1_s: found 1e-300") != std::string::npos);
  CHECK(refusal("1e-300,0,-1,0.06,3").find("lines.csv:8: mass_kg: found 1e-300") != std::string::npos);
}

TEST_CASE("diagnose: a table of lines in no folder is diagnosed as in a folder, and another table is refused") {
  const tests::TempDir temp;
  write_table(temp.path());
  const auto run = [&](const std::filesystem::path& what) {
    return tests::glidelab({"diagnose", what.string(), "--no-page", "--json", "-o", (temp / "out").string(), "-q"});
  };
  const tests::ProcessResult folder = run(temp.path()), file = run(temp / "lines.csv");
  INFO(file.err);
  REQUIRE(file.status == 0);
  CHECK(file.out == folder.out);
  std::ofstream(temp / "short.csv") << "t_s,x_m\n0,0\n0.1,0.1\n";
  CHECK(run(temp / "short.csv").err.find("short.csv: found 2 points") != std::string::npos);  // a track
  std::ofstream(temp / "track.csv") << "k_over_m_1_s,k_over_m_sd_1_s\n1,0.1\n";
  const tests::ProcessResult track = run(temp / "track.csv");
  CHECK(track.status == 1);
  CHECK(track.err.find("track.csv:1: header: found no column \"mass_kg\"") != std::string::npos);
  const tests::ProcessResult other = run(temp / "experiment.toml");
  CHECK(other.status == 1);
  CHECK(other.err.find("the folder that it is in") != std::string::npos);
}
