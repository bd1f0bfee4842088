/// What a diagnosis of a blind case says, read from its diagnosis.json.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glidelab::validate {

struct BlindNamed {
  std::string id;
  double probability = 0.0;
  std::vector<std::string> equivalent_to;
};

struct BlindRanked {
  std::vector<std::string> ids;  ///< one or two
  double probability = 0.0;
  double log_likelihood_gain = 0.0;
  double parameters = 0.0;
  std::optional<double> gap_after;
};

/// What a diagnosis.json says; "failed" with `why` where there is none.
struct BlindVerdict {
  std::string verdict;  ///< none, effect, unknown, failed
  std::string why;
  std::vector<BlindNamed> effects;
  std::vector<BlindRanked> ranking;
  std::vector<std::string> where;  ///< variables of the regions, the largest excess first
  double none = 0.0, unknown = 0.0, points = 0.0;
  double gap_before = 0.0, gap_after = 0.0, gap_error = 0.0;
};

/// InputError where the file is not a diagnosis.
BlindVerdict read_blind_verdict(const std::filesystem::path& diagnosis_json);

/// Takes effects that the folder itself tells of out of what a verdict names: what held them besides others counts for
/// the others, what held them alone for none.
void set_aside(const std::vector<std::string>& told, BlindVerdict& verdict);

}  // namespace glidelab::validate
