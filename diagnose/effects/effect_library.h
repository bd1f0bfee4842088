/// The library of effects: all those that effect_list.h names, each defined in its own file.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "diagnose/effects/effect.h"
#include "diagnose/effects/effect_list.h"

namespace glidelab::diagnose {

/// Effects that motions or images can show: all but those that only a table of lines shows, which come last.
const std::vector<EffectInfo>& effect_list();

/// All of them.
const std::vector<EffectInfo>& all_effects();

/// What is known about one; std::out_of_range for a word that is not an effect's id.
const EffectInfo& effect_of(std::string_view id);

/// The ids of all: those that may be left out of a diagnosis.
std::vector<std::string> effect_words();

/// The first of the effects that no experiment with tracks can tell apart: a wrong scale and a wrong frame rate; from
/// positions alone, not `filmed`, a shaking camera and a shaking table. An effect without such a double: itself.
std::size_t first_alike(std::size_t effect, bool filmed);

/// Whether an effect has a size of its own for each clip: then it can follow whatever differs between clips.
bool differs_between_clips(std::size_t effect);

/// The same, or pushes, each clip its own.
bool follows_each_clip(std::size_t effect);

/// The sizes of all effects at once, as one motion feels them.
class EffectValues {
 public:
  /// All absent.
  EffectValues();

  double& operator[](const EffectSlot& slot) { return values_[slot.effect][slot.parameter]; }
  double operator[](const EffectSlot& slot) const { return values_[slot.effect][slot.parameter]; }

  /// An effect's parameters in order.
  const double* of(std::size_t effect) const { return values_[effect].data(); }

 private:
  std::array<std::array<double, kMostParameters>, kEffects> values_;
};

}  // namespace glidelab::diagnose
