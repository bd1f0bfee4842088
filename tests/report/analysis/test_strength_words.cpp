#include "report/analysis/strength_words.h"

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("every way to choose a bandwidth or a strength has words, with its numbers in the units that people read") {
  namespace by = core::chosen_by;
  using Edge = by::Rule::Edge;
  const std::vector<std::pair<core::StrengthChoice, std::string>> choices = {
      {std::monostate{}, ""},
      {by::User{}, "given"},
      {by::LinesRule{0.0412}, "smallest mean squared error of the lines (41.2 ms)"},
      {by::LinesRule{0.0412, by::LinesRule::Raised{0.01234, 0.0021}},
       "smallest mean squared error of the lines (41.2 ms), raised for quieter points (the noise of a is 1.2 % of its "
       "spread; the lines are biased by 0.21 %)"},
      {by::FirstSmoothing{}, "that of the first smoothing: no bandwidth gives a line"},
      {by::FirstSmoothing{"gcv"}, "that of the first smoothing: the motion is too short for the rule gcv"},
      {by::Rule{"a rule's words"}, "a rule's words"},
      {by::Rule{"from {:.1f} to {:.3g}", {1.25, 2.0 / 3.0}, Edge::none, false}, "from 1.2 to 0.667"},
      {by::Rule{"{:.1f} ms for x", {30.0}, Edge::narrowest, true},
       "30.0 ms for x (the narrowest tried), converted for a"},
      {by::Rule{"{:.1f} ms", {30.0}, Edge::widest, false}, "30.0 ms (the widest tried)"},
      {by::Rule{"{:.1f} ms", {30.0}, Edge::only, false}, "30.0 ms (the only one tried)"},
      {by::Truth{}, "the least error of a(t), by the truth"},
      {by::Likelihood{}, "maximum marginal likelihood"},
      {by::CrossValidation{}, "minimum generalised cross-validation"},
      {by::Nothing{}, "no part of the motion is long enough to be smoothed"}};
  std::vector<bool> seen(std::variant_size_v<core::StrengthChoice>, false);
  for (const auto& [choice, words] : choices) {
    CHECK(report::strength_words(choice) == words);
    seen[choice.index()] = true;
  }
  for (std::size_t kind = 0; kind < seen.size(); ++kind) {
    INFO("kind " << kind);
    CHECK(seen[kind]);
  }
}
