#include "teach/page/page_words.h"

#include <filesystem>
#include <regex>
#include <set>
#include <string>

#include "base/files/file_io.h"
#include "teach/page/teaching_pages.h"
#include "teach/study/law_study.h"
#include "test_paths.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

std::multiset<std::string> matches(const std::string& text, const char* pattern) {
  const std::regex regex(pattern);
  std::multiset<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), regex); at != std::sregex_iterator(); ++at) {
    found.insert((*at)[1]);
  }
  return found;
}

}  // namespace

TEST_CASE("every language says all that English says, with the same numbers in it, and in its own words") {
  const std::vector<std::string> codes = teach::language_codes();
  REQUIRE(codes == std::vector<std::string>{"en", "de", "es", "fr", "pt"});
  // The same word in both.
  const std::set<std::string> shared = {"de pause", "fr pause", "de ws_name", "fr ws_date"};
  const std::map<std::string, std::string>& english = teach::texts_of("en");
  for (const std::string& code : codes) {
    const std::map<std::string, std::string>& texts = teach::texts_of(code);
    CHECK(texts.size() == english.size());
    for (const auto& [key, text] : english) {
      INFO(code << " " << key);
      const auto found = texts.find(key);
      REQUIRE(found != texts.end());
      CHECK_FALSE(found->second.empty());
      CHECK(matches(found->second, "\\{(\\w+)\\}") == matches(text, "\\{(\\w+)\\}"));
      if (code == "en") continue;
      CHECK((found->second != text || shared.contains(code + " " + key)));
      CHECK(matches(found->second, "(\\d\\.\\d)").empty());  // these write 1,5
    }
    CHECK(texts.at("decimal") == (code == "en" ? "." : ","));
  }
}

TEST_CASE("every text that a page for class asks for is there, and none is there for nothing") {
  const std::filesystem::path root = tests::kSourceDir;
  std::set<std::string> asked;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root / "teach/page")) {
    if (!entry.is_regular_file() || entry.path().extension() == ".json") continue;
    for (const std::string& name : matches(base::read_file(entry.path()), "[\"']([a-z_0-9]+)\\\\?[\"']")) {
      asked.insert(name);
    }
    // Outcomes of a motion, by which words.js finds its sentence.
    for (const std::string& name : matches(base::read_file(entry.path()), "ends: .*'([a-z]+)'")) asked.insert(name);
  }
  for (const auto& [key, text] : teach::texts_of("en")) {
    INFO(key);
    const bool numbered = key.starts_with("scenario") || std::regex_match(key, std::regex("(drag|law|case)\\d"));
    CHECK((numbered || asked.contains(key) || key == "decimal" || key == "language_name"));
  }
  for (const char* file : {"explorer/body.html", "laws/words_of_laws.js", "explorer/view.js", "explorer/words.js"}) {
    const std::string text = base::read_file(root / "teach/page" / file);
    for (const char* pattern :
         {"data-text=\"([a-z_0-9]+)\"", "data-label=\"([a-z_0-9]+)\"", "say\\('([a-z_0-9]+)'[,)]"}) {
      for (const std::string& key : matches(text, pattern)) {
        INFO(file << " " << key);
        CHECK(teach::texts_of("en").contains(key));
      }
    }
  }
}

TEST_CASE("the program's own laws are known by their names and texts in every language") {
  const std::filesystem::path folder = std::filesystem::path(tests::kSourceDir) / "scenarios/laws";
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".toml") continue;
    const teach::LawStudy study = teach::study_law(entry.path());
    const std::string number = entry.path().stem().string().substr(0, 1);
    CHECK(teach::key_of(study.name, "scenario") == "scenario" + number + "_name");
    CHECK(teach::key_of(study.text, "scenario") == "scenario" + number + "_text");
    ++count;
  }
  CHECK(count == 8);
  CHECK(teach::key_of("A law of my own", "scenario").empty());
}

TEST_CASE("a text takes its values as text") {
  CHECK(teach::text_in("de", "turns", {{"t", "0,5"}}) == "Er kehrt bei t = 0,5 s um.");
  CHECK(teach::words("unstable_at", {{"v", "<b>"}}) ==
        "<span data-text=\"unstable_at\" data-values=\"{&quot;v&quot;:&quot;&lt;b&gt;&quot;}\">unstable at &lt;b&gt; "
        "m/s</span>");
}
