#include "diagnose/noise/position_noise.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/math/dense.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/fit_neighbourhood.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/tracks/whitening.h"
#include "diagnose/verdict/diagnose.h"
#include "diagnose/verdict/settled_motions.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

constexpr double kPxPerM = 600.0;
constexpr double kMode = 1e-6;  // one error of the camera: a scale, by so much

/// Clips of a camera at 100 Hz whose columns lie along the track: `off_px` is what a position errs by at (column,
/// speed in px/s), besides white noise of 0.002 px; `sway_px` is how far the image is moved at a time.
tests::MadeExperiment filmed(
    const std::function<double(double u_px, double v_px_s)>& off_px, unsigned seed,
    const std::function<double(double t_s)>& sway_px = [](double) { return 0.0; }, const tests::MadeEffect& effect = {},
    const std::vector<tests::MadeLaunch>& launches = tests::made_launches()) {
  constexpr std::size_t kFrames = 145;
  constexpr double kRate = 100.0;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  tests::MadeExperiment made = tests::made_experiment(launches, {}, seed);
  for (std::size_t c = 0; c < made.results.clips.size(); ++c) {
    const std::vector<double> x_m = tests::made_motion({}, launches[c], effect, kFrames + 1, kRate);
    core::TrackData track;
    track.frame_rate_hz = kRate;
    for (std::size_t k = 0; k < kFrames; ++k) {
      core::MarkerSighting sighting;
      sighting.frame = k;
      const double sway = sway_px(static_cast<double>(k) / kRate);
      sighting.u_px = 500.0 + kPxPerM * x_m[k] + sway;
      sighting.v_px = 120.0;
      track.sightings.push_back(sighting);
      track.frame.push_back(k);
      track.t_s.push_back(static_cast<double>(k) / kRate);
      const double v_px_s = (x_m[k + 1] - x_m[k]) * kRate * kPxPerM;
      track.x_m.push_back(x_m[k] + (sway + off_px(sighting.u_px, v_px_s) + 0.002 * normal(random)) / kPxPerM);
    }
    track.frame_t_s = track.t_s;
    track.shared_m = {track.x_m};
    for (double& mode : track.shared_m.front()) mode *= kMode;
    made.results.clips[c] =
        core::analyze_motion(made.setups[c], track, core::MotionOptions{.lost_frames = core::LostFrameTimes::kept});
    made.results.clips[c].sightings = track.sightings;
  }
  return made;
}

/// Pixels that differ from each other: at each half pixel an error of its own, straight lines between.
std::function<double(double, double)> pixels_that_differ(double sd_px, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, sd_px);
  std::vector<double> at(4000);
  for (double& error : at) error = normal(random);
  return [at](double u_px, double) {
    const double place = 2.0 * (u_px + 200.0);
    const auto below = static_cast<std::size_t>(place);
    const double part = place - static_cast<double>(below);
    return (1.0 - part) * at.at(below) + part * at.at(below + 1);
  };
}

/// chi² a point under the noise that was found.
double chi2_of_fit(const diagnose::TrackSet& set, const diagnose::MotionFit& fit) {
  double points = 0.0;
  for (const auto& motion : set.motions) points += static_cast<double>(motion.t_s.size());
  return fit.cost / points;
}

double chi2_of(const diagnose::TrackSet& set) {
  return chi2_of_fit(set, diagnose::fit_nominal(set));
}

}  // namespace

