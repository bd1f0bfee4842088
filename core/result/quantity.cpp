#include "core/result/quantity.h"

namespace glidelab::core {

std::vector<std::string> quantity_keys() {
  std::vector<std::string> keys;
  for (const QuantityName& quantity : kQuantities) keys.emplace_back(quantity.key);
  return keys;
}

std::size_t place_of(std::string_view key) {
  std::size_t place = 0;
  while (place < kQuantities.size() && kQuantities[place].key != key) ++place;
  return place;
}

std::string symbol_of(std::string_view key) {
  const std::size_t place = place_of(key);
  return std::string(place < kQuantities.size() ? kQuantities[place].symbol : key);
}

std::string unit_of(std::string_view key) {
  const std::size_t place = place_of(key);
  return std::string(place < kQuantities.size() ? kQuantities[place].unit : "");
}

}  // namespace glidelab::core
