/// How strongly a motion was smoothed.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace glidelab::core {

/// How a bandwidth, or the strength of a smoother, was chosen, as data. report/analysis/note_words.h puts it into
/// words.

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
  std::string_view found;                             ///< a literal: results outlive the object that made it
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

/// What a smoother (core/motion/smoothing/smoother.h) chose.
struct SmoothingStrength {
  std::string smoother = "local-polynomial";
  StrengthChoice method;     ///< how it was chosen
  int order = 0;             ///< N of the process (wiener_chain.h); 0 if there is none
  double rate_1_s = 0.0;     ///< k, at which its last derivative decays
  double bandwidth_s = 0.0;  ///< of the local cubic; otherwise of the local cubic with the same noise in a, far from
                             ///< ends
  double noise_sd_m = 0.0;   ///< of a position of factor 1, if the smoother needs it; 0 otherwise
  /// For the integrated Wiener process of order N (wiener_chain.h): (s^2 dt / q)^(1 / 2N), dt the mean time step.
  /// Oscillations of x faster than 1/time_s in angular frequency are taken for noise.
  double time_s = 0.0;
  std::optional<double> jump_sd_m_s2;  ///< of a at a break; infinite if any jump is allowed
  std::vector<double> breaks_s;        ///< where a may jump, as estimated
  double parameters = 0.0;             ///< effective number of parameters: the trace of the smoothing matrix
  /// a ± this times its standard deviation contains a at all frames simultaneously with 95 % probability, if that is
  /// known.
  std::optional<double> simultaneous_a;
};

}  // namespace glidelab::core
