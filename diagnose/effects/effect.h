/// What an effect is, and everything that the program knows about one: its stage, its parameters, its law, what it does
/// to a table of lines, its twin in a scenario.
///
/// The nominal model and the effects together are the equation of motion
///
///     (m + m_w) dv/dt = W slope - o (K v f l / d + D) - against + forces - sign(v) (mu W cos(alpha) + F_0)
///
/// with the weight W = m g and the inertia m_w that carries no weight. D is the drag of air, `forces` are those that
/// effects add and the recorded one. The nominal model has slope = sin(alpha), o = f = d = l = 1, D = against = 0 and
/// F_0 = 0; the law of an effect that acts (EffectLaw) changes these terms and the way in which the motion is observed.
/// Units are SI, x and v are positive downhill, and t is the true time since the clip's first frame.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "diagnose/effects/effect_list.h"
#include "diagnose/result/gap_place.h"

namespace glidelab::diagnose {

/// The constants of a motion.
struct GliderConstants {
  double mass_kg = 0.0;
  double weight_n = 0.0;
  double cos_alpha = 1.0;
  double mu = 0.0;
  double x_mid_m = 0.0;                  ///< middle of the range of positions of this set-up
  double x_mid_all_m = 0.0;              ///< middle of the range of positions of all set-ups
  double x_low_m = 0.0, x_high_m = 0.0;  ///< range of the positions of all set-ups
  double clip = 0.0;                     ///< number of the clip, from 0, in the order of the file
  bool driven = false;                   ///< driven by a recorded force
};

struct GliderState {
  double x, v, t;
  double wave;  ///< sin(2 pi f t + phase) of base_vibration
  bool pushed;  ///< the hand of late_release still pushes
};

/// The terms of the equation of motion other than dry friction and added forces.
struct Resistance {
  double slope;                                  ///< sin(alpha)
  double drag_factor = 1.0, drag_divisor = 1.0;  ///< f and d
  double drag_along = 1.0;                       ///< l, a factor that depends on position
  double own_factor = 1.0;                       ///< o, each clip's or configuration's own
  double of_air_n = 0.0;                         ///< D, towards smaller x
  double against_n = 0.0;                        ///< a force towards smaller x, in both directions of motion
};

struct DryFriction {
  double mu;
  double force_n = 0.0;  ///< independent of the load
};

/// The order in which changes of the measured position are applied.
enum class SeenBy { lens, plane, scale, mount };

/// How an effect changes the motion and its observation. `p` are the effect's parameters in the order of its file.
struct EffectLaw {
  std::size_t size = 0;   ///< index of the first parameter that is 0 if the effect is absent,
  std::size_t sizes = 1;  ///< and the number of such parameters: the effect acts if any of them is not 0
  void (*resistance)(const double* p, const GliderConstants& glider, const GliderState& at, Resistance& of) = nullptr;
  double (*force_n)(const double* p, const GliderConstants& glider, const GliderState& at) = nullptr;
  void (*friction)(const double* p, const GliderConstants& glider, const GliderState& at, DryFriction& of) = nullptr;
  double (*inertia_kg)(const double* p, const GliderConstants& glider) = nullptr;  ///< added to the weighed mass
  double (*known_factor)(const double* p) = nullptr;  ///< ratio of the acting force to the recorded one
  double (*known_late_s)(const double* p) = nullptr;  ///< how much later it acts than recorded
  /// The rate at which the effect changes the motion. A step of the integrator is at most 0.3 of its inverse.
  double (*rate_1_s)(const double* p, double mass_kg) = nullptr;
  /// The measured position of an object at `x_m` which, with the changes applied so far, is seen at `seen_m`.
  double (*seen_m)(const double* p, const GliderConstants& glider, double x_m, double t_s, double seen_m) = nullptr;
  SeenBy seen_by = SeenBy::lens;
  double (*stretch)(const double* p) = nullptr;  ///< true time over stated time
  double (*row_s)(const double* p) =
      nullptr;  ///< delay of a row's exposure after the row above, in excess of the stated one
  /// Its resistance, force and friction depend on nothing but the direction of motion and whether the hand pushes, and
  /// a drag keeps its proportion to the speed.
  bool steady = false;
  bool passing = false;  ///< acts only at some positions, times or clips: left out of the terminal velocity

