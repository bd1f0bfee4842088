#include "report/blind/blind_run.h"

#include <fmt/format.h>

namespace glidelab::report {

std::string method_name(validate::DecisionMethod method) {
  using validate::DecisionMethod;
  switch (method) {
    case DecisionMethod::diagnosis:
      return "glidelab diagnose";
    case DecisionMethod::best_residual:
      return "refit that lowers the residuals most";
    case DecisionMethod::stepwise_bic:
      return "stepwise BIC";
    case DecisionMethod::picking:
      return "picking at random";
    case DecisionMethod::forward_selection:
      return "forward selection by held-out residuals";
  }
  return {};
}

std::string without_words(validate::VerdictWithout verdict) {
  using validate::VerdictWithout;
  switch (verdict) {
    case VerdictWithout::other_name:
      return "another name";
    case VerdictWithout::sure_other_name:
      return fmt::format("another name, probability over {:.1f}", validate::kSureName);
    case VerdictWithout::equivalent:
      return "equivalent";
    case VerdictWithout::failed:
      return "failed";
    case VerdictWithout::none:
      return "none";
    case VerdictWithout::unknown:
      return "unknown";
  }
  return {};
}

std::map<std::string, std::map<std::string, std::size_t>> confusion_words(const validate::BlindScore& score) {
  std::map<std::string, std::map<std::string, std::size_t>> rows;
  for (const validate::ConfusionRow& row : score.confusion) {
    auto& said = rows[row.truth.value_or("two effects")];
    said = row.said;
    for (const auto& [found, times] : row.named) said[fmt::format("{} of the two named", found)] = times;
  }
  return rows;
}

}  // namespace glidelab::report
