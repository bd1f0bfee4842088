#include "render/film/marker_truth.h"

#include <fmt/format.h>

#include <cmath>

#include "base/errors.h"
#include "render/paint/sphere_image.h"
#include "render/scenario/scene.h"

namespace glidelab::render {

std::optional<MarkerInPicture> marker_in_picture(const Scenario& scenario, const sim::Body& body,
                                                 const FrameMotion& frame) {
  const Camera& camera = scenario.camera;
  const Recording& recording = scenario.recording;
  const auto center_C = [&](double x_m, double t_s) -> Eigen::Vector3d {
    const Eigen::Vector3d at_rest = camera.X_WC.inverse() * marker_position_W(scenario, body.incline_rad, x_m);
    return scenario.mount.moves() ? mount_at(scenario.mount, t_s).inverse() * at_rest : at_rest;
  };
  MarkerInPicture marker;
  marker.x_m = frame.middle.x_m;
  marker.t_s = frame.middle.t_s;
  const double middle_row = 0.5 * (camera.height_px - 1);
  double sim_s = mid_exposure_s(recording, frame, middle_row);
  if (recording.shutter.rolling) {
    // The row's time and the centre's row depend on one another: t = mid-exposure of the row v(t), a contraction where
    // the marker moves by less than a row in a line time.
    double row = middle_row;
    for (int i = 0;; ++i) {
      sim_s = mid_exposure_s(recording, frame, row);
      marker.x_m = frame.path.x_m(sim_s);
      const auto pixel = pixel_of(camera, center_C(marker.x_m, sim_s).hnormalized());
      if (!pixel) return std::nullopt;
      const double change = pixel->y() - row;
      row = pixel->y();
      if (std::abs(change) < 1e-9) break;
      if (i == 200) {
        throw base::NumericalError(fmt::format("frame {}: the marker moves as fast as the rows are read", frame.frame));
      }
    }
    marker.t_s += recording.shutter.delay_s(row) - recording.shutter.delay_s(middle_row);
  }
  const Eigen::Vector3d c = center_C(marker.x_m, sim_s);
  const auto pixel = c.z() > 0.0 ? pixel_of(camera, c.hnormalized()) : std::nullopt;
  const auto outline = image_of_sphere(c, 0.5 * scenario.marker.diameter_m);
  if (!pixel || !outline || !in_picture(camera, *pixel)) return std::nullopt;
  marker.center_px = *pixel;
  marker.centroid_px = picture_of(camera, *outline).centroid_px;
  return marker;
}

}  // namespace glidelab::render