TEST_CASE("whitening makes the unit matrix of the covariance, and colouring takes it back") {
  diagnose::TrackedMotion motion;
  motion.sd_m = 2e-6;
  motion.m_per_px = 1e-3;
  for (std::size_t k = 0; k < 300; ++k) {  // more than are whitened together; it turns at frame 100
    const double t = 0.01 * static_cast<double>(k);
    motion.t_s.push_back(t);
    motion.along_px.push_back(50.0 * (t - 1.0) * (t - 1.0));
    motion.x_m.push_back(motion.m_per_px * motion.along_px.back());
    motion.outlier.push_back(k == 40 ? 1 : 0);
  }
  diagnose::NoiseShape shape;
  shape.pixels = 0.8;
  shape.phase = 0.5;
  shape.lasting = 0.6;
  shape.jitter_s = 1e-5;
  diagnose::whiten(motion, shape, 100.0);
  const auto n = static_cast<Eigen::Index>(motion.whitening.front().rows());
  REQUIRE(n == 150);
  // Of the first stretch: over each position's own noise the covariance has ones on its diagonal.
  diagnose::SeenFrames frames = diagnose::seen_frames(motion, 100.0);
  const Eigen::MatrixXd all = diagnose::covariance_of(frames, shape, motion.sd_m / motion.m_per_px);
  Eigen::MatrixXd of = all.topLeftCorner(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    CHECK(std::abs(motion.wider[static_cast<std::size_t>(i)] - std::sqrt(all(i, i))) < 1e-12);
    for (Eigen::Index j = 0; j < n; ++j) of(i, j) = all(i, j) / std::sqrt(all(i, i) * all(j, j));
  }
  of.row(40).setZero();  // an outlier shares nothing
  of.col(40).setZero();
  of(40, 40) = 1.0;
  const Eigen::MatrixXd& by = motion.whitening.front();
  const Eigen::MatrixXd unit = base::product(base::product(by, of), by.transpose());
  CHECK((unit - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff() < 1e-10);  // condition below 1e3, 150 sums
  Eigen::VectorXd some(300);
  for (Eigen::Index i = 0; i < 300; ++i) some[i] = std::sin(static_cast<double>(i * i));
  const Eigen::VectorXd back = diagnose::coloured(motion, diagnose::whitened(motion, some));
  CHECK((back - some).cwiseAbs().maxCoeff() < 1e-10);

  motion.m_per_px = 1.0;  // its pixel is a metre, which is what a track's positions are in
  motion.along_px = motion.x_m;
  diagnose::whiten(motion, shape, 100.0);
  const std::vector<Eigen::MatrixXd> metres = motion.whitening;
  motion.m_per_px = 0.0;
  motion.along_px.clear();
  diagnose::whiten(motion, shape, 100.0);
  REQUIRE(motion.whitening.size() == metres.size());
  for (std::size_t s = 0; s < metres.size(); ++s) CHECK(motion.whitening[s] == metres[s]);

  motion.m_per_px = 1e-3;  // filmed, and hardly moving: places are not known
  diagnose::whiten(motion, shape, 100.0);
  CHECK(motion.whitening.empty());
  CHECK(diagnose::whitened(motion, some) == some);
}

TEST_CASE("what is set aside beside a slow wave has each direction once") {
  // Of 0.5 Hz: over 80 frames at 100 Hz half a period, which the bumps ten frames apart have as well.
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), {}, 1);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit fit = diagnose::fit_nominal(set);
  const auto plain = diagnose::noise_chunks(set, fit, 0.0), waved = diagnose::noise_chunks(set, fit, 0.5);
  REQUIRE(plain.size() == waved.size());
  for (std::size_t c = 0; c < plain.size(); ++c) {
    const Eigen::MatrixXd& slow = waved[c].slow;
    const Eigen::MatrixXd unit = base::transposed_product(slow, slow);
    CHECK((unit - Eigen::MatrixXd::Identity(slow.cols(), slow.cols())).cwiseAbs().maxCoeff() < 1e-12);
    CHECK(slow.cols() >= plain[c].slow.cols());
  }
}

TEST_CASE("pixels that differ from each other are noise that slow frames share, and no effect") {
  // 0.004 px: twice the white noise, the same for all clips.
  const tests::MadeExperiment made = filmed(pixels_that_differ(0.004, 3), 11);
  diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const double white = chi2_of(set);
  REQUIRE(diagnose::find_position_noise(set, diagnose::fit_nominal(set)));
  const diagnose::PositionNoise& noise = *set.position_noise;
  CHECK(noise.shape.pixels > 0.75);  // 1.6 in truth: the field's mean square is 2/3 of its knots'
  CHECK(noise.shape.jitter_s == 0.0);
  CHECK(noise.jitter_log_evidence < 3.0);
  // Of 1160 points a standard deviation of 0.04, and as much again for the noise, which is found from the same points.
  CHECK(std::abs(chi2_of(set) - 1.0) < 0.2);
  CHECK(white > 1.12);  // what neighbours show of it by themselves is too little, by three of them
  CHECK(diagnose::diagnose_results(made.results, made.setups, {}).verdict == diagnose::Verdict::none);
}

TEST_CASE("white noise of filmed positions stays white") {
  const tests::MadeExperiment made = filmed([](double, double) { return 0.0; }, 12);
  diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  REQUIRE(diagnose::find_position_noise(set, diagnose::fit_nominal(set)));
  for (const auto& motion : set.motions) {
    // 0.002 px: 145 points know it to 6 %, and a part that is not there may have taken a tenth.
    CHECK(std::abs(motion.sd_of(70) / motion.m_per_px / 0.002 - 1.0) < 0.25);
  }
  CHECK(set.position_noise->jitter_log_evidence < 3.0);
  CHECK(set.position_noise->lasting_log_evidence == 0.0);  // not asked for: no file with loss
}

