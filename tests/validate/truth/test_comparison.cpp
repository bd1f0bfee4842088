#include "validate/truth/comparison.h"

#include <cmath>

#include "base/errors.h"
#include "report/text/why_words.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

core::Quantity known(double value, double sd) {
  return {core::Estimate{value, sd, value - 1.96 * sd, value + 1.96 * sd}, {}};
}

/// One clip of 100 frames at constant speed, on a track whose reference point lies 0.3 m beyond the analysis' origin.
validate::Truth made_truth() {
  validate::Truth truth;
  truth.name = "made by hand";
  truth.configurations = {{"m1", 0.335, 4.0, "flat", 2.768, 0.0071, 4.311, 0.242, {"m1-up"}},
                          {"m2", 0.435, 4.0, "flat", 2.1307, std::nullopt, 4.2944, std::nullopt, {"m2-up"}}};
  for (const char* name : {"m1-up", "m2-up"}) {
    validate::TrueClip clip;
    clip.name = name;
    clip.configuration = std::string(name).substr(0, 2);
    clip.x_origin_m = 0.3;
    for (int k = 0; k < 101; ++k) {
      clip.t_s.push_back(k / 200.0);
      clip.x_m.push_back(-0.5 + 0.01 * k);
      clip.v_m_s.push_back(2.0);
      clip.a_m_s2.push_back(0.0);
    }
    truth.clips.push_back(clip);
  }
  return truth;
}

/// What an analysis without any error would find.
core::AnalysisResults perfect(const validate::Truth& truth) {
  core::AnalysisResults results;
  results.estimator = "phase-diagram";
  for (const validate::TrueClip& expected : truth.clips) {
    core::ClipResult clip;
    clip.name = expected.name;
    clip.frames = clip.detected = expected.t_s.size();
    core::LineFit line;
    line.direction = 1;
    line.r2 = 0.9998;
    clip.segments = {line};
    for (std::size_t k = 0; k < expected.t_s.size(); ++k) {
      core::MotionPoint point;
      point.t_s = expected.t_s[k];
      point.measured_m = expected.x_m[k] - expected.x_origin_m;
      clip.motion.push_back(point);
    }
    results.clips.push_back(clip);
  }
  for (const validate::TrueConfiguration& expected : truth.configurations) {
    core::ConfigurationResult configuration;
    configuration.mass_kg = expected.mass_kg;
    configuration.incline_deg = expected.stated_incline_deg;
    configuration.clips = expected.clips;
    configuration.k_over_m_1_s = known(*expected.k_over_m_1_s, 0.006);
    configuration.alpha_deg = known(*expected.alpha_deg, 0.01);
    configuration.mu = {std::nullopt, core::WhyUnknown{core::unknown::Told{"one direction only"}}};
    if (expected.v_lim_m_s) configuration.v_lim_m_s = known(*expected.v_lim_m_s, 0.001);
    if (!expected.v_lim_m_s) configuration.v_lim_m_s = known(0.3, 0.001);
    results.configurations.push_back(configuration);
  }
  return results;
}

const validate::QuantityComparison& find(const validate::Comparison& comparison, const std::string& configuration,
                                         const std::string& quantity) {
  for (const validate::QuantityComparison& compared : comparison.quantities) {
    if (compared.configuration == configuration && compared.quantity == quantity) return compared;
  }
  throw std::runtime_error("no " + quantity + " of " + configuration);
}

constexpr double kRounding = 1e-14;  // positions below 1 m, a handful of operations of 1.1e-16 each

}  // namespace

TEST_CASE("results without error compare as zero error") {
  const validate::Truth truth = made_truth();
  const validate::Comparison comparison = validate::compare(perfect(truth), truth);
  CHECK(comparison.quantities.size() == 8);
  CHECK(find(comparison, "m1", "k_over_m_1_s").error == 0.0);
  CHECK(find(comparison, "m1", "alpha_deg").error == 0.0);
  CHECK(comparison.restitution.rms_m < kRounding);
  CHECK(comparison.restitution.max_m < kRounding);
  CHECK(std::abs(comparison.restitution.field_m - 1.0) < kRounding);
  CHECK(comparison.frames == 202);
  CHECK(comparison.detected == 202);
  REQUIRE(comparison.lines.size() == 2);
  CHECK(comparison.lines[1].clip == "m2-up");
  CHECK(comparison.lines[1].r2 == 0.9998);
}

