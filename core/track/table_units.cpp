#include "core/track/table_units.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "core/experiment/file_names.h"

namespace glidelab::core {
namespace {

using Unit = std::pair<std::string_view, double>;
constexpr std::array<Unit, 10> kLengths{{{"m", 1.0},
                                         {"cm", 1e-2},
                                         {"mm", 1e-3},
                                         {"um", 1e-6},
                                         {"\xC2\xB5m", 1e-6},
                                         {"\xCE\xBCm", 1e-6},
                                         {"dm", 0.1},
                                         {"km", 1e3},
                                         {"in", 0.0254},
                                         {"ft", 0.3048}}};
constexpr std::array<Unit, 7> kTimes{
    {{"s", 1.0}, {"sec", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"\xC2\xB5s", 1e-6}, {"\xCE\xBCs", 1e-6}, {"min", 60.0}}};

// English, German, French, Spanish and Portuguese, Italian; in lower case.
constexpr std::array<std::string_view, 9> kMetre{"meter",         "meters", "metre",  "metres", "m\xC3\xA8tre",
                                                 "m\xC3\xA8tres", "metro",  "metros", "metri"};
constexpr std::array<Unit, 11> kPrefixes{{{"deci", 0.1},
                                          {"dezi", 0.1},
                                          {"d\xC3\xA9\x63i", 0.1},
                                          {"dec\xC3\xAD", 0.1},
                                          {"centi", 1e-2},
                                          {"zenti", 1e-2},
                                          {"cent\xC3\xAD", 1e-2},
                                          {"milli", 1e-3},
                                          {"mili", 1e-3},
                                          {"mil\xC3\xAD", 1e-3},
                                          {"kilo", 1e3}}};
constexpr std::array<Unit, 5> kOtherLengths{
    {{"inch", 0.0254}, {"inches", 0.0254}, {"zoll", 0.0254}, {"foot", 0.3048}, {"feet", 0.3048}}};
constexpr std::array<Unit, 9> kTimeWords{{{"second", 1.0},
                                          {"seconds", 1.0},
                                          {"sekunden", 1.0},
                                          {"secondes", 1.0},
                                          {"segundos", 1.0},
                                          {"secondi", 1.0},
                                          {"milliseconds", 1e-3},
                                          {"minute", 60.0},
                                          {"minutes", 60.0}}};

template <std::size_t N>
std::optional<double> factor(const std::array<Unit, N>& units, std::string_view unit) {
  const auto found = std::find_if(units.begin(), units.end(), [&](const Unit& of) { return of.first == unit; });
  if (found == units.end()) return {};
  return found->second;
}

/// "metres", "Zentimeter", "inches".
std::optional<double> length_word(std::string_view word) {
  const auto is_metre = [](std::string_view text) {
    return std::find(kMetre.begin(), kMetre.end(), text) != kMetre.end();
  };
  if (is_metre(word)) return 1.0;
  for (const auto& [prefix, of_metre] : kPrefixes) {
    if (word.starts_with(prefix) && is_metre(word.substr(prefix.size()))) return of_metre;
  }
  return factor(kOtherLengths, word);
}

}  // namespace

std::optional<double> metres_per(std::string_view unit) {
  const std::optional<double> symbol = factor(kLengths, unit);
  return symbol ? symbol : length_word(lower(unit));
}

std::optional<double> seconds_per(std::string_view unit) {
  const std::optional<double> symbol = factor(kTimes, unit);
  return symbol ? symbol : factor(kTimeWords, lower(unit));
}

}  // namespace glidelab::core
