/// An effect and everything that the program knows about it: its stage, its parameters, its law, its lines in a table,
/// its twin in a scenario.
///
/// While an effect acts, the model calls the functions of its law (EffectLaw), which change the motion and its
/// observation:
///
///     (m + m_w) dv/dt = W slope - K v factor / divisor along - against + forces - sign(v) (mu W cos(alpha) + F_0)
///
/// with the weight W = m g. The terms slope, factor, divisor, along, against, mu and F_0 are those of the nominal model
/// (sin alpha, 1, 1, 1, 0, mu, 0) until an effect changes them. Everything is in SI units, x and v are positive
/// downhill, and t is the true time from the clip's first frame.
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
  double x_mid_m = 0.0;                  ///< of the set-up
  double x_mid_all_m = 0.0;              ///< of all set-ups
  double x_low_m = 0.0, x_high_m = 0.0;  ///< of the positions of all set-ups
  double clip = 0.0;                     ///< its number, from 0, in the order of the file
  bool driven = false;                   ///< by a force that was recorded
};

struct GliderState {
  double x, v, t;
  double wave;  ///< sine of base_vibration's phase at t
  bool pushed;  ///< before late_release's end
};

/// Everything but dry friction and effects that only add a force.
struct Resistance {
  double slope;  ///< sin(alpha)
  double drag_factor = 1.0, drag_divisor = 1.0;
  double drag_along = 1.0;  ///< factor that depends on position
  double against_n = 0.0;   ///< against x, whichever way it moves
};

struct DryFriction {
  double mu;
  double force_n = 0.0;  ///< independent of the load
};

/// The order in which changes of the measured position are applied.
enum class SeenBy { lens, plane, scale, mount };

/// How an effect changes the motion and its observation. `p` are the effect's parameters in the order of its file.
struct EffectLaw {
  std::size_t size = 0;   ///< the first parameter that is 0 where the effect is absent,
  std::size_t sizes = 1;  ///< and how many are: it acts where one of them is not 0
  void (*resistance)(const double* p, const GliderConstants& glider, const GliderState& at, Resistance& of) = nullptr;
  double (*force_n)(const double* p, const GliderConstants& glider, const GliderState& at) = nullptr;
  void (*friction)(const double* p, const GliderConstants& glider, const GliderState& at, DryFriction& of) = nullptr;
  double (*inertia_kg)(const double* p, const GliderConstants& glider) = nullptr;  ///< added to the weighed mass
  double (*known_factor)(const double* p) = nullptr;  ///< the force that acts over the recorded one
  double (*known_late_s)(const double* p) = nullptr;  ///< how much later it acts than recorded
  /// How fast it makes the motion change: a step is at most 0.3 of its inverse.
  double (*rate_1_s)(const double* p, double mass_kg) = nullptr;
  /// The measured x of an object at `x_m` that was seen at `seen_m` so far.
  double (*seen_m)(const double* p, const GliderConstants& glider, double x_m, double t_s, double seen_m) = nullptr;
  SeenBy seen_by = SeenBy::lens;
  double (*stretch)(const double* p) = nullptr;  ///< true time over stated time
  double (*row_s)(const double* p) =
      nullptr;           ///< how much later a row is exposed than the one above, over what is stated
  bool passing = false;  ///< acts at some positions, times or clips only: no part of the balance at terminal velocity

  bool acts(const double* p) const {
    return std::any_of(p + size, p + size + sizes, [](double value) { return value != 0.0; });
  }
  bool moves() const {
    return resistance != nullptr || force_n != nullptr || friction != nullptr || inertia_kg != nullptr ||
           known_factor != nullptr || known_late_s != nullptr;
  }
};

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

/// How the data were filmed, and the camera and clock that the scenario gets. World: x along the track, z towards the
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

/// An effect in a scenario, as part of a simulation that behaves like the data. One of the three is given: why no
/// scenario can express it, its force, or its change of the camera and the clock.
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

/// What bounds a parameter besides `low` and `high`, in given data (range_of() of fit_model.h).
enum class Reach {
  stated,      ///< nothing
  with_mass,   ///< `high` holds for gliders of up to 1 kg and grows in proportion to the mass beyond
  places,      ///< it lies among the positions
  waves,       ///< a frequency that the clips can show
  release,     ///< a time at the start of the clips
  held_speed,  ///< a speed above that at which a codec may hold the marker
};

/// How a parameter is shown, from what is fitted.
enum class ShownAs {
  itself,
  one_more,      ///< n from n - 1, s from s - 1
  inverse_root,  ///< v_c from 1/v_c²
  together,      ///< all of its kind together (derived_parameters() of verdict_details.h), under one key
};

/// What has its own value of a parameter. A configuration is a mass on a set-up.
enum class Each { experiment, configuration, clip, motion };

