/// All effects of effect_list.h, each defined in its own file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diagnose/effects/effect.h"

namespace glidelab::diagnose {

/// Effects that motions or images can show: all but those that only a table of lines shows, which come last.
const std::vector<EffectInfo>& effect_list();

/// All of them.
const std::vector<EffectInfo>& all_effects();

/// What is known of one; std::out_of_range for a word that is no effect's id.
const EffectInfo& effect_of(std::string_view id);

/// The ids of all, which are what may be left out of a diagnosis.
std::vector<std::string> effect_words();

/// The first of the effects that no experiment of tracks tells apart from this one: a wrong scale and a wrong frame
/// rate; of positions alone, not `filmed`, a camera and a table that shake. An effect without such a double: itself.
std::size_t first_alike(std::size_t effect, bool filmed);

}  // namespace glidelab::diagnose
