/// CONVENTIONS.md's table of rooms, held against the includes of every source; and core/ builds without the others.
#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "base/files/staged_output.h"
#include "test_paths.h"
#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

struct Source {
  fs::path path;  ///< relative to the root: "core/analyze.cpp"
  std::string text;
};

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
     {"base", "core/result/results.h", "core/analysis/preview.h", "core/characterize/camera_measurement.h",
      "core/check/recording_check.h", "validate/truth/comparison.h", "validate/study/sweep/sweep_summary.h",
      "validate/study/requirement/requirement.h", "validate/study/coverage/interval_coverage.h",
      "validate/blind/blind_score.h", "diagnose/result/diagnosis.h", "validate/film/twin_motions.h",
      "diagnose/next/plan.h"}},  // the result types
    {"app", {"base", "core", "sim", "render", "fit", "diagnose", "validate", "teach", "report"}},
};

/// C libraries that live behind one file (a header and its source) each, by how their headers start.
const std::map<std::string, std::vector<std::string>> kBehindOneFile = {
    {"OSMesa", {"GL/", "GLES", "osmesa"}},
    {"SUNDIALS", {"sundials/", "cvode/", "cvodes/", "nvector/", "sunmatrix/", "sunlinsol/", "sunnonlinsol/"}},
    {"libav", {"libavcodec/", "libavformat/", "libavutil/", "libswscale/"}},
    {"SQLite", {"sqlite3"}},
    {"Cairo", {"cairo"}},
};

std::vector<Source> sources_of_rooms() {
  const fs::path root = tests::kSourceDir;
  std::vector<Source> sources;
  for (const auto& [room, allowed] : kAllowed) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / room)) {
      const std::string ending = entry.path().extension();
      if (ending != ".h" && ending != ".cpp") continue;
      sources.push_back({fs::relative(entry.path(), root), base::read_file(entry.path())});
    }
  }
  return sources;
}

std::vector<std::string> includes_of(const Source& source) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])", std::regex::multiline);
  std::vector<std::string> includes;
  for (auto match = std::sregex_iterator(source.text.begin(), source.text.end(), kInclude);
       match != std::sregex_iterator(); ++match) {
    includes.push_back((*match)[1]);
  }
  return includes;
}

/// "core/analyze.h" belongs to the room core; a header without a room's name, or of a library, to none.
std::string room_of(const std::string& include) {
  const std::string first = include.substr(0, include.find('/'));
  return include.find('/') != std::string::npos && (kAllowed.contains(first) || first == "tests" || first == "bench")
             ? first
             : std::string();
}

std::vector<std::string> violations(const std::vector<Source>& sources) {
  std::vector<std::string> found;
  std::map<std::string, std::set<std::string>> users;  // of each library: files without their ending
  for (const Source& source : sources) {
    const std::string room = *source.path.begin();
    for (const std::string& include : includes_of(source)) {
      const std::string other = room_of(include);
      const std::set<std::string>& allowed = kAllowed.at(room);
      if (include.find("..") != std::string::npos) {
        found.push_back(fmt::format("{} includes {} by a way round", source.path.string(), include));
      } else if (!other.empty() && other != room && !allowed.contains(other) && !allowed.contains(include)) {
        found.push_back(fmt::format("{} includes {}", source.path.string(), include));
      }
      for (const auto& [library, starts] : kBehindOneFile) {
        for (const std::string& start : starts) {
          if (include.starts_with(start)) users[library].insert(fs::path(source.path).replace_extension().string());
        }
      }
    }
  }
  for (const auto& [library, files] : users) {
    if (files.size() > 1) found.push_back(fmt::format("{} stands in {}", library, fmt::join(files, ", ")));
  }
  return found;
}

}  // namespace

TEST_CASE("no file includes what the table of rooms does not allow") {
  const std::vector<Source> sources = sources_of_rooms();
  CHECK(sources.size() > 50);
  CHECK(violations(sources) == std::vector<std::string>{});
}

