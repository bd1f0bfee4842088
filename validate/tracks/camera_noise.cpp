#include "validate/tracks/camera_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/pictures/marker/marker_bound.h"
#include "render/scenario/scene.h"

namespace glidelab::validate {
namespace {

/// Electrons of one pixel.
struct Pixel {
  double amplitude_e = 0.0;  ///< marker above wall
  double variance_e2 = 0.0;
};

Pixel pixel_of(const render::Scenario& scenario, const WithoutLimit& without) {
  const render::Sensor& sensor = scenario.sensor;
  const double white_e = render::electrons_of_white(scenario);
  const double marker_e = std::min(white_e * scenario.marker.reflectance, sensor.full_well_e);
  const double wall_e = std::min(white_e * scenario.scene.wall_albedo, sensor.full_well_e);
  Pixel pixel;
  pixel.amplitude_e = marker_e - wall_e;
  if (!without.shot_noise) pixel.variance_e2 += 0.5 * (marker_e + wall_e);
  if (!without.camera_noise) {
    const int dropped_bits = sensor.converter_bits.value_or(sensor.bit_depth) - sensor.bit_depth;
    const double step_e = std::ldexp(1.0, dropped_bits) / sensor.gain_dn_per_e;
    pixel.variance_e2 += sensor.pixels.dark_signal_e_s * scenario.recording.exposure_s;
    pixel.variance_e2 += sensor.read_noise_e * sensor.read_noise_e + step_e * step_e / 12.0;
    pixel.variance_e2 += 0.5 * sensor.pixels.prnu * sensor.pixels.prnu * (marker_e * marker_e + wall_e * wall_e);
    pixel.variance_e2 += sensor.pixels.dsnu_e * sensor.pixels.dsnu_e;
  }
  return pixel;
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

/// Mean information of four places of the centre within a pixel.
double centre_sd_px(core::DiscImage disc) {
  double information = 0.0;
  const double reach_px = disc.radius_px + 3.0 * disc.blur_px + 2.0;
  for (const double u : {0.1, 0.4}) {
    for (const double v : {0.0, 0.3}) {
      disc.u = u;
      disc.v = v;
      information += 0.25 / std::pow(core::least_centre_sd_px(disc, reach_px), 2);
    }
  }
  return 1.0 / std::sqrt(information);
}

}  // namespace

std::vector<double> predicted_noise_m(const render::Scenario& scenario, const Truth& truth,
                                      const WithoutLimit& without) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  constexpr double kSharp_px = 0.1;        // a lens is not sharper; the bound needs an edge
  constexpr double kSmallest_px = 1.0;     // radius: below it a disc is a dot without an edge of its own
  constexpr double kNegligible_e2 = 1e-6;  // where all noise is thought away
  const Pixel pixel = pixel_of(scenario, without);
  std::vector<double> noise_m;
  for (const TrueClip& clip : truth.clips) {
    const auto configuration =
        std::find_if(scenario.motion.configurations.begin(), scenario.motion.configurations.end(),
                     [&](const sim::ConfigurationSetup& setup) { return setup.name == clip.configuration; });
    const double middle_m = 0.5 * (*std::min_element(clip.x_m.begin(), clip.x_m.end()) +
                                   *std::max_element(clip.x_m.begin(), clip.x_m.end()));
    const Eigen::Vector3d marker_C =
        scenario.camera.X_WC.inverse() * render::marker_position_W(scenario, configuration->body.incline_rad, middle_m);
    const double px_per_m = without.finer * scenario.camera.focal_px.x() / marker_C.z();
    core::DiscImage disc;
    disc.radius_px = 0.5 * scenario.marker.diameter_m * px_per_m;
    if (!(pixel.amplitude_e > 0.0) || disc.radius_px < kSmallest_px) {
      noise_m.push_back(kNever);
      continue;
    }
    const double smear_px = without.motion_blur ? 0.0 : rms(clip.v_m_s) * scenario.recording.exposure_s * px_per_m;
    disc.blur_px = std::sqrt(kSharp_px * kSharp_px + smear_px * smear_px / 12.0);
    disc.amplitude = pixel.amplitude_e;
    disc.noise_sd = std::sqrt(std::max(pixel.variance_e2, kNegligible_e2));
    noise_m.push_back(centre_sd_px(disc) / px_per_m);
  }
  return noise_m;
}

}  // namespace glidelab::validate
