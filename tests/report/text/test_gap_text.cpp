#include "report/text/display_text.h"

#include <nlohmann/json.hpp>

#include "report/diagnosis/diagnosis_json.h"
#include "report/diagnosis/diagnosis_report.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

diagnose::Diagnosis with_gap() {
  diagnose::Diagnosis diagnosis;
  diagnosis.verdict = diagnose::Verdict::unknown;
  diagnose::GapSizes gap;
  gap.before = 5.0;
  gap.after = 1.2;
  gap.shrink = 0.95;
  gap.acceleration_before = 0.02;
  gap.acceleration_after = 0.01;
  gap.parameters.push_back({"alpha_deg", diagnose::Against::plumb, "all", 3.0, {}});
  gap.interval95.before = diagnose::GapInterval{4.0, 6.25};
  gap.interval95.after = diagnose::GapInterval{1.0, 1.44};
  gap.interval95.shrink = diagnose::GapInterval{0.9, 1.0};
  gap.interval95.acceleration_before = diagnose::GapInterval{0.01, 0.04};
  diagnosis.gap = gap;
  return diagnosis;
}

nlohmann::json gap_of(const diagnose::Diagnosis& diagnosis) {
  return nlohmann::json::parse(report::diagnosis_json(diagnosis)).at("gap");
}

}  // namespace

TEST_CASE("a gap is written with its intervals over clips, and null with a reason where there is none") {
  const auto gap = gap_of(with_gap());
  CHECK(gap.at("interval95").at("before") == nlohmann::json({4.0, 6.25}));
  CHECK(gap.at("interval95").at("after") == nlohmann::json({1.0, 1.44}));
  CHECK(gap.at("interval95").at("shrink") == nlohmann::json({0.9, 1.0}));
  const auto& acceleration = gap.at("acceleration_m_s2").at("interval95");
  CHECK(acceleration.at("before") == nlohmann::json({0.01, 0.04}));
  CHECK(acceleration.at("after").is_null());
  CHECK_FALSE(acceleration.at("why").at("after").get<std::string>().empty());
  const auto& angle = gap.at("parameters").at(0);
  CHECK(angle.at("z_before") == 3.0);
  CHECK(angle.at("z_after").is_null());
  CHECK_FALSE(angle.at("why").at("z_after").get<std::string>().empty());
}

TEST_CASE("a gap that all but disappears shrinks by over 99.9 %, not by 100 %") {
  diagnose::GapSizes gap = *with_gap().gap;
  CHECK(report::shrink_text(gap) == "shrinks by 95.0 % (90.0 to 100.0 %)");
  gap.shrink = 0.99996;
  CHECK(report::shrink_text(gap) == "shrinks by 100.0 % (90.0 to 100.0 %)");
  gap.interval95.shrink = diagnose::GapInterval{0.9993, 1.0};
  CHECK(report::shrink_text(gap) == "shrinks by over 99.9 %");
  gap.interval95.shrink = {};
  CHECK(report::shrink_text(gap) == "shrinks by over 99.9 %");
}

TEST_CASE("where there are too few clips for an interval, the file and the text say so") {
  diagnose::Diagnosis diagnosis = with_gap();
  diagnosis.gap->interval95 = {
      .before = {}, .after = {}, .shrink = {}, .acceleration_before = {}, .acceleration_after = {}, .too_few = 2};
  const auto gap = gap_of(diagnosis);
  for (const char* key : {"before", "after", "shrink"}) {
    CHECK(gap.at("interval95").at(key).is_null());
    CHECK(gap.at("interval95").at("why").at(key) ==
          "2 clips cannot show how much clips differ: an interval needs three or more");
  }
  CHECK(report::diagnosis_text(diagnosis).find("2 clips cannot show how much clips differ") != std::string::npos);
  CHECK(report::shrink_text(*diagnosis.gap) == "shrinks by 95.0 %");
}

TEST_CASE("intervals read as from what to what") {
  CHECK(report::interval_text(diagnose::GapInterval{4.0, 6.25}) == "4.00 to 6.25");
  CHECK(report::interval_text({}) == "–");
  CHECK(report::shrink_text(*with_gap().gap) == "shrinks by 95.0 % (90.0 to 100.0 %)");
  diagnose::GapSizes larger = *with_gap().gap;
  larger.shrink = -1.678;
  larger.interval95.shrink = {-2.0, 0.1};
  CHECK(report::shrink_text(larger) == "grows by 167.8 % (-10.0 to 200.0 %)");
  const std::string text = report::diagnosis_text(with_gap());
  CHECK(text.find("4.00 to 6.25 before, 1.00 to 1.44 after") != std::string::npos);
  CHECK(text.find("0.02 m/s² (0.0100 to 0.0400) before, 0.01 m/s² after") != std::string::npos);
}