TEST_CASE("a camera that sways strongly makes no noise") {
  // 0.4 px at 6.03 Hz, between the frequencies that are tried. 145 points know the noise to 6 %.
  const auto sway = [](double t_s) { return 0.4 * std::sin(2.0 * std::acos(-1.0) * 6.03 * t_s + 0.7); };
  const tests::MadeExperiment made = filmed([](double, double) { return 0.0; }, 15, sway);
  diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  REQUIRE(diagnose::find_position_noise(set, diagnose::fit_nominal(set)));
  for (const auto& motion : set.motions) CHECK(std::abs(motion.sd_of(70) / motion.m_per_px / 0.002 - 1.0) < 0.25);
}

TEST_CASE("what an effect makes of the motion is no noise once the effect explains it") {
  // A soft bumper, which turns every launch back within some 50 frames.
  constexpr double kStiffness_n_m = 15.0, kPlace_m = 0.0;
  tests::MadeEffect bumper;
  bumper.force = [](double, double x, double, double) { return x > kPlace_m ? -kStiffness_n_m * (x - kPlace_m) : 0.0; };
  std::vector<tests::MadeLaunch> launches;
  for (const double mass_kg : {0.335, 0.535}) {
    launches.push_back({mass_kg, 0.0, -0.5, 1.2});
    launches.push_back({mass_kg, 4.0, -0.6, 1.0});
    launches.push_back({mass_kg, 4.0, 0.2, -0.9});
  }
  const tests::MadeExperiment made =
      filmed([](double, double) { return 0.0; }, 16, [](double) { return 0.0; }, bumper, launches);
  diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  set.images = true;
  REQUIRE(diagnose::find_position_noise(set, diagnose::fit_nominal(set)));
  const std::size_t stop = diagnose::effect_index(diagnose::ids::end_stop);
  const auto explained = [&] {
    const diagnose::MotionFit without = diagnose::fit_nominal(set);
    return diagnose::fit_with_effect(set, without, stop,
                                     diagnose::with_effect(set, without, stop, {kStiffness_n_m, kPlace_m}, {}));
  };
  REQUIRE(chi2_of_fit(set, explained()) < 0.5);  // the bounce passed for noise
  REQUIRE(diagnose::settle_noise_again(explained(), set));
  CHECK(std::abs(chi2_of_fit(set, explained()) - 1.0) < 0.2);  // of 870 positions 0.05, and as much for the noise
  for (const auto& motion : set.motions) CHECK(std::abs(motion.sd_of(70) / motion.m_per_px / 0.002 - 1.0) < 0.25);
  CHECK_FALSE(diagnose::settle_noise_again(explained(), set));  // it is right now
}

TEST_CASE("errors of the camera are where each frame is, in frames that look like a stop as well") {
  const auto sway = [](double t_s) { return 0.4 * std::sin(2.0 * std::acos(-1.0) * 6.03 * t_s + 0.7); };
  const tests::MadeExperiment made = filmed([](double, double) { return 0.0; }, 15, sway);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  REQUIRE(set.disputed > 100);
  for (const auto& motion : set.motions) {
    REQUIRE(motion.shared_m.front().size() == motion.x_m.size());
    for (std::size_t p = 0; p < motion.x_m.size(); ++p) {
      CHECK(std::abs(motion.shared_m.front()[p] - kMode * motion.x_m[p]) < 1e-15);  // rounding of 1 µm
    }
  }
}

TEST_CASE("uneven times are told from errors that go with the place") {
  // 40 µs at 600 px/s: 0.024 px, twelve times the noise; next to nothing where it turns.
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0.0, 4e-5);
  const tests::MadeExperiment made = filmed([&](double, double v) { return v * normal(random); }, 13);
  diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  REQUIRE(diagnose::find_position_noise(set, diagnose::fit_nominal(set)));
  const diagnose::PositionNoise& noise = *set.position_noise;
  CHECK(noise.jitter_log_evidence > 50.0);
  CHECK(std::abs(noise.jitter_s - 4e-5) < 5.0 * noise.jitter_sd_s + 6e-6);  // and half a step of the sizes tried
}

