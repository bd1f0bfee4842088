/// Who may include whom: CONVENTIONS.md's table of rooms, and no circles of folders or files, held against the includes
/// of every source; and core/ builds without the other rooms. test_house_rules.cpp has what holds of single files.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "test_paths.h"
#include "tests/app/run_process.h"
#include "tests/app/source_tree.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using tests::includes_of;
using tests::Source;
namespace fs = std::filesystem;

namespace {

/// What each room may include besides itself: rooms, or single headers of a room.
const std::map<std::string, std::set<std::string>> kAllowed = {
    {"base", {}},
    {"core", {"base"}},
    {"sim", {"base"}},
    {"render", {"base", "sim"}},
    {"fit", {"base", "core", "sim"}},
    {"diagnose", {"base", "core", "fit"}},
    {"validate", {"base", "core", "sim", "render", "fit", "diagnose"}},
    {"teach", {"base", "sim", "render", "report"}},
    {"report",
     {"base",
      "core/result/results.h",
      "core/result/quantity.h",
      "core/result/analysis_note.h",
      "core/result/uphill.h",
      "core/result/why_unknown.h",
      "fit/estimators.h",
      "fit/outside/outside_tally.h",
      "core/analysis/preview.h",
      "core/characterize/camera_measurement.h",
      "core/check/finding.h",
      "core/check/check_result.h",
      "validate/truth/comparison.h",
      "validate/study/sweep/sweep_summary.h",
      "validate/study/requirement/requirement.h",
      "validate/study/coverage/interval_coverage.h",
      "validate/study/certify/certificate.h",
      "validate/study/baseline/gate.h",
      "validate/blind/blind_score.h",
      "validate/blind/everyday_score.h",
      "validate/challenge/challenge_score.h",
      "diagnose/result/diagnosis.h",
      "diagnose/result/given_causes.h",
      "diagnose/result/next_step.h",
      "diagnose/result/note.h",
      "diagnose/result/image_fact.h",
      "diagnose/result/joined_ids.h",
      "diagnose/effects/effect_library.h",
      "diagnose/effects/effect_list.h",
      "validate/film/twin_motions.h",
      "sim/motion/simulate.h",
      "diagnose/next/plan.h"}},  // result types, the lists of estimators and effects, motions to draw
    {"app", {"base", "core", "sim", "render", "fit", "diagnose", "validate", "teach", "report"}},
    {"python", {"base", "core", "sim", "render", "fit", "diagnose", "validate", "teach", "report"}},
};

/// C libraries that live behind one file (a header and its source) of a room each, by how their headers start.
const std::map<std::string, std::vector<std::string>> kBehindOneFile = {
    {"OSMesa", {"GL/", "GLES", "osmesa"}},
    {"SUNDIALS", {"sundials/", "cvode/", "cvodes/", "nvector/", "sunmatrix/", "sunlinsol/", "sunnonlinsol/"}},
    {"libav", {"libavcodec/", "libavformat/", "libavutil/", "libswscale/"}},
    {"SQLite", {"sqlite3"}},
    {"Cairo", {"cairo"}},
};

/// Suites of one room that do not include each other.
const std::vector<std::pair<std::string, std::string>> kApart = {{"core/pictures/", "core/motion/"}};

/// Circles between folders that still stand; the list only shrinks.
const std::vector<std::string> kStandingCircles = {};

std::vector<Source> sources_of_rooms() {
  std::vector<std::string> rooms;
  for (const auto& [room, allowed] : kAllowed) rooms.push_back(room);
  return tests::sources_below(rooms);
}

/// "core/analysis/analyze.h" belongs to the room core; a header without a room's name, or of a library, to none.
std::string room_of(const std::string& include) {
  const std::string first = include.substr(0, include.find('/'));
  return include.find('/') != std::string::npos && (kAllowed.contains(first) || first == "tests" || first == "bench")
             ? first
             : std::string();
}

/// Whether the file lies in one suite and includes the other, of two that stay apart.
bool joins_suites(const std::string& path, const std::string& include) {
  return std::any_of(kApart.begin(), kApart.end(), [&](const auto& apart) {
    const auto& [a, b] = apart;
    return (path.starts_with(a) && include.starts_with(b)) || (path.starts_with(b) && include.starts_with(a));
  });
}

std::vector<std::string> violations(const std::vector<Source>& sources) {
  std::vector<std::string> found;
  std::map<std::string, std::set<std::string>> users;  // of each library in each room: files without their ending
  for (const Source& source : sources) {
    const std::string room = *source.path.begin();
    for (const std::string& include : includes_of(source)) {
      const std::string other = room_of(include);
      const std::set<std::string>& allowed = kAllowed.at(room);
      if (include.find("..") != std::string::npos) {
        found.push_back(fmt::format("{} includes {} by a relative path", source.path.string(), include));
      } else if (!other.empty() && other != room && !allowed.contains(other) && !allowed.contains(include)) {
        found.push_back(fmt::format("{} includes {}", source.path.string(), include));
      } else if (joins_suites(source.path.string(), include)) {
        found.push_back(fmt::format("{} includes {} of a suite it stays apart from", source.path.string(), include));
      }
      for (const auto& [library, starts] : kBehindOneFile) {
        for (const std::string& start : starts) {
          if (include.starts_with(start))
            users[library + " of " + room].insert(fs::path(source.path).replace_extension().string());
        }
      }
    }
  }
  for (const auto& [library, files] : users) {
    if (files.size() > 1) found.push_back(fmt::format("{} stands in {}", library, fmt::join(files, ", ")));
  }
  return found;
}

std::vector<std::string> one_line_each(const std::vector<std::vector<std::string>>& circles) {
  std::vector<std::string> lines;
  for (const std::vector<std::string>& circle : circles) lines.push_back(fmt::format("{}", fmt::join(circle, ", ")));
  return lines;
}

}  // namespace

