/// The pages and worksheets for class in docs/class, which need no build, are those that the program makes.
#include <filesystem>
#include <set>
#include <string>

#include "base/files/file_io.h"
#include "test_paths.h"
#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

const fs::path kClass = fs::path(tests::kSourceDir) / "docs/class";

/// The page without its films and plots, whose bytes differ from processor to processor in the last bits.
std::string without_media(const std::string& page) {
  std::string text;
  std::size_t at = 0;
  const auto skip = [&](std::size_t begin, const std::string& end) {
    text += page.substr(at, begin - at);
    at = page.find(end, begin);
    REQUIRE(at != std::string::npos);
  };
  while (true) {
    const std::size_t media = page.find("base64,", at), plot = page.find("<svg", at);
    if (media == std::string::npos && plot == std::string::npos) return text + page.substr(at);
    if (media < plot) {
      skip(media, "\"");
    } else {
      skip(plot, "</svg>");
    }
  }
}

void check_same(const std::string& stored, const std::string& made) {
  INFO("a page of docs/class is out of date: build class_pages");
  CHECK(stored.size() == made.size());
  CHECK((stored == made));  // in brackets: a failure does not print both pages
}

}  // namespace

TEST_CASE("the explorer for class in docs is the one that the program makes") {
  const tests::TempDir temp;
  const tests::ProcessResult made = tests::glidelab({"explore", "--quiet", "--out", "class"}, temp.path());
  INFO(made.err);
  REQUIRE(made.status == 0);
  check_same(base::read_file(kClass / "explore.html"), base::read_file(temp / "class/explore.html"));
}

TEST_CASE("the page of laws for class in docs is the one that the program makes, films and plots aside") {
  const tests::TempDir temp;
  const fs::path laws = fs::path(tests::kSourceDir) / "scenarios/laws";
  const tests::ProcessResult made = tests::glidelab({"laws", laws.string(), "--quiet", "--out", "class"}, temp.path());
  INFO(made.err);
  REQUIRE(made.status == 0);
  const std::string stored = base::read_file(kClass / "laws.html");
  check_same(without_media(stored), without_media(base::read_file(temp / "class/laws.html")));
  CHECK(stored.find("base64,") != std::string::npos);  // the films are in it
}

namespace {

std::set<std::string> files_of(const fs::path& folder) {
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  return names;
}

/// What is written on the sheet. The bytes also depend on the libraries that draw it.
std::string text_of(const fs::path& pdf) {
  const tests::ProcessResult text = tests::run({"pdftotext", "-layout", pdf.string(), "-"});
  INFO(pdf << text.err);
  REQUIRE(text.status == 0);
  return text.out;
}

}  // namespace

TEST_CASE("the worksheets for class in docs are those that the program makes, word by word") {
  const tests::TempDir temp;
  const fs::path laws = fs::path(tests::kSourceDir) / "scenarios/laws";
  const tests::ProcessResult made =
      tests::glidelab({"laws", laws.string(), "--worksheet", "--quiet", "--out", "sheets"}, temp.path());
  INFO(made.err);
  REQUIRE(made.status == 0);
  INFO("a sheet of docs/class/worksheets is out of date: build class_pages");
  const std::set<std::string> names = files_of(kClass / "worksheets");
  CHECK(names == files_of(temp / "sheets"));
  CHECK(names.size() == 16);
  if (tests::run({"pdftotext", "-v"}).status != 0) {
    WARN("skipped: no pdftotext program");
    return;
  }
  for (const std::string& name : names) {
    CAPTURE(name);
    const std::string stored = text_of(kClass / "worksheets" / name);
    CHECK(stored.size() > 100);
    CHECK(stored == text_of(temp / "sheets" / name));
  }
}
