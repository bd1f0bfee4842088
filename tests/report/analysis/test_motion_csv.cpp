#include "report/analysis/result_files.h"

#include <limits>

#include "base/errors.h"
#include "report/text/display_text.h"
#include "tests/catch.h"
#include "tests/report/made_results.h"

using namespace glidelab;

namespace {

std::vector<std::vector<std::string>> cells(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t from = 0; from < text.size();) {
    const auto end = text.find('\n', from);
    rows.emplace_back(1);
    for (std::size_t i = from; i < end; ++i) {
      if (text[i] == ',') {
        rows.back().emplace_back();
      } else {
        rows.back().back() += text[i];
      }
    }
    from = end + 1;
  }
  return rows;
}

}  // namespace

TEST_CASE("the motion's CSV has a row for every frame, units in its header, and residuals that add up") {
  core::ClipResult clip = tests::made_clip("m1-up", 2.768, 0.8063, 0.667);
  clip.motion[3].smoothed = false;
  clip.motion[5].measured_m.reset();
  const auto rows = cells(report::motion_csv(clip));
  REQUIRE(rows.size() == clip.motion.size() + 1);
  for (const auto& row : rows) REQUIRE(row.size() == 12);
  CHECK(rows[0][0] == "t_s");
  CHECK(rows[0][4] == "residual_x_m");
  CHECK(rows[0][10] == "residual_a_m_s2");
  const auto& row = rows[101];
  const core::MotionPoint& point = clip.motion[100];
  CHECK(std::stod(row[4]) == *point.measured_m - point.x_m);  // the shortest text that reads back as the same double
  const core::LineFit& line = clip.segments[point.v_m_s > 0.0 ? 1 : 0];
  const double of_line = line.a0_m_s2.value - line.k_over_m_1_s.value * point.v_m_s;
  CHECK(std::stod(row[9]) == of_line);
  CHECK(std::stod(row[10]) == point.a_m_s2 - of_line);
  for (const int column : {2, 4, 5, 7, 9, 10}) CHECK(rows[4][static_cast<std::size_t>(column)].empty());
  CHECK(rows[6][1].empty());
  CHECK(rows[6][4].empty());
  CHECK_FALSE(rows[6][2].empty());
}

TEST_CASE("a clip with a known force has no residuals of a line in a(v)") {
  core::ClipResult clip = tests::made_clip("m1-up", 2.768, 0.8063, 0.667);
  clip.forced = true;
  CHECK(cells(report::motion_csv(clip))[101][9].empty());
}

TEST_CASE("a motion that is not finite is an error, and its file bears the clip's name") {
  core::ClipResult clip = tests::made_clip("m1-up", 2.768, 0.8063, 0.667);
  clip.motion[50].sd_x_m = std::numeric_limits<double>::infinity();
  CHECK_THROWS_AS(report::motion_csv(clip), base::NumericalError);
  const core::AnalysisResults results = tests::made_results();
  CHECK(report::motion_file_names(results)[0] == "motion" + report::phase_file_names(results)[0].substr(5));
}
