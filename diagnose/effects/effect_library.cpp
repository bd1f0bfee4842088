#include "diagnose/effects/effect_library.h"

#include <stdexcept>

namespace glidelab::diagnose {
namespace effects {

#define GLIDELAB_DECLARE(id) EffectInfo id();
GLIDELAB_EFFECTS(GLIDELAB_DECLARE)
#undef GLIDELAB_DECLARE

}  // namespace effects

namespace {

std::vector<EffectInfo> list_of_all() {
  std::vector<EffectInfo> list;
#define GLIDELAB_ADD(id) list.push_back(effects::id());
  GLIDELAB_EFFECTS(GLIDELAB_ADD)
#undef GLIDELAB_ADD
  for (std::size_t e = 0; e < list.size(); ++e) {
    if (list[e].id != kEffectIds[e]) throw std::logic_error("an effect of another id: " + std::string(list[e].id));
    if (list[e].parameters.size() > kMostParameters) throw std::logic_error("too many parameters of an effect");
    for (std::size_t p = 0; p < list[e].parameters.size(); ++p) list[e].parameters[p].slot = {e, p};
  }
  return list;
}

}  // namespace

const std::vector<EffectInfo>& all_effects() {
  static const std::vector<EffectInfo> list = list_of_all();
  return list;
}

const std::vector<EffectInfo>& effect_list() {
  static const std::vector<EffectInfo> list = [] {
    std::vector<EffectInfo> shown = all_effects();
    std::erase_if(shown, [](const EffectInfo& effect) { return effect.search == Search::lines; });
    return shown;
  }();
  return list;
}

const EffectInfo& effect_of(std::string_view id) {
  return all_effects()[effect_index(id)];
}

const EffectInfo* find_effect(std::string_view id) {
  const auto& all = all_effects();
  const auto found = std::find_if(all.begin(), all.end(), [&](const EffectInfo& info) { return info.id == id; });
  return found == all.end() ? nullptr : &*found;
}

std::vector<std::string> effect_words() {
  return {kEffectIds.begin(), kEffectIds.end()};
}

std::size_t first_alike(std::size_t effect, bool filmed) {
  const Alike& alike = effect_list()[effect].alike;
  const bool same = !alike.id.empty() && (alike.filmed || !filmed);
  return same ? effect_index(alike.id) : effect;
}

bool follows_each_clip(std::size_t effect) {
  return effect_list()[effect].search == Search::pushes || differs_between_clips(effect);
}

bool is_bound_to_place(std::size_t effect) {
  const EffectInfo& info = effect_list()[effect];
  if (info.law.seen_m != nullptr && (info.law.seen_by == SeenBy::lens || info.law.seen_by == SeenBy::plane))
    return true;
  return std::any_of(info.parameters.begin(), info.parameters.end(), [](const EffectParameter& parameter) {
    return parameter.reach == Reach::places || parameter.shown_as == ShownAs::along_track ||
           parameter.shown_as == ShownAs::itself_and_middle || parameter.shown_as == ShownAs::place_of_middle;
  });
}

bool differs_between_clips(std::size_t effect) {
  const std::vector<EffectParameter>& parameters = effect_list()[effect].parameters;
  return std::any_of(parameters.begin(), parameters.end(),
                     [](const EffectParameter& parameter) { return parameter.each == Each::clip; });
}

EffectValues::EffectValues() {
  static const auto absent = [] {
    std::array<std::array<double, kMostParameters>, kEffects> values{};
    for (const EffectInfo& effect : all_effects()) {
      for (const EffectParameter& parameter : effect.parameters) {
        values[parameter.slot.effect][parameter.slot.parameter] = parameter.absent;
      }
    }
    return values;
  }();
  values_ = absent;
}

}  // namespace glidelab::diagnose
