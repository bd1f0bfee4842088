/// What holds of every file of the tree: its length, its name, its header; and of every test, its name and what it
/// needs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/files/file_io.h"
#include "diagnose/effects/effect_list.h"
#include "test_paths.h"
#include "tests/app/source_tree.h"
#include "tests/catch.h"

using namespace glidelab;
using tests::Source;
namespace fs = std::filesystem;

namespace {

const std::vector<std::string> kRooms = {"base",  "core",   "sim", "render",   "fit",   "diagnose",
                                         "teach", "report", "app", "validate", "python"};
constexpr int kMostLines = 500;
constexpr int kMostFiles = 25;  // of a folder

/// Where a file is one item of a list that a header elsewhere declares: it has no header of its own.
const std::vector<std::string> kItems = {"app/commands/",
                                         "python/binding/bind_",
                                         "python/binding/module.cpp",
                                         "app/shell/main.cpp",
                                         "diagnose/effects/force/",
                                         "diagnose/effects/camera/",
                                         "diagnose/effects/record/",
                                         "sim/force/laws/",
                                         "render/scenario/sections/",
                                         "core/motion/bandwidth/rule_"};

/// Headers whose functions several files of a list define: bind_<topic>.cpp each one.
const std::set<std::string> kDefinedElsewhere = {"python/binding/bindings.h"};

/// Where an effect may be named in words: its own description; the simulator, which has force laws of the same names;
/// the generator of blind cases, which shares nothing with what it tests.
const std::vector<std::string> kNamesEffects = {"diagnose/effects/", "sim/", "validate/blind/case/"};

/// Sources without a header of their name that still stand elsewhere; the list only shrinks.
const std::set<std::string> kStandingWithoutHeader = {};

std::vector<std::string> too_long(const std::vector<Source>& sources) {
  std::vector<std::string> found;
  for (const Source& source : sources) {
    const auto lines = std::count(source.text.begin(), source.text.end(), '\n');
    if (lines > kMostLines) found.push_back(fmt::format("{}: {} lines", source.path.string(), lines));
  }
  return found;
}

bool is_item(const Source& source) {
  const std::string path = source.path.string();
  return std::any_of(kItems.begin(), kItems.end(), [&](const std::string& start) { return path.starts_with(start); });
}

std::vector<std::string> too_full(const std::vector<Source>& sources) {
  std::map<std::string, int> count;
  for (const Source& source : sources) {
    ++count[source.path.parent_path().string()];
  }
  std::vector<std::string> found;
  for (const auto& [folder, files] : count) {
    if (files > kMostFiles) found.push_back(fmt::format("{}: {} files", folder, files));
  }
  return found;
}

/// Files of one base name, whose stem another folder has as well: "coverage.h" beside somebody else's "coverage.cpp".
std::vector<std::string> named_twice(const std::vector<Source>& sources) {
  std::map<std::string, std::set<std::string>> folders;
  for (const Source& source : sources) folders[source.path.stem().string()].insert(source.path.parent_path().string());
  std::vector<std::string> found;
  for (const auto& [stem, in] : folders) {
    if (in.size() > 1) found.push_back(fmt::format("{} in {}", stem, fmt::join(in, ", ")));
  }
  return found;
}

std::set<std::string> without_header(const std::vector<Source>& sources) {
  std::set<std::string> headers, found;
  for (const Source& source : sources) {
    if (source.path.extension() == ".h") headers.insert(fs::path(source.path).replace_extension().string());
  }
  for (const Source& source : sources) {
    const std::string path = source.path.string();
    if (source.path.extension() != ".cpp" || is_item(source)) continue;
    if (!headers.contains(fs::path(source.path).replace_extension().string())) found.insert(path);
  }
  return found;
}

/// The statements of a source that begin in the first column, to the end of the line on which they end or a body
/// begins.
std::vector<std::string> statements_of(const std::string& text) {
  std::vector<std::string> found;
  std::istringstream lines(text);
  std::string statement;
  for (std::string line; std::getline(lines, line);) {
    if (const std::size_t comment = line.find("//"); comment != std::string::npos) line.erase(comment);
    line.erase(line.find_last_not_of(' ') + 1);
    if (line.empty() || (statement.empty() && std::isalpha(static_cast<unsigned char>(line.front())) == 0)) continue;
    statement += line + " ";
    if (std::string_view(";{}").find(line.back()) == std::string_view::npos) continue;
    found.push_back(std::exchange(statement, {}));
  }
  return found;
}

/// Headers without a source of their name that declare a function and leave it to another file to define.
std::vector<std::string> defined_elsewhere(const std::vector<Source>& sources) {
  std::set<std::string> all;
  for (const Source& source : sources) all.insert(source.path.string());
  std::vector<std::string> found;
  for (const Source& source : sources) {
    const bool has_source = all.contains(fs::path(source.path).replace_extension(".cpp").string());
    if (source.path.extension() != ".h" || has_source || kDefinedElsewhere.contains(source.path.string())) continue;
    for (const std::string& statement : statements_of(source.text)) {
      const bool plain = !statement.starts_with("using ") && !statement.starts_with("static_assert(");
      const std::size_t open = statement.find('(');
      if (!plain || !statement.ends_with("; ") || open == std::string::npos || statement.find('=') < open) continue;
      found.push_back(fmt::format("{}: {}", source.path.string(), statement.substr(0, open)));
    }
  }
  return found;
}

/// The texts between quotes, without what is in comments or an include.
std::vector<std::string> literals_of(const std::string& text) {
  std::vector<std::string> found;
  std::size_t i = 0;
  const auto is = [&](std::string_view what) { return std::string_view(text).substr(i).starts_with(what); };
  while (i < text.size()) {
    if (is("//") || is("#include")) {
      i = std::min(text.find('\n', i), text.size());
    } else if (is("R\"")) {
      const std::size_t open = text.find('(', i);
      const std::string end = ")" + text.substr(i + 2, open - i - 2) + "\"";
      const std::size_t close = text.find(end, open);
      found.push_back(text.substr(open + 1, close - open - 1));
      i = close + end.size();
    } else if (is("\"")) {
      const std::size_t open = i++;
      while (i < text.size() && text[i] != '"') i += text[i] == '\\' ? 2 : 1;
      found.push_back(text.substr(open + 1, i - open - 1));
      ++i;
    } else if (is("'\\")) {
      i = text.find('\'', i + 3) + 1;
    } else {
      i += is("'") && i + 2 < text.size() && text[i + 2] == '\'' ? 3 : 1;
    }
  }
  return found;
}

/// Literals that hold the id of an effect, which `ids::` has too. An id that is also an English word counts where it is
/// the whole literal.
std::vector<std::string> typed_ids(const std::vector<Source>& sources) {
  std::vector<std::string> found;
  for (const Source& source : sources) {
    const std::string path = source.path.string();
    if (std::any_of(kNamesEffects.begin(), kNamesEffects.end(), [&](const auto& in) { return path.starts_with(in); }))
      continue;
    for (const std::string& literal : literals_of(source.text)) {
      static const std::regex kWord("\\w+");
      for (auto word = std::sregex_iterator(literal.begin(), literal.end(), kWord); word != std::sregex_iterator();
           ++word) {
        const std::string id = word->str();
        const auto& all = diagnose::kEffectIds;
        if (std::find(all.begin(), all.end(), id) == all.end()) continue;
        if (id == literal || id.find('_') != std::string::npos) found.push_back(fmt::format("{}: {}", path, id));
      }
    }
  }
  return found;
}

/// Tests that do not lie where their source lies: in a folder below tests/<room> that mirrors none, or, named after a
/// source, in another folder than that which mirrors its own.
std::vector<std::string> misplaced_tests(const std::vector<Source>& tests, const std::vector<Source>& sources) {
  std::set<fs::path> folders;
  std::map<std::string, fs::path> folder_of;  // by the source's name
  for (const Source& source : sources) {
    folder_of[source.path.stem().string()] = source.path.parent_path();
    for (fs::path folder = source.path.parent_path(); !folder.empty(); folder = folder.parent_path()) {
      folders.insert(folder);
    }
  }
  std::vector<std::string> found;
  for (const Source& test : tests) {
    const fs::path folder = test.path.parent_path().lexically_relative("tests");
    if (std::find(kRooms.begin(), kRooms.end(), folder.begin()->string()) == kRooms.end()) continue;
    if (!folders.contains(folder))
      found.push_back(fmt::format("{}: there is no {}", test.path.string(), folder.string()));
    const std::string stem = test.path.stem().string();
    if (!stem.starts_with("test_")) continue;
    const auto source = folder_of.find(stem.substr(5));
    if (source == folder_of.end() || source->second == folder) continue;
    found.push_back(fmt::format("{}: its source lies in {}", test.path.string(), source->second.string()));
  }
  return found;
}

/// Types that two files define in one namespace: their members' inline functions share one symbol, of which the linker
/// takes any. Unnamed namespaces are each file's own.
std::vector<std::string> defined_twice(const std::vector<Source>& sources) {
  static const std::regex kNamespace(R"(namespace ?([\w:]*) ?\{)");
  static const std::regex kType(R"((?:struct|class|union|enum|enum class) (\w+)(?: final)?(?: :[^:].*)? \{.*)");
  std::map<std::string, std::vector<std::string>> files_of;
  for (const Source& source : sources) {
    std::vector<std::string> spaces;
    std::istringstream lines(source.text);
    std::string line;
    std::smatch match;
    while (std::getline(lines, line)) {
      if (std::regex_match(line, match, kNamespace)) {
        spaces.push_back(match[1]);
      } else if (line.starts_with("}  // namespace") && !spaces.empty()) {
        spaces.pop_back();
      } else if (std::find(spaces.begin(), spaces.end(), "") == spaces.end() && std::regex_match(line, match, kType)) {
        files_of[fmt::format("{}::{}", fmt::join(spaces, "::"), match[1].str())].push_back(source.path.string());
      }
    }
  }
  std::vector<std::string> found;
  for (const auto& [type, files] : files_of) {
    if (files.size() > 1) found.push_back(fmt::format("{} in {}", type, fmt::join(files, ", ")));
  }
  return found;
}

/// Rooms and tests; the examples are programs of their own.
std::vector<Source> all_sources() {
  std::vector<std::string> folders = kRooms;
  folders.insert(folders.end(), {"tests", "bench"});
  return tests::sources_below(folders);
}

}  // namespace