TEST_CASE("no test's name holds a semicolon, at which CMake would cut it in two that match nothing") {
  static const std::regex kName(R"re(TEST_CASE\("([^"]*)")re");
  std::size_t names = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(fs::path(tests::kSourceDir) / "tests")) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = base::read_file(entry.path());
    for (auto match = std::sregex_iterator(text.begin(), text.end(), kName); match != std::sregex_iterator(); ++match) {
      INFO(entry.path().string() << ": " << (*match)[1]);
      CHECK((*match)[1].str().find(';') == std::string::npos);
      ++names;
    }
  }
  CHECK(names > 100);
}

TEST_CASE("every program that a test is skipped without is in a package that tools/test installs") {
  // Debian's package of each; script is of bsdutils, which every Debian has.
  const std::map<std::string, std::string> package_of = {{"chromium", "chromium"},
                                                         {"doxygen", "doxygen"},
                                                         {"ffmpeg", "ffmpeg"},
                                                         {"zsh", "zsh"},
                                                         {"script", ""},
                                                         {"pdftoppm", "poppler-utils"},
                                                         {"pdftotext", "poppler-utils"},
                                                         {"dpkg-deb", ""},
                                                         {"cpack", "cmake"},
                                                         {"dpkg-shlibdeps", "dpkg-dev"},
                                                         {"file", "file"}};
  std::string lists = "\n";
  for (const char* list : {"packages.txt", "packages-test.txt", "packages-optional.txt"}) {
    lists += base::read_file(fs::path(tests::kSourceDir) / "tools" / list) + "\n";
  }
  static const std::regex kSkipped(R"re(skipped: no ([^ "']+) program)re");
  std::set<std::string> seen;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(fs::path(tests::kSourceDir) / "tests")) {
    const std::string extension = entry.path().extension();
    if (extension != ".cpp" && extension != ".txt" && extension != ".sh") continue;
    const std::string text = base::read_file(entry.path());
    for (auto match = std::sregex_iterator(text.begin(), text.end(), kSkipped); match != std::sregex_iterator();
         ++match) {
      const std::string program = (*match)[1];
      if (program == "([^") continue;  // this very expression
      INFO(entry.path().string() << ": " << program);
      REQUIRE(package_of.contains(program));
      const std::string& package = package_of.at(program);
      CHECK((package.empty() || lists.find("\n" + package + "\n") != std::string::npos));
      seen.insert(program);
    }
  }
  CHECK(seen.contains("chromium"));
  CHECK(seen.contains("doxygen"));
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
  CHECK(one("core/a.cpp", "// no #include of \"sim/simulate.h\" here\n").empty());
}

TEST_CASE("a C library that is included from two files is found, from a header and its source it is not") {
  CHECK(violations(
            {{"sim/a.cpp", "#include <cvodes/cvodes.h>\n"}, {"sim/b.cpp", "#include <nvector/nvector_serial.h>\n"}})
            .size() == 1);
  CHECK(
      violations({{"sim/a.cpp", "#include <cvodes/cvodes.h>\n"}, {"sim/a.h", "#include <cvodes/cvodes.h>\n"}}).empty());
}

TEST_CASE("core builds alone in an empty tree, with base and cmake and no other room", "[slow]") {
  const tests::TempDir temp;
  const fs::path root = tests::kSourceDir;
  for (const char* folder : {"core", "base", "cmake"}) {
    fs::copy(root / folder, temp / folder, fs::copy_options::recursive);
  }
  const tests::ProcessResult configured =
      tests::run({"cmake", "-S", (temp / "core").string(), "-B", (temp / "build").string(), "-G", "Ninja",
                  "-DCMAKE_BUILD_TYPE=Debug"});
  INFO(configured.out << configured.err);
  REQUIRE(configured.status == 0);
  const tests::ProcessResult built = tests::run({"cmake", "--build", (temp / "build").string(), "-j", "2"});
  INFO(built.out << built.err);
  CHECK(built.status == 0);
  CHECK(fs::exists(temp / "build/libglidelab_core.a"));
}