TEST_CASE("a wrong estimate shows with its size and sign") {
  const validate::Truth truth = made_truth();
  core::AnalysisResults results = perfect(truth);
  results.configurations[1].k_over_m_1_s = known(2.1307 * 1.02, 0.004);
  const validate::Comparison comparison = validate::compare(results, truth);
  const validate::QuantityComparison& compared = find(comparison, "m2", "k_over_m_1_s");
  CHECK(compared.truth == 2.1307);
  CHECK(compared.value == 2.1307 * 1.02);
  CHECK(compared.sd == 0.004);
  CHECK(std::abs(*compared.error - 0.02 * 2.1307) < kRounding);
  CHECK(find(comparison, "m1", "k_over_m_1_s").error == 0.0);
}

TEST_CASE("what has no truth or no estimate has no error, and says why") {
  const validate::Truth truth = made_truth();
  const validate::Comparison comparison = validate::compare(perfect(truth), truth);
  const validate::QuantityComparison& no_estimate = find(comparison, "m1", "mu");
  CHECK(no_estimate.truth == 0.0071);
  CHECK_FALSE(no_estimate.value);
  CHECK_FALSE(no_estimate.error);
  CHECK(report::why_words(no_estimate.why) == "one direction only");
  const validate::QuantityComparison& no_truth = find(comparison, "m2", "v_lim_m_s");
  CHECK_FALSE(no_truth.truth);
  CHECK(no_truth.value == 0.3);
  CHECK_FALSE(no_truth.error);
}

TEST_CASE("positions are compared frame by frame, frames without a marker left out") {
  const validate::Truth truth = made_truth();
  core::AnalysisResults results = perfect(truth);
  for (std::size_t k = 0; k < results.clips[0].motion.size(); ++k) {
    core::MotionPoint& point = results.clips[0].motion[k];
    if (k % 2 == 0) {
      point.measured_m.reset();
    } else {
      *point.measured_m += 3e-3;
    }
  }
  results.clips[1].motion[40].measured_m = *results.clips[1].motion[40].measured_m - 7e-3;
  results.clips[0].detected = 50;
  const validate::Comparison comparison = validate::compare(results, truth);
  // 50 errors of 3 mm, one of 7 mm and 100 of zero.
  const double expected = std::sqrt((50.0 * 9e-6 + 49e-6) / 151.0);
  CHECK(std::abs(comparison.restitution.rms_m - expected) < kRounding);
  CHECK(std::abs(comparison.restitution.max_m - 7e-3) < kRounding);
  CHECK(comparison.restitution.points.size() == 151);
  CHECK(comparison.detected == 151);
}

TEST_CASE("positions that are counted from a wrong origin show as error") {
  const validate::Truth truth = made_truth();
  core::AnalysisResults results = perfect(truth);
  for (core::MotionPoint& point : results.clips[0].motion) *point.measured_m += truth.clips[0].x_origin_m;
  CHECK(std::abs(validate::compare(results, truth).restitution.max_m - 0.3) < kRounding);
}

TEST_CASE("a marker that is seen a little late is compared with where it was then") {
  // A rolling shutter's row is read up to 3 ms after the frame's time; x = x0 + v0 t + a t²/2 is exact at any time.
  validate::Truth truth = made_truth();
  const double x0_m = -0.5, v0_m_s = 2.0, a_m_s2 = -3.0;
  const auto place = [&](double t_s) { return x0_m + v0_m_s * t_s + 0.5 * a_m_s2 * t_s * t_s; };
  validate::TrueClip& clip = truth.clips[0];
  for (std::size_t k = 0; k < clip.t_s.size(); ++k) {
    clip.x_m[k] = place(clip.t_s[k]);
    clip.v_m_s[k] = v0_m_s + a_m_s2 * clip.t_s[k];
    clip.a_m_s2[k] = a_m_s2;
  }
  core::AnalysisResults results = perfect(truth);
  for (std::size_t k = 0; k < clip.t_s.size(); ++k) {
    core::MotionPoint& point = results.clips[0].motion[k];
    point.t_s = clip.t_s[k] + 3e-5 * static_cast<double>(k);
    point.measured_m = place(point.t_s) - clip.x_origin_m;
  }
  const validate::Comparison comparison = validate::compare(results, truth);
  CHECK(comparison.restitution.max_m < kRounding);  // without the lateness 6 mm, without the acceleration 13 µm
  CHECK(comparison.restitution.rms_m < kRounding);
}

TEST_CASE("results and truth of different experiments do not compare") {
  const validate::Truth truth = made_truth();
  core::AnalysisResults renamed = perfect(truth);
  renamed.clips[0].name = "another";
  CHECK_THROWS_AS(validate::compare(renamed, truth), base::InputError);
  core::AnalysisResults fewer = perfect(truth);
  fewer.clips.pop_back();
  CHECK_THROWS_AS(validate::compare(fewer, truth), base::InputError);
  core::AnalysisResults longer = perfect(truth);
  longer.clips[0].motion.emplace_back();
  CHECK_THROWS_AS(validate::compare(longer, truth), base::InputError);
}
