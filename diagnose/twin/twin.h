/// twin: The simulation that behaves like the data: fitted motions, forces, camera and clock as a scenario file.
///
/// The named effects of the camera and its clock as sections of a scenario, and what no key can express.
///
/// What each effect makes of the camera stands in its own file (diagnose/effects/effect.h): exactly what [clock],
/// [camera] exposure, [shutter] and [light] say; of the same kind a codec of unknown strength, a pan with one phase for
/// all clips, a focal length or a direction that was changed after the calibration.
///
/// The simulation that behaves like the data: the fitted motions as a scenario file.
///
/// Configurations are the fitted masses on the fitted inclinations, clips the fitted starts, forces the fitted ones.
/// Each effect says what force of a scenario it is (diagnose/effects/effect.h), or that no scenario can say it;
/// additional inertia is all forces, gravity with them, less by the factor m/(m + m_w): m dv/dt is then the same.
/// Camera and clock are those of twin.h. A scenario has no forces that depend on the place or the time, and none that
/// was recorded: what needs one is listed, and the twin lacks it. The camera is that of the folder as far as it is
/// known (twin_camera.h); what is assumed stands in the file's first lines. x counts from the middle of the data.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/pictures/twin_camera.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

struct TwinEffects {
  double exposure_s = 0.0;
  double readout_s = 0.0;          ///< from the first row to the last
  std::string sections;            ///< each begins with an empty line
  std::vector<std::string> notes;  ///< what of the sizes is assumed
  std::vector<TwinLack> lacks;
};

/// `reference_m`: x in the data of the world's origin.
TwinEffects effects_of_camera(const std::vector<DiagnosedEffect>& effects, const std::optional<Filming>& filming,
                              const TwinView& view, double frame_rate_hz, double reference_m);

/// How the scenario begins.
inline constexpr std::string_view kTwinHead = "# Made by glidelab diagnose --twin";

struct Twin {
  std::string toml;
  std::vector<TwinLack> lacks;
  double from_m = 0.0;  ///< x of the data where the twin's x is 0
  /// Clips that the twin has, as indices in TrackSet::clips, and when each begins after its first frame.
  std::vector<std::pair<std::size_t, double>> clips;
};

/// Of a fit and the sizes of the effects that are named. `nameless`: something is missing that has no name.
Twin twin_of(const TrackSet& set, const MotionFit& fit, const std::vector<DiagnosedEffect>& effects, bool nameless,
             const std::optional<Filming>& filming);

/// As a clip or a group is called in the twin's file: what is no letter, digit, "-" or "_" is "-".
std::string twin_name(const std::string& name);

/// Of all clips, in order: a name that comes out as one before has a number behind it, "---" and "----2".
std::vector<std::string> twin_clip_names(const std::vector<std::string>& names);

}  // namespace glidelab::diagnose