  bool acts(const double* p) const {
    return std::any_of(p + size, p + size + sizes, [](double value) { return value != 0.0; });
  }
  bool changes_forces() const { return resistance != nullptr || force_n != nullptr || friction != nullptr; }
  bool moves() const {
    return resistance != nullptr || force_n != nullptr || friction != nullptr || inertia_kg != nullptr ||
           known_factor != nullptr || known_late_s != nullptr;
  }
};

/// An effect that the twin lacks, and why.
struct MissingInTwin {
  std::string_view id;
  std::string why;
};

/// The forces of one configuration. A scenario integrates m dv/dt = F; where the fit has (m + m_w) dv/dt = F, every
/// force of the twin is multiplied by `part`.
struct TwinForces {
  double part = 1.0;               ///< m/(m + m_w)
  double k_n_s_m = 0.0, mu = 0.0;  ///< of the nominal model, times `part`
  double own_factor = 1.0;         ///< of the configuration: of K, which has it already, and of the drag of air
  double normal_n = 0.0;           ///< m g cos(alpha)
  double along_n = 0.0;            ///< m g sin(alpha)
  std::string drag;                ///< in place of K v; empty: K v itself
  std::string_view drag_by;        ///< the effect that replaced it
  std::string more_drag;
  std::string friction;  ///< in place of mu; empty: mu itself
  std::string others;
  std::vector<MissingInTwin> lacks;

  /// Puts a drag in place of K v. If another effect had replaced it already, the twin lacks that one.
  void replace_drag(std::string_view id, std::string text);
};

/// The section "[[configuration.force]]" of a scenario, for a law and its keys.
std::string scenario_force(const std::string& law, const std::map<std::string, double>& keys);

/// The sizes that the diagnosis found, by key.
class TwinSizes {
 public:
  explicit TwinSizes(std::vector<std::pair<std::string, double>> sizes) : sizes_(std::move(sizes)) {}
  std::optional<double> of(std::string_view key) const;

 private:
  std::vector<std::pair<std::string, double>> sizes_;
};

/// How the data were filmed, and the camera and the clock of the scenario. World frame: x along the track, z towards
/// the camera.
struct TwinCamera {
  // As filmed.
  bool filmed = false;
  bool exposure_known = false;
  double stated_frame_s = 0.0;
  int height_px = 0;
  double downhill = 1.0;        ///< +1 if the world's x points along the data's x, else -1
  double x_m = 0.0, z_m = 0.0;  ///< the camera's position
  double distance_m = 0.0;
  double focal_px = 0.0;
  double reference_m = 0.0;  ///< the data's x at the world's x = 0
  // As the scenario has it.
  double exposure_s = 0.0;
  double frame_s = 0.0;  ///< true
  double line_s = 0.0;
  double focal_factor = 1.0;
  std::string_view focal_by;  ///< the effect that changed the focal length first
  bool lossy = false;
  std::string clock, light, motions;  ///< keys of [clock] and [light], sections of mount.motion
  std::vector<std::string> notes;
  std::vector<MissingInTwin> lacks;

