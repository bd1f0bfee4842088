/// glidelab check, on recordings that the renderer made with one thing wrong.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <utility>

#include "base/files/file_io.h"
#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/one_glider.h"
#include "tests/temp_dir.h"

using namespace glidelab;
namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// 300 px a metre; a marker of 12 px that starts with 1.2 m/s, 360 px/s.
std::string scenario(const std::string& camera = "exposure_s = 0.001", const std::string& more = "",
                     double rate_hz = 100.0, const tests::Launch& launch = {"up", 0.2, -1.2, 1.0}) {
  return fmt::format(
             "format = 1\nname = \"to check\"\nseed = 5\n[camera]\nwidth_px = 480\nheight_px = 360\nframe_rate_hz = "
             "{}\nfocal_px = [720.0, 720.0]\nposition_m = [0.0, 0.1, 2.4]\n{}\n[calibration]\ninner_corners = [7, "
             "4]\nsquare_m = 0.08\nviews = 9\n[marker]\ndiameter_m = 0.04\n{}\n",
             rate_hz, camera, more) +
         tests::one_glider(4.0, 2.768, 0.0071, {launch});
}

struct Recording {
  tests::TempDir temp;
  explicit Recording(const std::string& text) {
    base::write_file(temp / "s.toml", text);
    const tests::ProcessResult rendered = tests::glidelab({"render", "s.toml", "-q", "-o", "r"}, temp.path());
    INFO(rendered.err);
    REQUIRE(rendered.status == 0);
  }
  /// experiment.toml with one text in place of another.
  void replace(const std::string& what, const std::string& by) const {
    std::string text = base::read_file(temp / "r/experiment.toml");
    const std::size_t at = text.find(what);
    REQUIRE(at != std::string::npos);
    base::write_file(temp / "r/experiment.toml", text.replace(at, what.size(), by));
  }
  json check(int status) const {
    const tests::ProcessResult checked = tests::glidelab({"check", "r", "--json", "-o", "out"}, temp.path());
    INFO(checked.out << checked.err);
    REQUIRE(checked.status == status);
    CHECK(fs::exists(temp / "out/report.html"));
    return json::parse(checked.out);
  }
};

/// Whether something of this severity was found whose text holds these words.
/// What follows from a finding's cause counts like a finding.
bool follows(const json& finding, const std::string& words) {
  return std::any_of(finding.at("follow").begin(), finding.at("follow").end(),
                     [&](const json& one) { return one.get<std::string>().find(words) != std::string::npos; });
}

bool finds(const json& check, const std::string& severity, const std::string& words) {
  for (const json& finding : check.at("findings")) {
    if (finding.at("severity") == severity && finding.at("found").get<std::string>().find(words) != std::string::npos) {
      return true;
    }
  }
  return false;
}

}  // namespace

TEST_CASE("a table of a body at rest is unusable, and check, analyze and diagnose say that nothing moves") {
  const tests::TempDir temp;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(1.12, 2e-4);
  std::string table = "t_s,x_m\n";
  for (int k = 0; k < 300; ++k) table += fmt::format("{},{:.6f}\n", 0.01 * k, normal(random));
  base::write_file(temp / "rest.csv", table);
  // An unusable recording has the status 4, one that no diagnosis can judge 1; an analysis without values is no error.
  for (const auto& [command, status] : {std::pair("check", 4), std::pair("analyze", 0), std::pair("diagnose", 1)}) {
    CAPTURE(command);
    const tests::ProcessResult said = tests::glidelab({command, "rest.csv", "-q", "-o", "out"}, temp.path());
    const std::string text = said.out + said.err;
    INFO(text);
    CHECK(said.status == status);
    CHECK_THAT(text, Catch::Contains("nothing moves"));
    for (const char* const wrong : {"does not fit", "±", "less scatter", "glidelab diagnose", "parameters", "sable; "})
      CHECK(text.find(wrong) == std::string::npos);
  }
}