TEST_CASE("in a file whose images are made of those before, noise that goes with the speed is its codec's own") {
  // At 600 px/s, 3 times the noise and 12 times: a codec does the first, and the second seven times in a thousand. The
  // first, 0.006 px, is also what a marker's place in the pixel does; 9 times, 0.018 px, is not.
  const auto noise_of = [](double uneven_s, bool handed_on) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal(0.0, uneven_s);
    const tests::MadeExperiment made = filmed([&](double, double v) { return v * normal(random); }, 13);
    diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    set.lossy = set.handed_on = handed_on;
    REQUIRE(diagnose::find_position_noise(set, diagnose::fit_nominal(set)));
    return *set.position_noise;
  };
  CHECK(noise_of(3e-5, false).jitter_log_evidence > 10.0);
  const diagnose::PositionNoise of_place = noise_of(1.2e-5, false);
  CHECK(of_place.jitter_log_evidence < 0.0);
  CHECK(of_place.shape.jitter_s > 0.0);
  const diagnose::PositionNoise codecs = noise_of(1e-5, true);
  CHECK(codecs.jitter_log_evidence < 1.0);
  CHECK(codecs.shape.jitter_s > 0.0);  // the fast positions are less certain all the same
  CHECK(noise_of(4e-5, true).jitter_log_evidence > 2.0);
}

TEST_CASE("a step in the image beside uneven times is not given to these") {
  // 0.3 px over 0.02 m, a hundred times the noise; 20 µs at 600 px/s are six times. The list holds no such step.
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0.0, 2e-5);
  const tests::MadeExperiment made =
      filmed([&](double u, double v) { return 0.15 * std::tanh((u - 440.0) / 12.0) + v * normal(random); }, 14);
  const diagnose::Diagnosis diagnosis = diagnose::diagnose_results(made.results, made.setups, {});
  CHECK(diagnosis.verdict == diagnose::Verdict::unknown);
  CHECK(diagnosis.unknown > 0.9);
}

TEST_CASE("tracks whose noise is white keep it") {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), {}, seed);
    diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    const double sd_m = set.motions.front().sd_m;
    CHECK(!diagnose::find_position_noise(set, diagnose::fit_nominal(set)));
    CHECK(!set.position_noise);
    CHECK(set.motions.front().sd_m == sd_m);
    CHECK(set.motions.front().whitening.empty());
  }
}

TEST_CASE("tracks whose errors last for frames have no gap, and keep no effect from its name") {
  constexpr double kFollows = 0.4, kNoise = 1e-4;
  const auto made_of = [](const tests::MadeEffect& effect, unsigned seed) {
    return tests::made_experiment(tests::made_launches(), effect, seed, kNoise, 150, 100.0, 0.05, kFollows);
  };
  for (const unsigned seed : {21U, 22U, 23U}) {
    const tests::MadeExperiment nothing = made_of({}, seed);
    diagnose::TrackSet set = diagnose::track_set(nothing.results, nothing.setups, true);
    const double white = chi2_of(set);
    CHECK(white > 1.3);  // neighbours tell of the part that differs between them only
    REQUIRE(diagnose::find_position_noise(set, diagnose::fit_nominal(set)));
    // Of 1160 points a standard deviation of 0.04, and as much again for the noise, which is found from the same
    // points.
    CHECK(std::abs(chi2_of(set) - 1.0) < 0.2);
    double mean = 0.0;  // of the logarithm; eight motions of some hundred independent errors know it to 3 %, sizes that
    for (const auto& motion : set.motions) {  // are tried lie a factor of 1.5 apart
      mean += std::log(motion.sd_of(70) / kNoise) / static_cast<double>(set.motions.size());
    }
    CHECK(std::abs(mean) < 0.25);
    const diagnose::Diagnosis diagnosis = diagnose::diagnose_results(nothing.results, nothing.setups, {});
    CHECK(diagnosis.verdict == diagnose::Verdict::none);
    CHECK(std::any_of(diagnosis.notes.begin(), diagnosis.notes.end(), [](const diagnose::Note& note) {
      return std::holds_alternative<diagnose::LastingErrors>(note);
    }));
  }
  // A track that is bent: 2 milliradians over half a metre.
  const auto bow = [](double mass_kg, double x_m, double, double) { return mass_kg * 9.80665 * 0.004 * x_m; };
  const tests::MadeExperiment bent = made_of({.force = bow}, 24);
  const diagnose::Diagnosis diagnosis = diagnose::diagnose_results(bent.results, bent.setups, {});
  REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
  CHECK(diagnosis.effects.front().id == "track_bow");
}
