/// The simulation that behaves like the data: the fitted motions, forces, camera and clock as a scenario file.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/pictures/twin_camera.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// The named effects of the camera and its clock as sections of a scenario, and what no key can express.
struct TwinEffects {
  double exposure_s = 0.0;
  double readout_s = 0.0;          ///< from the first row to the last
  std::string sections;            ///< each begins with an empty line
  std::vector<std::string> notes;  ///< what is assumed about the sizes
  std::vector<TwinLack> lacks;
};

/// What each effect does to the camera is in its own file (diagnose/effects/effect.h). [clock], [camera] exposure,
/// [shutter] and [light] express it exactly. A codec of unknown strength, a pan with one phase for all clips, and a
/// focal length or a direction changed after the calibration only resemble it.
///
/// `reference_m` is x in the data of the world's origin.
TwinEffects effects_of_camera(const std::vector<DiagnosedEffect>& effects, const std::optional<Filming>& filming,
                              const TwinView& view, double frame_rate_hz, double reference_m);

/// How the scenario begins.
inline constexpr std::string_view kTwinHead = "# Made by glidelab diagnose --twin";

/// One clip of a twin: it begins with a motion of the data, and has no other.
struct TwinClip {
  std::size_t motion = 0;  ///< index in TrackSet::motions
  std::string name;        ///< in the scenario: the data's clip, "cart"; its second motion is "cart-motion-2"
};

struct Twin {
  std::string toml;
  std::vector<TwinLack> lacks;
  double from_m = 0.0;  ///< x of the data where the twin's x is 0
  std::vector<TwinClip> clips;
};

/// The twin of a fit and the sizes of the effects that are named. `nameless`: something is missing that has no name.
///
/// Configurations are the fitted masses on the fitted inclinations, forces the fitted ones. Each motion is a clip, from
/// its fitted start: of a cart that bounces, every flight.
/// Each effect says which force of a scenario it is (diagnose/effects/effect.h), or that no scenario can express it.
/// Additional inertia becomes a factor m/(m + m_w) on all forces, gravity included, so that m dv/dt is the same. Camera
/// and clock are those of effects_of_camera(). A scenario has no forces that depend on position or time, and no
/// recorded ones. What needs one is listed, and the twin lacks it. The camera is that of the folder as far as it is
/// known (twin_camera.h). What is assumed is in the file's first lines. x counts from the middle of the data.
Twin twin_of(const TrackSet& set, const MotionFit& fit, const std::vector<DiagnosedEffect>& effects, bool nameless,
             const std::optional<Filming>& filming);

/// The name of a clip or a group in the twin's file: characters other than letters, digits, "-" or "_" become "-".
std::string twin_name(const std::string& name);

/// For all clips, in order: a name that comes out like an earlier one gets a number, "---" and "----2".
std::vector<std::string> twin_clip_names(const std::vector<std::string>& names);

}  // namespace glidelab::diagnose