TEST_CASE("a recording without a fault is usable, and its numbers are those of the scenario") {
  const Recording recording(scenario());
  const json check = recording.check(0);
  INFO(check.dump(1));
  CHECK(check.at("usable") == true);
  CHECK_FALSE(finds(check, "unusable", ""));
  const json& clip = check.at("clips").at(0);
  CHECK(clip.at("seen") == clip.at("frames"));
  CHECK(clip.at("jumps") == 0);
  CHECK(clip.at("stalls") == 0);
  // 0.04 m at 2.4 m with 720 px: 12 px; a pixel's own extent makes no marker larger than 5 %.
  CHECK(std::abs(clip.at("marker_px").get<double>() - 12.0) < 0.6);
  CHECK(std::abs(clip.at("marker_expected_px").get<double>() - 12.0) < 0.1);
  // The launch's 1.2 m/s, taken over four frames of 10 ms while it slows by 4 m/s^2: 0.08 m/s less at the most, and
  // the 99th part of hundred speeds is the second fastest, again 0.04 m/s less.
  const double speed_m_s = clip.at("top_speed_m_s").get<double>();
  CHECK(speed_m_s < 1.2);
  CHECK(speed_m_s > 1.2 - 0.13);
  CHECK(std::abs(clip.at("blur_px").get<double>() - clip.at("top_speed_px_s").get<double>() * 1e-3) < 1e-9);
  // The plane view and nine others, some of which an image as small as this may not show well enough.
  CHECK(check.at("pattern").at("found_in").get<std::size_t>() + check.at("pattern").at("not_found_in").size() == 10);
}

TEST_CASE("an exposure that smears the marker is found, as long as it is") {
  const Recording recording(scenario("exposure_s = 0.01"));
  const json check = recording.check(0);
  // Between 1.07 and 1.2 m/s (as above, and 4 % less in the first frame's own half) for 10 ms: 3.0 to 3.6 px.
  const double blur_px = check.at("clips").at(0).at("blur_px").get<double>();
  CHECK(blur_px > 3.0 * 0.96);
  CHECK(blur_px < 3.6);
  CHECK_FALSE(finds(check, "change", "smeared"));
  // At 25 Hz it may be smeared by 0.04 s times 1 m/s, its width.
  CHECK(finds(Recording(scenario("exposure_s = 0.04", "", 25.0)).check(0), "change", "the marker is smeared by"));
}

TEST_CASE("a marker that the sensor clips is found, and one that is not seen for darkness") {
  const json bright = Recording(scenario("", "[sensor]\nwhite_level = 1.0")).check(0);
  CHECK(finds(bright, "change", "saturated"));
  CHECK(bright.at("clips").at(0).at("marker_level").get<double>() > 0.985);
  // Far above what the sensor holds the marker's edge is sharper than a pixel; it is found nonetheless.
  const json far_above = Recording(scenario("", "[sensor]\nwhite_level = 1.0\n[light]\nlevel = 1.4")).check(0);
  CHECK(finds(far_above, "change", "saturated"));
  const json dark = Recording(scenario("", "[light]\nlevel = 0.25")).check(0);
  CHECK(finds(dark, "change", "of the camera's range"));
}

TEST_CASE("views without the pattern are named, and too few of them make the recording unusable") {
  const Recording recording(scenario());
  const fs::path views = recording.temp / "r/calibration";
  fs::copy_file(recording.temp / "r/calibration/plane.png", recording.temp / "plane.png");
  // A view of something else: the pattern's own corner only.
  const auto blank = [&](const char* name) {
    base::write_file(views / name, "P5 480 360 255\n" + std::string(480 * 360, '\x60'));
  };
  blank("view-03.png");
  const json one = recording.check(0);
  CHECK(finds(one, "change", "view-03.png"));
  for (const char* name : {"view-00.png", "view-01.png", "view-02.png", "view-04.png", "view-05.png", "view-06.png",
                           "view-07.png", "view-08.png"}) {
    blank(name);
  }
  const json none = recording.check(4);
  CHECK(finds(none, "unusable", "images with a visible pattern"));
  CHECK(none.at("usable") == false);
}

