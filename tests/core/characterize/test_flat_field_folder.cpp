#include "core/characterize/flat_field_folder.h"

#include "base/errors.h"
#include "core/characterize/photon_transfer.h"
#include "tests/catch.h"
#include "tests/core/flat_fields.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using namespace glidelab::tests;
namespace fs = std::filesystem;

namespace {

/// A good folder of three levels, to be spoilt.
struct Folder {
  TempDir dir;
  Folder() {
    TrueCamera camera;
    camera.width = 64;
    camera.height = 64;
    FlatFieldCamera source(camera, 1);
    FlatFieldPlan plan;
    plan.light_e = {1000.0, 3000.0, 5000.0};
    plan.dark_frames = 2;
    write_flat_fields(dir.path(), source, plan);
  }
  /// The message, without the folder's own path; empty where nothing is wrong.
  std::string message() const {
    try {
      core::measure_camera(core::read_flat_field_folder(dir.path()), base::no_progress);
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
  void settings(const std::string& text) const { base::write_file(dir / "characterize.toml", text); }
  void image(const std::string& name, int width, int height, int type, double value) const {
    write_png(dir / name, cv::Mat(height, width, type, cv::Scalar::all(value)));
  }
};

void check(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    INFO(message);
    CHECK(message.find(part) != std::string::npos);
  }
}

}  // namespace

TEST_CASE("a good flat-field folder is read with its sets in order and its exposures") {
  const Folder folder;
  fs::copy(folder.dir / "dark", folder.dir / "dark-10ms");
  folder.settings(
      "format = 1\nname = \"x\"\nbit_depth = 12\nexposure_s = 0.001\nframe_rate_hz = 200\npixel_pitch_m = 3.45e-6\n"
      "price_class = \"500 EUR\"\n[exposures_s]\ndark-10ms = 0.01\nflat-02 = 0.002\n[extra]\nlamp = \"LED\"\n");
  const core::FlatFieldFolder read = core::read_flat_field_folder(folder.dir.path());
  CHECK(read.name == "x");
  CHECK(read.largest_code() == 4095);
  REQUIRE(read.darks.size() == 2);
  CHECK(read.darks[0].name == "dark");
  CHECK(read.darks[0].exposure_s == 0.001);
  CHECK(read.darks[1].exposure_s == 0.01);
  REQUIRE(read.flats.size() == 3);
  CHECK(read.flats[0].exposure_s == 0.001);
  CHECK(read.flats[2].exposure_s == 0.002);
  CHECK(read.flats[2].files.size() == 2);
  CHECK(read.frame_rate_hz == 200.0);
  CHECK(read.pixel_pitch_m == 3.45e-6);
  CHECK(read.price_class == "500 EUR");
  CHECK(folder.message().empty());
}

TEST_CASE("wrong keys in characterize.toml are named with their lines") {
  const Folder folder;
  SECTION("missing, misspelt, out of range, of another type") {
    folder.settings("format = 1\nbit_dept = 12\nframe_rate_hz = -1\nexposure_s = \"1 ms\"\n");
    check(folder.message(), {"characterize.toml:2: bit_dept", "did you mean \"bit_depth\"", "name: found nothing",
                             "characterize.toml:3: frame_rate_hz", "characterize.toml:4: exposure_s"});
  }
  SECTION("an exposure of a set that is not there") {
    folder.settings("format = 1\nname = \"x\"\nbit_depth = 12\n[exposures_s]\nflat-07 = 0.1\n");
    check(folder.message(), {"characterize.toml:5: exposures_s.flat-07", "unknown key"});
  }
  SECTION("no TOML") {
    folder.settings("format = = 1\n");
    check(folder.message(), {"characterize.toml:1", "no valid TOML"});
  }
  SECTION("no file") {
    fs::remove(folder.dir / "characterize.toml");
    check(folder.message(), {"characterize.toml"});
  }
  SECTION("dark sets without exposures") {
    folder.settings("format = 1\nname = \"x\"\nbit_depth = 12\n");
    fs::copy(folder.dir / "dark", folder.dir / "dark-long");
    check(folder.message(), {"exposures_s", "no exposure of dark-long"});
  }
}

TEST_CASE("sets that are missing or too small are named, all at once") {
  const Folder folder;
  SECTION("no dark frames, and a single flat frame") {
    fs::remove_all(folder.dir / "dark");
    fs::remove(folder.dir / "flat-01" / "001.png");
    check(folder.message(), {"dark: found no such folder, expected dark frames", "flat-01: found a single PNG frame"});
  }
  SECTION("one level") {
    fs::remove_all(folder.dir / "flat-00");
    fs::remove_all(folder.dir / "flat-01");
    check(folder.message(), {"1 folder flat-…", "at least two levels"});
  }
  SECTION("a set without frames, and one of another format") {
    fs::remove(folder.dir / "flat-00" / "000.png");
    fs::rename(folder.dir / "flat-00" / "001.png", folder.dir / "flat-00" / "001.jpg");
    check(folder.message(), {"flat-00: found no PNG frame", "001.jpg: found a file .jpg"});
  }
  SECTION("a folder whose name is nearly right") {
    fs::rename(folder.dir / "flat-01", folder.dir / "flats-01");
    check(folder.message(), {"flats-01", "dark, dark-… or flat-…"});
  }
  SECTION("no folder at all") {
    CHECK_THROWS_AS(core::read_flat_field_folder(folder.dir / "none"), base::InputError);
  }
}

TEST_CASE("frames that cannot be used are named, with what was expected") {
  const Folder folder;
  SECTION("another size") {
    folder.image("flat-01/001.png", 65, 64, CV_16U, 500);
    check(folder.message(), {"flat-01/001.png: found 65 x 64 pixels, expected 64 x 64 pixels, as dark/000.png"});
  }
  SECTION("another depth") {
    folder.image("flat-01/001.png", 64, 64, CV_8U, 200);
    check(folder.message(), {"flat-01/001.png: found 8 bits, expected 16 bits, as dark/000.png"});
  }
  SECTION("8 bits for codes of 12") {
    for (const char* name : {"dark/000.png", "dark/001.png"}) folder.image(name, 64, 64, CV_8U, 20);
    check(folder.message(), {"dark/000.png: found an image of 8 bits", "bit_depth = 12"});
  }
  SECTION("no image") {
    base::write_file(folder.dir / "flat-02" / "000.png", "no picture");
    check(folder.message(), {"flat-02/000.png", "no image that can be decoded"});
  }
  SECTION("an empty file") {
    base::write_file(folder.dir / "dark" / "001.png", "");
    check(folder.message(), {"dark/001.png: found an empty file"});
  }
  SECTION("colours") {
    cv::Mat colors(64, 64, CV_16UC3, cv::Scalar(100, 200, 300));
    write_png(folder.dir / "flat-00/000.png", colors);
    check(folder.message(), {"flat-00/000.png: found an image with colours, expected a grey image"});
  }
  SECTION("codes above the largest") {
    folder.image("flat-02/000.png", 64, 64, CV_16U, 65520);
    check(folder.message(), {"flat-02/000.png: found a code of 65520, expected codes up to 4095"});
  }
  SECTION("the same frame twice") {
    fs::copy_file(folder.dir / "flat-01/000.png", folder.dir / "flat-01/001.png", fs::copy_options::overwrite_existing);
    check(folder.message(), {"flat-01/001.png: found the same image as 000.png"});
  }
  SECTION("too small") {
    for (const char* name : {"dark/000.png", "dark/001.png"}) folder.image(name, 32, 32, CV_16U, 64);
    check(folder.message(), {"dark/000.png: found 32 x 32 pixels, expected at least 64 x 64 pixels"});
  }
}

TEST_CASE("flat fields without light, or all saturated, are refused") {
  const Folder folder;
  const bool dark = GENERATE(true, false);
  for (const char* set : {"flat-00", "flat-01", "flat-02"}) {
    for (const char* name : {"000.png", "001.png"}) {
      const std::string file = std::string(set) + "/" + name;
      if (dark) {
        fs::copy_file(folder.dir / "dark" / name, folder.dir / file, fs::copy_options::overwrite_existing);
      } else {
        folder.image(file, 64, 64, CV_16U, 4095);
      }
    }
  }
  check(folder.message(), dark ? std::vector<std::string>{"no light: the brightest level is"}
                               : std::vector<std::string>{"all levels saturated", "code 4095"});
}