/// One free parameter of an effect.
struct EffectParameter {
  std::string_view key;  ///< as files have it, with its unit (base::name_and_unit()); empty: not shown
  double absent;         ///< where the effect is absent; of a shape, any value
  double low, high;      ///< what it may be, as it is fitted
  double step;           ///< for the finite difference of the motion with respect to it
  Reach reach = Reach::stated;
  ShownAs shown_as = ShownAs::itself;
  Each each = Each::experiment;
  bool only_filmed = false;  ///< fitted to filmed motions only
  /// Standard deviation of a prior that holds it at 0 where the data leave it open, as a deviation of every clip from a
  /// mean that is fitted too; 0: no prior.
  double held_sd = 0.0;
  EffectSlot slot = {};  ///< where its value is; set by the list
};

/// How the first fit is found.
enum class Search {
  amplitude,  ///< one parameter that acts in proportion
  shape,      ///< a second one is searched on a grid
  spread,     ///< many sizes of one kind, each as likely positive as negative
  wave,       ///< a frequency, with a phase in every motion
  pushes,     ///< a time, with a size in every motion
  frames,     ///< frames that are missing: found one by one
  noise,      ///< shown by the scatter of single points, not by a trajectory
  rows,       ///< one parameter that acts in proportion, by the row of the image: on filmed tracks only
  pictures,   ///< shown by the images; no position need move
  lines,      ///< shown by a table of lines only
};

/// Whether such an effect shows in the motion as a whole, not in single frames or in the images alone.
constexpr bool shows_in_motion(Search search) {
  return search != Search::frames && search != Search::noise && search != Search::pictures;
}

/// Whether such an effect moves positions, and so makes a gap: lost frames do, scatter of single points does not.
constexpr bool takes_part_of_gap(Search search) {
  return search == Search::frames || shows_in_motion(search);
}

/// What a search on a grid needs to know.
struct ShapeReach {
  double x_low_m, x_high_m;  ///< of the positions
  bool several_setups;
  double held_m_s;  ///< below this speed a codec may hold the marker
};

/// One line a = a0 - (K/m) v of a table.
struct LineQuantities {
  double mass_kg;
  double direction;  ///< sign of v
  double a0_m_s2, k_over_m_1_s;
};

/// What one unit of an effect adds to ln(K/m) and to a0 of a line.
struct LineChange {
  double of_log_k, of_a0_m_s2;
};

/// What each configuration of a table of lines has of its own.
enum class OwnOfLines { nothing, mu, drag };

/// What an effect does to a table of lines; a null function and nothing of its own: nothing that lines could show.
struct OnLines {
  LineChange (*change)(const LineQuantities& line) = nullptr;
  std::string_view key = {};
  double largest = 0.0;  ///< in the unit of the key
  OwnOfLines own = OwnOfLines::nothing;
  std::string_view same_as = {};  ///< the effect whose lines these are to first order
};

/// The effect before this one in the list that no experiment with tracks can tell from it.
struct Alike {
  std::string_view id = {};  ///< empty: none
  bool filmed = false;       ///< nor can clips
};

/// What an effect's prior odds depend on.
struct Circumstances {
  std::size_t clips = 0;
  bool only_falls = false;  ///< every inclination is 80 degrees or more
};

/// What the program knows about one effect: its names and words, its parameters and how large they may be, its law, its
/// lines in a table, its twin in a scenario, and what to record next. No member has a default, so the compiler refuses
/// an effect that leaves one out.
struct EffectInfo {
  std::string_view id;
  Stage stage;
  std::string_view words;    ///< a phrase for a sentence: "a drag that grows with the square of the speed"
  std::string_view name;     ///< up to 30 characters, for the axes of a plot: "quadratic drag"
  std::string_view meaning;  ///< what the symbols of its sizes mean; empty where its size is a word
  Search search;
  bool both_signs;
  /// Prior odds against another effect; 0 where such a recording cannot show this one, of whatever size. Null: 1.
  double (*odds)(const Circumstances& of);
  std::vector<EffectParameter> parameters;  ///< the amplitude first, then the shape
  EffectLaw law;
  std::vector<double> (*shapes)(const ShapeReach& reach);  ///< of Search::shape: the second parameter's grid
  OnLines lines;
  EffectTwin twin;
  std::string_view next;  ///< what to record next, with the reason; empty where a launch decides by its motion
  Alike alike;
};

/// The value as files and pages have it, and its derivative with respect to what is fitted, for the standard deviation.
struct ShownValue {
  double value = 0.0;
  double by_fitted = 1.0;
};
ShownValue shown(const EffectParameter& parameter, double fitted);

/// `parts` midpoints of equal parts of the range of positions: a grid for a position.
std::vector<double> places_of(const ShapeReach& reach, int parts);

}  // namespace glidelab::diagnose
