/// The causes of a diagnosis.json in their order: `explained`, `remainder`, `traces`, `levels`, `recovered` (result
/// files). A key that is missing or null counts as empty.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace glidelab::validate {

struct BlindExplained {
  std::string id;
  double share = 0.0;
};

struct BlindInterval {
  double low = 0.0, high = 0.0;
};

struct BlindRecovered {
  std::string group;
  double mass_kg = 0.0, incline_deg = 0.0;          ///< as stated
  std::map<std::string, BlindInterval> interval95;  ///< by key (k_over_m_1_s, mu, alpha_deg, v_lim_m_s), if stated
};

struct BlindSequence {
  std::vector<BlindExplained> explained;
  std::optional<double> remainder;  ///< share
  std::vector<std::string> traces;
  std::map<std::string, double> levels;  ///< clip, configuration, all
  std::vector<BlindRecovered> recovered;
};

/// Json::exception if an existing entry is incomplete or of the wrong type.
BlindSequence read_blind_sequence(const nlohmann::json& diagnosis);

}  // namespace glidelab::validate
