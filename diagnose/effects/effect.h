/// What the program knows about one effect: its names and words, its parameters and how large they may be, its law, its
/// lines in a table, its twin in a scenario, and what to record next.
///
/// No member has a default: the compiler refuses an effect that leaves one out.
#pragma once

#include <string_view>
#include <vector>

#include "diagnose/effects/effect_law.h"
#include "diagnose/effects/effect_list.h"
#include "diagnose/effects/effect_twin.h"
#include "diagnose/effects/stage.h"

namespace glidelab::diagnose {

/// What bounds a parameter besides `low` and `high`, in given data (range_of() of effect_ranges.h).
enum class Reach {
  stated,      ///< nothing
  with_mass,   ///< `high` is that of a glider of up to 1 kg, of a heavier one as many times more
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
};

/// One free parameter of an effect.
struct EffectParameter {
  std::string_view key;  ///< as files have it, with its unit (base::name_and_unit()); empty: not shown
  double absent;         ///< where the effect is absent; of a shape, any value
  double low, high;      ///< what it may be, as it is fitted
  double step;           ///< for the finite difference of the motion by it
  Reach reach = Reach::stated;
  ShownAs shown_as = ShownAs::itself;
  bool own = false;          ///< each motion has its own
  bool only_filmed = false;  ///< fitted to filmed motions only
  EffectSlot slot = {};      ///< where its value stands; by the list
};

/// How the first fit is found.
enum class Search {
  amplitude,  ///< one parameter that acts in proportion
  shape,      ///< a second one is searched on a grid
  wave,       ///< a frequency, with a phase in every motion
  pushes,     ///< a time, with a size in every motion
  frames,     ///< frames that are missing: found one by one
  noise,      ///< the scatter of single points tells, no trajectory
  rows,       ///< one parameter that acts in proportion, by the row of the image: on filmed tracks only
  pictures,   ///< the images tell, no position need move
  lines,      ///< only a table of lines tells
};

/// What a search on a grid goes by.
struct ShapeReach {
  double x_low_m, x_high_m;  ///< of the positions
  bool several_setups;
  double held_m_s;  ///< slower than this a codec may hold the marker
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

/// What an effect does to a table of lines; a null function: nothing that lines could show by itself.
struct OnLines {
  LineChange (*change)(const LineQuantities& line) = nullptr;
  std::string_view key = {};
  double largest = 0.0;           ///< in the unit of the key
  std::string_view same_as = {};  ///< the effect whose lines these are to first order
};

/// The effect that comes before this one in the list and that no experiment of tracks tells apart from it.
struct Alike {
  std::string_view id = {};  ///< empty: none
  bool filmed = false;       ///< nor can clips
};

struct EffectInfo {
  std::string_view id;
  Stage stage;
  std::string_view words;    ///< a phrase for a sentence: "a drag that grows with the square of the speed"
  std::string_view name;     ///< up to 30 characters, for the axes of a plot: "quadratic drag"
  std::string_view meaning;  ///< what the letters beside its size mean; empty where its size is a word
  Search search;
  bool both_signs;
  std::vector<EffectParameter> parameters;  ///< the amplitude first, then the shape
  EffectLaw law;
  std::vector<double> (*shapes)(const ShapeReach& reach);  ///< of Search::shape: the second parameter's grid
  OnLines lines;
  EffectTwin twin;
  std::string_view next;  ///< what to record next, with the reason; empty where a launch decides by its motion
  Alike alike;
};

/// The value as files and pages have it; the derivative by what is fitted goes with it, for the standard deviation.
struct ShownValue {
  double value = 0.0;
  double by_fitted = 1.0;
};
ShownValue shown(const EffectParameter& parameter, double fitted);

/// `parts` midpoints of equal parts of the positions' range: a grid for a place.
std::vector<double> places_of(const ShapeReach& reach, int parts);

}  // namespace glidelab::diagnose
