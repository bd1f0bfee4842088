/// The word that the user may have meant, by edit distance (Damerau, 1964: letters inserted, omitted, replaced, or
/// exchanged with their neighbour).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace glidelab::base {

/// The known word that requires the fewest changes (the first of several); empty if that is more than two and more than
/// a third of the letters.
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

/// "; did you mean \"up\"?", or an empty text if no known word is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

}  // namespace glidelab::base