TEST_CASE("no file is longer than a person reads at a sitting") {
  CHECK(too_long(all_sources()) == std::vector<std::string>{});
  CHECK(too_long({{"core/a.cpp", std::string(500, '\n')}, {"core/b.cpp", std::string(501, '\n')}}) ==
        std::vector<std::string>{"core/b.cpp: 501 lines"});
}

TEST_CASE("no folder holds more files than one takes in at a glance") {
  CHECK(too_full(tests::sources_below(kRooms)) == std::vector<std::string>{});
  std::vector<Source> many;
  for (int i = 0; i < 24; ++i) many.push_back({fmt::format("core/a/x{}.cpp", i), ""});
  many.push_back({"core/a/x.h", ""});
  many.push_back({"core/a/b/x.cpp", ""});
  CHECK(too_full(many).empty());
  many.push_back({"core/a/y.h", ""});
  CHECK(too_full(many) == std::vector<std::string>{"core/a: 26 files"});
  std::vector<Source> items;
  for (int i = 0; i < 26; ++i) items.push_back({fmt::format("diagnose/effects/force/x{}.cpp", i), ""});
  CHECK(too_full(items) == std::vector<std::string>{"diagnose/effects/force: 26 files"});
}

TEST_CASE("no two files have one name") {
  CHECK(named_twice(all_sources()) == std::vector<std::string>{});
  CHECK(named_twice({{"core/a/x.h", ""}, {"core/a/x.cpp", ""}, {"core/b/y.h", ""}}).empty());
  CHECK(named_twice({{"core/a/x.h", ""}, {"core/b/x.h", ""}}) == std::vector<std::string>{"x in core/a, core/b"});
  CHECK(named_twice({{"core/a/x.h", ""}, {"report/x.cpp", ""}}).size() == 1);
}

