#include "report/analysis/strength_words.h"

#include <fmt/args.h>
#include <fmt/format.h>

#include <variant>

#include "base/text/number_text.h"

namespace glidelab::report {
namespace {

/// Words for every choice; a choice without them does not compile.
struct ChoiceSentence {
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(const core::chosen_by::User&) const { return "given"; }
  std::string operator()(const core::chosen_by::LinesRule& of) const {
    std::string text = fmt::format("smallest mean squared error of the lines ({:.1f} ms)", 1e3 * of.line_s);
    if (of.raised) {
      text += fmt::format(
          ", raised for quieter points (the noise of a is {} % of its spread; the lines are biased by {} %)",
          base::digits_text(100.0 * of.raised->noise_share, 2), base::digits_text(100.0 * of.raised->bias_share, 2));
    }
    return text;
  }
  std::string operator()(const core::chosen_by::FirstSmoothing& of) const {
    return "that of the first smoothing: " +
           (of.rule.empty() ? "no bandwidth gives a line" : "the motion is too short for the rule " + of.rule);
  }
  std::string operator()(const core::chosen_by::Rule& of) const {
    fmt::dynamic_format_arg_store<fmt::format_context> numbers;
    for (const double number : of.numbers) numbers.push_back(number);
    using Edge = core::chosen_by::Rule::Edge;
    return fmt::vformat(fmt::string_view(of.found.data(), of.found.size()), numbers) +
           (of.edge == Edge::narrowest ? " (the narrowest tried)"
            : of.edge == Edge::widest  ? " (the widest tried)"
            : of.edge == Edge::only    ? " (the only one tried)"
                                       : "") +
           (of.converted ? ", converted for a" : "");
  }
  std::string operator()(const core::chosen_by::Truth&) const { return "the least error of a(t), by the truth"; }
  std::string operator()(const core::chosen_by::Likelihood&) const { return "maximum marginal likelihood"; }
  std::string operator()(const core::chosen_by::CrossValidation&) const {
    return "minimum generalised cross-validation";
  }
  std::string operator()(const core::chosen_by::Nothing&) const {
    return "no part of the motion is long enough to be smoothed";
  }
};

}  // namespace

std::string strength_words(const core::StrengthChoice& choice) {
  return std::visit(ChoiceSentence{}, choice);
}

}  // namespace glidelab::report
