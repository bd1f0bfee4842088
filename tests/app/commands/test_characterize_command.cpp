/// `glidelab characterize`: files, JSON, exit statuses, nothing half-written.
#include <nlohmann/json.hpp>

#include "base/files/file_io.h"
#include "base/toml/strict_toml.h"
#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/core/flat_fields.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

void write_folder(const fs::path& folder, const tests::TrueCamera& camera) {
  tests::FlatFieldCamera source(camera, 3);
  tests::FlatFieldPlan plan;
  plan.light_e = tests::even_levels(8, 1.2 * camera.full_well_e);
  tests::write_flat_fields(folder, source, plan);
}

}  // namespace

TEST_CASE("characterize writes camera.toml, characterize.json and a page, and --json prints exactly the JSON") {
  const tests::TempDir temp;
  const tests::TrueCamera camera;
  write_folder(temp / "flats", camera);
  const tests::ProcessResult result =
      tests::glidelab({"characterize", (temp / "flats").string(), "--out", (temp / "out").string(), "--json"});
  INFO(result.err);
  REQUIRE(result.status == 0);
  CHECK(result.out == base::read_file(temp / "out/characterize.json"));
  const json gain = json::parse(result.out).at("sensor").at("gain_dn_per_e");
  // 4 sd: see tests/core/characterize/test_photon_transfer.cpp.
  CHECK(std::abs(gain.at("value").get<double>() - camera.gain_dn_per_e) < 4.0 * gain.at("sd").get<double>());
  const base::TomlFile file = base::TomlFile::load(temp / "out/camera.toml");
  CHECK(std::abs(file.root().table("sensor").number("gain_dn_per_e") - gain.at("value").get<double>()) <
        0.01 * gain.at("sd").get<double>());
  CHECK(fs::exists(temp / "out/report.html"));
  CHECK(std::distance(fs::directory_iterator(temp.path()), fs::directory_iterator{}) == 2);  // no staging is left
}

TEST_CASE("characterize of images with a gamma prints why there is no gain, and its camera file has none") {
  const tests::TempDir temp;
  tests::TrueCamera camera;
  camera.tone = [](double x) { return std::pow(x, 1.0 / 2.2); };
  write_folder(temp / "flats", camera);
  const tests::ProcessResult result =
      tests::glidelab({"characterize", (temp / "flats").string(), "--out", (temp / "out").string()});
  INFO(result.out << result.err);
  REQUIRE(result.status == 4);
  CHECK(result.out.starts_with("These images do not give the gain: "));
  CHECK(result.out.find("not linear in the light") != std::string::npos);
  CHECK(result.err.find("; report: " + (temp / "out/report.html").string()) != std::string::npos);
  CHECK(result.err.find("error:") == std::string::npos);  // the answer is no
  CHECK(result.err.find("incomplete") != std::string::npos);
  CHECK(base::read_file(temp / "out/camera.toml").find("gain_dn_per_e = nan") != std::string::npos);
}

TEST_CASE("characterize of a folder with a broken frame is status 1, names it, and writes nothing") {
  const tests::TempDir temp;
  write_folder(temp / "flats", tests::TrueCamera());
  base::write_file(temp / "flats/flat-03/001.png", "no picture");
  const tests::ProcessResult result =
      tests::glidelab({"characterize", (temp / "flats").string(), "--out", (temp / "out").string()});
  CHECK(result.status == 1);
  CHECK(result.err.find("flat-03/001.png") != std::string::npos);
  CHECK_FALSE(fs::exists(temp / "out"));
  CHECK(result.out.empty());
}