TEST_CASE("no type of a namespace is defined by two files") {
  CHECK(defined_twice(all_sources()) == std::vector<std::string>{});
  const std::string open = "namespace glidelab::core {\n", close = "}  // namespace glidelab::core\n";
  const Source one{"core/a.h", open + "struct Part {\n  int a;\n};\nclass Solver : public Base {\n};\n" + close};
  CHECK(defined_twice({one, {"core/b.h", open + "struct Part;\nstruct Whole {\n  struct Part {};\n};\n" + close}})
            .empty());
  CHECK(
      defined_twice({one, {"core/b.cpp", open + "namespace {\nstruct Part {\n};\n}  // namespace\n" + close}}).empty());
  CHECK(
      defined_twice({one, {"sim/b.h", "namespace glidelab::sim {\nstruct Part {\n};\n}  // namespace glidelab::sim\n"}})
          .empty());
  CHECK(defined_twice({one, {"core/b.h", open + "struct Part {\n  double b;\n};\n" + close}}) ==
        std::vector<std::string>{"glidelab::core::Part in core/a.h, core/b.h"});
  CHECK(defined_twice({one, {"core/b.cpp", open + "namespace {\n}  // namespace\nclass Solver {\n};\n" + close}}) ==
        std::vector<std::string>{"glidelab::core::Solver in core/a.h, core/b.cpp"});
}

TEST_CASE("every source has the header of its name, unless it is an item of a list") {
  CHECK(without_header(tests::sources_below(kRooms)) == kStandingWithoutHeader);
  CHECK(without_header({{"core/a/x.h", ""}, {"core/a/x.cpp", ""}, {"core/a/y.h", ""}}).empty());
  CHECK(without_header({{"core/a/x.h", ""}, {"core/b/x.cpp", ""}, {"core/a/x_more.cpp", ""}}) ==
        std::set<std::string>{"core/a/x_more.cpp", "core/b/x.cpp"});
  CHECK(without_header({{"app/commands/x_command.cpp", ""}, {"core/motion/bandwidth/rule_x.cpp", ""}}).empty());
}

