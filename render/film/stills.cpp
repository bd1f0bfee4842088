#include "render/film/stills.h"

#include <cmath>
#include <optional>

#include "base/errors.h"
#include "base/long_work.h"
#include "base/math/angles.h"
#include "render/film/truth_files.h"
#include "render/paint/board_painter.h"
#include "render/paint/static_painter.h"
#include "render/random/random_numbers.h"
#include "render/sensor/readout.h"

namespace glidelab::render {
namespace {

/// A typical hand-held pose: position in the image (offset from the middle in fractions of its half width and height),
/// size (fraction of the image's width), tilt (degrees about the image's horizontal and vertical), and rotation.
struct Pose {
  double right, down, width, tilt_x_deg, tilt_y_deg, turn_deg;
};

// Every part of the image is covered, and every tilt has a different position; cyclic beyond twelve.
constexpr Pose kPoses[] = {
    {0.00, 0.00, 0.78, 0.0, 0.0, 0.0},        {-0.55, -0.50, 0.52, 25.0, -25.0, 3.0},
    {0.55, -0.50, 0.52, 25.0, 25.0, -4.0},    {-0.55, 0.50, 0.52, -25.0, -25.0, -3.0},
    {0.55, 0.50, 0.52, -25.0, 25.0, 5.0},     {0.00, -0.45, 0.60, 33.0, 0.0, 2.0},
    {0.00, 0.45, 0.60, -33.0, 0.0, -6.0},     {-0.50, 0.00, 0.55, 0.0, -33.0, 8.0},
    {0.50, 0.00, 0.55, 0.0, 33.0, -7.0},      {0.05, 0.05, 0.66, 18.0, -28.0, 25.0},
    {-0.05, -0.05, 0.66, -28.0, 18.0, -25.0}, {0.30, -0.25, 0.50, 12.0, 20.0, 88.0},
};

double jitter(std::uint64_t seed, std::uint32_t view, std::uint32_t number) {
  return 2.0 * uniform_of(random_words(RandomPurpose::pattern_poses, {view, number, 0}, philox_key(seed))[0]) -
         1.0;  // -1 to 1
}

bool wholly_seen(const Camera& camera, const Chessboard& board, double margin_px) {
  const std::vector<Eigen::Vector3d> outline = outline_of(board);
  constexpr int kSteps = 16;  // the lens bends the edges
  for (std::size_t i = 0; i < outline.size(); ++i) {
    for (int k = 0; k < kSteps; ++k) {
      const Eigen::Vector3d p = outline[i] + (outline[(i + 1) % outline.size()] - outline[i]) * k / kSteps;
      const auto pixel = project(camera, p);
      if (!pixel || !in_image(camera, *pixel, margin_px)) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<Chessboard> calibration_boards(const Scenario& scenario, std::uint64_t seed) {
  const Camera& camera = scenario.camera;
  const PatternSetup& pattern = scenario.pattern;
  std::vector<Chessboard> boards;
  for (int view = 0; view < pattern.views; ++view) {
    Pose pose = kPoses[static_cast<std::size_t>(view) % std::size(kPoses)];
    const auto random = [&](std::uint32_t number) { return jitter(seed, static_cast<std::uint32_t>(view), number); };
    const double tilt_x = (pose.tilt_x_deg + 2.0 * random(0)) * base::kRadPerDegree;
    const double tilt_y = (pose.tilt_y_deg + 2.0 * random(1)) * base::kRadPerDegree;
    const double turn = (pose.turn_deg + 3.0 * random(2)) * base::kRadPerDegree;
    const Eigen::Matrix3d R_CP =
        (Eigen::AngleAxisd(tilt_x, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(tilt_y, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()))
            .toRotationMatrix();
    Chessboard board;
    board.inner_columns = pattern.inner_columns;
    board.inner_rows = pattern.inner_rows;
    board.square_m = pattern.square_m;
    const double plate_m = (pattern.inner_columns + 1 + 2 * board.border_squares) * pattern.square_m;
    const Eigen::Vector3d middle_P(0.5 * (pattern.inner_columns - 1) * pattern.square_m,
                                   0.5 * (pattern.inner_rows - 1) * pattern.square_m, 0.0);
    bool found = false;
    // Moved towards the middle and away from the camera until it is entirely in the image.
    for (int attempt = 0; attempt < 60 && !found; ++attempt) {
      const double inward = std::pow(0.93, attempt);
      const double width = pose.width * std::pow(0.985, attempt);
      const Eigen::Vector2d pixel(0.5 * (camera.width_px - 1) * (1.0 + inward * (pose.right + 0.04 * random(3))),
                                  0.5 * (camera.height_px - 1) * (1.0 + inward * (pose.down + 0.04 * random(4))));
      const auto ray = undistorted_at(camera, pixel);
      if (!ray) continue;
      const double depth = camera.focal_px.x() * plate_m / (width * camera.width_px) * (1.0 + 0.03 * random(5));
      Eigen::Isometry3d X_CP = Eigen::Isometry3d::Identity();
      X_CP.linear() = R_CP;
      X_CP.translation() = depth * ray->homogeneous() - R_CP * middle_P;
      board.X_WP = camera.X_WC * X_CP;
      found = wholly_seen(camera, board, 3.0);
    }
    if (!found) throw base::NumericalError("calibration: no pose of the pattern is wholly in the image");
    boards.push_back(board);
  }
  return boards;
}

namespace {

struct Still {
  std::string name;  ///< within the experiment folder
  StaticScene scene;
};

std::vector<Still> stills_of(const Scenario& scenario, std::uint64_t seed) {
  const StaticScene track = empty_track(scenario, scenario.motion.configurations.front().body.incline_rad);
  std::vector<Still> stills;
  for (const Chessboard& board : calibration_boards(scenario, seed)) {
    stills.push_back({view_name(stills.size()), track});
    stills.back().scene.board = board;
  }
  const std::size_t planes = scenario.pattern.plane_x_m.size();
  for (std::size_t i = 0; i < planes; ++i) {
    stills.push_back({plane_name(i, planes), track});
    stills.back().scene.board = plane_board(scenario, i);
  }
  if (scenario.plumb) {
    stills.push_back({"plumb.png", track});
    stills.back().scene.plumb = plumb_line(*scenario.plumb, scenario.camera);
  }
  return stills;
}

/// Stills are stored with 8 bits, as saved by a viewer program.
Sensor with_8_bits(const Sensor& sensor) {
  Sensor shallow = sensor;
  shallow.bit_depth = 8;
  if (sensor.converter_bits || sensor.tone.kind != ToneCurve::Kind::linear || sensor.colour == Colour::bayer) {
    shallow.converter_bits = sensor.converter_bits.value_or(sensor.bit_depth);
    return shallow;
  }
  const double share = 255.0 / sensor.largest_code();
  shallow.gain_dn_per_e *= share;
  shallow.offset_dn *= share;
  return shallow;
}

/// The painter of stills in which the board is partly hidden or shaded, or not sharp everywhere; made when first
/// needed.
class Painter {
 public:
  Painter(const Scenario& scenario, const Stage& stage)
      : scenario_(scenario), stage_(stage), white_e_(electrons_of_white(scenario)) {}

  FloatImage paint(const StaticScene& scene) {
    if (!scenario_.focus && !scene.plumb && stands_free(scenario_.camera, scene)) {
      return paint_board(scenario_.camera, stage_.rays_of_stills(), stage_.behind_stills_e, scene, white_e_);
    }
    if (!painter_) painter_.emplace(scenario_.camera, stage_.rays_of_stills(), scenario_.focus);
    return painter_->paint_before(stage_.behind_stills_e, scene, white_e_);
  }

 private:
  const Scenario& scenario_;
  const Stage& stage_;
  double white_e_;
  std::optional<StaticPainter> painter_;
};

}  // namespace

std::size_t count_stills(const Scenario& scenario) {
  return static_cast<std::size_t>(scenario.pattern.views) + scenario.pattern.plane_x_m.size() +
         (scenario.plumb ? 1 : 0);
}

std::vector<std::string> still_names(const Scenario& scenario) {
  std::vector<std::string> names;
  const std::size_t planes = scenario.pattern.plane_x_m.size();
  for (std::size_t i = 0; i < static_cast<std::size_t>(scenario.pattern.views); ++i) names.push_back(view_name(i));
  for (std::size_t i = 0; i < planes; ++i) names.push_back(plane_name(i, planes));
  if (scenario.plumb) names.emplace_back("plumb.png");
  return names;
}

void take_stills(const Scenario& scenario, const Stage& stage, std::uint64_t seed, int jobs, const StillTaker& take) {
  const std::vector<Still> stills = stills_of(scenario, seed);
  const Readout readout(with_8_bits(scenario.sensor), scenario.recording.exposure_s, seed, scenario.camera.width_px,
                        scenario.camera.height_px);
  base::in_parallel(jobs, stills.size(), [&](const auto& next) {
    Painter painter(scenario, stage);
    const PixelRect all{0, 0, scenario.camera.width_px, scenario.camera.height_px};
    cv::Mat codes(all.height, all.width, CV_8U);
    for (std::size_t i = next(); i < stills.size(); i = next()) {
      readout.read(painter.paint(stills[i].scene), kFirstStillStream + static_cast<std::uint32_t>(i), 0, all,
                   std::span<std::uint8_t>(codes.data, codes.total()));
      take(stills[i].name, codes);
    }
  });
}

}  // namespace glidelab::render
