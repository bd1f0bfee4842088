/// An effect in a scenario: the forces, the camera and the clock of a simulation that behaves like the data, or why no
/// scenario can say it.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glidelab::diagnose {

/// What a twin lacks, and why.
struct MissingInTwin {
  std::string_view id;
  std::string why;
};

/// The forces of one configuration. A scenario's m dv/dt = F is (m + m_w) dv/dt = F times `part`.
struct TwinForces {
  double part = 1.0;               ///< m/(m + m_w)
  double k_n_s_m = 0.0, mu = 0.0;  ///< of the nominal model, times `part`
  double normal_n = 0.0;           ///< m g cos(alpha)
  double along_n = 0.0;            ///< m g sin(alpha)
  std::string drag;                ///< in place of K v; empty: that
  std::string_view drag_by;        ///< which effect that is
  std::string more_drag;
  std::string friction;  ///< in place of mu; empty: that
  std::string others;
  std::vector<MissingInTwin> lacks;

  /// A drag in place of K v; the effect that had put one there before is lacking.
  void replace_drag(std::string_view id, std::string text);
};

/// "[[configuration.force]]" of a law with its keys.
std::string scenario_force(const std::string& law, const std::map<std::string, double>& keys);

/// The sizes that were found, by key.
class TwinSizes {
 public:
  explicit TwinSizes(std::vector<std::pair<std::string, double>> sizes) : sizes_(std::move(sizes)) {}
  std::optional<double> of(std::string_view key) const;

 private:
  std::vector<std::pair<std::string, double>> sizes_;
};

/// How the data were filmed, and the camera and clock that the scenario gets. World: x along the track, z to the
/// camera.
struct TwinCamera {
  // As filmed.
  bool filmed = false;
  bool exposure_known = false;
  double stated_frame_s = 0.0;
  int height_px = 0;
  double downhill = 1.0;        ///< sign of the world's x along the data's
  double x_m = 0.0, z_m = 0.0;  ///< where the camera stands
  double distance_m = 0.0;
  double focal_px = 0.0;
  double reference_m = 0.0;  ///< x of the data where the world's is 0
  // As the scenario has it.
  double exposure_s = 0.0;
  double frame_s = 0.0;  ///< true
  double line_s = 0.0;
  double focal_factor = 1.0;
  std::string_view focal_by;  ///< the effect that changed it first
  bool lossy = false;
  std::string clock, light, motions;  ///< keys of [clock] and [light], sections of mount.motion
  std::vector<std::string> notes;
  std::vector<MissingInTwin> lacks;

  void lack(std::string_view id, std::string why) { lacks.push_back({id, std::move(why)}); }
};

/// The order in which effects change the camera: each may depend on those before.
enum class TwinPart { exposure, clock, shutter, light, mount, codec };

/// One of the three is given: why no scenario can say it, its force, or its change of the camera.
class EffectTwin {
 public:
  using Force = void (*)(const double* p, TwinForces& forces);
  using Camera = void (*)(const TwinSizes& sizes, TwinCamera& camera);
  static EffectTwin none(std::string_view why) { return {why, nullptr, TwinPart::exposure, nullptr}; }
  static EffectTwin as_force(Force force) { return {{}, force, TwinPart::exposure, nullptr}; }
  static EffectTwin as_camera(TwinPart part, Camera camera) { return {{}, nullptr, part, camera}; }

  std::string_view why_not;
  Force force;
  TwinPart part;
  Camera camera;

 private:
  EffectTwin(std::string_view why, Force f, TwinPart p, Camera c) : why_not(why), force(f), part(p), camera(c) {}
};

}  // namespace glidelab::diagnose
