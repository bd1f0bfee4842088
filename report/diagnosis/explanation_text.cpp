#include "report/diagnosis/explanation_text.h"

#include <fmt/format.h>

#include <vector>

#include "report/html/html.h"
#include "report/text/effect_names.h"

namespace glidelab::report {
namespace {

std::vector<std::string> ids_of(const diagnose::Explanation& explanation) {
  std::vector<std::string> ids = explanation.effects;
  if (explanation.unnamed) ids.emplace_back("unknown");
  if (ids.empty()) ids.emplace_back("none");
  return ids;
}

}  // namespace

std::string verdict_id(diagnose::Verdict verdict) {
  switch (verdict) {
    case diagnose::Verdict::none:
      return "none";
    case diagnose::Verdict::effect:
      return "effect";
    case diagnose::Verdict::unknown:
      return "unknown";
  }
  return {};
}

std::string explanation_id(const diagnose::Explanation& explanation) {
  return fmt::format("{}", fmt::join(ids_of(explanation), " + "));
}

std::string explanation_name(const diagnose::Explanation& explanation) {
  return fmt::format("{}", fmt::join(effect_names(ids_of(explanation)), " + "));
}

std::string explanation_html(const diagnose::Explanation& explanation) {
  const std::string name = explanation_name(explanation), id = explanation_id(explanation);
  if (name == id) return escape(id);
  return fmt::format("{} <small><code>{}</code></small>", escape(name), escape(id));
}

std::string percent(double probability) {
  if (probability > 0.995) return "more than 99 %";
  if (probability < 0.005) return "less than 1 %";
  return fmt::format("{:.0f} %", 100.0 * probability);
}

}  // namespace glidelab::report
