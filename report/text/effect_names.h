/// What effects are called on pages, beside the ids that stand in files and options: the names that the effects' own
/// files give them (diagnose/effects/).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace glidelab::report {

/// "quadratic drag + rolling shutter" of "quadratic_drag + rolling_shutter"; "none" and "unknown" are told
/// in words too. What is the id of no effect (a cause without a name, in words already) stays as it is.
std::string effect_name(std::string_view ids);

/// What the letters beside the effect's size mean: "a force −c v |v|"; empty where its size is a word, or an id is of
/// no effect.
std::string effect_meaning(std::string_view id);

/// effect_name() of each.
std::vector<std::string> effect_names(const std::vector<std::string>& ids);

/// The name, and the ids small beside it where it is another. HTML.
std::string effect_html(std::string_view ids);

}  // namespace glidelab::report