TEST_CASE("no file includes what the table of rooms does not allow") {
  const std::vector<Source> sources = sources_of_rooms();
  CHECK(sources.size() > 50);
  CHECK(violations(sources) == std::vector<std::string>{});
}

TEST_CASE("no folders include each other in a circle") {
  CHECK(one_line_each(tests::circles_of(tests::folder_graph(sources_of_rooms()))) == kStandingCircles);
}

TEST_CASE("no files of a folder include each other in a circle, a header with its source being one") {
  CHECK(one_line_each(tests::circles_of(tests::unit_graph(sources_of_rooms()))) == std::vector<std::string>{});
}

TEST_CASE("a circle of folders is found, of two and of three, and a folder inside another is one of its own") {
  const auto circles = [](const std::vector<Source>& sources) {
    return one_line_each(tests::circles_of(tests::folder_graph(sources)));
  };
  CHECK(circles({{"core/a/x.h", "#include \"core/b/y.h\"\n"}, {"core/b/y.cpp", "#include \"core/a/x.h\"\n"}}) ==
        std::vector<std::string>{"core/a, core/b"});
  CHECK(circles({{"core/a/x.h", "#include \"core/b/y.h\"\n"},
                 {"core/b/z.h", "#include \"sim/c/u.h\"\n"},
                 {"sim/c/v.h", "#include \"core/a/w.h\"\n"},
                 {"sim/d/v.h", "#include \"core/a/w.h\"\n"}}) == std::vector<std::string>{"core/a, core/b, sim/c"});
  CHECK(circles({{"core/a/x.h", "#include \"core/a/in/y.h\"\n"}, {"core/a/in/y.h", "#include \"core/a/z.h\"\n"}}) ==
        std::vector<std::string>{"core/a, core/a/in"});
  CHECK(circles({{"core/a/x.h", "#include \"core/b/y.h\"\n#include <vector>\n"}, {"core/b/y.h", ""}}).empty());
}

TEST_CASE("a circle of files within a folder is found, and a header with its source is none") {
  const auto circles = [](const std::vector<Source>& sources) {
    return one_line_each(tests::circles_of(tests::unit_graph(sources)));
  };
  CHECK(circles({{"core/a/x.cpp", "#include \"core/a/y.h\"\n"},
                 {"core/a/x.h", ""},
                 {"core/a/y.h", "#include \"core/a/x.h\"\n"}}) == std::vector<std::string>{"core/a/x, core/a/y"});
  CHECK(circles({{"core/a/x.cpp", "#include \"core/a/x.h\"\n"}, {"core/a/x.h", ""}}).empty());
  CHECK(circles({{"core/a/x.h", "#include \"core/b/y.h\"\n"}, {"core/b/y.h", "#include \"core/a/x.h\"\n"}}).empty());
}

