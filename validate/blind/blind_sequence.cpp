#include "validate/blind/blind_sequence.h"

#include <nlohmann/json.hpp>

#include "core/result/quantity.h"

namespace glidelab::validate {
namespace {

using SequenceJson = nlohmann::json;

/// The value of a key; null if it is missing.
const SequenceJson& value_of(const SequenceJson& object, const std::string& key) {
  static const SequenceJson none;
  return object.contains(key) ? object.at(key) : none;
}

BlindRecovered recovered_of(const SequenceJson& object) {
  BlindRecovered one{object.at("group"), object.at("mass_kg"), object.at("incline_deg"), {}};
  for (const std::string& key : core::quantity_keys()) {
    const SequenceJson& quantity = value_of(object, key);
    const SequenceJson& interval = quantity.is_object() ? value_of(quantity, "interval95") : quantity;
    if (interval.is_array()) one.interval95[key] = {interval.at(0), interval.at(1)};
  }
  return one;
}

}  // namespace

BlindSequence read_blind_sequence(const SequenceJson& diagnosis) {
  BlindSequence sequence;
  for (const SequenceJson& cause : value_of(diagnosis, "explained")) {
    sequence.explained.push_back({cause.at("id"), cause.at("share")});
  }
  if (const SequenceJson& rest = value_of(diagnosis, "remainder"); rest.is_object() && rest.at("share").is_number()) {
    sequence.remainder = rest.at("share").get<double>();
  }
  for (const SequenceJson& id : value_of(diagnosis, "traces")) sequence.traces.push_back(id);
  if (const SequenceJson& levels = value_of(diagnosis, "levels"); levels.is_object()) {
    for (const char* key : {"clip", "configuration", "all"}) {
      if (value_of(levels, key).is_number()) sequence.levels[key] = levels.at(key);
    }
  }
  for (const SequenceJson& one : value_of(diagnosis, "recovered")) sequence.recovered.push_back(recovered_of(one));
  return sequence;
}

}  // namespace glidelab::validate
