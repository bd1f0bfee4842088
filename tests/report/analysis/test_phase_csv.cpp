#include "report/analysis/result_files.h"

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/text/csv.h"
#include "report/text/display_text.h"
#include "tests/catch.h"
#include "tests/report/made_results.h"
#include "tests/temp_dir.h"

using namespace glidelab;

TEST_CASE("the CSV of a clip reads back as the smoothed motion, bit for bit") {
  const tests::TempDir temp;
  core::ClipResult clip = tests::made_clip("m1-up", 2.768, 0.8063, 0.667);
  clip.motion[3].smoothed = false;
  base::write_file(temp / "phase.csv", report::phase_csv(clip));
  const base::CsvTable table = base::read_csv(temp / "phase.csv", {"t_s", "x_m", "v_m_s", "a_m_s2", "used"}, {}, true);
  REQUIRE(table.column("t_s").size() == clip.motion.size() - 1);
  CHECK(table.column("t_s")[3] == clip.motion[4].t_s);
  CHECK(table.column("x_m")[3] == clip.motion[4].x_m);
  CHECK(table.column("v_m_s")[100] == clip.motion[101].v_m_s);
  CHECK(table.column("a_m_s2")[100] == clip.motion[101].a_m_s2);
  CHECK(table.column("used")[0] == 0.0);
  CHECK(table.column("used")[100] == 1.0);
}

TEST_CASE("a smoothed value that is not finite is an error and not a row") {
  core::ClipResult clip = tests::made_clip("m1-up", 2.768, 0.8063, 0.667);
  clip.motion[50].a_m_s2 = std::nan("");
  CHECK_THROWS_AS(report::phase_csv(clip), base::NumericalError);
}

TEST_CASE("a clip's name never leads out of the folder, and two clips never share a file") {
  core::AnalysisResults results = tests::made_results();
  results.clips[0].name = "../../etc/x";
  CHECK(report::phase_file_names(results)[0] == "phase-..%2F..%2Fetc%2Fx.csv");
  results.clips[0].name = results.clips[1].name = "run";
  results.clips[1].experiment = "second folder";
  CHECK(report::phase_file_names(results) ==
        std::vector<std::string>{"phase-made by hand-run.csv", "phase-second folder-run.csv"});
  results.clips[1].experiment = results.clips[0].experiment;
  CHECK(report::phase_file_names(results)[0] != report::phase_file_names(results)[1]);
}