TEST_CASE("a rate that is not the file's is told, and a clip that is not there is wrong input") {
  const Recording recording(scenario());
  recording.replace("frame_rate_hz = 100.0", "frame_rate_hz = 240.0");
  const json check = recording.check(4);  // 2.4 times the speed is 5.76 times the acceleration
  const json& first = check.at("findings").at(0);
  CHECK(first.at("severity") == "unusable");
  CHECK(first.at("found").get<std::string>().find("frame_rate_hz = 240 does not fit the motion") == 0);
  CHECK(follows(first, "incline_deg says 4"));
  CHECK(follows(first, "the file states 100 frames per second, experiment.toml 240"));
  fs::remove(recording.temp / "r/clips/up.mkv");
  const tests::ProcessResult gone = tests::glidelab({"check", "r"}, recording.temp.path());
  CHECK(gone.status == 1);
  CHECK(gone.err.find("up.mkv") != std::string::npos);
}

TEST_CASE("frames that are missing show as jumps of the marker, frames that came twice as stalls") {
  const json dropped = Recording(scenario("", "[clock]\ndropped_fraction = 0.05")).check(4);
  CHECK(dropped.at("clips").at(0).at("jumps").get<int>() > 0);
  CHECK(finds(dropped, "unusable", "frames are missing"));
  const json twice = Recording(scenario("", "[clock]\nduplicated_fraction = 0.05")).check(0);
  CHECK(twice.at("clips").at(0).at("repeated_frames").get<int>() > 0);
  CHECK(twice.at("clips").at(0).at("jumps").get<int>() >= 0);
  CHECK(finds(twice, "change", "identical to the frame before"));
}

TEST_CASE("a codec that leaves a slow marker where it was for a frame loses no frames") {
  // 0.4 px a frame at most: where a block is coded anew only when it is off by enough, one step is none and the next is
  // two.
  const json check = Recording(scenario("exposure_s = 0.001", "[codec]\nname = \"h264\"\ncrf = 23.0", 240.0,
                                        {"down", -0.2, 0.35, 1.0}))
                         .check(0);
  CHECK(check.at("clips").at(0).at("jumps") == 0);
  CHECK(check.at("clips").at(0).at("stalls") == 0);
}

TEST_CASE("a marker that is not there is a finding of its clip, and names from files stay text") {
  const Recording recording(scenario());
  recording.replace("name = \"up\"", "name = \"<script>alert(1)<x>\"");
  recording.replace("diameter_m = 0.04", "diameter_m = 3.0");  // also a tenth of it is not there
  const json check = recording.check(4);
  CHECK(check.at("clips").at(0).contains("failure"));
  const std::string page = base::read_file(recording.temp / "out/report.html");
  CHECK(page.find("<script>") == std::string::npos);
  CHECK(page.find("&lt;script&gt;alert(1)&lt;x&gt;") != std::string::npos);
}

TEST_CASE("an exposure that is stated too short shows in how the marker lengthens") {
  const tests::Launch fast = {"up", 0.6, -2.4, 0.6};
  const Recording recording(scenario("exposure_s = 0.0098", "", 100.0, fast));
  recording.replace("exposure_s = 0.0098", "exposure_s = 0.001");
  const json check = recording.check(0);
  INFO(check.dump(1));
  CHECK(finds(check, "change", "exposure_s is less than half of that"));
  CHECK(finds(check, "change", "the marker is smeared by"));
  // 6 px of smear on 12 px of marker. The moments' disc, a little larger than the marker, cuts some of it off, and the
  // marker looks shorter by up to 1 - cos(16 degrees), 4 %, where it is seen aslant: 8 % of a variance of 9 px², beside
  // 3 px² by the smear, so that the exposure may be off by 12 %.
  CHECK(std::abs(check.at("clips").at(0).at("measured_exposure_s").get<double>() / 0.0098 - 1.0) < 0.12);
  // A marker that is smeared as stated is nothing to talk about.
  CHECK_FALSE(Recording(scenario("exposure_s = 0.001", "", 100.0, fast))
                  .check(0)
                  .at("clips")
                  .at(0)
                  .contains("measured_exposure_s"));
}

TEST_CASE("check says how long each stage took where it is asked to") {
  const Recording recording(scenario());
  const tests::ProcessResult result = tests::glidelab({"check", "r", "-v", "-o", "out"}, recording.temp.path());
  INFO(result.err);
  CHECK(result.err.find("calibration: took ") != std::string::npos);
}
