#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <random>
#include <string>

#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;

namespace {

/// What `diagnose --json` says of a table of a fall.
nlohmann::json diagnosed_fall(const std::string& table) {
  const tests::TempDir temp;
  std::ofstream(temp / "falling.csv") << table;
  const tests::ProcessResult done =
      tests::glidelab({"diagnose", "falling.csv", "--incline", "90", "--json", "--quiet", "--no-page"}, temp.path());
  INFO(done.err);
  REQUIRE(done.status == 0);
  return nlohmann::json::parse(done.out);
}

}  // namespace

TEST_CASE("diagnose: of a bead in a liquid that bears nearly all of its weight the force that drives it is fitted") {
  // x'' = 0.15 m/s² - (2 1/s) x' from 0.02 m/s: v tends to 0.075 m/s. In air that would be K/m = 131 1/s.
  std::mt19937 random(4);
  std::normal_distribution<double> noise_m(0.0, 2e-4);
  std::string table = "t,x\n";
  for (int i = 0; i < 60; ++i) {
    const double t_s = i / 30.0;
    table += fmt::format("{:.5f},{:.6f}\n", t_s, 0.075 * t_s + 0.0275 * (std::exp(-2.0 * t_s) - 1.0) + noise_m(random));
  }
  const nlohmann::json diagnosis = diagnosed_fall(table);
  CHECK(diagnosis["verdict"] != "effect");
  const nlohmann::json& k = diagnosis["recovered"].front()["k_over_m_1_s"];
  REQUIRE(k.is_object());
  CHECK(std::abs(k["value"].get<double>() - 2.0) < 4.0 * k["sd"].get<double>());
  CHECK(k["sd"].get<double>() < 1.0);
}

TEST_CASE("diagnose: what falls with a fifth of gravity has no drag of size 0 that explains its gap") {
  std::mt19937 random(1);
  std::normal_distribution<double> noise_m(0.0, 0.015);
  for (int run = 0; run < 4; ++run) {
    CAPTURE(run);
    std::string table = "t,x\n";
    for (int i = 0; i < 32; ++i) {
      const double t_s = 0.1 * i;
      table += fmt::format("{:.1f},{:.9f}\n", t_s, 0.05 + 0.02 * t_s + 0.5 * 2.005 * t_s * t_s + noise_m(random));
    }
    const nlohmann::json diagnosis = diagnosed_fall(table);
    REQUIRE(diagnosis["verdict"] == "effect");
    REQUIRE_FALSE(diagnosis["effects"].empty());
    for (const nlohmann::json& effect : diagnosis["effects"]) {
      CAPTURE(effect["id"].get<std::string>());
      REQUIRE_FALSE(effect["parameters"].empty());
      const nlohmann::json& size = effect["parameters"].front();
      CHECK(std::abs(size["value"].get<double>()) > size["sd"].get<double>());
    }
  }
}
