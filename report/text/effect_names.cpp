#include "report/text/effect_names.h"

#include <fmt/format.h>

#include <algorithm>

#include "diagnose/effects/effect_library.h"
#include "report/html/html.h"

namespace glidelab::report {
namespace {

std::string_view name_of(std::string_view id) {
  if (id == "none") return "nothing is missing";
  if (id == "unknown") return "something without a name";
  for (const diagnose::EffectInfo& effect : diagnose::all_effects()) {
    if (effect.id == id) return effect.name;
  }
  return id;
}

}  // namespace

std::string effect_name(std::string_view ids) {
  constexpr std::string_view kAnd = " + ";
  std::string text;
  for (std::size_t at = 0; at <= ids.size();) {
    const std::size_t end = std::min(ids.find(kAnd, at), ids.size());
    text += (text.empty() ? "" : std::string(kAnd)) + std::string(name_of(ids.substr(at, end - at)));
    at = end + kAnd.size();
  }
  return text;
}

std::vector<std::string> effect_names(const std::vector<std::string>& ids) {
  std::vector<std::string> names;
  for (const std::string& id : ids) names.push_back(effect_name(id));
  return names;
}

std::string effect_meaning(std::string_view id) {
  for (const diagnose::EffectInfo& effect : diagnose::all_effects()) {
    if (effect.id == id) return std::string(effect.meaning);
  }
  return {};
}

std::string effect_html(std::string_view ids) {
  const std::string name = effect_name(ids);
  if (name == ids) return escape(ids);
  return fmt::format("{} <small><code>{}</code></small>", escape(name), escape(ids));
}

}  // namespace glidelab::report
