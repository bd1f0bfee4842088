#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/experiment/experiment.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "validate/blind/case/blind_effects.h"
#include "validate/blind/case/blind_strength.h"
#include "validate/blind/case/everyday_causes.h"
#include "validate/blind/case/everyday_law.h"
#include "validate/blind/run_blind.h"

using namespace glidelab;
namespace fs = std::filesystem;
using validate::EverydayClass;

namespace {

/// Four clips on one slope, two masses.
validate::BlindDesign small_design() {
  validate::BlindDesign design;
  design.k_n_s_m = 0.5;
  design.mu = 0.01;
  design.noise_sd_m = 1e-4;
  design.groups.push_back({"inclined", 0.06, 0.06, 2e-3});
  design.masses.push_back({0.3, 0.3, 0.0});
  design.masses.push_back({0.5, 0.5, 0.0});
  for (std::size_t c = 0; c < 4; ++c) {
    const double direction = c % 2 == 0 ? -1.0 : 1.0;
    design.clips.push_back(
        {"c" + std::to_string(c), 0, c / 2, -0.3 * direction, direction * (0.6 + 0.1 * double(c)), 50.0, 50});
  }
  return design;
}

/// All positions over the noise, clip after clip.
Eigen::VectorXd positions(const validate::BlindDesign& design, const std::vector<validate::BlindPut>& puts = {}) {
  std::vector<double> all;
  for (std::size_t c = 0; c < design.clips.size(); ++c) {
    validate::BlindFilm film = validate::nominal_film(design, design.clips[c]);
    for (const auto& put : puts) put.effect->put(put.size, c, film);
    for (const double x : validate::seen_positions(design.clips[c], film)) all.push_back(x / design.noise_sd_m);
  }
  return Eigen::Map<Eigen::VectorXd>(all.data(), std::ssize(all));
}

/// Terms of a law with one effect in it, at (x, v) in a clip.
validate::BlindTerms terms(const validate::BlindDesign& design, const validate::BlindEffect& effect, double size,
                           std::size_t clip, double x, double v) {
  validate::BlindFilm film = validate::nominal_film(design, design.clips[clip]);
  effect.put(size, clip, film);
  validate::BlindTerms at{1.0, 2.0 * v, 3.0, 0.3, 0.3};
  for (const auto& change : film.law.changes) change(x, v, 0.5, at);
  return at;
}

validate::BlindEffect effect_of(const std::string& id, const validate::BlindDesign& design, std::uint64_t seed = 7) {
  validate::BlindRandom random(seed);
  return validate::draw_everyday_effect(id, design, random);
}

}  // namespace

