#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "base/math/angles.h"
#include "core/analysis/clip_to_track.h"
#include "core/motion/configurations.h"
#include "fit/trajectory/trajectory_results.h"
#include "tests/catch.h"
#include "tests/core/small_clip.h"

using namespace glidelab;

namespace {

constexpr double kRate = 90.0, kPixelsPerMetre = 376.0, kGravity = 9.80665;
constexpr double kDamping = 2.768, kMu = 0.0071, kAlphaDeg = 4.311;
constexpr int kFrames = 180;
constexpr double kDead_px = 0.025;  // what the codec leaves uncoded; the limit speed is 1.007 pixels a frame
const cv::Size kSize(640, 40);

/// x after t from (0, v): dv/dt = g (sin(alpha) - sign(v) mu cos(alpha)) - k v, solved in closed form on both sides of
/// the turn.
double travelled(double v, double t) {
  const double alpha = kAlphaDeg * base::kRadPerDegree;
  const double drive = kGravity * std::sin(alpha), friction = kMu * kGravity * std::cos(alpha);
  const auto glide = [](double from, double limit, double s) {
    return limit * s + (from - limit) * (1.0 - std::exp(-kDamping * s)) / kDamping;
  };
  const double down = (drive - friction) / kDamping, up = (drive + friction) / kDamping;
  if (v >= 0.0) return glide(v, down, t);
  const double turn = std::log((up - v) / up) / kDamping;
  return t < turn ? glide(v, up, t) : glide(v, up, turn) + glide(0.0, down, t - turn);
}

/// Places as such a codec draws them: the last one, moved by a whole number of quarters of a pixel, and put right only
/// as far as it would else be off by more than `dead_px`. 0: the places themselves.
std::vector<double> drawn(const std::vector<double>& places, double dead_px) {
  std::vector<double> seen;
  for (const double place : places) {
    const double last = seen.empty() ? place : seen.back();
    const double predicted = last + 0.25 * std::round(4.0 * (place - last));
    seen.push_back(place + std::clamp(predicted - place, -dead_px, dead_px));
  }
  return seen;
}

class PaintedFrames final : public core::FrameSource {
 public:
  PaintedFrames(std::vector<double> u_px, std::uint64_t seed, bool predicts)
      : u_px_(std::move(u_px)), seed_(seed), predicts_(predicts) {}
  std::optional<core::Frame> next() override {
    if (index_ == u_px_.size()) return std::nullopt;
    cv::Mat image(kSize, CV_64F, cv::Scalar(60.0));
    tests::put_disc(image, {u_px_[index_], 20.3}, 4.0, 200.0);
    core::Frame frame;
    frame.grey = tests::expose(image, 1.0, seed_ + index_);
    frame.index = index_;
    frame.t_s = static_cast<double>(index_++) / kRate;
    return frame;
  }
  std::size_t stated_frames() const override { return u_px_.size(); }
  std::vector<core::Note> notes() const override { return {}; }
  core::FileFacts facts() const override {
    core::FileFacts facts;
    facts.lossy = true;
    facts.predicts = predicts_;
    return facts;
  }

 private:
  std::vector<double> u_px_;
  std::uint64_t seed_;
  bool predicts_;
  std::size_t index_ = 0;
};

/// Errors of K/m, mu and alpha, and what is stated of them.
struct Recovered {
  std::array<double, 3> error{}, sd{};
};

/// The number of the experiment shifts its starts and speeds by a few pixels and draws its noise. `says_so`: the file
/// tells that its codec predicts images.
Recovered experiment(int number, double dead_px, bool says_so) {
  core::Experiment experiment;
  experiment.camera.emplace().frame_rate_hz = kRate;
  experiment.scale = core::ScaleSetup{kPixelsPerMetre, 0.0};
  experiment.marker.emplace().diameter_m = 8.0 / kPixelsPerMetre;
  const double shift = 0.011 * number;
  const std::array<std::pair<double, double>, 3> starts{
      {{1.40, -1.4 - shift}, {0.1, 0.9 + shift}, {0.3, 0.21 + shift}}};
  for (const char* const name : {"up", "down", "slow"}) {
    core::ClipSetup setup;
    setup.name = setup.file = name;
    setup.mass_kg = 0.335;
    setup.group = "all";
    experiment.clips.push_back(setup);
  }
  const core::FrameOpener open = [&](const std::filesystem::path& file, const core::CameraSettings&, bool,
                                     std::optional<cv::Size>) {
    const auto clip = static_cast<std::size_t>(file == "up" ? 0 : file == "down" ? 1 : 2);
    std::vector<double> places;
    for (int k = 0; k < kFrames; ++k) {
      places.push_back(kPixelsPerMetre * (starts[clip].first + shift + travelled(starts[clip].second, k / kRate)));
    }
    const std::uint64_t seed = 1000 * (3 * static_cast<std::uint64_t>(number) + clip) + 7;
    return std::make_unique<PaintedFrames>(drawn(places, dead_px), seed, says_so);
  };
  const auto tracks = core::tracks_of(experiment, 1, base::no_progress, open).tracks;
  const auto results =
      fit::with_trajectory_fits(core::analyze_tracks(experiment.clips, tracks, kGravity, {}, 1)).configurations.at(0);
  Recovered recovered;
  const std::array<double, 3> truth{kDamping, kMu, kAlphaDeg};
  const std::array<const core::Quantity*, 3> found{&results.k_over_m_1_s, &results.mu, &results.alpha_deg};
  for (std::size_t q = 0; q < 3; ++q) {
    REQUIRE(found[q]->estimate);
    recovered.error[q] = found[q]->estimate->value - truth[q];
    recovered.sd[q] = found[q]->estimate->sd;
  }
  return recovered;
}

struct Errors {
  double squares = 0.0;  ///< over the stated deviations, of 18
  double mean_sd_of_damping = 0.0;
};

Errors errors_of_six(double dead_px, bool says_so) {
  constexpr int kExperiments = 6;
  Errors errors;
  for (int number = 0; number < kExperiments; ++number) {
    const Recovered recovered = experiment(number, dead_px, says_so);
    for (std::size_t q = 0; q < 3; ++q) errors.squares += std::pow(recovered.error[q] / recovered.sd[q], 2);
    errors.mean_sd_of_damping += recovered.sd[0] / kExperiments;
  }
  return errors;
}

// Errors of K/m and mu go together: the sum is 2 chi^2 + chi^2 of six degrees of freedom each, 18 ± 7.7, and more than
// four such deviations are above this.
constexpr double kMostSquares = 50.0;

}  // namespace

TEST_CASE("intervals hold where a codec moves the marker by quarters of a pixel and codes no small remainder") {
  const Errors errors = errors_of_six(kDead_px, true);
  CAPTURE(errors.squares, errors.mean_sd_of_damping);
  CHECK(errors.squares < kMostSquares);
  // Not by being wide: 0.1 % of k.
  CHECK(errors.mean_sd_of_damping < 3e-3);
}

TEST_CASE("the same positions, analysed as those of a codec that predicts nothing, break their intervals") {
  CHECK(errors_of_six(kDead_px, false).squares > kMostSquares);
}

TEST_CASE("intervals stay narrow behind a codec that predicts images and leaves no error") {
  const Errors with = errors_of_six(0.0, true), without = errors_of_six(0.0, false);
  CAPTURE(with.squares, without.squares, with.mean_sd_of_damping, without.mean_sd_of_damping);
  CHECK(with.squares < kMostSquares);
  CHECK(with.mean_sd_of_damping < 4.0 * without.mean_sd_of_damping);
}
