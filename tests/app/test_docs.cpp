/// README, the guide, the reference and the evidence, held to the repository: links and anchors lead somewhere, files
/// that are named exist, nothing outside docs/evidence depends on a seed, a commit or a date, and the README is short.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <functional>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "base/files/file_io.h"
#include "diagnose/effects/effect_list.h"
#include "test_paths.h"
#include "tests/app/command_names.h"
#include "tests/catch.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

/// Folders of the repository, which a path in a page begins with.
constexpr std::array kTopFolders = {"app",       "base",     "bench", "cmake",  "core",   "diagnose",
                                    "docs",      "examples", "fit",   "python", "render", "report",
                                    "scenarios", "sim",      "teach", "tests",  "tools",  "validate"};

struct Line {
  std::size_t number = 0;
  std::string text;
  bool code = false;  ///< in a fence or indented by four spaces
};

/// A page of Markdown; `path` is relative to the root.
struct Page {
  std::string path;
  std::vector<Line> lines;
};

Page page_of(const std::string& path, const std::string& text) {
  Page page{path, {}};
  std::istringstream stream(text);
  bool fenced = false;
  bool listed = false;  // in a list, four spaces continue an item
  std::size_t number = 0;
  for (std::string line; std::getline(stream, line);) {
    const bool fence = line.starts_with("```");
    if (line.starts_with("- ") || line.starts_with("1. ")) listed = true;
    if (!line.empty() && !line.starts_with(" ") && !line.starts_with("- ")) listed = false;
    page.lines.push_back({++number, line, fenced || fence || (line.starts_with("    ") && !listed)});
    if (fence) fenced = !fenced;
  }
  return page;
}

std::vector<Page> pages_of_repository() {
  const fs::path root = tests::kSourceDir;
  std::vector<std::string> paths = {"README.md", "CHANGELOG.md", "CONVENTIONS.md", "CONTRIBUTING.md"};
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / "docs")) {
    if (entry.path().extension() == ".md") paths.push_back(fs::relative(entry.path(), root).generic_string());
  }
  std::ranges::sort(paths);
  std::vector<Page> pages;
  for (const std::string& path : paths) pages.push_back(page_of(path, base::read_file(root / path)));
  return pages;
}

bool stands_in_repository(const std::string& path) {
  return fs::exists(fs::path(tests::kSourceDir) / path);
}

std::vector<std::string> matches(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (auto match = std::sregex_iterator(text.begin(), text.end(), pattern); match != std::sregex_iterator(); ++match) {
    found.push_back((*match)[1]);
  }
  return found;
}

/// The anchor of a heading as GitHub makes it: lower case, no punctuation, hyphens for spaces.
std::string anchor_of(const std::string& heading) {
  const std::string text = std::regex_replace(heading, std::regex(R"(\]\([^)]*\))"), "]");
  std::string anchor;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == ' ') anchor += '-';
    if (std::isalnum(byte) != 0 || c == '-' || c == '_' || byte >= 0x80)
      anchor += static_cast<char>(std::tolower(byte));
  }
  return anchor;
}

std::set<std::string> anchors_of(const Page& page) {
  static const std::regex kHeading(R"(^#{1,6} +(.*\S)\s*$)");
  std::set<std::string> anchors;
  std::map<std::string, int> seen;
  for (const Line& line : page.lines) {
    std::smatch match;
    if (line.code || !std::regex_match(line.text, match, kHeading)) continue;
    const std::string anchor = anchor_of(match[1]);
    const int before = seen[anchor]++;
    anchors.insert(before == 0 ? anchor : fmt::format("{}-{}", anchor, before));
  }
  return anchors;
}

struct Link {
  std::string from;  ///< page
  std::size_t line = 0;
  std::string file;    ///< relative to the root; the page itself for "#anchor"
  std::string anchor;  ///< empty where the link has none
};

/// Links and images within the repository; those that begin with a scheme ("https:") are not.
std::vector<Link> links_of(const Page& page) {
  static const std::regex kLink(R"(\]\(([^)\s]+)\))");
  static const std::regex kScheme(R"(^[a-z]+:.*)");
  static const std::regex kInlineCode(R"(`[^`]*`)");
  std::vector<Link> links;
  for (const Line& line : page.lines) {
    if (line.code) continue;
    for (const std::string& target : matches(std::regex_replace(line.text, kInlineCode, "`"), kLink)) {
      if (std::regex_match(target, kScheme)) continue;
      const std::size_t hash = target.find('#');
      const std::string file = target.substr(0, hash);
      links.push_back(
          {page.path, line.number,
           file.empty() ? page.path : (fs::path(page.path).parent_path() / file).lexically_normal().generic_string(),
           hash == std::string::npos ? "" : target.substr(hash + 1)});
    }
  }
  return links;
}

