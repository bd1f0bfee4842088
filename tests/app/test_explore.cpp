/// glidelab explore.
#include <regex>

#include "base/staged_output.h"
#include "catch.h"
#include "run_process.h"
#include "temp_dir.h"

using namespace glidelab;

TEST_CASE("the explorer's page stands alone, and its script agrees with the program's solver") {
  const tests::TempDir temp;
  const tests::ProcessResult made = tests::glidelab({"explore", "-q", "-o", "page"}, temp.path());
  INFO(made.err);
  REQUIRE(made.status == 0);
  const std::string page = base::read_file(temp / "page/explore.html");
  CHECK(page.find("http:") == std::string::npos);
  CHECK(page.find("https:") == std::string::npos);
  CHECK(page.find("nan") == std::string::npos);
  // The page measures itself against the solver's motions when it is opened; a browser is needed to see by how much.
  const tests::ProcessResult opened =
      tests::run({"chromium", "--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", "--dump-dom",
                  "file://" + (temp / "page/explore.html").string()});
  if (opened.status != 0) {
    WARN("skipped: no chromium program");
    return;
  }
  CHECK(opened.err.find("CONSOLE") == std::string::npos);
  // Cubics through points a tenth of the time apart in which u changes by itself leave some 3e-7 of it, and 1e-4 of the
  // acceleration: of 2 m/s, 5 s and 12 m/s^2 well below these.
  const auto off = [&](const char* which) {
    std::smatch found;
    REQUIRE(std::regex_search(opened.out, found, std::regex(std::string("data-off-") + which + "=\"([^\"]+)\"")));
    return std::stod(found[1]);
  };
  CHECK(off("x") < 1e-5);
  CHECK(off("v") < 5e-5);
  CHECK(off("a") < 5e-3);
}
