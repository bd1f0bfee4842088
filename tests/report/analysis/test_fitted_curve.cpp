#include "report/analysis/fitted_curve.h"

#include <cmath>
#include <numbers>

#include "report/analysis/analysis_report.h"
#include "tests/catch.h"
#include "tests/report/made_results.h"

using namespace glidelab;

namespace {

constexpr double kG = 9.80665, kAlpha_deg = 4.0, kMu = 0.01;

/// One stretch of the closed form of dv/dt = a0 - k v in the direction of v0, a sine of `off_m` beside it.
core::AnalysisResults moving(double k, double v0, double off_m) {
  const int direction = v0 > 0.0 ? 1 : -1;
  const double alpha = kAlpha_deg * std::numbers::pi / 180.0;
  const double a0 = kG * (std::sin(alpha) - direction * kMu * std::cos(alpha));
  core::ClipResult clip;
  clip.name = "up";
  clip.position_noise_m = 2e-5;
  for (int i = 0; i < 200; ++i) {
    core::MotionPoint point;
    const double t = 0.002 * i;
    point.t_s = 1.0 + t;
    const double phi = k == 0.0 ? t : -std::expm1(-k * t) / k;
    const double psi = k == 0.0 ? 0.5 * t * t : (t - phi) / k;
    point.measured_m = 0.3 + v0 * phi + a0 * psi + off_m * std::sin(40.0 * std::numbers::pi * t);
    point.smoothed = true;
    clip.motion.push_back(point);
  }
  clip.stretches = {{1.0, 1.4, direction, 200}};
  core::ConfigurationResult configuration;
  configuration.mass_kg = 0.3;
  configuration.clips = {"up"};
  configuration.k_over_m_1_s = tests::known(k, 0.01);
  configuration.mu = tests::known(kMu, 0.001);
  configuration.alpha_deg = tests::known(kAlpha_deg, 0.01);
  configuration.v_lim_m_s = core::Quantity{{}, core::WhyUnknown{core::unknown::InterceptNotPositive{}}};
  core::AnalysisResults results;
  results.gravity_m_s2 = kG;
  results.clips = {clip};
  results.configurations = {configuration};
  return results;
}

}  // namespace

TEST_CASE("the fitted curve of a motion that obeys the recovered law is that motion, in either direction") {
  for (const double k : {0.0, 1e-4, 2.7}) {
    for (const double v0 : {-0.9, 0.4}) {
      const core::AnalysisResults results = moving(k, v0, 0.0);
      const auto curves = report::fitted_curves(results.clips[0], results.configurations[0], kG);
      REQUIRE(curves.size() == 1);
      CHECK(curves[0].t_s.size() == 200);
      // Of numbers about 1, divided by k twice: 1e-16 / 1e-4 in this oracle, and a condition of 1e3 in the solution.
      CHECK(curves[0].rms_m < 1e-11);
    }
  }
}

TEST_CASE("what the law does not have stays between the positions and the curve") {
  // A sine of whole periods over the stretch, which a start can hardly take up: rms of 1/sqrt 2 of its height.
  const core::AnalysisResults results = moving(2.7, 0.4, 1e-3);
  const auto curves = report::fitted_curves(results.clips[0], results.configurations[0], kG);
  REQUIRE(curves.size() == 1);
  CHECK(curves[0].rms_m == Approx(1e-3 / std::sqrt(2.0)).epsilon(0.05));
}

TEST_CASE("a clip under a known force has no fitted curve, nor one without a law") {
  core::AnalysisResults results = moving(2.7, 0.4, 0.0);
  results.clips[0].forced = true;
  CHECK(report::fitted_plots(results, 4).empty());
  results.clips[0].forced = false;
  CHECK(report::fitted_plots(results, 4).size() == 1);
  results.configurations[0].mu = core::Quantity{{}, core::WhyUnknown{core::unknown::NotBothLines{true, false}}};
  CHECK(report::fitted_plots(results, 4).empty());
  results.configurations[0].lines = {tests::made_line(1, 2.7, 0.6)};
  CHECK(report::fitted_plots(results, 4).size() == 1);
}

TEST_CASE("an analysis' page has the values as tiles, one plot and one table open, and all other plots folded") {
  const std::string html = report::analysis_report("glider", moving(2.7, 0.4, 0.0), {}).html;
  const std::size_t tile = html.find("<b>2.700"), table = html.find("id=\"recovered\""),
                    fitted = html.find("id=\"fitted\"");
  const std::string fold = "<details class=\"part\"";
  CHECK(tile < table);
  CHECK(table < html.find(fold));
  CHECK(tile < html.find("id=\"meaning\""));  // then what they mean
  CHECK(html.find(fold) < fitted);
  CHECK(fitted < html.find("id=\"phase\""));
  const std::string many = report::analysis_report("track", tests::made_results(), {}).html;
  const std::string open = many.substr(0, many.find(fold));
  CHECK(open.find("<figure>") != std::string::npos);
  CHECK(open.find("<figure>") == open.rfind("<figure>"));
  CHECK(open.find("<figure>") < open.find("<table"));
  CHECK(fitted != std::string::npos);
  CHECK(html.find("fit of") == std::string::npos);  // the lines' name, not that of the other estimator
}