TEST_CASE("the excess is that of clips held out one by one, each over the covariance of its prediction") {
  const validate::BlindDesign design = small_design();
  const validate::BlindEffect drag = effect_of("quadratic_drag", design);
  constexpr double kSize = 0.01;  // so small that the positions are linear in all: bends are of the order of its square
  const validate::BlindDetection detection(design);
  const std::vector<validate::BlindPut> acting = {{&drag, kSize}};

  // Parameters anew: K, mu, the slope with its statement, and the starts; derivatives by central differences.
  std::vector<std::pair<double, std::function<void(validate::BlindDesign&, double)>>> shared = {
      {1e-4, [](auto& d, double by) { d.k_n_s_m += by; }},
      {1e-6, [](auto& d, double by) { d.mu += by; }},
      {1e-6, [](auto& d, double by) { d.groups[0].true_rad += by; }}};
  const auto derivative = [&](double step, const auto& change) -> Eigen::VectorXd {
    validate::BlindDesign up = design, down = design;
    change(up, step);
    change(down, -step);
    return (positions(up) - positions(down)) / (2.0 * step);
  };
  Eigen::MatrixXd columns(200, 3);
  for (Eigen::Index n = 0; n < 3; ++n) columns.col(n) = derivative(shared[n].first, shared[n].second);
  const Eigen::VectorXd off = positions(design, acting) - positions(design);
  double chi2 = 0.0;
  for (Eigen::Index out = 0; out < 4; ++out) {
    Eigen::Matrix3d inform = Eigen::Matrix3d::Zero();
    Eigen::Vector3d pull = Eigen::Vector3d::Zero();
    inform(2, 2) = 1.0 / (2e-3 * 2e-3);
    Eigen::MatrixXd held;
    Eigen::VectorXd held_off;
    for (Eigen::Index c = 0; c < 4; ++c) {
      Eigen::MatrixXd start(50, 2);
      start.col(0) = derivative(1e-5, [&](auto& d, double by) { d.clips[c].x0_m += by; }).segment(50 * c, 50);
      start.col(1) = derivative(1e-5, [&](auto& d, double by) { d.clips[c].v0_m_s += by; }).segment(50 * c, 50);
      const Eigen::MatrixXd free =
          Eigen::MatrixXd::Identity(50, 50) - start * (start.transpose() * start).inverse() * start.transpose();
      const Eigen::MatrixXd rows = free * columns.middleRows(50 * c, 50);
      const Eigen::VectorXd left = free * off.segment(50 * c, 50);
      if (c == out) {
        held = rows;
        held_off = left;
        continue;
      }
      inform += rows.transpose() * rows;
      pull += rows.transpose() * left;
    }
    const Eigen::VectorXd error = held_off - held * inform.ldlt().solve(pull);
    const Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(50, 50) + held * inform.inverse() * held.transpose();
    chi2 += error.dot(covariance.ldlt().solve(error));
  }
  const double wanted = chi2 / 200.0;
  REQUIRE(wanted > 0.01);
  // Forward differences of 1e-4 of K, and a fit that settles to 1 % of chi².
  CHECK(detection.first_order_excess(acting, {}) == Approx(wanted).epsilon(0.02));
  CHECK(detection.excess(acting, {}).value() == Approx(wanted).epsilon(0.02));
  // With the effect itself in the law nothing is left, but what the fit's end leaves open (0.01 of chi²).
  CHECK(detection.excess(acting, {{&drag, 0.9 * kSize}}).value() < 1e-3 * wanted);
}

TEST_CASE("causes of a rig have the laws of the list") {
  const validate::BlindDesign design = small_design();
  const auto directed = effect_of("direction_dependent_drag", design);
  const double fore = terms(design, directed, 0.2, 0, 0.1, 1.0).drag_n,
               back = terms(design, directed, 0.2, 0, 0.1, -1.0).drag_n;
  CHECK(std::abs(fore + back) == Approx(2.0 * 2.0 * 0.2));  // 2 (1 + d) - 2 (1 - d)
  CHECK(std::abs(fore - back) == Approx(4.0));

  const auto drift = effect_of("friction_drift", design);
  const double step = terms(design, drift, 0.1, 1, 0.0, 1.0).friction_n - 3.0;
  CHECK(std::abs(step) == Approx(0.3));
  CHECK(terms(design, drift, 0.1, 0, 0.0, 1.0).friction_n == Approx(3.0));
  CHECK(terms(design, drift, 0.1, 3, 0.0, 1.0).friction_n == Approx(3.0 + 3.0 * step));

  // Two configurations: deviates of mean 0 and sd 1 are 1 and -1.
  const auto friction = effect_of("configuration_friction", design);
  CHECK(terms(design, friction, 0.1, 0, 0.0, 1.0).friction_n ==
        Approx(terms(design, friction, 0.1, 1, 0.0, 1.0).friction_n));
  CHECK(terms(design, friction, 0.1, 0, 0.0, 1.0).friction_n + terms(design, friction, 0.1, 2, 0.0, 1.0).friction_n ==
        Approx(6.0));
  const auto drag = effect_of("configuration_drag", design);
  CHECK(terms(design, drag, 0.1, 0, 0.0, 1.0).drag_n + terms(design, drag, 0.1, 2, 0.0, 1.0).drag_n == Approx(4.0));

  const auto scatter = effect_of("clip_scatter", design);
  CHECK(terms(design, scatter, 0.1, 0, 0.0, 1.0).friction_n != terms(design, scatter, 0.1, 1, 0.0, 1.0).friction_n);

  const auto place = effect_of("place_friction", design);
  CHECK(terms(design, place, 0.1, 0, 0.2, 1.0).friction_n == terms(design, place, 0.1, 3, 0.2, -1.0).friction_n);
  CHECK(terms(design, place, 0.1, 0, 0.2, 1.0).friction_n != terms(design, place, 0.1, 0, 0.5, 1.0).friction_n);

  const auto stop = effect_of("end_stop", design);
  const auto of = stop.truth(2.0);
  const double end = of.at("end"), beyond = of.at("x_b_m") + 0.1 * end;
  CHECK(terms(design, stop, 2.0, 0, beyond, 1.0).drive_n == Approx(1.0 - end * 2.0 * 0.1));
  CHECK(terms(design, stop, 2.0, 0, of.at("x_b_m") - 0.1 * end, 1.0).drive_n == 1.0);
}