using Exists = std::function<bool(const std::string&)>;

std::vector<std::string> broken_links(const std::vector<Page>& pages, const Exists& exists) {
  std::map<std::string, std::set<std::string>> anchors;
  for (const Page& page : pages) anchors[page.path] = anchors_of(page);
  std::vector<std::string> broken;
  for (const Page& page : pages) {
    for (const Link& link : links_of(page)) {
      const std::string place = fmt::format("{}:{}", link.from, link.line);
      if (!exists(link.file)) {
        broken.push_back(fmt::format("{}: no file {}", place, link.file));
      } else if (!link.anchor.empty() && anchors.contains(link.file) && !anchors[link.file].contains(link.anchor)) {
        broken.push_back(fmt::format("{}: {} has no heading #{}", place, link.file, link.anchor));
      }
    }
  }
  return broken;
}

/// Paths that a page names: in backticks, and as words of a code block. A name with a placeholder is none.
std::vector<std::string> paths_named_in(const Line& line) {
  static const std::regex kInlineCode("`([^`]+)`");
  static const std::regex kPlaceholder(R"([*<>{}]|\xE2\x80\xA6|[A-Z]{3,}(?!\.md|\.h)|\.\.)");
  std::vector<std::string> texts = matches(line.text, kInlineCode);
  if (line.code) texts.push_back(line.text);
  std::vector<std::string> paths;
  for (const std::string& text : texts) {
    std::istringstream words(text);
    for (std::string word; words >> word;) {
      while (!word.empty() && std::string_view(",;:.)\"").find(word.back()) != std::string_view::npos) word.pop_back();
      while (!word.empty() && std::string_view("(\"").find(word.front()) != std::string_view::npos) word.erase(0, 1);
      if (word == "#") break;  // the rest is a comment for people
      const std::size_t slash = word.find('/');
      const bool ours =
          slash != std::string::npos && std::ranges::find(kTopFolders, word.substr(0, slash)) != kTopFolders.end();
      if (ours && !std::regex_search(word, kPlaceholder)) paths.push_back(word);
    }
  }
  return paths;
}

/// A path may name a file, a folder, or a header and its source without their endings.
std::vector<std::string> missing_files(const std::vector<Page>& pages, const Exists& exists) {
  std::vector<std::string> missing;
  for (const Page& page : pages) {
    for (const Line& line : page.lines) {
      for (const std::string& path : paths_named_in(line)) {
        if (!exists(path) && !exists(path + ".h") && !exists(path + ".cpp")) {
          missing.push_back(fmt::format("{}:{}: {}", page.path, line.number, path));
        }
      }
    }
  }
  return missing;
}

/// What makes a page a record of one day: seeds that were run, commits, dates.
std::vector<std::string> dated_lines(const std::vector<Page>& pages) {
  static const std::regex kSeed(R"((?:^|[^-\w])[Ss]eeds? \d+)");
  static const std::regex kHex(R"(\b([0-9a-f]{7,40})\b)");
  static const std::regex kDate(R"(\b20\d\d-\d\d-\d\d\b)");
  const auto is_commit = [](const std::string& word) {
    return word.find_first_of("abcdef") != std::string::npos && word.find_first_of("0123456789") != std::string::npos;
  };
  std::vector<std::string> found;
  for (const Page& page : pages) {
    if (page.path.starts_with("docs/evidence/")) continue;
    for (const Line& line : page.lines) {
      if (std::regex_search(line.text, kSeed) || std::regex_search(line.text, kDate) ||
          std::ranges::any_of(matches(line.text, kHex), is_commit)) {
        found.push_back(fmt::format("{}:{}: {}", page.path, line.number, line.text));
      }
    }
  }
  return found;
}

std::string text_of(const Page& page) {
  std::string text;
  for (const Line& line : page.lines) text += line.text + "\n";
  return text;
}

/// The rows of the first table below a heading, without their links' targets.
std::string table_below(const Page& page, const std::string& heading) {
  std::string rows;
  bool below = false;
  for (const Line& line : page.lines) {
    if (line.text == heading) below = true;
    if (below && line.text.starts_with("|")) rows += line.text + "\n";
    if (!rows.empty() && !line.text.starts_with("|")) break;
  }
  return std::regex_replace(rows, std::regex(R"(\]\([^)]*\))"), "]");
}

