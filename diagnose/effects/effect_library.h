/// The library of effects: all that effect_list.h names, each defined in a file of its own.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "diagnose/effects/effect.h"
#include "diagnose/effects/effect_list.h"

namespace glidelab::diagnose {

/// Effects that motions or images can show, in the order of effect_list.h: all but those that only a table of lines
/// shows, which come last there.
const std::vector<EffectInfo>& effect_list();

/// All effects, in the order of effect_list.h.
const std::vector<EffectInfo>& all_effects();

/// What is known about one effect. std::out_of_range for a word that is no effect's id.
const EffectInfo& effect_of(std::string_view id);
/// The same; null for such a word.
const EffectInfo* find_effect(std::string_view id);

/// The ids of all effects: the words by which one can be left out of a diagnosis.
std::vector<std::string> effect_words();

/// Index of the first of the effects that the data cannot tell from this one: a wrong frame rate for a wrong scale or a
/// wrong mass and, if the motion was not `filmed`, a shaking table for a shaking camera. The index itself if there is
/// none.
std::size_t first_alike(std::size_t effect, bool filmed);

/// Whether an effect has a size of its own for each clip. Such an effect can follow any difference between clips.
bool differs_between_clips(std::size_t effect);

/// Whether it acts at a place, or changes from place to place along x: clips whose x counts from different origins
/// cannot share it.
bool is_bound_to_place(std::size_t effect);

/// Whether it has a size of its own for each clip, or a push of its own in each motion.
bool follows_each_clip(std::size_t effect);

/// The parameters of all effects, as they act on one motion.
class EffectValues {
 public:
  /// All effects absent.
  EffectValues();

  double& operator[](const EffectSlot& slot) { return values_[slot.effect][slot.parameter]; }
  double operator[](const EffectSlot& slot) const { return values_[slot.effect][slot.parameter]; }

  /// The parameters of an effect, in the order of its file.
  const double* of(std::size_t effect) const { return values_[effect].data(); }

 private:
  std::array<std::array<double, kMostParameters>, kEffects> values_;
};

}  // namespace glidelab::diagnose
