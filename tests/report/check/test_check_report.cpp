#include "report/check/check_report.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "tests/catch.h"

using namespace glidelab;
using Part = core::Subject::Part;

TEST_CASE("check.json says how far the glider goes in each clip, of images and of a track alike") {
  core::RecordingCheck check;
  check.clips.resize(2);
  check.clips[0].images = true;
  check.clips[0].distance_m = 0.75;
  check.clips[1].distance_m = 1.25;
  const auto json = nlohmann::json::parse(report::check_json(check));
  CHECK(json["clips"][0]["way_m"] == 0.75);
  CHECK(json["clips"][1]["way_m"] == 1.25);
}

TEST_CASE("findings that are notes are in words, those that read the same are one, and what follows stands below") {
  core::RecordingCheck check;
  const auto note = [](const char* about, core::Note of) {
    return core::Finding{core::Severity::note, {Part::clips, {about}}, std::move(of)};
  };
  core::Finding root{core::Severity::unusable,
                     {Part::pattern},
                     core::found::LengthInUnit{"square_m", 40.0, core::LengthUnit::millimetres}};
  const core::InclineContradiction angle{{4.3, 0.3, "incline_deg"}, 0.42, 0.13};
  root.follow = {{core::Severity::change, {Part::clips, {"up"}}, core::found::InclineOff{angle, {}, false}},
                 {core::Severity::change, {Part::clips, {"down"}}, core::found::BeyondTrack{900.0, 1.5, {}}}};
  // 33.1 and 33.2 % read the same, 40 % does not.
  check.findings = {root, note("up", core::MarkerOfOtherSize{1.331}), note("down", core::MarkerOfOtherSize{1.332}),
                    note("late", core::MarkerOfOtherSize{1.40})};
  const auto findings = nlohmann::json::parse(report::check_json(check)).at("findings");
  REQUIRE(findings.size() == 3);
  CHECK(findings[0]["found"] == "square_m = 40 looks like millimetres (0.04 m) (this explains 2 other findings)");
  CHECK(findings[0]["follow"] ==
        nlohmann::json({"up: the acceleration gives an inclination of 0.42 ± 0.13°, but incline_deg says 4.30 ± 0.30°",
                        "down: the glider runs 900 m, but length_m in [track] is 1.5 m"}));
  CHECK(findings[1]["about"] == "up, down");
  CHECK(findings[1]["found"] == "the marker looks 33 % larger than its diameter predicts");
  CHECK(findings[1]["severity"] == "note");
  CHECK(findings[2]["about"] == "late");
  const std::string text = report::check_text(check);
  CHECK(text.find("note: up, down: the marker looks 33 % larger") != std::string::npos);
}

TEST_CASE("the clips of a check have no column that says nothing about any of them") {
  core::RecordingCheck check;
  check.usable = true;
  check.clips.resize(2);
  for (core::ClipCheck& clip : check.clips) {
    clip.name = "track";
    clip.images = false;
    clip.frames = clip.seen = 60;
    clip.frame_rate_hz = 60.0;
    clip.top_speed_m_s = 0.5;
  }
  check.clips[0].position_noise_m = 2e-4;
  std::string text = report::check_text(check), page = report::check_report(check, {}).html;
  CHECK(text.find("noise (mm)") != std::string::npos);
  CHECK(text.find("blur (px)") == std::string::npos);
  CHECK(page.find("noise (mm)</th>") != std::string::npos);
  CHECK(page.find("120 positions in 2 clips") != std::string::npos);
  for (const char* title : {"blur (px)", "marker (px)", "contrast", "white, black", "in the file"}) {
    INFO(title);
    CHECK(page.find(title) == std::string::npos);
  }
  check.clips[1].images = true;
  check.clips[1].marker_px = 18.0;
  check.clips[1].saturated = 1.54e-6;
  text = report::check_text(check);
  page = report::check_report(check, {}).html;
  CHECK(text.find("blur (px)") != std::string::npos);
  CHECK(page.find("“marker (px)”: its diameter") != std::string::npos);
  CHECK(page.find("&lt; 0.01\u00a0%, 0\u00a0%") != std::string::npos);
}
