#include "validate/blind/blind_verdict.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/files/staged_output.h"

namespace glidelab::validate {
namespace {

using Json = nlohmann::json;

std::vector<std::string> split(const std::string& id) {
  const auto plus = id.find(" + ");
  if (plus == std::string::npos) return {id};
  return {id.substr(0, plus), id.substr(plus + 3)};
}

/// Json::exception where something is missing or of another type.
BlindVerdict verdict_of(const Json& document) {
  BlindVerdict verdict;
  verdict.verdict = document.at("verdict");
  verdict.points = document.at("points");
  verdict.none = document.at("probability").at("none");
  verdict.unknown = document.at("probability").at("unknown");
  for (const Json& effect : document.at("effects")) {
    verdict.effects.push_back({effect.at("id"), effect.at("probability"), effect.at("equivalent_to")});
  }
  for (const Json& ranked : document.at("ranking")) {
    BlindRanked one{split(ranked.at("id")),
                    ranked.at("probability"),
                    ranked.at("log_likelihood_gain"),
                    ranked.at("parameters"),
                    {}};
    if (ranked.contains("gap_after") && ranked.at("gap_after").is_number()) one.gap_after = ranked.at("gap_after");
    verdict.ranking.push_back(std::move(one));
  }
  for (const Json& region : document.at("where").at("regions")) {
    verdict.where.push_back(region.contains("clip") ? "clip" : std::string(region.at("variable")));
  }
  if (const Json& gap = document.at("gap"); gap.is_object()) {
    verdict.gap_before = gap.at("before");
    verdict.gap_after = gap.at("after");
    verdict.gap_error = gap.at("standard_error");
  }
  return verdict;
}

}  // namespace

BlindVerdict read_blind_verdict(const std::filesystem::path& file) {
  const Json document = Json::parse(base::read_file(file), nullptr, false);
  if (!document.is_object() || document.value("format", Json()) != 1 || !document.contains("verdict")) {
    throw base::InputError(base::Issue{file.string(), 0, "", "no diagnosis", "a diagnosis.json"});
  }
  try {
    return verdict_of(document);
  } catch (const Json::exception& error) {
    throw base::InputError(base::Issue{file.string(), 0, "", error.what(), "a diagnosis.json"});
  }
}

void set_aside(const std::vector<std::string>& told, BlindVerdict& verdict) {
  const auto is_told = [&](const std::string& id) { return std::find(told.begin(), told.end(), id) != told.end(); };
  if (told.empty() || verdict.verdict == "failed") return;
  std::erase_if(verdict.effects, [&](const BlindNamed& effect) { return is_told(effect.id); });
  if (verdict.verdict == "effect" && verdict.effects.empty()) verdict.verdict = "none";
  for (BlindRanked& ranked : verdict.ranking) {
    std::erase_if(ranked.ids, is_told);
    if (ranked.ids.empty()) verdict.none += ranked.probability;
  }
  std::erase_if(verdict.ranking, [](const BlindRanked& ranked) { return ranked.ids.empty(); });
}

}  // namespace glidelab::validate