TEST_CASE("an include that the table does not allow is found") {
  const auto one = [](const char* path, const char* text) { return violations({{path, text}}); };
  CHECK(one("core/a.cpp", "#include \"sim/simulate.h\"\n") ==
        std::vector<std::string>{"core/a.cpp includes sim/simulate.h"});
  CHECK(one("core/a.cpp", "  #  include <render/scenario/scenario.h>\n").size() == 1);
  CHECK(one("render/a.h", "#include \"core/results.h\"\n").size() == 1);
  CHECK(one("report/a.h", "#include \"core/analysis/analyze.h\"\n").size() == 1);
  CHECK(one("sim/a.h", "#include \"../core/result/results.h\"\n").size() == 1);
  CHECK(one("base/a.h", "#include \"core/results.h\"\n").size() == 1);
  CHECK(one("core/a.cpp", "#include \"tests/made_results.h\"\n").size() == 1);
  CHECK(one("report/a.h", "#include \"core/result/results.h\"\n#include <vector>\n").empty());
  CHECK(one("validate/a.h", "#include \"render/scenario.h\"\n").empty());
  CHECK(one("core/pictures/a.h", "#include \"core/motion/free/motion.h\"\n").size() == 1);
  CHECK(one("core/motion/free/a.cpp", "#include \"core/pictures/marker/marker_fit.h\"\n").size() == 1);
  CHECK(one("core/analysis/a.cpp", "#include \"core/pictures/marker/marker_fit.h\"\n").empty());
  CHECK(one("core/a.cpp", "// no #include of \"sim/motion/simulate.h\" here\n").empty());
}

TEST_CASE("a C library that is included from two files is found, from a header and its source it is not") {
  CHECK(violations(
            {{"sim/a.cpp", "#include <cvodes/cvodes.h>\n"}, {"sim/b.cpp", "#include <nvector/nvector_serial.h>\n"}})
            .size() == 1);
  CHECK(
      violations({{"sim/a.cpp", "#include <cvodes/cvodes.h>\n"}, {"sim/a.h", "#include <cvodes/cvodes.h>\n"}}).empty());
  // The clips' reader and their writer share nothing, so each room has its own file.
  CHECK(violations({{"core/a.cpp", "#include <libavcodec/avcodec.h>\n"},
                    {"render/b.cpp", "#include <libavcodec/avcodec.h>\n"}})
            .empty());
}

namespace {

/// Copies the folders into an empty tree and builds one of them there.
void build_alone(const std::vector<std::string>& folders, const std::string& built_folder, const std::string& library,
                 const std::vector<std::string>& settings = {}) {
  const tests::TempDir temp;
  for (const std::string& folder : folders) {
    fs::create_directories((temp / folder).parent_path());
    fs::copy(fs::path(tests::kSourceDir) / folder, temp / folder, fs::copy_options::recursive);
  }
  std::vector<std::string> configure = {
      "cmake", "-S",    (temp / built_folder).string(), "-B", (temp / "build").string(),
      "-G",    "Ninja", "-DCMAKE_BUILD_TYPE=Debug"};
  configure.insert(configure.end(), settings.begin(), settings.end());
  const tests::ProcessResult configured = tests::run(configure);
  INFO(configured.out << configured.err);
  REQUIRE(configured.status == 0);
  const tests::ProcessResult built = tests::run({"cmake", "--build", (temp / "build").string(), "-j", "2"});
  INFO(built.out << built.err);
  CHECK(built.status == 0);
  CHECK(fs::exists(temp / "build" / library));
}

/// The folders of core's analysis of tracks.
const std::vector<std::string> kWithoutImages = {"core/experiment", "core/math", "core/motion", "core/result",
                                                 "core/track"};

}  // namespace

TEST_CASE("core builds alone in an empty tree, with base and cmake and no other room", "[slow]") {
  build_alone({"core", "base", "cmake"}, "core", "libglidelab_core.a");
}

TEST_CASE("the analysis of tracks builds alone in an empty tree, where OpenCV is not to be found", "[slow]") {
  std::vector<std::string> folders = kWithoutImages;
  folders.insert(folders.end(), {"base", "cmake"});
  build_alone(folders, "core/motion", "libglidelab_motion.a", {"-DCMAKE_DISABLE_FIND_PACKAGE_OpenCV=ON"});
}

TEST_CASE("the analysis of tracks includes neither OpenCV nor the suites that read images, and these not it") {
  for (const Source& source : sources_of_rooms()) {
    const std::string path = source.path.string();
    const auto lies_in = [&](const std::string& folder) { return path.starts_with(folder + "/"); };
    const bool of_tracks = std::any_of(kWithoutImages.begin(), kWithoutImages.end(), lies_in);
    for (const std::string& include : includes_of(source)) {
      INFO(path << " includes " << include);
      if (of_tracks) {
        CHECK_FALSE(include.starts_with("opencv"));
        const bool of_core = include.starts_with("core/");
        CHECK((!of_core || std::any_of(kWithoutImages.begin(), kWithoutImages.end(),
                                       [&](const std::string& folder) { return include.starts_with(folder + "/"); })));
      }
      if (lies_in("core/pictures")) CHECK_FALSE(include.starts_with("core/motion/"));
    }
  }
}
