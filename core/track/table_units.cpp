#include "core/track/table_units.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
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
using Words = std::span<const std::string_view>;
constexpr std::array<std::string_view, 9> kMetre{"meter",         "meters", "metre",  "metres", "m\xC3\xA8tre",
                                                 "m\xC3\xA8tres", "metro",  "metros", "metri"};
constexpr std::array<std::string_view, 10> kSecond{"second",   "seconds", "sekunde",  "sekunden", "seconde",
                                                   "secondes", "segundo", "segundos", "secondo",  "secondi"};
constexpr std::array<std::string_view, 6> kMinute{"minute", "minutes", "minuten", "minuto", "minutos", "minuti"};
constexpr std::array<Unit, 22> kPrefixes{
    {{"deci", 0.1},          {"dezi", 0.1},          {"d\xC3\xA9\x63i", 0.1}, {"dec\xC3\xAD", 0.1},
     {"centi", 1e-2},        {"zenti", 1e-2},        {"cent\xC3\xAD", 1e-2},  {"milli", 1e-3},
     {"mili", 1e-3},         {"mil\xC3\xAD", 1e-3},  {"micro", 1e-6},         {"mikro", 1e-6},
     {"micr\xC3\xB3", 1e-6}, {"micr\xC3\xB4", 1e-6}, {"kilo", 1e3},           {"kil\xC3\xB3", 1e3},
     {"quil\xC3\xB4", 1e3},  {"quil\xC3\xB3", 1e3},  {"quilo", 1e3},          {"chilo", 1e3},
     {"milis", 1e-3},  // Portuguese: milissegundos
     {"micros", 1e-6}}};
constexpr std::array<Unit, 5> kOtherLengths{
    {{"inch", 0.0254}, {"inches", 0.0254}, {"zoll", 0.0254}, {"foot", 0.3048}, {"feet", 0.3048}}};
template <std::size_t N>
std::optional<double> factor(const std::array<Unit, N>& units, std::string_view unit) {
  const auto found = std::find_if(units.begin(), units.end(), [&](const Unit& of) { return of.first == unit; });
  if (found == units.end()) return {};
  return found->second;
}

/// "metres" and "Zentimeter" by the words for a metre, "Millisekunden" by those for a second.
std::optional<double> word_factor(Words words, std::string_view word) {
  const auto is_whole = [&](std::string_view text) {
    return std::find(words.begin(), words.end(), text) != words.end();
  };
  if (is_whole(word)) return 1.0;
  for (const auto& [prefix, of_whole] : kPrefixes) {
    if (word.starts_with(prefix) && is_whole(word.substr(prefix.size()))) return of_whole;
  }
  return {};
}

}  // namespace

std::optional<double> metres_per(std::string_view unit) {
  const std::optional<double> symbol = factor(kLengths, unit);
  if (symbol) return symbol;
  const std::string word = lower(unit);
  const std::optional<double> metric = word_factor(kMetre, word);
  return metric ? metric : factor(kOtherLengths, word);
}

std::optional<double> seconds_per(std::string_view unit) {
  const std::optional<double> symbol = factor(kTimes, unit);
  if (symbol) return symbol;
  const std::string word = lower(unit);
  if (std::find(kMinute.begin(), kMinute.end(), word) != kMinute.end()) return 60.0;
  return word_factor(kSecond, word);
}

}  // namespace glidelab::core
