/// What may explain the data: nothing beyond the nominal model, effects with a name, something without a name, or both.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glidelab::diagnose {

enum class Verdict { none, effect, unknown };

/// In files: "none", "effect", "unknown".
constexpr std::string_view verdict_id(Verdict verdict) {
  switch (verdict) {
    case Verdict::none:
      return "none";
    case Verdict::effect:
      return "effect";
    case Verdict::unknown:
      return "unknown";
  }
  return {};
}
/// Empty for any other word.
std::optional<Verdict> verdict_of_id(std::string_view id);

/// Its ids and words are made in report/diagnosis/words/diagnosis_words.h.
struct Explanation {
  std::vector<std::string> effects = {};  ///< ids, each once
  bool unnamed = false;                   ///< something without a name acts, alone or beside them

  bool is_nothing() const { return effects.empty() && !unnamed; }
  bool holds(const std::string& id) const;
  bool operator==(const Explanation&) const = default;
};

/// The verdict from the probabilities of nothing and of something without a name. Something is claimed only if it is
/// three times as likely as nothing.
Verdict verdict_by(double none, double unknown);

}  // namespace glidelab::diagnose
