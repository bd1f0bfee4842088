/// glidelab laws.
#include "base/files/file_io.h"
#include "test_paths.h"
#include "tests/app/opened_page.h"
#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;

TEST_CASE("the page of laws holds a film for each law, which the browser can play, and the points go with it") {
  const tests::TempDir temp;
  const std::string laws = std::string(tests::kSourceDir) + "/scenarios/laws/";
  const tests::ProcessResult made =
      tests::glidelab({"laws", "-q", "-o", "page", laws + "6-stribeck.toml", laws + "8-look-alike.toml"}, temp.path());
  INFO(made.err);
  REQUIRE(made.status == 0);
  const std::string page = base::read_file(temp / "page/laws.html");
  CHECK(page.find("http:") == std::string::npos);
  CHECK(page.find("https:") == std::string::npos);
  const auto opened = tests::open_with(temp.path(), page, R"js(
const seen = [], films = [...document.querySelectorAll('video')];
const tell = () => { document.documentElement.dataset.films = seen.join(' '); };
for (const film of films) {
  film.addEventListener('seeked', () => { seen.push(film.videoWidth + '/' + film.duration.toFixed(2)); tell(); });
  film.addEventListener('error', () => { seen.push('error'); tell(); });
  film.currentTime = 0.5;
}
// The browser's clock is virtual and leaps over idle time, but films are decoded in real time: work takes it.
let sum = 0;
const wait = () => {
  for (let i = 0; i < 2e7; ++i) sum += i;
  if (seen.length < films.length) setTimeout(wait, 5);
};
wait();
)js");
  if (!opened) {
    WARN("skipped: no chromium program");
    return;
  }
  CHECK(opened->messages.find("CONSOLE") == std::string::npos);
  // 91 and 36 frames at 25 a second, each shown for its time.
  INFO(opened->data.at("films"));
  CHECK(opened->data.at("films").find("800/3.64") != std::string::npos);
  CHECK(opened->data.at("films").find("800/1.44") != std::string::npos);
}