TEST_CASE("an effect is the same as another where no data of a design tell them apart") {
  validate::BlindDesign design = small_design();
  CHECK(validate::equals_of("scale_error", design, false) == std::vector<std::string>{"frame_rate_error"});
  CHECK(validate::equals_of("end_stop", design, true) == std::vector<std::string>{"tether"});
  CHECK(validate::equals_of("end_stop", design, false).empty());
  CHECK(validate::equals_of("configuration_friction", design, false) ==
        std::vector<std::string>{"load_independent_friction"});
  design.masses.push_back({0.7, 0.7, 0.0});
  CHECK(validate::equals_of("configuration_friction", design, false).empty());
}

TEST_CASE("the true terminal velocity has the cause in the law") {
  const validate::BlindDesign design = small_design();
  const validate::BlindEffect drag = effect_of("quadratic_drag", design);
  const std::vector<std::vector<double>> x(4, std::vector<double>{-0.5, 0.5});
  const auto list = validate::everyday_configurations(design, {{&drag, 0.8}}, x);
  REQUIRE(list.size() == 2);
  for (const auto& one : list) {
    // K v + C v² = push, C = 0.8 K as the cause counts it.
    const double push = one.mass_kg * 9.80665 * (std::sin(0.06) - 0.01 * std::cos(0.06)), k = 0.5, c = 0.4;
    const double v = (-k + std::sqrt(k * k + 4.0 * c * push)) / (2.0 * c);
    CHECK(one.v_lim_m_s.value() == Approx(v).epsilon(1e-9));  // a bisection to rounding
    CHECK(one.k_over_m_1_s == Approx(0.5 / one.mass_kg));
    CHECK(one.mu == Approx(0.01));
  }
  const validate::BlindEffect friction = effect_of("configuration_friction", design);
  const auto each = validate::everyday_configurations(design, {{&friction, 0.1}}, x);
  CHECK(0.5 * (each[0].mu + each[1].mu) == Approx(0.01));
  CHECK(std::abs(each[0].mu - each[1].mu) == Approx(2e-3));
}

TEST_CASE("noise of clicks and rounding has the sd that a case states, and rounded positions lie on the step") {
  validate::BlindRandom random(3);
  const auto noise = validate::draw_noise(1e-3, true, true, random);
  REQUIRE(noise.rounded_m >= 5e-4);
  REQUIRE(noise.clicked_sd_m > 0.0);
  // Positions spread over many steps, so that rounding errors are uniform.
  std::vector<double> x;
  for (int k = 0; k < 100000; ++k) x.push_back(0.37e-3 * k);
  const auto seen = validate::with_noise(x, noise, random);
  double square = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    square += (seen[k] - x[k]) * (seen[k] - x[k]);
    REQUIRE(std::abs(std::remainder(seen[k], noise.rounded_m)) < 1e-9);
  }
  // 1e5 values, a memory of up to 2.5: about 2e4 independent ones, a relative error of the sd of 1/sqrt(4e4) = 0.5 %.
  CHECK(std::sqrt(square / 1e5) == Approx(1e-3).epsilon(0.025));
}

TEST_CASE("classes of everyday cases are as frequent as stated") {
  std::map<EverydayClass, double> seen;
  constexpr std::size_t kCases = 4000;
  for (std::size_t i = 0; i < kCases; ++i) seen[validate::everyday_class(27, i)] += 1.0;
  const std::map<EverydayClass, double> share = {{EverydayClass::one, 0.50},
                                                 {EverydayClass::two, 0.20},
                                                 {EverydayClass::imperfect, 0.15},
                                                 {EverydayClass::outside, 0.15}};
  double chi2 = 0.0;
  for (const auto& [kind, p] : share) chi2 += std::pow(seen[kind] - p * kCases, 2) / (p * kCases);
  CHECK(chi2 < 16.3);  // three degrees of freedom, p = 0.001
}