std::set<std::string> figures_in(const std::string& rows) {
  static const std::regex kFigure(R"(\b(\d+(?:\.\d+)?)\b)");
  const std::vector<std::string> figures = matches(rows, kFigure);
  return {figures.begin(), figures.end()};
}

}  // namespace

TEST_CASE("every link of the documentation leads to a file and a heading that exist") {
  const std::vector<Page> pages = pages_of_repository();
  CHECK(pages.size() > 20);
  CHECK(broken_links(pages, stands_in_repository) == std::vector<std::string>{});
}

TEST_CASE("every page of docs is linked from another page") {
  const std::vector<Page> pages = pages_of_repository();
  std::set<std::string> linked;
  for (const Page& page : pages) {
    for (const Link& link : links_of(page)) {
      if (link.file != page.path) linked.insert(link.file);
    }
  }
  for (const Page& page : pages) {
    INFO(page.path);
    CHECK((!page.path.starts_with("docs/") || linked.contains(page.path)));
  }
}

TEST_CASE("every file of the repository that the documentation names exists") {
  CHECK(missing_files(pages_of_repository(), stands_in_repository) == std::vector<std::string>{});
}

TEST_CASE("every page of docs that a source, a scenario or a script points to exists") {
  static const std::regex kPage(R"(\b(docs/[\w./-]+\.(?:md|png|svg))\b)");
  std::size_t pointers = 0;
  for (const char* folder : kTopFolders) {
    if (std::string_view(folder) == "docs") continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(fs::path(tests::kSourceDir) / folder)) {
      const std::string ending = entry.path().extension();
      const bool text = ending == ".h" || ending == ".cpp" || ending == ".toml" || ending == ".txt" ||
                        ending == ".sh" ||
                        (entry.is_regular_file() && ending.empty() && std::string_view(folder) == "tools");
      if (!text || entry.path().filename() == "test_docs.cpp") continue;
      for (const std::string& page : matches(base::read_file(entry.path()), kPage)) {
        INFO(entry.path().string() << ": " << page);
        CHECK(stands_in_repository(page));
        ++pointers;
      }
    }
  }
  CHECK(pointers > 20);
}

TEST_CASE("seeds that were run, commits and dates stand in docs/evidence only") {
  CHECK(dated_lines(pages_of_repository()) == std::vector<std::string>{});
}

TEST_CASE("the README has at most 100 lines and 800 words, says that it runs on Linux, and names the paper") {
  const std::vector<Page> pages = pages_of_repository();
  const auto readme = std::ranges::find(pages, "README.md", &Page::path);
  REQUIRE(readme != pages.end());
  CHECK(readme->lines.size() <= 100);
  std::istringstream words(text_of(*readme));
  CHECK(std::distance(std::istream_iterator<std::string>(words), {}) <= 800);
  const std::string text = std::regex_replace(text_of(*readme), std::regex(R"(\s+)"), " ");
  CHECK(text.find("Linux") != std::string::npos);
  CHECK(text.find("Experimental study of viscous friction in undergraduate physics laboratory. Introduction of phase "
                  "diagrams to analyze dynamic equilibrium") != std::string::npos);
  for (const char* word : {"newest build", "missed", "commit"}) {
    INFO(word);
    CHECK(text.find(word) == std::string::npos);
  }
}

TEST_CASE("the guide is read in the hour that the index of the documentation states, at 240 words a minute") {
  std::ptrdiff_t words = 0;
  bool stated = false;
  for (const Page& page : pages_of_repository()) {
    const std::string text = text_of(page);
    std::istringstream stream(text);
    if (page.path.starts_with("docs/guide/"))
      words += std::distance(std::istream_iterator<std::string>(stream), std::istream_iterator<std::string>());
    if (page.path == "docs/README.md") stated = text.find("front to back in an hour (") != std::string::npos;
  }
  CHECK(words > 5000);
  CHECK(words <= 60 * 240);
  CHECK(stated);
}

