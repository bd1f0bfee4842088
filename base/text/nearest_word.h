/// The word that somebody may have meant, by its edit distance (Damerau, 1964: letters put in, left out, replaced,
/// or exchanged with their neighbour).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace glidelab::base {

/// The known word that takes the fewest changes, the first of equals; empty where even that one takes more than two and
/// more than a third of the word's letters.
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

/// "; did you mean \"up\"?", or nothing where no known word is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

}  // namespace glidelab::base