TEST_CASE("an everyday case is the same for a seed and an index, with imperfections, shares and a folder as stated") {
  std::set<EverydayClass> kinds;
  for (const std::size_t index : {0, 2, 3, 7, 9}) {
    const auto one = validate::make_everyday_case(1, index);
    INFO("case " << index);
    if (index == 0) CHECK(validate::make_everyday_case(1, index).x_m == one.x_m);
    CHECK(one.truth.kind == validate::everyday_class(1, index));
    kinds.insert(one.truth.kind);
    CHECK(one.design.clips.size() >= 4);
    CHECK(one.design.clips.size() <= 12);
    CHECK(one.causes.size() == one.truth.shares.size());
    const std::size_t of_noise = (one.noise.clicked_sd_m > 0.0 ? 1 : 0) + (one.noise.rounded_m > 0.0 ? 1 : 0);
    CHECK(one.truth.imperfections.size() + of_noise >= 3);
    CHECK(one.truth.imperfections.size() + of_noise <= 5);
    double sum = one.truth.remainder;
    for (const double share : one.truth.shares) sum += share;
    CHECK(sum == Approx(1.0));
    if (!one.causes.empty()) {
      CHECK(one.truth.remainder >= validate::kLeastImperfections);
      CHECK(one.truth.remainder <= validate::kMostImperfections);
      CHECK(one.truth.excess >= validate::kModerateExcess);
      CHECK((one.truth.excess >= validate::kStrongExcess) == one.truth.strong);
    }
    if (one.truth.kind == EverydayClass::two) CHECK(one.truth.shares.back() >= validate::kLeastSecond);

    tests::TempDir temp;
    validate::write_blind_folder(one, temp / "case");
    CHECK(core::read_experiment(temp / "case").clips.size() == one.design.clips.size());
    std::vector<std::string> secrets = {"truth", "share", "dirt"};
    for (const auto& cause : one.causes) secrets.push_back(cause.id);
    for (const auto& imperfection : one.truth.imperfections) secrets.push_back(imperfection.id);
    for (const auto& entry : fs::recursive_directory_iterator(temp / "case")) {
      if (!entry.is_regular_file()) continue;
      const std::string text = base::read_file(entry.path());
      for (const std::string& secret : secrets) CHECK(text.find(secret) == std::string::npos);
    }
  }
  CHECK(kinds.size() == 4);
}

TEST_CASE("an everyday run leaves truth and time, goes on where it stopped, and takes no pictures") {
  tests::TempDir temp;
  std::size_t calls = 0;
  const validate::Diagnoser diagnoser = [&](const fs::path& folder, const fs::path& out, const auto&) -> std::string {
    ++calls;
    CHECK(!fs::exists(temp / "out" / "truth" / (folder.filename().string() + ".json")));
    if (calls == 1) return "made to fail";
    base::write_file(out / "diagnosis.json",
                     R"({"format": 1, "verdict": "none", "points": 9, "effects": [], "ranking": [], "gap": null,
                         "probability": {"none": 1, "unknown": 0}, "where": {"regions": []}})");
    return "";
  };
  validate::BlindOptions options;
  options.seed = 1;
  options.everyday = true;
  options.cases = 1;
  CHECK_FALSE(validate::run_blind(options, temp / "out", diagnoser).front().verdict.verdict);
  options.cases = 3;
  const auto outcomes = validate::run_blind(options, temp / "out", diagnoser);
  CHECK(calls == 3);
  for (const auto& outcome : outcomes) {
    CHECK(outcome.everyday.has_value());
    CHECK(outcome.seconds.has_value());
  }
  options.everyday = false;
  CHECK_THROWS_AS(validate::run_blind(options, temp / "out", diagnoser), base::InputError);
  options.everyday = options.images = true;
  CHECK_THROWS_AS(validate::run_blind(options, temp / "other", diagnoser), base::InputError);
  options.images = false;
  options.leave_out = true;
  CHECK_THROWS_AS(validate::run_blind(options, temp / "other", diagnoser), base::InputError);
}

TEST_CASE("of many everyday cases every one has imperfections of 2 to 30 per cent", "[slow]") {
  for (std::size_t index = 100; index < 140; ++index) {
    const auto one = validate::make_everyday_case(27, index);
    INFO("case " << index);
    if (one.causes.empty()) continue;
    CHECK(one.truth.remainder >= validate::kLeastImperfections);
    CHECK(one.truth.remainder <= validate::kMostImperfections);
  }
}
