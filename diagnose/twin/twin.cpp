#include "diagnose/twin/twin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>

#include "base/math/angles.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/pictures/image_evidence.h"

namespace glidelab::diagnose {
namespace {

constexpr double kAssumedExposure_s = 0.001;
constexpr double kMostFocalChange = 0.2;  // that a scenario allows

TwinCamera as_filmed(const std::optional<Filming>& filming, const TwinView& view, double frame_s, double reference_m) {
  TwinCamera camera;
  camera.filmed = filming.has_value();
  camera.exposure_known = filming && filming->settings.exposure_s;
  camera.stated_frame_s = camera.frame_s = frame_s;
  camera.height_px = filming ? filming->height_px : 0;
  camera.downhill = view.downhill;
  camera.x_m = view.position_m.x();
  camera.z_m = view.position_m.z();
  camera.distance_m = view.distance_m();
  camera.focal_px = view.focal_px[0];
  camera.reference_m = reference_m;
  // Of an unknown exposure, half of the frame time at most leaves the clock room.
  camera.exposure_s =
      camera.exposure_known ? *filming->settings.exposure_s : std::min(kAssumedExposure_s, 0.5 * frame_s);
  camera.line_s = filming ? stated_line_s(filming->settings) : 0.0;
  return camera;
}

std::string section(const std::string& name, const std::string& keys) {
  return keys.empty() ? "" : "\n" + name + "\n" + keys;
}

std::string shutter_section(const TwinCamera& camera) {
  if (camera.line_s == 0.0) return "";
  return section("[shutter]", fmt::format("kind = \"rolling\"\nline_readout_s = {:.9g}\nfirst_row = \"{}\"\n",
                                          std::abs(camera.line_s), camera.line_s < 0.0 ? "bottom" : "top"));
}

std::string mount_sections(TwinCamera& camera) {
  if (std::abs(camera.focal_factor - 1.0) > kMostFocalChange) {
    camera.lack(camera.focal_by, "a scenario changes its focal length by at most a fifth");
    camera.focal_factor = 1.0;
  }
  const double change = camera.focal_factor - 1.0;
  return section("[mount]", change == 0.0 ? "" : fmt::format("focal_change = {:.12g}\n", change)) + camera.motions;
}

std::string codec_sections(const std::optional<Filming>& filming, TwinCamera& camera) {
  const bool deep = filming && filming->settings.bit_depth > 8;
  const std::string depth =
      section("[sensor]", deep ? fmt::format("bit_depth = {}\n", filming->settings.bit_depth) : "");
  const bool stated_lossy = filming && filming->lossy.value_or(false);
  if (!camera.lossy && !stated_lossy) return depth;
  if (deep) {
    camera.lack(ids::compression, "a scenario stores more than 8 bits only without loss");
    return depth;
  }
  const bool motion_jpeg = !filming || filming->codec == "MJPG";
  const bool even = filming && filming->width_px % 2 == 0 && filming->height_px % 2 == 0;
  // Of 8 x 8 blocks in a file that does not say which codec made them, each image by itself is the simplest.
  const bool h264 = stated_lossy && !motion_jpeg && even;
  camera.notes.emplace_back("how strongly the codec compresses is not known: the scenario's default is used");
  return depth + section("[codec]", h264 ? "name = \"h264\"\n" : "name = \"mjpeg\"\n");
}

TwinSizes sizes_of(const DiagnosedEffect& effect) {
  std::vector<std::pair<std::string, double>> sizes;
  for (const DiagnosedParameter& parameter : effect.parameters) sizes.emplace_back(parameter.key, parameter.value);
  return TwinSizes(std::move(sizes));
}

/// All named effects of one part of the camera, in the order of the list.
void apply(TwinPart part, const std::vector<DiagnosedEffect>& effects, TwinCamera& camera) {
  for (const EffectInfo& info : effect_list()) {
    if (info.twin.camera == nullptr || info.twin.part != part) continue;
    const auto named = std::find_if(effects.begin(), effects.end(), [&](const auto& e) { return e.id == info.id; });
    if (named != effects.end()) info.twin.camera(sizes_of(*named), camera);
  }
}

}  // namespace

TwinEffects effects_of_camera(const std::vector<DiagnosedEffect>& effects, const std::optional<Filming>& filming,
                              const TwinView& view, double frame_rate_hz, double reference_m) {
  TwinCamera camera = as_filmed(filming, view, 1.0 / frame_rate_hz, reference_m);
  for (const TwinPart part :
       {TwinPart::exposure, TwinPart::clock, TwinPart::shutter, TwinPart::light, TwinPart::mount, TwinPart::codec}) {
    apply(part, effects, camera);
  }
  TwinEffects twin;
  twin.exposure_s = camera.exposure_s;
  if (camera.line_s != 0.0) twin.readout_s = std::abs(camera.line_s) * camera.height_px;
  twin.sections = section("[clock]", camera.clock) + shutter_section(camera) + section("[light]", camera.light);
  twin.sections += mount_sections(camera);
  twin.sections += codec_sections(filming, camera);
  twin.notes = camera.notes;
  for (const MissingInTwin& lack : camera.lacks) twin.lacks.push_back({std::string(lack.id), lack.why});
  for (const DiagnosedEffect& effect : effects) {
    const EffectInfo& info = effect_of(effect.id);
    if (info.stage != Stage::dynamics && !info.twin.why_not.empty())
      twin.lacks.push_back({effect.id, std::string(info.twin.why_not)});
  }
  return twin;
}

namespace {

/// The forces of a model with the effects that act in it.
TwinForces forces_of(const TrackModel& model) {
  const std::vector<EffectInfo>& list = effect_list();
  const auto acts = [&](std::size_t e) {
    return list[e].twin.force != nullptr && list[e].law.acts(model.effects.of(e));
  };
  const double m = model.mass_kg;
  double inertia_kg = m;
  for (std::size_t e = 0; e < list.size(); ++e) {
    if (list[e].law.inertia_kg != nullptr && acts(e))
      inertia_kg += list[e].law.inertia_kg(model.effects.of(e), {.mass_kg = m});
  }
  TwinForces forces;
  forces.part = m / inertia_kg;
  forces.k_n_s_m = forces.part * model.k_n_s_m;
  forces.mu = forces.part * model.mu;
  forces.normal_n = m * model.gravity_m_s2 * std::cos(model.alpha_rad);
  forces.along_n = m * model.gravity_m_s2 * std::sin(model.alpha_rad);
  for (const bool of_configuration : {true, false}) {  // whose K and mu others change
    for (std::size_t e = 0; e < list.size(); ++e) {
      if (!acts(e) || (list[e].parameters.front().each == Each::configuration) != of_configuration) continue;
      list[e].twin.force(model.effects.of(e), forces);
    }
  }
  return forces;
}

std::string sections_of(const TwinForces& forces) {
  std::string text = forces.drag;
  if (forces.drag.empty() && forces.k_n_s_m >= 0.0) text = scenario_force("viscous", {{"k_n_s_m", forces.k_n_s_m}});
  text += forces.more_drag + forces.friction;
  if (forces.friction.empty() && forces.mu >= 0.0) text += scenario_force("coulomb", {{"mu", forces.mu}});
  return text + forces.others;
}

/// The parts that one configuration needs besides its motions.
struct Place {
  std::size_t group = 0, mass = 0;
  bool operator<(const Place& other) const { return std::pair(group, mass) < std::pair(other.group, other.mass); }
};

std::vector<TwinLack> lacks_of_forces(const TrackSet& set, const TrackModel& model,
                                      const std::vector<DiagnosedEffect>& effects, bool nameless) {
  std::vector<TwinLack> lacks;
  for (const DiagnosedEffect& effect : effects) {
    const EffectInfo& info = effect_of(effect.id);
    if (info.stage == Stage::dynamics && !info.twin.why_not.empty())
      lacks.push_back({effect.id, std::string(info.twin.why_not)});
  }
  if (nameless) lacks.push_back({"what is missing", "it has no name"});
  const bool forced = std::any_of(set.motions.begin(), set.motions.end(),
                                  [](const TrackedMotion& motion) { return !motion.known.t_s.empty(); });
  if (forced) lacks.push_back({"the recorded force", "no force in a scenario depends on time"});
  for (const MissingInTwin& lack : forces_of(model).lacks) lacks.push_back({std::string(lack.id), lack.why});
  if (model.k_n_s_m < 0.0) lacks.push_back({"a drag below zero", "drag in a scenario can only remove energy"});
  if (model.mu < 0.0) lacks.push_back({"a friction below zero", "friction in a scenario can only remove energy"});
  return lacks;
}

std::string head(const Twin& twin, const std::vector<std::string>& assumed, const std::vector<std::string>& notes) {
  std::string text =
      fmt::format("{}: the motions as they were fitted. x counts from {:.6g} m of the data.\n", kTwinHead, twin.from_m);
  for (const TwinLack& lack : twin.lacks) text += fmt::format("# Not in it: {} ({}).\n", lack.what, lack.why);
  for (const std::string& what : assumed) text += fmt::format("# Assumed: {}.\n", what);
  for (const std::string& note : notes) text += fmt::format("# Note: {}.\n", note);
  return text;
}

/// Beyond the vertical a track is as steep as one as far before it: a fall's inclination is 90 degrees only to within
/// its uncertainty.
double incline_deg(double alpha_rad) {
  const double deg = alpha_rad * base::kDegreesPerRad;
  return std::abs(deg) <= 90.0 ? deg : std::copysign(180.0, deg) - deg;
}

std::string configuration(const TrackSet& set, const MotionFit& fit, const Place& place,
                          const std::vector<std::size_t>& motions, const std::vector<TwinClip>& clips, double from_m,
                          double readout_s) {
  const TrackGroup& group = set.groups[place.group];
  const TrackModel model = model_of(set, *fit.layout, fit.at, motions.front());
  std::string text = fmt::format(
      "\n[[configuration]]\nname = \"g{}-m{}\"\nmass_kg = {:.9g}\nincline_deg = {:.12g}\nstated_incline_deg = "
      "{:.9g}\n"
      "group = \"{}\"\n",
      place.group + 1, place.mass + 1, model.mass_kg, incline_deg(model.alpha_rad),
      group.stated_rad * base::kDegreesPerRad, twin_name(group.name));
  for (const InclineStatement& statement : group.statements) {
    if (statement.against == Against::stated)
      text += fmt::format("stated_incline_sd_deg = {:.9g}\n", statement.sd_rad * base::kDegreesPerRad);
  }
  text += sections_of(forces_of(model));
  for (const std::size_t i : motions) {
    const TrackedMotion& motion = set.motions[i];
    const Eigen::VectorXd& own = fit.at.own[i];
    const double frame = 1.0 / set.clips[motion.clip].frame_rate_hz;
    text += fmt::format(
        "[[configuration.clip]]\nname = \"{}\"\nlaunched = \"{}\"\nx0_m = {:.12g}\nv0_m_s = {:.12g}\nduration_s = "
        "{:.9g}\n",
        clips[i].name,
        own[1] < 0.0   ? "up"
        : own[1] > 0.0 ? "down"
                       : "released",
        own[0] - from_m, own[1], motion.t_s.back() - motion.t_s.front() + frame + readout_s);
  }
  return text;
}

/// A clip of the twin for each motion, in the order of the motions.
std::vector<TwinClip> clips_of(const TrackSet& set) {
  std::vector<std::string> names;
  for (const TrackedClip& clip : set.clips) names.push_back(clip.name);
  names = twin_clip_names(names);
  std::vector<TwinClip> clips;
  std::vector<std::size_t> motions(set.clips.size(), 0);  // of each clip, so far
  std::vector<std::string> all = names;
  std::vector<std::size_t> place;  // of each clip's name in `all`
  for (const TrackedMotion& motion : set.motions) {
    const std::size_t number = ++motions[motion.clip];
    place.push_back(number == 1 ? motion.clip : all.size());
    if (number > 1) all.push_back(fmt::format("{}-motion-{}", names[motion.clip], number));
  }
  all = twin_clip_names(all);
  for (std::size_t i = 0; i < place.size(); ++i) clips.push_back({i, all[place[i]]});
  return clips;
}

/// The differences between the data and the twin's file, apart from the camera: a scenario has one frame rate, and a
/// clip one motion.
std::vector<std::string> assumed_of_clips(const TrackSet& set, double rate_hz) {
  std::vector<std::string> assumed;
  const bool rates = std::any_of(set.motions.begin(), set.motions.end(), [&](const TrackedMotion& motion) {
    return set.clips[motion.clip].frame_rate_hz != rate_hz;
  });
  if (rates) assumed.push_back(fmt::format("{:.6g} frames a second, the first clip's, for all clips", rate_hz));
  std::vector<std::size_t> motions(set.clips.size(), 0);
  for (const TrackedMotion& motion : set.motions) ++motions[motion.clip];
  if (std::ranges::any_of(motions, [](std::size_t of_clip) { return of_clip > 1; })) {
    assumed.push_back(
        fmt::format("a clip for each of the {} motions, without what lies between those of one clip of "
                    "the data",
                    set.motions.size()));
  }
  return assumed;
}

}  // namespace

std::string twin_name(const std::string& name) {
  std::string plain;
  for (const char c : name) plain += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' ? c : '-';
  return plain.empty() ? "clip" : plain;
}

std::vector<std::string> twin_clip_names(const std::vector<std::string>& names) {
  std::vector<std::string> twins;
  for (const std::string& name : names) {
    const std::string plain = twin_name(name);
    std::string own = plain;
    for (int k = 2; std::find(twins.begin(), twins.end(), own) != twins.end(); ++k)
      own = fmt::format("{}-{}", plain, k);
    twins.push_back(std::move(own));
  }
  return twins;
}

Twin twin_of(const TrackSet& set, const MotionFit& fit, const std::vector<DiagnosedEffect>& effects, bool nameless,
             const std::optional<Filming>& filming) {
  Twin twin;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  std::map<Place, std::vector<std::size_t>> places;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const TrackedMotion& motion = set.motions[i];
    for (const double x : motion.x_m) {
      low = std::min(low, x);
      high = std::max(high, x);
    }
    places[{motion.group, motion.mass}].push_back(i);
  }
  twin.clips = clips_of(set);
  const double rate_hz = set.clips[set.motions.front().clip].frame_rate_hz;
  const TrackModel first = model_of(set, *fit.layout, fit.at, places.begin()->second.front());
  twin.from_m = 0.5 * (low + high);
  const TwinView view = view_of(filming, twin.from_m, high - low, first.alpha_rad);
  const TwinEffects seen = effects_of_camera(effects, filming, view, rate_hz, twin.from_m);
  twin.lacks = lacks_of_forces(set, first, effects, nameless);
  twin.lacks.insert(twin.lacks.end(), seen.lacks.begin(), seen.lacks.end());

  std::vector<std::string> assumed = assumed_of_clips(set, rate_hz);
  assumed.insert(assumed.end(), view.assumed.begin(), view.assumed.end());
  twin.toml = head(twin, assumed, seen.notes);
  twin.toml += fmt::format(
      "format = 1\nname = \"twin\"\ngravity_m_s2 = {:.9g}\n\n[camera]\nframe_rate_hz = {:.9g}\nexposure_s = {:.9g}\n",
      first.gravity_m_s2, rate_hz, seen.exposure_s);
  twin.toml += camera_keys(filming, view) + seen.sections + scene_sections(filming, view);
  for (const auto& [place, motions] : places) {
    twin.toml += configuration(set, fit, place, motions, twin.clips, twin.from_m, seen.readout_s);
  }
  return twin;
}

}  // namespace glidelab::diagnose
