/// `glidelab simulate`: trajectories and the instants of reversal.
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/files/file_io.h"
#include "tests/app/run_process.h"
#include "tests/app/tiny_scenario.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using nlohmann::json;

TEST_CASE("simulate writes one trajectory a clip, and tells where the glider turned") {
  const tests::TempDir temp;
  tests::write_tiny_scenario(temp / "tiny.toml", 1.0);
  const tests::ProcessResult result =
      tests::glidelab({"simulate", (temp / "tiny.toml").string(), "--out", (temp / "out").string(), "--json"});
  INFO(result.err);
  REQUIRE(result.status == 0);
  const json document = json::parse(result.out);
  CHECK(document.at("format") == 1);
  const json& clip = document.at("clips").at(0);
  CHECK(clip.at("name") == "up");
  CHECK(clip.at("file") == "trajectory-up.csv");
  const std::string csv = base::read_file(temp / "out/trajectory-up.csv");
  CHECK(csv.starts_with("t_s,x_m,v_m_s,a_m_s2,mode\n0,"));
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + clip.at("states").get<int>());
  // Closed form: v reaches zero at ln(1 + 1.2 K/m / a0) m/K with a0 = g (sin 4° + mu cos 4°); the first exposure's
  // middle, half of the default 1 ms later, is t = 0. The solver's tolerance is 1e-12.
  const double alpha = 4.0 * 3.14159265358979323846 / 180.0;
  const double a0 = 9.80665 * (std::sin(alpha) + 0.0071 * std::cos(alpha));
  const double expected_s = std::log(1.0 + 1.2 * 2.768 / a0) / 2.768 - 0.0005;
  REQUIRE(clip.at("reversals").size() == 1);
  CHECK(std::abs(clip.at("reversals").at(0).at("t_s").get<double>() - expected_s) < 1e-9);
  CHECK(clip.at("reversals").at(0).at("to") == "slide_down");
}

TEST_CASE("the option --rate gives the states of another camera, and the table is for people") {
  const tests::TempDir temp;
  tests::write_tiny_scenario(temp / "tiny.toml");
  const tests::ProcessResult result =
      tests::glidelab({"simulate", (temp / "tiny.toml").string(), "--rate", "400"}, temp.path());
  REQUIRE(result.status == 0);
  CHECK(result.out.find("clip") != std::string::npos);
  const std::string csv = base::read_file(temp / "glidelab-out/simulate-tiny/trajectory-up.csv");
  CHECK(csv.find("\n0.0025,") != std::string::npos);
}

TEST_CASE("simulate refuses more states than it can hold, says what they would take, and leaves nothing") {
  const tests::TempDir temp;
  tests::write_tiny_scenario(temp / "tiny.toml", 3600.0);
  const tests::ProcessResult result =
      tests::glidelab({"simulate", (temp / "tiny.toml").string(), "--rate", "1e5", "-o", "out"}, temp.path());
  CHECK(result.status == 1);
  // The exposure of 1 ms ends within the 3600 s: 100 states fewer, and the first one.
  CHECK(result.err.find("--rate: found 100000 Hz, for clip \"up\" of 3600 s 35999") != std::string::npos);
  CHECK(result.err.find("23.4 GB, expected at most 5000000 states in a clip, 1388.89 Hz") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(temp / "out"));
}
