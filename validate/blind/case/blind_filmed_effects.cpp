#include "validate/blind/case/blind_filmed_effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "diagnose/effects/effect_list.h"
#include "validate/blind/case/blind_effects.h"
#include "validate/blind/case/blind_strength.h"

namespace glidelab::validate {
namespace {

constexpr double kLeastOfWanted = 0.8;  // fraction of the wanted size that is accepted if the camera cannot do more

double top_speed(const BlindScene& scene) {
  double top = 0.0;
  const BlindDetection nominal(scene.motion);
  for (const auto& clip : nominal.speed_m_s()) {
    for (const double v : clip) top = std::max(top, std::abs(v));
  }
  return top;
}

std::optional<BlindCause> by_images(const char* id, double size, double usual, double largest, double wanted,
                                    const char* parameter) {
  if (size > largest) {
    if (kLeastOfWanted * size > largest) return std::nullopt;
    size = largest;
    wanted = 0.5 * std::pow(size / usual, 2);
  }
  return BlindCause{id, size, {{parameter, size}}, "", wanted};
}

}  // namespace

std::optional<BlindCause> long_exposure(double wanted, BlindScene& scene, BlindRandom&) {
  BlindCamera& camera = scene.camera;
  const double stated_s = camera.exposure_s;
  const double usual_s = std::hypot(0.4 * stated_s, 0.2 / camera.px_per_m() / top_speed(scene));
  // Rows that are read one after another must still end within the frame time.
  const double largest_s = 0.85 / camera.rate_hz - camera.line_s * camera.height_px - stated_s;
  auto cause = by_images(diagnose::ids::exposure_blur, usual_s * std::sqrt(2.0 * wanted), usual_s, largest_s, wanted,
                         "exposure_s");
  if (!cause) return cause;
  camera.exposure_s = stated_s + cause->size;
  cause->parameters["exposure_s"] = camera.exposure_s;
  scene.stated.push_back({"exposure_s", fmt::format("{:.9g}", stated_s)});
  return cause;
}

std::optional<BlindCause> hidden_rolling(double wanted, BlindScene& scene, BlindRandom&) {
  BlindCamera& camera = scene.camera;
  const double marker_px = 0.02 * camera.px_per_m();
  const double usual_s = 0.02 / (marker_px * top_speed(scene) * camera.px_per_m());
  const double largest_s = (1.0 / camera.rate_hz - camera.exposure_s) / camera.height_px;
  camera.line_s = 0.0;
  auto cause = by_images(diagnose::ids::rolling_shutter, usual_s * std::sqrt(2.0 * wanted), usual_s, largest_s, wanted,
                         "line_s");
  if (!cause) return cause;
  camera.line_s = cause->size;
  scene.stated.push_back({"shutter", "\"global\""});
  scene.stated.push_back({"line_readout_s", ""});
  return cause;
}

std::optional<BlindCause> flicker(double wanted, BlindScene& scene, BlindRandom& random) {
  const BlindCamera& camera = scene.camera;
  const double hz = uniform(random, 0.0, 1.0) < 0.7 ? (uniform(random, 0.0, 1.0) < 0.5 ? 100.0 : 120.0)
                                                    : uniform(random, 8.0, 0.45 * camera.rate_hz);
  // The frames must sample it as a wave: five periods in the shortest clip, and not a multiple of the rate.
  const double folded = std::abs(hz - camera.rate_hz * std::round(hz / camera.rate_hz));
  double shortest_s = 10.0;
  for (const BlindClip& clip : scene.motion.clips) {
    shortest_s = std::min(shortest_s, static_cast<double>(clip.frames) / clip.rate_hz);
  }
  if (folded * shortest_s < 5.0 || folded > 0.47 * camera.rate_hz) return std::nullopt;
  const double half_turns = std::numbers::pi * hz * camera.exposure_s;
  const double usual = (camera.lossy() ? 0.01 : 0.002) / (std::sin(half_turns) / half_turns);
  auto cause = by_images(diagnose::ids::light_flicker, usual * std::sqrt(2.0 * wanted), usual, 0.25, wanted, "depth");
  if (!cause) return cause;
  scene.flicker_depth = cause->size;
  scene.flicker_hz = hz;
  cause->parameters["f_hz"] = hz;
  return cause;
}

std::optional<BlindCause> gradient(double wanted, BlindScene& scene, BlindRandom& random) {
  constexpr double kUsual_1_m = 0.1, kMost_1_m = 1.2;
  auto cause = by_images(diagnose::ids::light_gradient, kUsual_1_m * std::sqrt(2.0 * wanted), kUsual_1_m, kMost_1_m,
                         wanted, "gradient");
  if (!cause) return cause;
  scene.gradient_1_m = uniform(random, 0.0, 1.0) < 0.5 ? -cause->size : cause->size;
  cause->parameters["gradient"] = scene.gradient_1_m;
  return cause;
}

std::optional<BlindCause> hidden_codec(double wanted, BlindScene& scene, BlindRandom& random) {
  BlindCamera& camera = scene.camera;
  const double wall_e = 0.285 * camera.full_well_e;
  const double noise_code = 253.0 / camera.full_well_e * std::hypot(std::sqrt(wall_e), camera.read_noise_e);
  const double usual = 3.0 * std::hypot(noise_code, 0.3), step = usual * std::sqrt(2.0 * wanted);
  scene.retouch.rewritten = true;
  BlindCause cause{diagnose::ids::compression, step, {}, "", wanted};
  if (uniform(random, 0.0, 1.0) < 0.5) {
    // The quantiser's step doubles every 6 of crf, 0.625 at 0.
    camera.codec = "h264";
    camera.crf = std::round(6.0 * std::log2(step / 0.625));
    if (camera.crf < 20.0 || camera.crf > 44.0) return std::nullopt;
    return cause;
  }
  // libjpeg's table begins at 16 and is scaled by 50/quality below 50 and 2 - quality/50 above.
  camera.codec = "mjpeg";
  const double scaled = step / 16.0;
  camera.quality = static_cast<int>(std::round(scaled > 1.0 ? 50.0 / scaled : 100.0 - 50.0 * scaled));
  if (camera.quality < 8 || camera.quality > 90) return std::nullopt;
  return cause;
}

namespace {

using Put = std::function<std::optional<BlindCause>(double wanted, BlindScene&, BlindRandom&)>;
using Parameters = std::map<std::string, double>;

/// For effects of tracks: drawn with a size of the wanted gain, and passed to `film`.
Put as_in_tracks(std::string id, std::function<void(const BlindEffect&, double size, BlindScene&)> film) {
  return [=](double wanted, BlindScene& scene, BlindRandom& random) -> std::optional<BlindCause> {
    BlindEffect effect = draw_effect(id, scene.motion, random);
    // The renderer's clock is off by at most a tenth.
    if (id == diagnose::ids::frame_rate_error) effect.largest = std::min(effect.largest, 0.09);
    // Successive exposures must not overlap, even if each is six standard deviations off its time.
    if (id == diagnose::ids::timestamp_jitter) {
      const double exposed_s = scene.camera.exposure_s + scene.camera.line_s * scene.camera.height_px;
      effect.largest = std::min(effect.largest, (1.0 / scene.camera.rate_hz - exposed_s) / 12.0);
      if (!(effect.largest > 0.0)) return std::nullopt;  // the shutter is open for the whole frame time
    }
    const auto strength = size_for(BlindDetection(scene.motion), effect, wanted);
    if (!strength) return std::nullopt;
    film(effect, strength->size, scene);
    return BlindCause{id, strength->size, effect.truth ? effect.truth(strength->size) : Parameters{}, effect.variable,
                      strength->gain};
  };
}

/// A force law of the renderer instead of one of the usual two, or in addition to them, by the parameters of
/// effects.md.
Put as_law(std::string id, std::function<void(const Parameters&, double mass_kg, double alpha_rad, BlindForces&)> set) {
  return as_in_tracks(id, [=](const BlindEffect& effect, double size, BlindScene& scene) {
    const BlindDesign& design = scene.motion;
    for (std::size_t c = 0; c < design.clips.size(); ++c) {
      set(effect.truth(size), design.masses[design.clips[c].mass].true_kg,
          design.groups[design.clips[c].group].true_rad, scene.forces[c]);
    }
  });
}

/// A drag multiplied by a factor in each clip, as given by the change of forces.
Put as_drag_factor(std::string id) {
  return as_in_tracks(id, [](const BlindEffect& effect, double size, BlindScene& scene) {
    for (std::size_t c = 0; c < scene.forces.size(); ++c) {
      BlindFilm film = nominal_film(scene.motion, scene.motion.clips[c]);
      effect.put(size, c, film);
      BlindTerms terms{0.0, 1.0, 0.0, 1.0, film.law.mass_kg};
      for (const BlindChange& change : film.law.changes) change(0.0, 1.0, 0.0, terms);
      scene.forces[c].k_n_s_m *= terms.drag_n;
    }
  });
}

/// A displacement that depends on position alone: the glider is shown displaced.
Put as_warp(std::string id) {
  return as_in_tracks(id, [](const BlindEffect& effect, double size, BlindScene& scene) {
    scene.retouch.rewritten = true;
    for (std::size_t c = 0; c < scene.motion.clips.size(); ++c) {
      BlindFilm film = nominal_film(scene.motion, scene.motion.clips[c]);
      effect.put(size, c, film);
      scene.retouch.shown_at.push_back([seen = film.seen](double x) {
        for (const auto& see : seen) x = see(x, 0.0);
        return x;
      });
    }
  });
}

/// Dust on the magnets, an iron part near one of the runs: a friction that differs from clip to clip.
std::optional<BlindCause> friction_of_each_run(double wanted, BlindScene& scene, BlindRandom& random) {
  std::vector<double> share;
  for (std::size_t c = 0; c < scene.motion.clips.size(); ++c) share.push_back(std::clamp(normal(random), -2.0, 2.0));
  BlindEffect effect;
  effect.id = "friction_of_each_run";
  effect.largest = 0.45;
  effect.put = [=](double size, std::size_t clip, BlindFilm& film) {
    const double times = 1.0 + size * share[clip];
    film.law.changes.push_back([=](double, double, double, BlindTerms& f) { f.friction_n *= times; });
  };
  const auto strength = size_for(BlindDetection(scene.motion), effect, wanted);
  if (!strength) return std::nullopt;
  for (std::size_t c = 0; c < share.size(); ++c) scene.forces[c].mu *= 1.0 + strength->size * share[c];
  return BlindCause{effect.id, strength->size, {}, "clip", strength->gain};
}

/// An image stitched from two parts that do not quite match: a step in position.
std::optional<BlindCause> seam_in_image(double wanted, BlindScene& scene, BlindRandom& random) {
  const double at = uniform(random, -0.25, 0.25);
  const auto see = [at](double size, double x) { return x + 0.5 * size * std::tanh((x - at) / 0.02); };
  BlindEffect effect;
  effect.largest = 0.01;
  effect.put = [see](double size, std::size_t, BlindFilm& film) {
    film.seen.push_back([=](double x, double) { return see(size, x); });
  };
  const auto strength = size_for(BlindDetection(scene.motion), effect, wanted);
  if (!strength) return std::nullopt;
  scene.retouch.rewritten = true;
  for (std::size_t c = 0; c < scene.motion.clips.size(); ++c) {
    scene.retouch.shown_at.push_back([=, size = strength->size](double x) { return see(size, x); });
  }
  return BlindCause{"seam_in_picture", strength->size, {}, "x_m", strength->gain};
}

void lose_frames(const BlindEffect& effect, double size, BlindScene& scene) {
  scene.retouch.rewritten = true;
  for (std::size_t c = 0; c < scene.motion.clips.size(); ++c) {
    const BlindClip& clip = scene.motion.clips[c];
    BlindFilm film = nominal_film(scene.motion, clip);
    effect.put(size, c, film);
    std::vector<char> lost;
    for (const double t : film.true_t_s) {
      const auto frame = static_cast<std::size_t>(std::lround(t * clip.rate_hz));
      while (lost.size() < frame) lost.push_back(1);
      lost.push_back(0);
    }
    scene.spare_frames = std::max(scene.spare_frames, lost.size() - clip.frames);
    scene.retouch.lost.push_back(std::move(lost));
  }
}

/// The camera's own sway or turn; a scene 0.6 m behind the track moves less by a sway.
std::optional<BlindCause> shaken_camera(double wanted, BlindScene& scene, BlindRandom& random) {
  const bool pans = uniform(random, 0.0, 1.0) < 0.5;
  const double phase_deg = uniform(random, 0.0, 360.0);
  return as_in_tracks(diagnose::ids::camera_motion, [=](const BlindEffect& effect, double size, BlindScene& shaken) {
    shaken.mount =
        fmt::format("[[mount.motion]]\naxis = \"{}\"\n{} = {:.9g}\nfrequency_hz = {:.9g}\nphase_deg = {:.6g}\n\n",
                    pans ? "pan" : "x", pans ? "amplitude_deg" : "amplitude_m",
                    pans ? 360.0 / kTurn * size / shaken.camera.z_m : size, effect.truth(size).at("f_hz"), phase_deg);
  })(wanted, scene, random);
}

const std::vector<std::pair<std::string, Put>>& library() {
  static const std::vector<std::pair<std::string, Put>> list = {
      {diagnose::ids::quadratic_drag, as_law(diagnose::ids::quadratic_drag,
                                             [](const Parameters& p, double, double, BlindForces& forces) {
                                               forces.more = fmt::format(
                                                   "[[configuration.force]]\nlaw = \"quadratic\"\nc_kg_m = {:.9g}\n",
                                                   p.at("c_kg_m"));
                                             })},
      {diagnose::ids::eddy_rolloff, as_law(diagnose::ids::eddy_rolloff,
                                           [](const Parameters& p, double, double, BlindForces& forces) {
                                             forces.drag_law = "eddy_rolloff";
                                             forces.drag_keys = fmt::format("v_c_m_s = {:.9g}\n", p.at("v_c_m_s"));
                                           })},
      {diagnose::ids::power_law_drag, as_law(diagnose::ids::power_law_drag,
                                             [](const Parameters& p, double, double, BlindForces& forces) {
                                               forces.drag_law = "power_law";
                                               forces.drag_keys = fmt::format("n = {:.9g}\n", p.at("n"));
                                             })},
      {diagnose::ids::stribeck, as_law(diagnose::ids::stribeck,
                                       [](const Parameters& p, double, double, BlindForces& forces) {
                                         forces.friction_law = "stribeck";
                                         forces.friction_keys =
                                             fmt::format("s = {:.9g}\nv_s_m_s = {:.9g}\n", p.at("s"), p.at("v_s_m_s"));
                                       })},
      {diagnose::ids::load_independent_friction,
       as_law(diagnose::ids::load_independent_friction,
              [](const Parameters& p, double mass_kg, double alpha_rad, BlindForces& forces) {
                forces.mu += p.at("force_n") / (mass_kg * kBlindGravity_m_s2 * std::cos(alpha_rad));
              })},
      // -mu (1 + d sign(v)) N sign(v) is -mu N sign(v) and a constant force.
      {diagnose::ids::direction_asymmetry,
       as_law(diagnose::ids::direction_asymmetry,
              [](const Parameters& p, double mass_kg, double alpha_rad, BlindForces& forces) {
                forces.more = fmt::format("[[configuration.force]]\nlaw = \"constant\"\nforce_n = {:.9g}\n",
                                          -forces.mu * p.at("d") * mass_kg * kBlindGravity_m_s2 * std::cos(alpha_rad));
              })},
      // (m + w) a = F is m a = F m/(m + w).
      {diagnose::ids::rotational_inertia,
       as_law(diagnose::ids::rotational_inertia,
              [](const Parameters& p, double mass_kg, double alpha_rad, BlindForces& forces) {
                const double share = mass_kg / (mass_kg + p.at("mass_kg"));
                forces.k_n_s_m *= share;
                forces.mu *= share;
                forces.more = fmt::format("[[configuration.force]]\nlaw = \"constant\"\nforce_n = {:.9g}\n",
                                          (share - 1.0) * mass_kg * kBlindGravity_m_s2 * std::sin(alpha_rad));
              })},
      {diagnose::ids::frame_rate_error, as_in_tracks(diagnose::ids::frame_rate_error,
                                                     [](const BlindEffect& effect, double size, BlindScene& scene) {
                                                       scene.rate_error =
                                                           1.0 / (1.0 + effect.truth(size).at("e")) - 1.0;
                                                     })},
      {diagnose::ids::scale_error,
       as_in_tracks(diagnose::ids::scale_error,
                    [](const BlindEffect& effect, double size, BlindScene& scene) {
                      scene.stated.push_back(
                          {"square_m", fmt::format("{:.9g}", 0.04 * (1.0 + effect.truth(size).at("e")))});
                    })},
      {diagnose::ids::perspective_error, as_warp(diagnose::ids::perspective_error)},
      {diagnose::ids::lens_distortion, as_warp(diagnose::ids::lens_distortion)},
      {diagnose::ids::dropped_frames, as_in_tracks(diagnose::ids::dropped_frames, lose_frames)},
      {diagnose::ids::timestamp_jitter,
       as_in_tracks(diagnose::ids::timestamp_jitter,
                    [](const BlindEffect&, double size, BlindScene& scene) { scene.jitter_s = size; })},
      {diagnose::ids::camera_motion, shaken_camera},
      {diagnose::ids::exposure_blur, long_exposure},
      {diagnose::ids::rolling_shutter, hidden_rolling},
      {diagnose::ids::light_flicker, flicker},
      {diagnose::ids::light_gradient, gradient},
      {diagnose::ids::compression, hidden_codec},
  };
  return list;
}

const std::vector<std::pair<std::string, Put>>& outside_library_filmed() {
  static const std::vector<std::pair<std::string, Put>> list = {
      {"drag_of_each_run", as_drag_factor("drag_of_each_run")}, {"drag_by_load", as_drag_factor("drag_by_load")},
      {"friction_of_each_run", friction_of_each_run},           {"flawed_pane", as_warp("flawed_pane")},
      {"scale_of_each_clip", as_warp("scale_of_each_clip")},    {"seam_in_picture", seam_in_image},
  };
  return list;
}

std::vector<std::string> filmed_ids_of(const std::vector<std::pair<std::string, Put>>& list) {
  std::vector<std::string> ids;
  for (const auto& [id, put] : list) ids.push_back(id);
  return ids;
}

}  // namespace

const std::vector<std::string>& filmed_effects() {
  static const std::vector<std::string> ids = filmed_ids_of(library());
  return ids;
}

const std::vector<std::string>& filmed_outside_effects() {
  static const std::vector<std::string> ids = filmed_ids_of(outside_library_filmed());
  return ids;
}

bool needs_lossless(const std::string& id) {
  static const std::vector<std::string> filed_anew = {diagnose::ids::perspective_error,
                                                      diagnose::ids::lens_distortion,
                                                      diagnose::ids::dropped_frames,
                                                      diagnose::ids::compression,
                                                      "flawed_pane",
                                                      "scale_of_each_clip",
                                                      "seam_in_picture"};
  return std::find(filed_anew.begin(), filed_anew.end(), id) != filed_anew.end();
}

std::optional<BlindCause> put_filmed_effect(const std::string& id, double wanted, BlindScene& scene,
                                            BlindRandom& random) {
  for (const auto* list : {&library(), &outside_library_filmed()}) {
    for (const auto& [known, put] : *list) {
      if (known == id) return put(wanted, scene, random);
    }
  }
  throw std::out_of_range("no such effect of filmed cases: " + id);
}

}  // namespace glidelab::validate
