#include "report/analysis/left_out_clips.h"

#include "report/analysis/analysis_report.h"
#include "report/analysis/result_files.h"
#include "tests/catch.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

std::vector<core::LeftOutClip> of(std::size_t clips, std::size_t all) {
  std::vector<core::LeftOutClip> left_out;
  for (std::size_t i = 0; i < clips; ++i)
    left_out.push_back({"u" + std::to_string(i + 1), "rail", "clips/<u>: marker: found no marker", i, all});
  return left_out;
}

}  // namespace

TEST_CASE("clips that are left out come first on the screen and the page, with their reason") {
  core::AnalysisResults results;
  results.left_out = of(1, 5);
  const std::string text = report::analysis_text(results);
  CHECK(text.starts_with(
      "1 of 5 clips is left out, because its marker is not found. The results are those of the other 4.\n"
      "u1: clips/<u>: marker: found no marker\n"));
  CHECK_THAT(report::left_out_html(results.left_out), Contains("&lt;u&gt;"));
  const report::Json json = report::Json::parse(report::results_json(results));
  REQUIRE(json["clips_left_out"].size() == 1);
  CHECK(json["clips_left_out"][0]["clip"] == "u1");
  CHECK(json["clips_left_out"][0]["experiment"] == "rail");
}

TEST_CASE("where fewer than half of the clips are left, a warning says so") {
  CHECK(report::left_out_words(of(3, 5)).size() == 5);
  CHECK_THAT(report::left_out_words(of(3, 5)).back(), Contains("Fewer than half") && Contains("glidelab check"));
  CHECK(report::left_out_words(of(2, 4)).size() == 3);  // half are left
  CHECK(report::left_out_words({}).empty());
  CHECK(report::left_out_text({}).empty());
  CHECK(report::left_out_html({}).empty());
}
