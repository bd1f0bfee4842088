#include "teach/page/page_texts.h"
#include "teach/page/teaching_pages.h"

#include <filesystem>
#include <string>

#include "base/files/file_io.h"
#include "test_paths.h"
#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("the program holds the fixed parts of the pages as they stand in their files") {
  const std::filesystem::path page = std::filesystem::path(tests::kSourceDir) / "teach/page";
  CHECK(teach::kExplorerStyle == base::read_file(page / "explorer/explorer.css"));
  CHECK(teach::kExplorerBody == base::read_file(page / "explorer/body.html"));
  CHECK(teach::kExplorerMotion == base::read_file(page / "explorer/motion.js"));
  CHECK(teach::kExplorerWords == base::read_file(page / "explorer/words.js"));
  CHECK(teach::kExplorerTrack == base::read_file(page / "explorer/track.js"));
  CHECK(teach::kExplorerKept == base::read_file(page / "explorer/kept.js"));
  CHECK(teach::kExplorerLink == base::read_file(page / "explorer/link.js"));
  CHECK(teach::kPageLanguage == base::read_file(page / "languages/language.js"));
  CHECK(teach::kEnglish == base::read_file(page / "languages/en.json"));
  CHECK(teach::kGerman == base::read_file(page / "languages/de.json"));
  CHECK(teach::kSpanish == base::read_file(page / "languages/es.json"));
  CHECK(teach::kFrench == base::read_file(page / "languages/fr.json"));
  CHECK(teach::kPortuguese == base::read_file(page / "languages/pt.json"));
  CHECK(teach::kLawsWords == base::read_file(page / "laws/words_of_laws.js"));
  CHECK(teach::kExplorerView == base::read_file(page / "explorer/view.js"));
  CHECK(teach::kFilmStyle == base::read_file(page / "laws/film.css"));
  CHECK(teach::kFilmScript == base::read_file(page / "laws/film.js"));
}
