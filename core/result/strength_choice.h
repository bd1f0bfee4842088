/// How a bandwidth, or the strength of a smoother, was chosen, as data. report/analysis/strength_words.h puts it into
/// words.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace glidelab::core {

namespace chosen_by {

/// Given in the options.
struct User {};

/// The default rule, least mean squared error of the lines (core/motion/bandwidth/rule_lines.h).
struct LinesRule {
  /// The bandwidth is raised above that optimum, so that points are quieter.
  struct Raised {
    double noise_share = 0.0;  ///< noise of a over its spread along the lines
    double bias_share = 0.0;   ///< bias of the lines over their size
  };
  double line_s = 0.0;  ///< the optimum
  std::optional<Raised> raised = {};
};

/// The first smoothing's bandwidth takes the place of one that cannot be chosen.
struct FirstSmoothing {
  std::string rule = {};  ///< the motion is too short for this rule; empty: no bandwidth gives a line
};

/// A rule of core/motion/bandwidth/bandwidth_rule.h. What it found is worded by the rule itself, as its name is: a
/// pattern of fmt with a place for each number, "rms x'''' of {:.3g} m/s^4".
struct Rule {
  enum class Edge { none, narrowest, widest, only };  ///< of the bandwidths tried
  std::string_view found;                             ///< a literal: results outlive whatever made it
  std::vector<double> numbers = {};
  Edge edge = Edge::none;  ///< at which the choice lies
  bool converted = false;  ///< from the bandwidth for x to that for a
};

/// The least error of a(t) of a simulated motion.
struct Truth {};

struct Likelihood {};
struct CrossValidation {};

/// No part of the motion is long enough for the smoother.
struct Nothing {};

}  // namespace chosen_by

/// Empty for results from elsewhere, which do not state it.
using StrengthChoice =
    std::variant<std::monostate, chosen_by::User, chosen_by::LinesRule, chosen_by::FirstSmoothing, chosen_by::Rule,
                 chosen_by::Truth, chosen_by::Likelihood, chosen_by::CrossValidation, chosen_by::Nothing>;

}  // namespace glidelab::core