TEST_CASE("the figures of results in the README and the guide are those of the summary") {
  const std::vector<Page> pages = pages_of_repository();
  const auto rows_of = [&](const std::string& path, const std::string& heading) {
    const auto page = std::ranges::find(pages, path, &Page::path);
    REQUIRE(page != pages.end());
    return table_below(*page, heading);
  };
  const std::set<std::string> known = figures_in(rows_of("docs/evidence/summary.md", "# Summary"));
  const auto unknown = [&](const std::string& rows) {
    std::vector<std::string> found;
    std::ranges::set_difference(figures_in(rows), known, std::back_inserter(found));
    return found;
  };
  const std::string readme = rows_of("README.md", "## What to expect"),
                    guide = rows_of("docs/guide/diagnosis.md", "## How far to trust it");
  CHECK(figures_in(readme).size() > 10);
  CHECK(figures_in(guide).size() > 20);
  CHECK(unknown(readme) == std::vector<std::string>{});
  CHECK(unknown(guide) == std::vector<std::string>{});
  CHECK(unknown(readme + "| first | in 79 % of 181 |\n") == std::vector<std::string>{"79"});
}

TEST_CASE("the README says how many effects a diagnosis knows, and no other page repeats the number") {
  const std::string stated = fmt::format("{} effects", diagnose::kEffects);
  for (const Page& page : pages_of_repository()) {
    if (page.path.starts_with("docs/evidence")) continue;
    INFO(page.path);
    CHECK((text_of(page).find(stated) != std::string::npos) == (page.path == "README.md"));
  }
}

TEST_CASE("the page of commands has a row for each") {
  const std::vector<Page> pages = pages_of_repository();
  const auto commands = std::ranges::find(pages, "docs/reference/commands.md", &Page::path);
  REQUIRE(commands != pages.end());
  const std::string text = text_of(*commands);
  for (const std::string& command : tests::kCommands) {
    INFO(command);
    CHECK(text.find("| `glidelab " + command) != std::string::npos);
  }
}

TEST_CASE("a link to a file or a heading that is not there is found") {
  const std::vector<Page> two = {
      page_of("README.md",
              "[a](docs/a.md), [b](docs/a.md#two-words), [c](https://elsewhere.org/x), ![d](docs/d.png)\n"),
      page_of("docs/a.md", "# Two words\n[up](../README.md) [here](#two-words)\n## Of `x_m`, (all)\n")};
  const auto there = [](const std::string& path) {
    return path == "README.md" || path == "docs/a.md" || path == "docs/d.png";
  };
  CHECK(broken_links(two, there).empty());
  const auto broken = [&](const char* text) {
    return broken_links({two[0], two[1], page_of("docs/b.md", text)}, there);
  };
  CHECK(broken("[x](a.md#of-x_m-all)\n").empty());
  CHECK(broken("[x](docs/a.md)\n") == std::vector<std::string>{"docs/b.md:1: no file docs/docs/a.md"});
  CHECK(broken("one\n[x](a.md#three)\n") == std::vector<std::string>{"docs/b.md:2: docs/a.md has no heading #three"});
  CHECK(broken("![x](e.png)\n").size() == 1);
  CHECK(broken("[x](#nowhere)\n").size() == 1);
  CHECK(broken("    [x](nowhere.md)\n```\n[x](nowhere.md)\n```\n`[x](nowhere.md)`\n").empty());
  CHECK(broken("- a list\n    [x](nowhere.md)\n").size() == 1);
}

TEST_CASE("a file of the repository that is named and not there is found, a placeholder is none") {
  const auto there = [](const std::string& path) {
    return path == "core/a.h" || path == "sim/force" || path == "tools/demo";
  };
  const auto missing = [&](const char* text) { return missing_files({page_of("docs/b.md", text)}, there); };
  CHECK(missing("`core/a.h`, `core/a`, `sim/force`, `other/b.h`, core/c.h without backticks\n").empty());
  CHECK(missing("`core/c.h`\n") == std::vector<std::string>{"docs/b.md:1: core/c.h"});
  CHECK(missing("    tools/demo     # installs\n    tools/gone\n").size() == 1);
  CHECK(missing("`diagnose/effects/force/<id>.cpp`, `scenarios/rehearsals/NAME.toml`, `core/*.h`\n").empty());
}

TEST_CASE("a seed, a commit or a date outside docs/evidence is found") {
  const auto dated = [](const char* path, const char* text) { return dated_lines({page_of(path, text)}).size(); };
  CHECK(dated("docs/a.md", "run once on seed 4000\n") == 1);
  CHECK(dated("docs/a.md", "by commit e62e6ed\n") == 1);
  CHECK(dated("README.md", "on 2026-01-31\n") == 1);
  CHECK(dated("docs/evidence/a.md", "seed 4000, by e62e6ed\n") == 0);
  CHECK(dated("docs/a.md", "    glidelab blind --cases 400 --seed 400\n") == 0);
  CHECK(dated("docs/a.md", "1000000 runs of a feedback, Huber 1964\n") == 0);
}