TEST_CASE("a header without a source of its name defines what it declares") {
  CHECK(defined_elsewhere(tests::sources_below(kRooms)) == std::vector<std::string>{});
  const Source whole{"core/a/x.h",
                     "using F = double(int);\nstatic_assert(sizeof(int) == 4);\ninline constexpr auto kA = f(1);\n"
                     "struct Part {\n  int a;\n  int f() const;\n};\ninline int twice(int a) {\n  return 2 * a;\n}\n"};
  CHECK(defined_elsewhere({whole}).empty());
  const Source declares{"core/a/y.h", "// f();\nint first(int a,\n          int b = 1);  // of both\nstruct Part;\n"};
  CHECK(defined_elsewhere({whole, declares}) == std::vector<std::string>{"core/a/y.h: int first"});
  CHECK(defined_elsewhere({declares, {"core/a/y.cpp", ""}}).empty());
  for (const std::string& header : kDefinedElsewhere) CHECK(fs::exists(fs::path(tests::kSourceDir) / header));
}

TEST_CASE("no literal holds the id of an effect, which the list of effects has") {
  CHECK(typed_ids(tests::sources_below(kRooms)) == std::vector<std::string>{});
  const std::string id(diagnose::kEffectIds.front());
  REQUIRE(id.find('_') != std::string::npos);
  CHECK(typed_ids({{"report/x.cpp", fmt::format("f(\"--without {}\");", id)}}) ==
        std::vector<std::string>{"report/x.cpp: " + id});
  CHECK(typed_ids({{"report/x.cpp", fmt::format("f(R\"({})\", '\"');", id)}}).size() == 1);
  CHECK(typed_ids({{"report/x.cpp", fmt::format("f(); // \"{}\"\n#include \"{}\"\nids::{};", id, id, id)}}).empty());
  CHECK(typed_ids({{"report/x.cpp", fmt::format("f(\"http://a\", \"{}\");", id)}}).size() == 1);
  CHECK(typed_ids({{"report/x.cpp", "f(\"strong compression\");"}}).empty());
  CHECK(typed_ids({{"report/x.cpp", "f(\"compression\");"}}).size() == 1);
  CHECK(typed_ids({{"sim/x.cpp", fmt::format("f(\"{}\");", id)}}).empty());
}

TEST_CASE("a test lies in the folder that mirrors its source's") {
  CHECK(misplaced_tests(tests::sources_below({"tests"}), tests::sources_below(kRooms)) == std::vector<std::string>{});
  const std::vector<Source> sources = {{"core/a/b/x.cpp", ""}, {"core/c/y.h", ""}};
  CHECK(misplaced_tests({{"tests/core/a/b/test_x.cpp", ""},
                         {"tests/core/a/test_of_a.cpp", ""},
                         {"tests/core/c/made_y.h", ""},
                         {"tests/recipes/any/test_x.cpp", ""},
                         {"tests/test_main.cpp", ""}},
                        sources)
            .empty());
  CHECK(misplaced_tests({{"tests/core/c/test_x.cpp", ""}}, sources) ==
        std::vector<std::string>{"tests/core/c/test_x.cpp: its source lies in core/a/b"});
  CHECK(misplaced_tests({{"tests/core/d/test_z.cpp", ""}}, sources) ==
        std::vector<std::string>{"tests/core/d/test_z.cpp: there is no core/d"});
}

TEST_CASE("no test's name holds a semicolon, at which CMake would cut it in two that match nothing") {
  static const std::regex kName(R"re(TEST_CASE\(\s*"([^"]*)")re");
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

TEST_CASE("each change by hand of tests/tools/named_mutants.txt names what stands once in its file") {
  std::istringstream lines(base::read_file(fs::path(tests::kSourceDir) / "tests/tools/named_mutants.txt"));
  int changes = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line.starts_with('#')) continue;
    const std::size_t first = line.find(" | "), second = line.find(" | ", first + 3);
    REQUIRE(second != std::string::npos);
    const std::string text = base::read_file(fs::path(tests::kSourceDir) / line.substr(0, first)),
                      old = line.substr(first + 3, second - first - 3);
    const std::size_t at = text.find(old);
    INFO(line);
    CHECK(at != std::string::npos);
    CHECK(text.find(old, at + 1) == std::string::npos);
    ++changes;
  }
  CHECK(changes > 20);
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
