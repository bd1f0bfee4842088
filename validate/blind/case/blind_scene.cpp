#include "validate/blind/case/blind_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/math/angles.h"
#include "core/pictures/marker/marker_fit.h"

namespace glidelab::validate {
namespace {

constexpr double kMarker_m = 0.02, kReflectance = 1.1, kWhite = 0.75, kWall = 0.38;
constexpr double kReach_m = 0.46;  // from the reference point: the marker is in the image
constexpr std::size_t kFewestFrames = 40, kMostFilmedFrames = 150;

BlindCamera draw_camera(BlindRandom& random, bool lossless) {
  BlindCamera camera;
  camera.rate_hz = one_of(random, {100.0, 120.0, 150.0, 200.0, 240.0});
  camera.exposure_s = log_uniform(random, 3e-4, 1.5e-3);
  camera.z_m = uniform(random, 1.2, 1.4);
  camera.focal_px = uniform(random, 560.0, 600.0) * camera.z_m;
  camera.x_m = uniform(random, -0.08, 0.08);
  camera.y_m = uniform(random, 0.0, 0.12);
  camera.k1 = uniform(random, -0.08, 0.08);
  camera.full_well_e = log_uniform(random, 8e3, 6e4);
  camera.read_noise_e = log_uniform(random, 4.0, 30.0);
  camera.prnu = uniform(random, 0.0, 1.0) < 0.5 ? 0.0 : uniform(random, 0.002, 0.01);
  const double tone = uniform(random, 0.0, 1.0);
  camera.tone = tone < 0.6 ? "linear" : tone < 0.8 ? "gamma" : "bt709";
  // All rows within nine tenths of the frame time.
  const double longest_line_s = 0.9 / camera.rate_hz / camera.height_px;
  if (uniform(random, 0.0, 1.0) < 0.25) camera.line_s = uniform(random, 0.3, 1.0) * longest_line_s;
  const double file = uniform(random, 0.0, 1.0);
  camera.codec = lossless || file < 0.65 ? "magicyuv" : file < 0.85 ? "mjpeg" : "h264";
  camera.quality = static_cast<int>(uniform(random, 85.0, 97.0));
  camera.crf = std::floor(uniform(random, 14.0, 21.0));
  return camera;
}

/// The bound of the marker's centre for a camera's noise, in metres, at a speed.
double least_noise_m(const BlindCamera& camera, double v_m_s) {
  const double marker_e = kReflectance * kWhite * camera.full_well_e, wall_e = kWall * kWhite * camera.full_well_e;
  const double step_e = camera.full_well_e / 255.0;
  core::DiscImage disc;
  disc.u = 0.3;
  disc.v = 0.2;
  disc.radius_px = 0.5 * kMarker_m * camera.px_per_m();
  const double smear_px = v_m_s * camera.exposure_s * camera.px_per_m();
  disc.blur_px = std::sqrt(0.01 + smear_px * smear_px / 12.0);
  disc.amplitude = marker_e - wall_e;
  disc.noise_sd = std::sqrt(0.5 * (marker_e + wall_e) + camera.read_noise_e * camera.read_noise_e +
                            step_e * step_e / 12.0 + 0.5 * camera.prnu * camera.prnu * marker_e * marker_e);
  return core::least_centre_sd_px(disc, disc.radius_px + 3.0 * disc.blur_px + 2.0) / camera.px_per_m();
}

/// Additional errors observed in clips with nothing wrong (28 cases): differing pixels and the
/// position between two of them, more so with a tone curve; the blocks of MJPEG (quality 86 to 91: 0.005 to 0.0075 px);
/// H.264 (crf 14 to 20: 0.02 to 0.046 px, which last for about eight frames and so weigh twice as much on slow
/// effects).
double added_px(const BlindCamera& camera) {
  if (camera.codec == "h264") return 0.07;
  if (camera.codec == "mjpeg") return 0.006;
  return camera.tone == "linear" ? 0.001 : 0.002;
}

/// Number of frames until the glider has left the image or is at rest.
std::size_t frames_of(const BlindDesign& design, BlindClip clip) {
  clip.frames = kMostFilmedFrames;
  const BlindFilm film = nominal_film(design, clip);
  const auto motion = blind_motion(film.law, clip.x0_m, clip.v0_m_s, film.true_t_s);
  std::size_t frames = 0;
  while (frames < motion.size() && std::abs(motion[frames].x_m) < kReach_m && motion[frames].v_m_s != 0.0) ++frames;
  return frames;
}

void draw_setups(BlindDesign& design, BlindRandom& random) {
  const int kind = one_of(random, {0, 1, 1, 2, 2});  // level, inclined, both
  const bool stated = uniform(random, 0.0, 1.0) < 0.85;
  const double sd = log_uniform(random, 0.01, 0.3) / base::kDegreesPerRad;
  const auto add = [&](const char* name, double degrees) {
    BlindGroup group{name, degrees / base::kDegreesPerRad, degrees / base::kDegreesPerRad + sd * normal(random), {}};
    if (stated) group.stated_sd_rad = sd;
    design.groups.push_back(group);
  };
  if (kind != 1) add("level", 0.0);
  if (kind != 0) add("inclined", std::round(10.0 * uniform(random, 2.0, 6.0)) / 10.0);
  const int masses = one_of(random, {1, 2, 2});
  double mass = uniform(random, 0.25, 0.4);
  for (int m = 0; m < masses; ++m) {
    const double grams = std::round(1e3 * mass) * 1e-3;
    design.masses.push_back({grams, grams, 0.0});
    mass += uniform(random, 0.1, 0.25);
  }
}

void draw_clips(BlindDesign& design, const BlindCamera& camera, BlindRandom& random) {
  const std::size_t pairs = design.groups.size() * design.masses.size();
  const int repeats = pairs == 1 && uniform(random, 0.0, 1.0) < 0.5 ? 2 : 1;
  for (std::size_t g = 0; g < design.groups.size(); ++g) {
    for (std::size_t m = 0; m < design.masses.size(); ++m) {
      for (int r = 0; r < 2 * repeats; ++r) {
        const bool up = r % 2 == 0;
        // Four pairs; on the level track one direction only, so that there are six clips at most.
        if (pairs == 4 && g == 0 && up) continue;
        BlindClip clip{fmt::format("clip-{}", design.clips.size() + 1), g, m, 0.0, 0.0, camera.rate_hz, 0};
        clip.v0_m_s = up ? -uniform(random, 0.6, 1.3) : uniform(random, 0.3, 1.0);
        clip.x0_m = (up ? 1.0 : -1.0) * uniform(random, 0.30, 0.43);
        clip.frames = frames_of(design, clip);
        design.clips.push_back(clip);
      }
    }
  }
}

std::string force_text(const BlindForces& forces) {
  return fmt::format(
      "[[configuration.force]]\nlaw = \"{}\"\nk_n_s_m = {:.9g}\n{}[[configuration.force]]\nlaw = \"{}\"\nmu = "
      "{:.9g}\n{}{}",
      forces.drag_law, forces.k_n_s_m, forces.drag_keys, forces.friction_law, forces.mu, forces.friction_keys,
      forces.more);
}

std::string camera_text(const BlindScene& scene) {
  const BlindCamera& camera = scene.camera;
  std::string text = fmt::format(
      "[camera]\nwidth_px = {}\nheight_px = {}\nframe_rate_hz = {:.9g}\nexposure_s = {:.9g}\nfocal_px = [{:.9g}, "
      "{:.9g}]\nposition_m = [{:.9g}, {:.9g}, {:.9g}]\ntarget_m = [0.0, 0.03, 0.0]\ndistortion = {{ k1 = {:.9g} }}\n\n",
      camera.width_px, camera.height_px, camera.rate_hz, camera.exposure_s, camera.focal_px, camera.focal_px,
      camera.x_m, camera.y_m, camera.z_m, camera.k1);
  text += fmt::format("[sensor]\nfull_well_e = {:.9g}\nread_noise_e = {:.9g}\nprnu = {:.9g}\n", camera.full_well_e,
                      camera.read_noise_e, camera.prnu);
  text += fmt::format("white_level = {}\ntone = \"{}\"\n{}\n", kWhite, camera.tone,
                      camera.tone == "gamma" ? "gamma = 2.2\n" : "");
  if (camera.line_s > 0.0) {
    text += fmt::format("[shutter]\nkind = \"rolling\"\nline_readout_s = {:.9g}\n\n", camera.line_s);
  }
  text += fmt::format("[codec]\nname = \"{}\"\n", camera.codec);
  if (camera.codec == "mjpeg") text += fmt::format("quality = {}\n", camera.quality);
  if (camera.codec == "h264") text += fmt::format("crf = {:.9g}\n", camera.crf);
  text +=
      fmt::format("\n[clock]\nrate_error_ppm = {:.9g}\njitter_s = {:.9g}\n\n", 1e6 * scene.rate_error, scene.jitter_s);
  text += fmt::format("[light]\ngradient_per_m = [{:.9g}, 0.0]\nflicker_depth = {:.9g}\nflicker_hz = {:.9g}\n\n",
                      scene.gradient_1_m, scene.flicker_depth, scene.flicker_hz);
  return text + scene.mount + "[calibration]\ninner_corners = [7, 4]\nsquare_m = 0.04\nviews = 8\n\n" +
         fmt::format("[marker]\ndiameter_m = {}\nreflectance = {}\n\n[scene]\nwall_albedo = {}\n\n", kMarker_m,
                     kReflectance, kWall);
}

}  // namespace

BlindScene draw_scene(BlindRandom& random, bool lossless) {
  for (;;) {
    BlindScene scene;
    scene.camera = draw_camera(random, lossless);
    BlindDesign& design = scene.motion;
    design.k_n_s_m = log_uniform(random, 0.3, 1.4);
    design.mu = log_uniform(random, 0.002, 0.015);
    design.noise_sd_m = std::hypot(least_noise_m(scene.camera, 0.5), added_px(scene.camera) / scene.camera.px_per_m());
    // Medians of the calibrations of sixteen such scenes with nothing wrong.
    design.calibration.scale_sd = 1.5e-4;
    design.calibration.bend_sd_1_m = 7e-4;
    design.calibration.cubic_sd_1_m2 = 4e-3;
    draw_setups(design, random);
    draw_clips(design, scene.camera, random);
    scene.forces.assign(design.clips.size(), {design.k_n_s_m, design.mu, "viscous", "", "coulomb", "", ""});
    const bool long_enough = std::all_of(design.clips.begin(), design.clips.end(),
                                         [](const BlindClip& clip) { return clip.frames >= kFewestFrames; });
    if (long_enough) return scene;
  }
}

std::string scenario_text(const BlindScene& scene, const std::string& name, std::uint64_t seed) {
  const BlindDesign& design = scene.motion;
  std::string text =
      fmt::format("format = 1\nname = \"{}\"\nseed = {}\ngravity_m_s2 = {}\n\n", name, seed, design.gravity_m_s2);
  text += camera_text(scene);
  const double rate_hz = scene.camera.rate_hz * (1.0 + scene.rate_error);
  for (std::size_t c = 0; c < design.clips.size(); ++c) {
    const BlindClip& clip = design.clips[c];
    const BlindGroup& group = design.groups[clip.group];
    text += fmt::format("[[configuration]]\nname = \"{}\"\nmass_kg = {:.9g}\nincline_deg = {:.9g}\n", clip.name,
                        design.masses[clip.mass].true_kg, group.true_rad * base::kDegreesPerRad);
    text += fmt::format("stated_incline_deg = {:.9g}\nstated_incline_sd_deg = {:.9g}\ngroup = \"{}\"\n",
                        group.stated_rad * base::kDegreesPerRad,
                        group.stated_sd_rad.value_or(0.0) * base::kDegreesPerRad, group.name);
    text += force_text(scene.forces[c]);
    const double duration_s = (static_cast<double>(clip.frames + scene.spare_frames) - 0.5) / rate_hz +
                              scene.camera.exposure_s + scene.camera.line_s * (scene.camera.height_px - 1);
    text += fmt::format(
        "[[configuration.clip]]\nname = \"{}\"\nlaunched = \"{}\"\nx0_m = {:.9g}\nv0_m_s = {:.9g}\nduration_s = "
        "{:.9g}\n\n",
        clip.name, clip.v0_m_s < 0.0 ? "up" : "down", clip.x0_m, clip.v0_m_s, duration_s);
  }
  return text;
}

}  // namespace glidelab::validate
