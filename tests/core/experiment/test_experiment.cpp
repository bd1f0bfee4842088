#include "core/experiment/experiment.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/experiment/file_names.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using Catch::Matchers::Contains;
using glidelab::tests::TempDir;
namespace fs = std::filesystem;

namespace {

/// A folder whose files exist (empty: read_experiment opens none of them).
struct Folder {
  TempDir dir;
  Folder() {
    fs::create_directories(dir / "calibration");
    fs::create_directories(dir / "clips/frames");
    for (const char* name :
         {"calibration/view-02.png", "calibration/view-00.png", "calibration/view-01.png", "calibration/plane.png",
          "calibration/plane-flat.png", "plumb.png", "clips/a.mkv", "clips/b.mkv", "track.csv", "lines.csv"}) {
      base::write_file(dir / name, "");
    }
  }
  core::Experiment read(const std::string& text) const {
    base::write_file(dir / "experiment.toml", text);
    return core::read_experiment(dir.path());
  }
  /// The message, with the folder's own path left out; empty where nothing is wrong.
  std::string message(const std::string& text) const {
    try {
      read(text);
    } catch (const base::InputError& error) {
      std::string what = error.what();
      const std::string prefix = dir.path().string() + "/";
      for (std::size_t at = what.find(prefix); at != std::string::npos; at = what.find(prefix)) {
        what.erase(at, prefix.size());
      }
      return what;
    }
    return "";
  }
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const std::string kHead = "format = 1\nname = \"test\"\n";                            // lines 1, 2
const std::string kCamera = "[camera]\nframe_rate_hz = 200.0\nexposure_s = 0.001\n";  // lines 3 to 5
const std::string kCalibration =                                                      // lines 6 to 11
    "[calibration]\npattern = \"chessboard\"\ninner_corners = [9, 6]\nsquare_m = 0.04\n"
    "views = \"calibration/view-*.png\"\nplane = \"calibration/plane.png\"\n";
const std::string kMarker = "[marker]\ndiameter_m = 0.02\n";  // lines 12, 13
const std::string kTrack = "[track]\ndownhill = \"-X\"\n";    // lines 14, 15
const std::string kClip =                                     // lines 16 to 21
    "[[clip]]\nname = \"a\"\nfile = \"clips/a.mkv\"\nmass_kg = 0.335\nincline_deg = 4.0\nlaunched = \"up\"\n";
const std::string kWhole = kHead + kCamera + kCalibration + kMarker + kTrack + kClip;

std::string with(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

}  // namespace

TEST_CASE("a whole experiment.toml is read with its units converted and its files sorted") {
  const Folder folder;
  const core::Experiment experiment = folder.read(
      kHead + "gravity_m_s2 = 9.81\n" + kCamera +
      "shutter = \"rolling\"\nline_readout_s = 1e-5\nfirst_row = \"bottom\"\nbit_depth = 12\ntime = "
      "\"container\"\n" +
      kCalibration + "[plumb]\nview = \"plumb.png\"\nregion = [40, 0, 120, 500]\n" + kMarker +
      "height_m = 0.03\ncolor = \"#10f0A0\"\nstart_px = [400, 120.5]\n" + kTrack + "length_m = 2.0\n" + kClip +
      "incline_sd_deg = 0.3\nmass_sd_kg = 0.0005\nstart_s = 0.1\nend_s = 1.8\nstart_px = [7, 8.5]\ngroup = \"flat\"\n" +
      "[[clip]]\nname = \"b\"\nfile = \"clips/frames\"\nmass_kg = 1\nincline_deg = 0\nlaunched = \"released\"\n" +
      "[[group]]\nname = \"flat\"\nplane = \"calibration/plane-flat.png\"\ndownhill = \"+X\"\n"
      "plumb = { view = \"plumb.png\", region = [1, 2, 3, 4] }\n[extra]\nanything = { goes = true }\n");
  CHECK(experiment.name == "test");
  CHECK(experiment.gravity_m_s2 == 9.81);
  REQUIRE(experiment.camera);
  CHECK(experiment.camera->frame_rate_hz == 200.0);
  CHECK(experiment.camera->shutter == core::Shutter::rolling);
  CHECK(experiment.camera->line_readout_s == 1e-5);
  CHECK(experiment.camera->bottom_row_first);
  CHECK(experiment.camera->bit_depth == 12);
  CHECK(experiment.camera->time == core::TimeSource::container);
  REQUIRE(experiment.calibration);
  CHECK(experiment.calibration->inner_corners == core::BoardSize{9, 6});
  REQUIRE(experiment.calibration->views.size() == 3);
  CHECK(experiment.calibration->views[0] == folder.dir / "calibration/view-00.png");
  CHECK(experiment.calibration->views[2] == folder.dir / "calibration/view-02.png");
  CHECK(experiment.calibration->planes == std::vector<fs::path>{folder.dir / "calibration/plane.png"});
  REQUIRE(experiment.plumb);
  CHECK(experiment.plumb->region == core::PixelRegion{40, 0, 120, 500});
  REQUIRE(experiment.marker);
  CHECK(experiment.marker->height_m == 0.03);
  CHECK(experiment.marker->color_bgr == std::array<unsigned char, 3>{0xa0, 0xf0, 0x10});
  CHECK(experiment.marker->start_px == core::PixelPoint{400.0, 120.5});
  CHECK(experiment.track.downhill == core::Downhill::minus_x);
  CHECK(experiment.track.length_m == 2.0);
  REQUIRE(experiment.clips.size() == 2);
  const core::ClipSetup& clip = experiment.clips[0];
  CHECK(clip.launched == core::Launched::up);
  CHECK(std::abs(clip.incline_rad - 4.0 * std::numbers::pi / 180.0) < 1e-15);
  CHECK(std::abs(*clip.incline_sd_rad - 0.3 * std::numbers::pi / 180.0) < 1e-15);
  CHECK(clip.mass_sd_kg == 0.0005);
  CHECK(clip.start_px == core::PixelPoint{7.0, 8.5});
  CHECK(core::marker_in(experiment, clip).start_px == core::PixelPoint{7.0, 8.5});
  CHECK(core::marker_in(experiment, experiment.clips[1]).start_px == core::PixelPoint{400.0, 120.5});
  CHECK(clip.group == "flat");
  CHECK(experiment.clips[1].group == "0 deg");
  CHECK(experiment.clips[1].file == folder.dir / "clips/frames");
  REQUIRE(experiment.groups.size() == 1);
  CHECK(experiment.groups[0].downhill == core::Downhill::plus_x);
  CHECK(experiment.groups[0].plumb->region == core::PixelRegion{1, 2, 3, 4});
  CHECK(experiment.groups[0].planes.size() == 1);
}

TEST_CASE("the uncertainty of gravity is that stated, otherwise that of its digits, and needs a gravity") {
  const Folder folder;
  const auto sd_of = [&](const std::string& lines) {
    return folder.read(kHead + lines + kCamera + kCalibration + kMarker + kTrack + kClip).gravity_sd_m_s2;
  };
  CHECK(sd_of("") == 0.015);
  CHECK(sd_of("gravity_m_s2 = 9.8\n") == 0.015);
  CHECK(sd_of("gravity_m_s2 = 9.82\n") == Approx(0.01 / std::sqrt(12.0)).epsilon(1e-12));
  CHECK(sd_of("gravity_m_s2 = 9.81\ngravity_sd_m_s2 = 0.0002\n") == 0.0002);
  CHECK(sd_of("gravity_m_s2 = 9.81\ngravity_sd_m_s2 = 0\n") == 0.0);
  CHECK_THROWS_WITH(sd_of("gravity_sd_m_s2 = 0.01\n"), Contains("gravity_sd_m_s2") && Contains("gravity_m_s2, whose"));
  CHECK_THROWS_WITH(sd_of("gravity_m_s2 = 9.81\ngravity_sd_m_s2 = -0.01\n"), Contains("gravity_sd_m_s2"));
}

TEST_CASE("what may be left out has the contract's defaults") {
  const Folder folder;
  const core::Experiment experiment = folder.read(kWhole);
  CHECK(experiment.gravity_m_s2 == 9.80665);
  CHECK(experiment.gravity_sd_m_s2 == 0.015);
  CHECK(experiment.camera->shutter == core::Shutter::global);
  CHECK(experiment.camera->bit_depth == 8);
  CHECK(experiment.camera->time == core::TimeSource::rate);
  CHECK(experiment.marker->height_m == 0.0);
  CHECK(experiment.clips[0].mass_sd_kg == 0.0);
  CHECK_FALSE(experiment.clips[0].incline_sd_rad);
  CHECK(experiment.clips[0].group == "all");
}

TEST_CASE("downhill may lie along the image's y where a scale stands for a pattern") {
  const Folder folder;
  const std::string scale = "[scale]\npx_per_m = 480.0\n";
  const auto read = [&](const std::string& downhill) {
    return folder.read(kHead + kCamera + scale + kMarker + "[track]\ndownhill = \"" + downhill + "\"\n" + kClip);
  };
  CHECK(read("+Y").track.downhill == core::Downhill::plus_y);
  CHECK(read("-Y").track.downhill == core::Downhill::minus_y);
  CHECK(read("+X").track.downhill == core::Downhill::plus_x);
  // A group of its own, and a track beside filmed clips of a pattern.
  const core::Experiment own = folder.read(kHead + kCamera + scale + kMarker + kTrack + kClip +
                                           "[[group]]\nname = \"all\"\ndownhill = \"+Y\"\n");
  CHECK(core::downhill_of(own, "all") == core::Downhill::plus_y);
  CHECK(core::downhill_of(own, "other") == core::Downhill::minus_x);
}

TEST_CASE("a folder of tracks needs neither camera, calibration nor marker") {
  const Folder folder;
  const core::Experiment experiment =
      folder.read(kHead + kTrack + with(kClip, "file = \"clips/a.mkv\"", "track = \"track.csv\""));
  CHECK_FALSE(experiment.camera);
  CHECK(experiment.clips[0].file.empty());
  CHECK(experiment.clips[0].track == folder.dir / "track.csv");
}

TEST_CASE("a folder of tracks needs no table of the track: x is then positive downhill") {
  const Folder folder;
  const std::string track = with(kClip, "file = \"clips/a.mkv\"", "track = \"track.csv\"");
  CHECK_FALSE(folder.read(kHead + track).track.downhill);
  CHECK_FALSE(folder.read(kHead + track + "[[group]]\nname = \"all\"\n").track.downhill);
  CHECK_FALSE(folder.read(kHead + track + "[track]\nlength_m = 2.0\n").track.downhill);
  CHECK(contains(folder.message(kHead + kCamera + kCalibration + kMarker + kClip), "track: found nothing"));
}

TEST_CASE("a folder of tracks says what measured them") {
  const Folder folder;
  const auto recorder = [&](const std::string& line) {
    return folder
        .read("format = 1\nname = \"t\"\n" + line + with(kClip, "file = \"clips/a.mkv\"", "track = \"track.csv\""))
        .clips.front()
        .recorded_by;
  };
  CHECK(recorder("") == core::RecordedBy::unstated);
  CHECK(recorder("recorded_by = \"sensor\"\n") == core::RecordedBy::sensor);
  CHECK(recorder("recorded_by = \"camera\"\n") == core::RecordedBy::camera);
}

TEST_CASE("a table of lines needs no clips") {
  const Folder folder;
  CHECK(folder.read(kHead + "lines = \"lines.csv\"\n").lines == folder.dir / "lines.csv");
  CHECK(contains(folder.message(kHead + "lines = \"none.csv\"\n"), "experiment.toml:3: lines: found no file none.csv"));
  CHECK(contains(folder.message(kHead + "lines = \"lines.csv\"\n" + kCamera + kCalibration + kMarker + kTrack + kClip),
                 "experiment.toml:3: lines: found a table of lines and [[clip]]"));
  CHECK(contains(folder.message(kHead), "clip: found nothing"));
}

TEST_CASE("a scale is stated or follows from two points a known length apart") {
  const Folder folder;
  const std::string rest = kHead + kCamera + kMarker + kTrack + kClip;
  const auto stated = folder.read(rest + "[scale]\npx_per_m = 480\npx_per_m_sd = 40\n");
  CHECK(stated.scale->px_per_m == 480.0);
  CHECK(stated.scale->px_per_m_sd == 40.0);
  // 300, 400 -> 500 px for 0.5 m; one pixel at each end is sqrt(2) px of the length, so sqrt(2)/0.5 px/m.
  const auto measured = folder.read(rest + "[scale]\nfrom_px = [10, 20]\nto_px = [310, 420]\nlength_m = 0.5\n");
  CHECK(std::abs(measured.scale->px_per_m - 1000.0) < 1e-9);
  CHECK(std::abs(measured.scale->px_per_m_sd - std::numbers::sqrt2 / 0.5) < 1e-12);
  CHECK(
      contains(folder.message(rest + "[scale]\npx_per_m = 480\nfrom_px = [10, 20]\nto_px = [310, 420]\nlength_m = 1\n"),
               "experiment.toml:17: scale.px_per_m"));
  CHECK(contains(folder.message(rest + "[scale]\nfrom_px = [10, 20]\nto_px = [10, 20]\nlength_m = 1\n"),
                 "experiment.toml:18: scale.to_px: found the same point"));
  CHECK(contains(folder.message(kWhole + "[scale]\npx_per_m = 480\n"),
                 "scale: found a table [scale] and a table [calibration]"));
}

TEST_CASE("groups default to one for each stated inclination") {
  const Folder folder;
  const std::string second = with(with(kClip, "\"a\"", "\"b\""), "incline_deg = 4.0", "incline_deg = 0.0");
  const auto experiment = folder.read(kWhole + second);
  CHECK(experiment.clips[0].group == "4 deg");
  CHECK(experiment.clips[1].group == "0 deg");
}

TEST_CASE("planes and downhill may come from every group instead") {
  const Folder folder;
  const std::string text =
      kHead + kCamera + with(kCalibration, "plane = \"calibration/plane.png\"\n", "") + kMarker + kClip;
  const std::string group = "[[group]]\nname = \"all\"\nplane = \"calibration/plane-flat.png\"\ndownhill = \"+X\"\n";
  CHECK(folder.read(text + group).groups.size() == 1);
  const std::string message = folder.message(text);
  CHECK(contains(message, "calibration.plane: found nothing"));
  CHECK(contains(message, "track: found nothing"));
}

TEST_CASE("each wrong key of experiment.toml is named with its line, what was found and what is allowed") {
  struct Wrong {
    const char* what;
    const char* by;
    const char* message;  // follows "experiment.toml:"
  };
  const char* const kUp = "launched = \"up\"";
  const Wrong wrongs[] = {
      {"format = 1", "format = 2", "1: format: found 2"},
      {"name = \"test\"", "nam = \"test\"",
       "2: nam: found an unknown key, expected a known key; did you mean \"name\"?"},
      {"name = \"test\"", "name = 3", "2: name: found 3, expected a string"},
      {"name = \"test\"", "name = \"test\"\nrecorded_by = \"sonar\"", "3: recorded_by: found text \"sonar\""},
      {"name = \"test\"", "name = \"test\"\nrecorded_by = \"sensor\"",
       "3: recorded_by: found \"sensor\" with clip \"a\", which has images"},
      {"frame_rate_hz = 200.0", "frame_rate_hz = 0", "4: camera.frame_rate_hz: found 0, expected a number above 0"},
      {"frame_rate_hz = 200.0", "frame_rate_hz = nan", "4: camera.frame_rate_hz: found nan"},
      {"frame_rate_hz = 200.0", "frame_rate_hz = \"200\"", "4: camera.frame_rate_hz: found text \"200\""},
      {"frame_rate_hz = 200.0", "", "3: camera.frame_rate_hz: found nothing"},
      {"exposure_s = 0.001", "exposure_ms = 1", "5: camera.exposure_ms: found an unknown key"},
      {"exposure_s = 0.001", "exposure_s = 0.006", "5: camera.exposure_s: found 0.006, expected at most"},
      {"exposure_s = 0.001", "shutter = \"roling\"", "5: camera.shutter"},
      {"exposure_s = 0.001", "shutter = \"rolling\"", "3: camera.line_readout_s: found nothing"},
      {"exposure_s = 0.001", "first_row = \"bottom\"", "5: camera.first_row: found \"bottom\" with a global shutter"},
      {"exposure_s = 0.001", "line_readout_s = 1e-5", "5: camera.line_readout_s: found 1e-05 with a global shutter"},
      {"exposure_s = 0.001", "bit_depth = 17", "5: camera.bit_depth: found 17, expected a whole number from 8 to 16"},
      {"exposure_s = 0.001", "time = \"file\"", "5: camera.time"},
      {"\"chessboard\"", "\"dots\"", "7: calibration.pattern: found text \"dots\""},
      {"[9, 6]", "[9]", "8: calibration.inner_corners: found an array of 1"},
      {"[9, 6]", "[9, 2]", "8: calibration.inner_corners: found 2"},
      {"[9, 6]", "[9, 6.5]", "8: calibration.inner_corners: found [9, 6.5], expected two whole numbers"},
      {"square_m = 0.04", "square_m = -0.04", "9: calibration.square_m: found -0.04"},
      {"/view-*", "/shot-*", "10: calibration.views: found no file calibration/shot-*.png"},
      {"calibration/plane.png", "plane.png", "11: calibration.plane: found no file plane.png"},
      {"diameter_m = 0.02", "diameter_m = 0", "13: marker.diameter_m: found 0"},
      {"diameter_m = 0.02", "diameter_m = 0.02\ncolor = \"green\"", "14: marker.color: found text \"green\""},
      {"diameter_m = 0.02", "diameter_m = 0.02\nstart_px = [1, -2]", "14: marker.start_px: found -2"},
      {"\"-X\"", "\"x\"", "15: track.downhill"},
      {"\"-X\"", "\"+Y\"", "15: track.downhill: found \"+Y\" for clip \"a\", which is calibrated by a pattern"},
      {"name = \"a\"", "name = \"a/b\"", "17: clip[1].name"},
      {"clips/a.mkv", "clips/c.mkv", "18: clip[1].file: found no file clips/c.mkv"},
      {"mass_kg", "track = \"track.csv\"\nmass_kg", "19: clip[1].track: found a track and a file"},
      {"file = \"clips/a.mkv\"", "track = \"no.csv\"", "18: clip[1].track: found no file no.csv"},
      {"file = \"clips/a.mkv\"", "", "16: clip[1].file: found nothing"},
      {"file = \"clips/a.mkv\"", "track = \"track.csv\"\nstart_px = [1, 2]",
       "19: clip[1].start_px: found a place in an image"},
      {"mass_kg = 0.335", "mass_kg = 0.335\nstart_px = [1, -2]", "20: clip[1].start_px: found -2"},
      {"mass_kg = 0.335", "mass_kg = 0", "19: clip[1].mass_kg: found 0"},
      {"mass_kg = 0.335", "mass_kg = inf", "19: clip[1].mass_kg: found inf"},
      {"incline_deg = 4.0", "incline_deg = 90.5", "20: clip[1].incline_deg: found 90.5"},
      {"incline_deg = 4.0", "incline_deg = 4.0\nincline_sd_deg = -1", "21: clip[1].incline_sd_deg: found -1"},
      {kUp, "launched = \"left\"", "21: clip[1].launched"},
      {kUp, "launched = \"up\"\nstart_s = 2\nend_s = 2",
       "23: clip[1].end_s: found 2, expected a time after start_s = 2"},
      {kUp, "launched = \"up\"\n[[group]]\nname = \"steep\"",
       "23: group[1].name: found text \"steep\", a group without a clip"},
      {kUp, "launched = \"up\"\n[plumb]\nview = \"no.png\"\nregion = [0, 0, 9, 9]",
       "23: plumb.view: found no file no.png"},
      {kUp, "launched = \"up\"\n[plumb]\nview = \"plumb.png\"\nregion = [0, 0, 9]",
       "24: plumb.region: found an array of 3"},
      {kUp, "launched = \"up\"\n[plumb]\nview = \"plumb.png\"\nregion = [0, 0, 2, 9]",
       "24: plumb.region: found 2 x 9 pixels"},
  };
  const Folder folder;
  REQUIRE(folder.message(kWhole).empty());
  for (const Wrong& wrong : wrongs) {
    const std::string message = folder.message(with(kWhole, wrong.what, wrong.by));
    INFO(wrong.by << "\n" << message);
    CHECK(contains(message, std::string("experiment.toml:") + wrong.message));
  }
}

TEST_CASE("sections that a clip made of images needs are asked for") {
  const Folder folder;
  const std::string message = folder.message(kHead + kTrack + kClip);
  CHECK(contains(message, "camera: found nothing, expected a table [camera], for clip \"a\""));
  CHECK(contains(message, "marker: found nothing"));
  CHECK(contains(message, "calibration: found nothing, expected a table [calibration] or [scale]"));
}

TEST_CASE("a clip's name that is used twice is an error") {
  const Folder folder;
  CHECK(contains(folder.message(kWhole + kClip), "experiment.toml:23: clip[2].name: found text \"a\" a second time"));
}

TEST_CASE("no folder, another folder, a file in place of it: each is told with what is wanted") {
  const Folder folder;
  const auto message = [](const fs::path& path) {
    try {
      core::read_experiment(path);
    } catch (const base::InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string wanted = "expected a folder with an experiment.toml (glidelab new";
  CHECK(contains(message(folder.dir / "nowhere"), "nowhere: found no file or folder of this name, " + wanted));
  CHECK(contains(message(folder.dir / "clips"), "clips: found a folder without experiment.toml, " + wanted));
  CHECK(contains(message(folder.dir / "clips/a.mkv"), "a.mkv: found a file, " + wanted));
  base::write_file(folder.dir / "experiment.toml", "");
  CHECK(contains(message(folder.dir / "experiment.toml"),
                 "experiment.toml: found a file, expected the folder that it is in, " + folder.dir.path().string()));
}

TEST_CASE("an experiment.toml that is no TOML is an error that names the line") {
  const Folder folder;
  CHECK(contains(folder.message("format = 1\nname = \n"), "experiment.toml:2: column"));
}

TEST_CASE("names that leave the folder are refused with the option that permits them, and followed where it is given") {
  const Folder folder;
  const TempDir elsewhere;
  base::write_file(elsewhere / "other.csv", "");
  const std::string up = fs::relative(elsewhere.path(), folder.dir.path()).string();
  const auto track = [](const std::string& name) {
    return kHead + kTrack + "[[clip]]\nname = \"a\"\ntrack = \"" + name +
           "\"\nmass_kg = 1\nincline_deg = 0\nlaunched = \"up\"\n";
  };
  const std::string outside[] = {
      track((elsewhere / "other.csv").string()),
      track(up + "/other.csv"),
      track("clips/../" + up + "/other.csv"),
      kHead + "lines = \"" + up + "/other.csv\"\n" + kTrack,
  };
  for (const std::string& text : outside) {
    const std::string message = folder.message(text);
    INFO(message);
    CHECK(contains(message, "experiment.toml:"));
    CHECK(contains(message, "outside the folder"));
    CHECK(contains(message, "--allow-outside"));
    CHECK_NOTHROW(core::read_experiment(folder.dir.path(), {.outside = core::OutsideFiles::allowed}));
  }
  CHECK(contains(folder.message(with(kWhole, "clips/a.mkv", "..")), "outside the folder"));
  CHECK(contains(folder.message(with(kWhole, "calibration/view-*.png", up + "/*")), "outside the folder"));
  CHECK(contains(folder.message(with(kWhole, "calibration/plane.png", "/*/*")), "outside the folder"));
  CHECK(contains(folder.message(with(kWhole, "clips/a.mkv", "clips/a.mkv\\u0000.png")), "zero byte"));
}

TEST_CASE("a detour within the folder and a link that its owner put there are followed") {
  const Folder folder;
  const TempDir elsewhere;
  base::write_file(elsewhere / "c.mkv", "");
  CHECK(folder.read(with(kWhole, "clips/a.mkv", "clips/../clips/./b.mkv")).clips[0].file == folder.dir / "clips/b.mkv");
  fs::create_symlink(elsewhere.path(), folder.dir / "card");
  CHECK(folder.read(with(kWhole, "clips/a.mkv", "card/c.mkv")).clips[0].file == folder.dir / "card/c.mkv");
  // Beside the link, not beside what it leads to.
  CHECK(contains(folder.message(with(kWhole, "clips/a.mkv", "card/../c.mkv")), "no file c.mkv"));
}

TEST_CASE("wildcards match within one part of a path and results are sorted") {
  const Folder folder;
  CHECK(core::files_matching(folder.dir.path(), "*/view-0?.png").size() == 3);
  CHECK(core::files_matching(folder.dir.path(), "calibration/view-0[01].png").size() == 2);
  CHECK(core::files_matching(folder.dir.path(), "*.png") == std::vector<fs::path>{folder.dir / "plumb.png"});
  CHECK(core::files_matching(folder.dir.path(), "no/*.png").empty());
}
