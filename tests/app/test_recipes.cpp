/// The recipes of docs/extending.md, followed with the toys of tests/recipes in a copy of the rooms that they need:
/// with all steps the toy is known and gives its closed form, and a step that is left out is answered with the toy's
/// name.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <string>
#include <vector>

#include "base/files/file_io.h"
#include "test_paths.h"
#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

constexpr const char* kBuildOfCopy = R"(cmake_minimum_required(VERSION 3.25)
project(recipe LANGUAGES CXX)
include(cmake/Room.cmake)
add_subdirectory(base)
{}
set_source_files_properties({} TARGET_DIRECTORY {} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
find_package(Catch2 REQUIRED)
file(WRITE ${{CMAKE_BINARY_DIR}}/test_paths.h "#pragma once
namespace glidelab::tests {{
inline constexpr const char* kSourceDir = \"${{CMAKE_SOURCE_DIR}}\";
}}
")
file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${{CMAKE_SOURCE_DIR}}/tests/*.cpp)
add_executable(driver ${{sources}})
target_include_directories(driver PRIVATE ${{CMAKE_SOURCE_DIR}} ${{CMAKE_BINARY_DIR}})
target_link_libraries(driver PRIVATE {} Catch2::Catch2)
)";

/// A tree with some of the folders and files, a program `driver` of the tests among them, and one build folder.
class Copy {
 public:
  /// `rooms` are lines of CMake that make the target `room`, which the driver links to. `toy` is the source that a
  /// recipe adds, compiled apart from its folder.
  Copy(std::vector<std::string> paths, const std::string& rooms, const std::string& room, const std::string& toy)
      : toy_(toy) {
    paths.insert(paths.end(), {"base", "cmake", "tests/test_main.cpp", "tests/catch.h"});
    for (const std::string& path : paths) take(path, path);
    base::write_file(temp_ / "CMakeLists.txt",
                     fmt::format(kBuildOfCopy, rooms, (temp_ / toy).string(), "glidelab_" + room, "glidelab_" + room));
    const tests::ProcessResult configured =
        tests::run({"cmake", "-S", (temp_ / ".").string(), "-B", (temp_ / "build").string(), "-G", "Ninja",
                    "-DCMAKE_BUILD_TYPE=Debug", "-DGLIDELAB_WERROR=ON"});
    INFO(configured.out << configured.err);
    REQUIRE(configured.status == 0);
  }

  /// Puts a file or folder of the source tree into the copy.
  void take(const std::string& from, const std::string& to) {
    fs::create_directories((temp_ / to).parent_path());
    fs::copy(fs::path(tests::kSourceDir) / from, temp_ / to, fs::copy_options::recursive);
  }

  void remove(const std::string& path) { REQUIRE(fs::remove(temp_ / path)); }

  /// Where `from` stands first.
  void replace(const std::string& path, const std::string& from, const std::string& to) {
    std::string text = base::read_file(temp_ / path);
    const std::size_t at = text.find(from);
    INFO(path << ": " << from);
    REQUIRE(at != std::string::npos);
    base::write_file(temp_ / path, text.replace(at, from.size(), to));
  }

  void add_line_before(const std::string& path, const std::string& next, const std::string& line) {
    replace(path, next, line + "\n" + next);
  }

  void remove_line(const std::string& path, const std::string& line) { replace(path, line + "\n", ""); }

  /// Builds the driver, and its tests of these names pass; all of them without names.
  void check_passes(const std::string& chosen = "") {
    const tests::ProcessResult built = build();
    INFO(built.out << built.err);
    REQUIRE(built.status == 0);
    const tests::ProcessResult tested = test(chosen);
    INFO(tested.out << tested.err);
    CHECK(tested.status == 0);
    CHECK(tested.out.find("All tests passed") != std::string::npos);
  }

  /// The toy does not compile with `to` where `from` stands first; the file is put back.
  void check_does_not_compile(const std::string& path, const std::string& from, const std::string& to,
                              const std::string& named) {
    const std::string kept = base::read_file(temp_ / path);
    const fs::file_time_type kept_time = fs::last_write_time(temp_ / path);
    replace(path, from, to);
    check_says(tests::run({"ninja", "-C", (temp_ / "build").string(), (temp_ / toy_).string() + "^"}), named);
    base::write_file(temp_ / path, kept);
    fs::last_write_time(temp_ / path, kept_time);  // nothing else was built of it
  }

  void check_does_not_build(const std::string& named) { check_says(build(), named); }

  void check_test_fails(const std::string& named, const std::string& chosen = "") {
    const tests::ProcessResult built = build();
    INFO(built.out << built.err);
    REQUIRE(built.status == 0);
    const tests::ProcessResult tested = test(chosen);
    INFO(tested.out << tested.err);
    CHECK(tested.status != 0);
    CHECK(tested.out.find("FAILED") != std::string::npos);
    CHECK(tested.out.find(named) != std::string::npos);
  }

 private:
  static void check_says(const tests::ProcessResult& built, const std::string& named) {
    INFO(built.out << built.err);
    CHECK(built.status != 0);
    CHECK(built.out.find("error") != std::string::npos);
    CHECK(built.out.find(named) != std::string::npos);
  }
  tests::ProcessResult build() const { return tests::run({"cmake", "--build", (temp_ / "build").string(), "-j", "2"}); }
  tests::ProcessResult test(const std::string& chosen) const {
    std::vector<std::string> command = {(temp_ / "build/driver").string()};
    if (!chosen.empty()) command.push_back(chosen);
    return tests::run(command);
  }

  tests::TempDir temp_;
  std::string toy_;
};

}  // namespace

TEST_CASE("the recipe of a force law: all its steps make one, and each step that is left out is named", "[slow]") {
  Copy copy({"sim", "tests/sim/bodies.h", "tests/sim/force/test_law_list.cpp", "docs/reference/scenario.md"},
            "add_subdirectory(sim)", "sim", "sim/force/laws/toy_law.cpp");
  const std::string law = "sim/force/laws/toy_law.cpp", list = "sim/force/law_list.h";
  const std::string line = "  LAW(toy) \\", page = "docs/reference/scenario.md";
  const std::string row = "| `toy` | -c v abs(v) log(1 + abs(v)/v_0) | `c_kg_m`, at least 0; `v_0_m_s`, above 0 | – |";
  copy.take("tests/recipes/force_law/toy_law.cpp", law);
  copy.add_line_before(list, "  LAW(constant)", line);
  copy.add_line_before(page, "| `constant` |", row);
  copy.take("tests/recipes/force_law/test_toy_law.cpp", "tests/sim/force/laws/test_toy_law.cpp");
  copy.check_passes();

  copy.remove_line(page, row);
  copy.check_test_fails("\n  toy\n");
  copy.add_line_before(page, "| `constant` |", row);

  const std::string slope = "double slope_n_s_m(double v_m_s, int direction, const Contact&) const override";
  copy.check_does_not_compile(law, slope, "double other(double v_m_s, int direction, const Contact&) const",
                              "slope_n_s_m");
  copy.check_does_not_compile(list, line + "\n", "", "laws::toy()");
  copy.remove(law);
  copy.check_does_not_build("laws::toy()");
}

TEST_CASE("the recipe of a bandwidth rule: all its steps make one, and each step that is left out is named", "[slow]") {
  Copy copy({"core/experiment", "core/math", "core/motion", "core/result", "core/track",
             "tests/core/motion/bandwidth/test_bandwidth_rule.cpp", "docs/guide/bandwidth.md"},
            "add_subdirectory(core/motion)", "motion", "core/motion/bandwidth/rule_toy.cpp");
  const std::string rule = "core/motion/bandwidth/rule_toy.cpp", list = "core/motion/bandwidth/bandwidth_rule.cpp";
  const std::string line = "  RULE(kToy) \\", page = "docs/guide/bandwidth.md";
  const std::string row = "| `toy` | the geometric mean of plug-in and ebbs | what these two assume | – |";
  // Not how near each rule comes to the best bandwidth, which takes minutes where nothing is optimised.
  const std::string chosen = "every rule states what it does and assumes*,the toy rule*,a motion that is too short*";
  copy.take("tests/recipes/bandwidth_rule/rule_toy.cpp", rule);
  copy.add_line_before(list, "  RULE(kIntersectionOfIntervals)", line);
  copy.add_line_before(page, "| `rsc` |", row);
  copy.take("tests/recipes/bandwidth_rule/test_rule_toy.cpp", "tests/core/motion/bandwidth/test_rule_toy.cpp");
  copy.check_passes(chosen);

  copy.remove_line(page, row);
  copy.check_test_fails("\n  toy\n", chosen);
  copy.add_line_before(page, "| `rsc` |", row);

  copy.check_does_not_compile(rule, "\"what these two assume\",", "", "between_two");

  copy.remove_line(list, line);
  copy.check_test_fails("\n  toy\n", chosen);
  copy.add_line_before(list, "  RULE(kIntersectionOfIntervals)", line);

  copy.remove(rule);
  copy.check_does_not_build("kToy");
}

TEST_CASE("the recipe of an effect: all its steps make one, and each step that is left out is named", "[slow]") {
  Copy copy({"diagnose/effects", "diagnose/model", "diagnose/result/gap_place.h", "diagnose/result/gap_place.cpp",
             "tests/diagnose/effects/test_effect_library.cpp", "docs/reference/effects.md"},
            "glidelab_room(effects FOLDERS diagnose LINK glidelab::base)", "effects",
            "diagnose/effects/force/toy_effect.cpp");
  const std::string effect = "diagnose/effects/force/toy_effect.cpp", list = "diagnose/effects/effect_list.h";
  const std::string next = "  EFFECT(smoothing_bias)", line = "  EFFECT(toy_effect) \\";
  const std::string page = "docs/reference/effects.md", next_row = "| `smoothing_bias` |";
  const std::string row = "| `toy_effect` | spring | a force -k x | `k_n_m` (0) | a range of x |";
  copy.take("tests/recipes/effect/toy_effect.cpp", effect);
  copy.add_line_before(list, next, line);
  copy.add_line_before(page, next_row, row);
  copy.take("tests/recipes/effect/test_toy_effect.cpp", "tests/diagnose/effects/force/test_toy_effect.cpp");
  copy.check_passes();

  copy.remove_line(page, row);
  copy.check_test_fails("\n  toy_effect\n");
  copy.add_line_before(page, next_row, row);

  copy.check_does_not_compile(effect, ".both_signs = false,", "", "both_signs");
  copy.check_does_not_compile(effect, ".drag = Drag::none,", "", "drag");
  copy.check_does_not_compile(list, line + "\n", "", "ids::toy_effect");
  copy.remove(effect);
  copy.check_does_not_build("effects::toy_effect()");
}

TEST_CASE("the recipe of a camera defect: all its steps make one, and each step that is left out is named", "[slow]") {
  Copy copy({"sim", "render", "tests/temp_dir.h", "tests/render/made_clip.h",
             "tests/render/scenario/test_scenario_sections.cpp", "docs/reference/scenario.md"},
            "add_subdirectory(sim)\nadd_subdirectory(render)", "render", "render/scenario/sections/dust_section.cpp");
  const std::string toy = "tests/recipes/camera_defect/", data = "render/scenario/scenario_data.h";
  const std::string section = "render/scenario/sections/dust_section.cpp", list = "render/scenario/scenario_sections.h";
  const std::string next = "  SECTION(vignetting)", line = "  SECTION(dust) \\", member = "  Dust dust;";
  const std::string page = "docs/reference/scenario.md", next_of_page = "[vignetting]   ";
  const std::string keys = "[dust]\nx_px = 0.0\ny_px = 0.0\nradius_px = 0.0\npasses = 1.0\n";
  copy.add_line_before(data, "#include \"render/sensor/sensor.h\"", "#include \"render/sensor/dust.h\"");
  copy.add_line_before(data, "  Vignetting vignetting;", member);
  copy.take(toy + "dust_section.cpp", section);
  copy.add_line_before(list, next, line);
  copy.take(toy + "dust.h", "render/sensor/dust.h");
  copy.take(toy + "dust.cpp", "render/sensor/dust.cpp");
  const std::string seen = "readout_.read(expected(frame, readout_.seen_by(rect)),";
  const std::string behind = "readout_.read(behind(scenario_.dust, expected(frame, readout_.seen_by(rect))),";
  copy.replace("render/film/clip_renderer.cpp", seen, behind);  // 8 bits, then 16
  copy.replace("render/film/clip_renderer.cpp", seen, behind);
  copy.add_line_before(page, next_of_page, keys);
  copy.take(toy + "test_dust.cpp", "tests/render/sensor/test_dust.cpp");
  copy.check_passes();

  copy.remove_line(page, keys);
  copy.check_test_fails("\"dust\"");
  copy.add_line_before(page, next_of_page, keys);

  copy.check_does_not_compile(section, "  .ideal = no_dust", "", "ideal");
  copy.check_does_not_compile(list, line + "\n", "", "sections::dust");
  copy.check_does_not_compile(data, member + "\n", "", "scenario.dust");

  copy.replace("render/film/clip_renderer.cpp", behind, seen);
  copy.check_test_fails("behind opaque dust");

  copy.remove(section);
  copy.check_does_not_build("sections::dust");
}