  void lack(std::string_view id, std::string why) { lacks.push_back({id, std::move(why)}); }
};

/// The order in which effects change the camera. Each may depend on the ones before it.
enum class TwinPart { exposure, clock, shutter, light, mount, codec };

/// An effect as part of a scenario that behaves like the data. Exactly one of three is given: the reason why no
/// scenario can express the effect, its force, or its change of the camera and the clock.
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

/// What bounds a parameter in given data, besides `low` and `high` (range_of() in fit_model.h).
enum class Reach {
  stated,     ///< nothing
  with_mass,  ///< `high` holds up to 1 kg and grows in proportion to a larger mass
  inertia,    ///< as with_mass; in a fall, what a wheel or the air that moves along can weigh
  per_clip,   ///< a relative change from each clip to the next, which takes at most all of it by the last clip
  places,     ///< the range of the positions
  bulge,    ///< `low` and `high`, or a shift of the ends of the range of positions by a quarter of their distance from
            ///< its middle
  waves,    ///< the frequencies that the clips can show
  release,  ///< times at the start of the clips
  held_speed,  ///< speeds above the one at which a codec may hold the marker in place
};

/// How a fitted parameter is shown.
enum class ShownAs {
  itself,
  itself_and_directions,  ///< d, and K (1 + d) and K (1 - d) under k_plus_n_s_m and k_minus_n_s_m
  one_more,               ///< n, where n - 1 is fitted; s, where s - 1 is
  inverse_root,           ///< v_c, where 1/v_c² is fitted
  beside_stated,          ///< the stated line time plus e, where e is fitted; for line_s alone
  itself_and_middle,      ///< the slope, and under x_mid_m the middle of each set-up's positions, about which it is
  place_of_middle,        ///< as x_mid_m alone: at this part of the distance from a set-up's own middle to that of all
  of_mu,                  ///< deviations d of mu: the standard deviation of all mu + d, and each of them (own_sizes.h)
  of_drag,                ///< relative deviations d of K: the same of all K (1 + d)
  along_track,            ///< with the effect's other parameters, as a function of position (own_sizes.h)
};

/// Whether it is shown only together with others of its kind.
constexpr bool shown_together(ShownAs how) {
  return how == ShownAs::of_mu || how == ShownAs::of_drag || how == ShownAs::along_track;
}

/// What has a parameter value of its own. A configuration is one mass on one set-up.
enum class Each { experiment, configuration, clip, motion };

/// One free parameter of an effect.
struct EffectParameter {
  std::string_view key;  ///< as in files, with its unit (base::name_and_unit()); empty: not shown
  double absent;         ///< its value if the effect is absent; arbitrary for a shape parameter
  double low, high;      ///< the range of the fitted quantity
  double step;           ///< of the finite difference of the motion with respect to it
  Reach reach = Reach::stated;
  ShownAs shown_as = ShownAs::itself;
  Each each = Each::experiment;
  std::string_view each_key = {};  ///< for ShownAs::of_mu and of_drag: the key of single values; empty: not shown
  bool only_filmed = false;        ///< fitted to filmed motions only
  bool open_ended = false;         ///< beyond some size no position tells how large it is: an end of the range is usual
  /// Standard deviation of a normal prior about 0, for parameters of which the data determine only combinations: the
  /// deviations of clips, configurations or places from a mean that is fitted too. 0: no prior.
  double held_sd = 0.0;
  /// Larger sizes are rarer: density falls by 1 + (size/usual)²; 0: not. Of a place, in ranges of x from its middle.
  double usual = 0.0;
  EffectSlot slot = {};  ///< where its value is stored; set by the list
};

/// How the first fit of an effect is found.
enum class Search {
  amplitude,  ///< one parameter, to which the change of the motion is proportional
  shape,      ///< the same with a second parameter, searched on a grid
  spread,     ///< many sizes of one kind, each of either sign
  wave,       ///< a frequency, with a phase in every motion
  pushes,     ///< a time, with a size in every motion
  frames,     ///< missing frames, found one by one
  noise,      ///< shown by the scatter of single positions, not by the trajectory
  rows,       ///< one proportional parameter that acts by the image row: filmed tracks only
  images,     ///< shown by the images, even if no position changes
  lines,      ///< shown only by a table of lines
};

/// Whether such an effect shows in the motion as a whole, rather than in single frames or in the images alone.
constexpr bool shows_in_motion(Search search) {
  return search != Search::frames && search != Search::noise && search != Search::images;
}

/// Whether such an effect shifts positions and so contributes to the gap. Lost frames do; the scatter of single
/// positions does not.
constexpr bool takes_part_of_gap(Search search) {
  return search == Search::frames || shows_in_motion(search);
}

/// What the search on a grid needs to know of the data.
struct ShapeReach {
  double x_low_m, x_high_m;  ///< range of the positions
  bool several_setups;
  double held_m_s;  ///< below this speed a codec may hold the marker
};

/// One line a = a0 - (K/m) v of a table.
struct LineQuantities {
  double mass_kg;
  double direction;  ///< sign of v
  double a0_m_s2, k_over_m_1_s;
};

/// What one unit of an effect adds to ln(K/m) and to a0 of a line, to first order.
struct LineChange {
  double of_log_k, of_a0_m_s2;
};

/// The quantity that has a separate value for each configuration in a table of lines.
enum class OwnOfLines { nothing, mu, drag };

/// What an effect does to a table of lines. A null function and OwnOfLines::nothing: nothing that lines could show.
struct OnLines {
  LineChange (*change)(const LineQuantities& line) = nullptr;
  std::string_view key = {};
  double largest = 0.0;  ///< in the unit of the key
  OwnOfLines own = OwnOfLines::nothing;
  std::string_view same_as = {};      ///< the effect that changes lines in the same way to first order
  std::string_view unknown_key = {};  ///< of a second size, which the width of the smoothing kernel would tell
};

/// An effect earlier in the list that no experiment with tracks can tell from this one.
struct Alike {
  std::string_view id = {};  ///< empty: none
  bool filmed = false;       ///< nor can filmed clips
};

/// Where images show an effect by themselves, whatever the positions do.
struct InImages {
  GapVariable over;
  GapKind what;
  bool along_track = false;  ///< over rows if the track runs down the image
};

/// What an effect has to do with drag.
enum class Drag {
  none,
  viscous,  ///< it changes the viscous drag K v, and needs one
  of_air,   ///< a drag such as that of air at speed; all of these are one law with other constants
};

/// What an effect lets touch the glider besides the track and the air.
enum class Touch {
  nothing,
  in_one_place,  ///< a bumper, a cable
  hand,          ///< at the start of a clip
};

/// The effect that moves the body or its image in nearly the same way. Each of the two names the other, the size is the
/// first parameter of both, and a place or a frequency the second (weigh/twin_fits.h).
struct Mirror {
  std::string_view id = {};                              ///< empty: none
  double (*size)(double size, double second) = nullptr;  ///< the other's size for one of this; null: the same
  double phase_rad = 0.0;                                ///< the other's phase less that of this; of waves
  bool beyond_middle = false;                            ///< only for a place beyond the middle of the positions
};

/// What the sizes of single clips follow where the effect acts (causes/scatter_structure.h).
struct AmongClips {
  enum class Of { nothing, friction, drag };
  Of of = Of::nothing;
  bool steadily = false;  ///< they change steadily from clip to clip; otherwise each configuration has one
};

/// Of an effect that makes single positions scatter: the size's key in files, and the number of parameters that tell
/// the scatter.
struct PointScatter {
  std::string_view key = {};
  std::size_t parameters = 0;
};

/// What the prior odds of an effect depend on.
struct Circumstances {
  std::size_t clips = 0;
  bool only_falls = false;   ///< every inclination is 80 degrees or more
  bool through_air = false;  ///< falls faster than any viscous drag allows (tracks/tracked_motions.h)
  double loads = 1.0;        ///< the largest normal force over the smallest, of the motions
};

/// What the program knows about one effect: its names and words, its parameters and their ranges, its law, its change
/// of a table of lines, its twin in a scenario, and what to record next. No member has a default, so the compiler
/// refuses an effect that leaves one out.
struct EffectInfo {
  std::string_view id;
  Stage stage;
  bool of_camera;            ///< only a camera has it: the positions of a motion sensor cannot show it
  std::string_view words;    ///< a phrase for a sentence: "a drag that grows with the square of the speed"
  std::string_view name;     ///< up to 30 characters, for the axes of a plot: "quadratic drag"
  std::string_view meaning;  ///< what the symbols of its sizes mean; empty if its size is a word
  Search search;
  bool both_signs;
  Drag drag;
  Touch touch;
  Mirror mirror;
  AmongClips among_clips;
  PointScatter point_scatter;
  /// Prior odds relative to another effect; 0 if such a recording cannot show this one at any size. Null: 1.
  double (*odds)(const Circumstances& of);
  /// Log of a further factor of these odds where explanations are weighed with a remainder. Below 0 for an effect that
  /// fits nearly any small imperfection of single clips; the two values are fitted (cause_odds.h).
  double log_odds_beside_remainder;
  std::vector<EffectParameter> parameters;  ///< the amplitude first, then the shape parameter
  EffectLaw law;
  std::vector<double> (*shapes)(const ShapeReach& reach);  ///< for Search::shape: the grid of the second parameter
  OnLines lines;
  EffectTwin twin;
  std::optional<InImages> in_images;  ///< for effects that images show by themselves
  std::string_view next;              ///< what to record next, and why; empty if the motion of another launch decides
  Alike alike;
};

/// A parameter as files and pages show it, and its derivative with respect to the fitted one, for the standard
/// deviation.
struct ShownValue {
  double value = 0.0;
  double by_fitted = 1.0;
};
ShownValue shown(const EffectParameter& parameter, double fitted);

/// The midpoints of `parts` equal parts of the range of positions: a grid for a position.
std::vector<double> places_of(const ShapeReach& reach, int parts);

}  // namespace glidelab::diagnose
