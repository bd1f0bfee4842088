/// The camera of a twin is the one that the recording was made with: there and back.
#include "diagnose/pictures/twin_camera.h"

#include <cmath>

#include "tests/catch.h"

using namespace glidelab;

namespace {

/// The axes of a camera in the world as columns: right, down and forward. A roll turns it about the line of sight, from
/// right towards down.
Eigen::Matrix3d axes_of(const Eigen::Vector3d& position, const Eigen::Vector3d& target, double roll_rad) {
  const Eigen::Vector3d forward = (target - position).normalized();
  const Eigen::Vector3d level = forward.cross(Eigen::Vector3d::UnitY()).normalized(), under = forward.cross(level);
  Eigen::Matrix3d axes;
  axes.col(0) = std::cos(roll_rad) * level + std::sin(roll_rad) * under;
  axes.col(1) = forward.cross(axes.col(0));
  axes.col(2) = forward;
  return axes;
}

/// Downhill along the track.
Eigen::Vector3d track_of(int downhill, double incline_rad) {
  return {downhill * std::cos(incline_rad), -std::sin(incline_rad), 0.0};
}

constexpr double kReference = 0.05, kHeight = 0.012;

}  // namespace

TEST_CASE("the view through a lens is the camera that saw the pattern, whichever way it hangs and the track falls") {
  const Eigen::Vector3d position(0.2, 0.15, 1.8), target(0.05, -0.02, 0.0);
  for (const int downhill : {1, -1}) {
    for (const double incline_rad : {0.0, 0.07, -0.02}) {
      for (const double hangs_rad : {0.04, 0.3, -2.0}) {
        for (const double roll_rad : {0.03, -0.2}) {
          INFO(downhill << ", " << incline_rad << ", " << hangs_rad << ", " << roll_rad);
          // The pattern's Z points away from the camera, -z of the world; `along` in it is the track.
          const Eigen::Vector3d along(std::cos(hangs_rad), std::sin(hangs_rad), 0.0);
          const Eigen::Vector3d track = track_of(downhill, incline_rad);
          Eigen::Isometry3d X_WP = Eigen::Isometry3d::Identity();
          const Eigen::Vector3d across = Eigen::Vector3d::UnitZ().cross(along);
          const Eigen::Vector3d across_track = (-Eigen::Vector3d::UnitZ()).cross(track);
          X_WP.linear() = track * along.transpose() + across_track * across.transpose() -
                          Eigen::Vector3d::UnitZ() * Eigen::Vector3d::UnitZ().transpose();
          const Eigen::Vector3d through(0.3, -0.1, -kHeight);
          // The marker at the reference is before the world's origin.
          const Eigen::Vector3d reference = through + kReference * along;
          X_WP.translation() = -(X_WP.linear() * Eigen::Vector3d(reference.x(), reference.y(), 0.0));
          Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();
          X_WC.linear() = axes_of(position, target, roll_rad);
          X_WC.translation() = position;
          diagnose::Filming filming;
          filming.width_px = 640;
          filming.height_px = 480;
          filming.lens.emplace();
          filming.lens->fx = 900.0;
          filming.lens->fy = 905.0;
          filming.lens->cx = 310.0;
          filming.lens->cy = 245.0;
          filming.lens->size = cv::Size(640, 480);
          filming.X_CP = X_WC.inverse() * X_WP;
          filming.through_P = through;
          filming.along_P = along;
          filming.marker_height_m = kHeight;
          const diagnose::TwinView view = diagnose::view_of(filming, kReference, 1.0, incline_rad);
          // To rounding of numbers of the order of 1.
          CHECK(view.downhill == downhill);
          CHECK((view.position_m - position).norm() < 1e-12);
          CHECK((view.target_m - target).norm() < 1e-12);
          CHECK(std::abs(view.roll_rad - roll_rad) < 1e-12);
          CHECK(view.focal_px[0] == 900.0);
          CHECK(view.focal_px[1] == 905.0);
        }
      }
    }
  }
}

TEST_CASE("the view by a scale shows the marker where it was seen, at every place of the track") {
  for (const Eigen::Vector2d& along : {Eigen::Vector2d(800.0, 30.0), Eigen::Vector2d(-500.0, 12.0)}) {
    for (const double incline_rad : {0.0, 0.07}) {
      diagnose::Filming filming;
      filming.width_px = 640;
      filming.height_px = 480;
      filming.marker_height_m = kHeight;
      filming.through_px = {300.0, 210.0};
      filming.along_px_m = along;
      const diagnose::TwinView view = diagnose::view_of(filming, kReference, 1.0, incline_rad);
      CHECK(view.downhill == (along.x() > 0.0 ? 1 : -1));
      const Eigen::Matrix3d axes = axes_of(view.position_m, view.target_m, view.roll_rad);
      for (const double x : {-0.4, 0.0, kReference, 0.6}) {
        INFO("along " << along.transpose() << ", inclination " << incline_rad << ", x " << x);
        const Eigen::Vector3d marker =
            (x - kReference) * track_of(view.downhill, incline_rad) + Eigen::Vector3d(0.0, 0.0, kHeight);
        const Eigen::Vector3d seen = axes.transpose() * (marker - view.position_m);
        const Eigen::Vector2d pixel(319.5 + view.focal_px[0] * seen.x() / seen.z(),
                                    239.5 + view.focal_px[1] * seen.y() / seen.z());
        CHECK((pixel - (filming.through_px + x * along)).norm() < 1e-9);  // of hundreds of pixels
      }
    }
  }
}

TEST_CASE("the camera of tracks stands far enough away to see their range") {
  const diagnose::TwinView near = diagnose::view_of(std::nullopt, 0.0, 0.5, 0.0);
  const diagnose::TwinView far = diagnose::view_of(std::nullopt, 0.0, 4.0, 0.0);
  // A scenario's own camera sees 1.6 m from 2.4 m; a fifth more than the range is asked for.
  CHECK(near.position_m.z() == 2.4);
  CHECK(far.position_m.z() == Approx(2.4 * 1.2 * 4.0 / 1.6));
}
