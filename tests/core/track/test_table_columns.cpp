#include "core/track/table_columns.h"

#include <string>
#include <utility>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;

namespace {

struct Words {
  double factor;
  std::vector<std::string> words;
};

// English, German, French, Spanish, Portuguese, Italian; factors by the definition of the unit or the prefix.
const std::vector<Words> kLengths = {
    {1.0,
     {"m", "meter", "meters", "metre", "metres", "Meter", "mètre", "mètres", "metro", "metros", "metri", "METERS"}},
    {0.1, {"dm", "decimeter", "decimetres", "Dezimeter", "décimètres", "decímetros", "decimetri"}},
    {1e-2, {"cm", "centimeters", "centimetres", "Zentimeter", "centimètres", "centímetros", "centimetri"}},
    {1e-3, {"mm", "millimeters", "millimetres", "Millimeter", "millimètres", "milímetros", "millimetri"}},
    {1e-6,
     {"um", "µm", "μm", "micrometers", "micrometres", "Mikrometer", "micromètres", "micrómetros", "micrômetros",
      "micrometri"}},
    {1e3,
     {"km", "kilometers", "kilometres", "Kilometer", "kilomètres", "kilómetros", "quilômetros", "quilómetros",
      "chilometri"}},
    {0.0254, {"in", "inch", "inches", "Zoll"}},
    {0.3048, {"ft", "foot", "feet"}},
};

const std::vector<Words> kTimes = {
    {1.0,
     {"s", "sec", "second", "seconds", "Sekunde", "Sekunden", "seconde", "secondes", "segundo", "segundos", "secondo",
      "secondi"}},
    {1e-3,
     {"ms", "millisecond", "milliseconds", "Millisekunde", "Millisekunden", "milliseconde", "millisecondes",
      "milisegundo", "milisegundos", "milissegundos", "millisecondo", "millisecondi"}},
    {1e-6,
     {"us", "µs", "μs", "microseconds", "Mikrosekunden", "microsecondes", "microsegundos", "microssegundos",
      "microsecondi"}},
    {60.0, {"min", "minute", "minutes", "Minute", "Minuten", "minuto", "minutos", "minuti"}},
};

}  // namespace

TEST_CASE("units of length are symbols, and words of six languages with their prefixes") {
  for (const Words& unit : kLengths) {
    for (const std::string& word : unit.words) {
      INFO(word);
      CHECK(core::metres_per(word) == unit.factor);
      CHECK_FALSE(core::seconds_per(word));
    }
  }
}

TEST_CASE("units of time are symbols, and words of six languages with their prefixes") {
  for (const Words& unit : kTimes) {
    for (const std::string& word : unit.words) {
      INFO(word);
      CHECK(core::seconds_per(word) == unit.factor);
      CHECK_FALSE(core::metres_per(word));
    }
  }
}

TEST_CASE("other words, bare prefixes and symbols in the wrong case are no units") {
  for (const char* const word :
       {"", "milli", "kilo", "megameter", "metermeter", "millimillimeter", "secondary", "minus", "M", "S", "Pixel"}) {
    INFO(word);
    CHECK_FALSE(core::metres_per(word));
    CHECK_FALSE(core::seconds_per(word));
  }
}
