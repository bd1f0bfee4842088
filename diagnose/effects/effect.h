/// The effects that a diagnosis knows: their ids, stages, parameters, and how large each may be.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diagnose/model/effect_values.h"

namespace glidelab::diagnose {

/// One free parameter of an effect.
struct EffectParameter {
  std::string_view key;  ///< as in the list of effects, with its unit; empty: not shown
  double EffectValues::*member = nullptr;
  bool own = false;  ///< each motion has its own
  double low = 0.0;  ///< what it may be, of `member`
  double high = 0.0;
  double step = 0.0;       ///< for the finite difference
  bool with_mass = false;  ///< `high` is that of a glider of up to 1 kg, of a heavier one as many times more
};

/// How the first fit is found.
enum class Search {
  amplitude,  ///< one parameter that acts in proportion
  shape,      ///< a second one is searched on a grid
  wave,       ///< a frequency, with a phase in every motion
  pushes,     ///< a time, with a size in every motion
  frames,     ///< frames that are missing: found one by one
  noise,      ///< the scatter of single points tells, no trajectory
  rows,       ///< one parameter that acts in proportion, by the row of the picture: on filmed tracks only
  pictures,   ///< the pictures tell, no position need move
};

struct EffectInfo {
  std::string_view id;
  std::string_view stage;  ///< dynamics, optics, timing, sensor, tracking, analysis
  Search search = Search::amplitude;
  bool both_signs = false;
  /// The amplitude first, then the shape.
  std::vector<EffectParameter> parameters;
  std::string_view words;  ///< for a person: "a drag that grows with the square of the speed"
};

/// All effects that tracks can show.
const std::vector<EffectInfo>& effect_list();

/// What may be left out of a diagnosis: the ids of effect_list(), and smoothing_bias, which only a table of lines
/// shows.
std::vector<std::string> effect_words();

/// Index in effect_list(); std::out_of_range for another word.
std::size_t effect_index(std::string_view id);

/// The first of those effects that are the same to every experiment of tracks: a wrong scale and a wrong frame rate; of
/// positions alone, not `filmed`, a camera and a table that shake. An effect without such a double: itself.
std::size_t first_alike(std::size_t effect, bool filmed);

/// The value as the list of effects has it: v_c from 1/v_c², n from n - 1, s from s - 1; others as they are. The
/// derivative by the member goes with it, for the standard deviation.
struct ShownValue {
  double value = 0.0;
  double by_member = 1.0;
};
ShownValue shown(const EffectParameter& parameter, double member);

}  // namespace glidelab::diagnose
